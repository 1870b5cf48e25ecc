//! The buttons and fields of the timeline: playback and frame at the left, range, rate and loop at the right.

use egui::{Rect, RichText, Role, Ui, WidgetInfo, accesskit, pos2, vec2};
use impasto_editor_model::Session;
use impasto_editor_model::command::{Command, Time};
use impasto_editor_model::keymap::Action;
use impasto_editor_model::playback::Pacing;
use impasto_editor_model::timeline::{TimelineEvent, typed_frame};
use impasto_scene::document::Timeline;
use impasto_scene::limits::MAX_FRAME;

use crate::icons;
use crate::panels::{Ask, PanelInput, divider, text_width};
use crate::theme::{Tokens, measure, type_face};
use crate::widgets::{self, Button, FieldResponse, NumberField, Tip};

/// The frames per second that can be typed.
pub(in crate::panels) const FPS: std::ops::RangeInclusive<f64> = 0.001..=1e6;

/// In a window narrower than this, in points, the bar leaves out the time and the shortcut of *Set key*, which are not
/// controls.
const NARROW: f32 = 1080.0;

/// In a window narrower than this, in points, *Auto key*, *Set key* and the pacing are icons. The bar also leaves out
/// the word *Range* and the dropped frames.
const ICONS_ONLY: f32 = 900.0;

/// In a window narrower than this, in points, *Curves* is an icon.
const ROOM_FOR_CURVES: f32 = 1200.0;

/// The buttons that go to the ends, step and play; and the field of the frame that is shown.
pub(in crate::panels) fn transport(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    ui.spacing_mut().item_spacing.x = 1.0;
    ui.add_space(7.0);
    let plays = shown.time.playback.is_playing();
    let (icon, name) = if plays { (icons::PAUSE, "Pause") } else { (icons::PLAY, Action::Play.name()) };
    for (icon, name, action) in [
        (icons::FIRST_FRAME, Action::FirstFrame.name(), Action::FirstFrame),
        (icons::PREVIOUS_FRAME, Action::StepBack.name(), Action::StepBack),
        (icon, name, Action::Play),
        (icons::NEXT_FRAME, Action::StepOn.name(), Action::StepOn),
        (icons::LAST_FRAME, Action::LastFrame.name(), Action::LastFrame),
    ] {
        if action == Action::Play {
            let (at, tokens) = (ui.cursor().min, Tokens::of(ui));
            let top = ui.max_rect().center().y - measure::BUTTON / 2.0;
            let side = vec2(measure::BUTTON, measure::BUTTON);
            ui.painter().rect_filled(Rect::from_min_size(pos2(at.x, top), side), measure::CORNER, tokens.wid);
        }
        let response = widgets::icon_button(ui, icon, name);
        let response = Tip { name, key: &shown.keys_of(action), effect: "", range: "" }.on(response);
        if response.clicked() {
            asks.push(Ask::Act(action));
        }
    }
    ui.add_space(6.0);
    let mut frame = shown.session.frame;
    let fps = shown.document.scene().timeline.fps;
    let read = |text: &str| typed_frame(text, fps);
    let field = NumberField::new("Current frame", &mut frame, f64::NEG_INFINITY..=f64::INFINITY)
        .reading(&read)
        .tip("", "The frame that is shown. A time may be typed: 1.5 s.");
    if field.unlabelled(52.0).centred().show(ui).changed {
        let frame = frame.clamp(-MAX_FRAME, MAX_FRAME);
        asks.push(Ask::Timeline(TimelineEvent::GoTo(frame)));
    }
}

/// What follows the playback buttons while the lanes are open: the time, Auto key, Set key and Curves.
pub(super) fn keying(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    let window_wide = ui.ctx().content_rect().width();
    let (is_narrow, icons_only) = (window_wide < NARROW, window_wide < ICONS_ONLY);
    if !is_narrow {
        seconds(ui, shown);
    }
    ui.add_space(if icons_only { 2.0 } else { 6.0 });
    let on = shown.session.auto_key;
    let words = if icons_only { " " } else { "    Auto key" };
    let response = Button::new(words).name("Auto key").on(on).show(ui);
    let tokens = Tokens::of(ui);
    let dot = response.rect.left_center() + vec2(16.0, 0.0);
    if on {
        ui.painter().circle_filled(dot, 5.0, tokens.vermilion);
    } else {
        ui.painter().circle_stroke(dot, 4.5, (1.0, tokens.out));
    }
    let effect = "In Animate, a pose is keyed at its frame as it is made. Off, it is lost with its frame.";
    if (Tip { name: "Auto key", key: "", effect, range: "" }).on(response).clicked() {
        asks.push(shown.session_with(|session| session.auto_key = !on));
    }
    ui.add_space(8.0);
    let keys = shown.keys_of(Action::SetKey);
    let response = match icons_only {
        true => widgets::icon_button(ui, icons::KEY, "Set key"),
        false => Button::new("Key").name("Set key").icon(icons::KEY).plain().show(ui),
    };
    let effect = "Keys what is selected as it stands at this frame.";
    if (Tip { name: "Set key", key: &keys, effect, range: "" }).on(response).clicked() {
        asks.push(Ask::Act(Action::SetKey));
    }
    if !keys.is_empty() && !is_narrow {
        widgets::key_cap(ui, &keys);
    }
    ui.add_space(8.0);
    curves(ui, shown, asks);
}

/// The button that shows curves in the place of the lanes' keys.
fn curves(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    let on = shown.session.shows_curves();
    let effect = "Shows how values come from key to key, with handles to drag, in the place of the keys.";
    let response = if ui.ctx().content_rect().width() < ROOM_FOR_CURVES {
        let mut shows = on;
        widgets::icon_toggle(ui, icons::CURVES, "Curves", &mut shows)
    } else {
        Button::new("Curves").icon(icons::CURVES).on(on).show(ui)
    };
    let keys = shown.keys_of(Action::Curves);
    if (Tip { name: "Curves", key: &keys, effect, range: "" }).on(response).clicked() {
        asks.push(shown.session_with(Session::toggle_curves));
    }
}

/// The time of the frame that is shown.
fn seconds(ui: &mut Ui, shown: &PanelInput<'_>) {
    ui.add_space(8.0);
    let seconds = shown.session.frame / shown.document.scene().timeline.fps;
    let words = format!("{seconds:.2} s");
    let room = text_width(ui, "0000.00 s", type_face::number());
    let left = ui.cursor().left();
    ui.label(RichText::new(words).font(type_face::number()).color(Tokens::of(ui).weak));
    ui.add_space((left + room - ui.cursor().left()).max(2.0));
    divider(ui);
}

/// What is at the right end, from right to left: fold, finish, loop, fields for rate and range, dropped frames, pacing.
pub(super) fn range_fields(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    ui.spacing_mut().item_spacing.x = measure::GAP;
    ui.add_space(6.0);
    let response = widgets::icon_button(ui, icons::KEYS_DOWN, "Hide keys");
    let effect = "Folds the lanes to a strip.";
    if (Tip { name: "Hide keys", key: "", effect, range: "" }).on(response).clicked() {
        asks.push(shown.session_with(|session| session.show_lanes(false)));
    }
    finishes(ui, shown, asks);
    looped(ui, shown, asks);
    let Timeline { fps, first, last, .. } = shown.document.shown().scene.timeline;
    let stored = &shown.document.scene().timeline;
    let mut value = fps;
    let decimals = if fps.fract() == 0.0 { 0 } else { 3 };
    let field = NumberField::new("Frames per second", &mut value, f64::NEG_INFINITY..=f64::INFINITY)
        .limits(FPS)
        .step(1.0, decimals)
        .reading(&|text| text.trim().trim_end_matches("fps").trim().replace(',', ".").parse().ok())
        .unit("fps");
    let answer = field.unlabelled(if decimals == 0 { 62.0 } else { 92.0 }).show(ui);
    asks.extend(asked(&answer, value, [fps, stored.fps], Time::SetFps));
    for (name, is_end) in [("Range end", true), ("Range start", false)] {
        let before = if is_end { last } else { first } as f64;
        let mut value = before;
        let (least, most) = if is_end { (first as f64, MAX_FRAME) } else { (-MAX_FRAME, last as f64) };
        let field = NumberField::new(name, &mut value, f64::NEG_INFINITY..=f64::INFINITY);
        let answer = field.limits(least..=most).unlabelled(50.0).show(ui);
        let stored_value = if is_end { stored.last } else { stored.first } as f64;
        asks.extend(asked(&answer, value, [before, stored_value], |to| match is_end {
            true => Time::SetRange(stored.first, to as i64),
            false => Time::SetRange(to as i64, stored.last),
        }));
    }
    if ui.ctx().content_rect().width() < ICONS_ONLY {
        return pacing_icon(ui, shown, asks);
    }
    ui.label(RichText::new("Range").font(type_face::small()).color(Tokens::of(ui).weak));
    ui.add_space(4.0);
    dropped(ui, shown);
    let mut pacing = usize::from(shown.session.pacing == Pacing::EveryFrame);
    let choices = ["Real time", "Every frame"];
    if widgets::combo(ui, "Pacing", Some(icons::DROPPED), &choices, &mut pacing).changed() {
        let pacing = if pacing == 0 { Pacing::RealTime } else { Pacing::EveryFrame };
        asks.push(shown.session_with(|session| session.pacing = pacing));
    }
}

/// The choice of the pacing as a toggle.
fn pacing_icon(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    let mut real_time = shown.session.pacing == Pacing::RealTime;
    let response = widgets::icon_toggle(ui, icons::DROPPED, "Pacing", &mut real_time);
    let effect = "On, frames are dropped to keep real time. Off, every frame is shown.";
    if (Tip { name: "Real time", key: "", effect, range: "" }).on(response).changed() {
        let pacing = if real_time { Pacing::RealTime } else { Pacing::EveryFrame };
        asks.push(shown.session_with(|session| session.pacing = pacing));
    }
}

pub(in crate::panels) fn looped(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    let mut looped = shown.session.looped;
    let response = widgets::icon_toggle(ui, icons::LOOP, "Loop", &mut looped);
    let effect = "Playing begins again at the end of the range.";
    if (Tip { name: "Loop", key: "", effect, range: "" }).on(response).changed() {
        asks.push(shown.session_with(|session| session.looped = looped));
    }
}

/// The toggle for painting the film's frames exactly while the user pauses.
pub(in crate::panels) fn finishes(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    let mut on = shown.session.finishes;
    let response = widgets::icon_toggle(ui, icons::FINISH, "Finish frames", &mut on);
    let effect = "Once you have played, frames are painted exactly while you pause, and then play exactly. A line marks them.";
    if (Tip { name: "Finish frames", key: "", effect, range: "" }).on(response).changed() {
        asks.push(shown.session_with(|session| session.finishes = on));
    }
}

/// Shows how many frames were dropped since playback began. If playback shows every frame, shows its rate instead.
pub(in crate::panels) fn dropped(ui: &mut Ui, shown: &PanelInput<'_>) {
    let playback = &shown.time.playback;
    let words = match (shown.session.pacing, playback.dropped(), playback.rate()) {
        (Pacing::EveryFrame, _, Some(rate)) => format!("{rate:.1} fps"),
        (Pacing::EveryFrame, _, None) | (Pacing::RealTime, 0, _) => return,
        (Pacing::RealTime, dropped, _) => format!("{dropped} dropped"),
    };
    let response = ui.label(RichText::new(&words).font(type_face::small()).color(Tokens::of(ui).ochre));
    response.widget_info(|| {
        let mut info = WidgetInfo::labeled(Role::Status, true, "Dropped frames");
        info.current_text_value = Some(words.clone());
        info
    });
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_live(accesskit::Live::Off));
}

/// What a field asks for: a drag is previewed and makes one entry of the history.
fn asked(
    answer: &FieldResponse,
    value: f64,
    [shown, stored]: [f64; 2],
    time: impl Fn(f64) -> Time,
) -> Option<Ask> {
    let command = || Command::Time(time(value));
    if answer.stepped {
        let name = format!("{:?}", answer.response.id);
        (value != shown).then(|| Ask::DoMerged(command(), name))
    } else if answer.ended {
        Some(if value == stored { Ask::EndPreview } else { Ask::Do(command()) })
    } else {
        answer.changed.then(|| Ask::Preview(command()))
    }
}
