//! What the command search finds, in its order: commands, what can be added, tools, settings of the view and of time,
//! preferences, and the controls of the inspector for what is selected.

use egui::Context;
use impasto_editor_model::Session;
use impasto_editor_model::keymap::{Action, Digits, Preset};
use impasto_editor_model::playback::Pacing;
use impasto_editor_model::session::{Shading, Tool};

use crate::panels::tool_names::face;
use crate::panels::{Ask, Control, PanelInput, Preference, menus, tree};
use crate::theme::Theme;

/// One line of the search.
#[derive(Debug)]
pub(super) struct Entry {
    /// What it is called.
    pub(super) words: String,
    /// Its keys. For a preference or a control of the inspector, the place where it is found.
    pub(super) keys: String,
    pub(super) on: bool,
    /// The request, or why it cannot be made now.
    pub(super) ask: Result<Ask, &'static str>,
}

/// A setting of the session that is on or off.
struct Switch {
    name: &'static str,
    is_on: fn(&Session) -> bool,
    set: fn(&mut Session),
}

/// The switches of the session that have no command of their own.
const SWITCHES: &[Switch] = &[
    Switch {
        name: "Shading: painted",
        is_on: |session| session.shading == Shading::Painted,
        set: |session| session.shading = Shading::Painted,
    },
    Switch {
        name: "Shading: shaded",
        is_on: |session| session.shading == Shading::Shaded,
        set: |session| session.shading = Shading::Shaded,
    },
    Switch {
        name: "Shading: trust",
        is_on: |session| session.shading == Shading::Trust,
        set: |session| session.shading = Shading::Trust,
    },
    Switch {
        name: "Regions overlay",
        is_on: |session| session.overlays.regions,
        set: |session| session.overlays.regions = !session.overlays.regions,
    },
    Switch {
        name: "Grid",
        is_on: |session| session.overlays.grid,
        set: |session| session.overlays.grid = !session.overlays.grid,
    },
    Switch {
        name: "Auto key",
        is_on: |session| session.auto_key,
        set: |session| session.auto_key = !session.auto_key,
    },
    Switch {
        name: "Lock to view",
        is_on: |session| session.lock_to_view,
        set: |session| session.lock_to_view = !session.lock_to_view,
    },
    Switch { name: "Loop", is_on: |session| session.looped, set: |session| session.looped = !session.looped },
    Switch {
        name: "Finish frames",
        is_on: |session| session.finishes,
        set: |session| session.finishes = !session.finishes,
    },
    Switch {
        name: "Play in real time",
        is_on: |session| session.pacing == Pacing::RealTime,
        set: |session| session.pacing = Pacing::RealTime,
    },
    Switch {
        name: "Play every frame",
        is_on: |session| session.pacing == Pacing::EveryFrame,
        set: |session| session.pacing = Pacing::EveryFrame,
    },
    Switch {
        name: "Keys in lanes",
        is_on: Session::shows_lanes,
        set: |session| session.show_lanes(!session.shows_lanes()),
    },
    Switch {
        name: "Snap",
        is_on: |session| session.options.snap,
        set: |session| session.options.snap = !session.options.snap,
    },
];

/// Everything that the search knows.
pub(super) fn entries(ctx: &Context, shown: &PanelInput<'_>, controls: &[Control]) -> Vec<Entry> {
    let plain = |words: &str, ask: Result<Ask, &'static str>| Entry {
        words: words.to_owned(),
        keys: String::new(),
        on: false,
        ask,
    };
    let actions = menus::actions().into_iter().filter(|action| *action != Action::Palette);
    let mut all: Vec<Entry> = actions
        .map(|action| Entry {
            words: action.name().to_owned(),
            keys: shown.keys_of(action),
            on: menus::is_on(shown, action),
            ask: shown.why_not(action).map_or(Ok(Ask::Act(action)), Err),
        })
        .collect();
    all.extend(menus::others(shown).map(|(words, ask)| plain(words, ask)));
    // Importing a mesh is already among the commands.
    let additions = tree::additions(shown).into_iter();
    all.extend(additions.filter(|addition| !matches!(addition.ask, Ask::Act(_))).map(|addition| {
        let mut words = addition.words;
        if let Some(first) = words.get_mut(..1) {
            first.make_ascii_lowercase();
        }
        plain(&format!("Add {words}"), Ok(addition.ask))
    }));
    let without_key = [Tool::AddLight, Tool::ShotCamera].into_iter();
    all.extend(without_key.map(|tool| Entry {
        on: shown.session.tool() == tool,
        ..plain(face(tool).name, Ok(Ask::TakeUp(tool)))
    }));
    all.extend(SWITCHES.iter().map(|switch| Entry {
        on: (switch.is_on)(shown.session),
        ..plain(switch.name, Ok(shown.session_with(switch.set)))
    }));
    all.extend(preferences(ctx, shown).map(|(words, on, preference)| Entry {
        keys: "Preferences".to_owned(),
        on,
        ..plain(&words, Ok(Ask::Prefer(preference)))
    }));
    all.extend(controls.iter().map(|control| Entry {
        keys: if control.section == control.name { String::new() } else { control.section.clone() },
        ..plain(&control.name, Ok(Ask::Reach(control.clone())))
    }));
    all
}

/// The preferences as entries: the words of each, whether it shows as on, and the value that choosing it sets.
fn preferences(
    ctx: &Context,
    shown: &PanelInput<'_>,
) -> impl Iterator<Item = (String, bool, Preference)> + use<> {
    let is_dark = ctx.global_style().visuals.dark_mode;
    let keymap = shown.keymap;
    let foresees = shown.session.options.foresee;
    let digits = |digits| (keymap.digits == digits, Preference::Digits(digits));
    let choices = [
        ("Dark theme", (is_dark, Preference::Theme(Theme::Dark))),
        ("Light theme", (!is_dark, Preference::Theme(Theme::Light))),
        ("Keys like Blender", (keymap.preset == Preset::Blender, Preference::Keys(Preset::Blender))),
        ("Keys like Maya", (keymap.preset == Preset::Maya, Preference::Keys(Preset::Maya))),
        ("Digits choose modes", digits(Digits::Modes)),
        ("Digits choose views", digits(Digits::NumPad)),
        ("Show what a comb would do", (foresees, Preference::ForeseeStrokes(!foresees))),
        ("Motion of the window: usual", (false, Preference::ReducedMotion(false))),
        ("Motion of the window: little", (false, Preference::ReducedMotion(true))),
    ];
    let scale = ctx.zoom_factor();
    let sizes = [0.9_f32, 1.0, 1.25, 1.5, 2.0].map(|size| {
        let words = format!("Interface size {:.0} %", size * 100.0);
        (words, (scale - size).abs() < 0.01, Preference::Scale(size))
    });
    choices.map(|(words, (on, preference))| (words.to_owned(), on, preference)).into_iter().chain(sizes)
}
