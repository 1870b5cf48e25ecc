//! Reports to tests and scripts what the window shows (`impasto edit --tell`): the picture at rest, playback, controls.

use std::fmt::Write as _;

use egui::Context;
use egui::accesskit::{Role, TreeUpdate};
use impasto_editor_model::camera_rig::Looking;
use impasto_editor_model::editor::{Editor, reference_frame};
use impasto_editor_model::session::Mode;

use super::EditorApp;

/// Where reports go, and what was reported last.
#[derive(Default)]
pub(super) struct Telling {
    tell: Option<fn(&str)>,
    rest: String,
    /// The controls of the last pass, and whether they were reported.
    controls: (String, bool),
    menu_was_open: bool,
}

impl Telling {
    pub(super) fn new(tell: Option<fn(&str)>) -> Self {
        Self { tell, ..Self::default() }
    }

    pub(super) fn is_on(&self) -> bool {
        self.tell.is_some()
    }

    /// Reports the names and rectangles of all controls, once two passes in a row laid them out alike: in its first
    /// pass a sheet or a menu is only measured.
    pub(super) fn tell_controls(&mut self, ctx: &Context, controls: &TreeUpdate) {
        let Some(tell) = self.tell else { return };
        let words = controls_in_words(controls);
        let (last, is_told) = &mut self.controls;
        if words != *last {
            (*last, *is_told) = (words, false);
            ctx.request_repaint();
        } else if !std::mem::replace(is_told, true) {
            tell(last);
        }
    }
}

/// `controls:`, then name, x, y, width and height (points) of each control, then `end`; tabs between all parts.
fn controls_in_words(controls: &TreeUpdate) -> String {
    let mut words = "controls:".to_owned();
    for (_, node) in &controls.nodes {
        let (Some(name), Some(rect)) = (node.label(), node.bounds()) else { continue };
        if node.role() == Role::Label || name.is_empty() {
            continue;
        }
        let name = name.replace(['\t', '\n'], " ");
        let [width, height] = [rect.x1 - rect.x0, rect.y1 - rect.y0];
        // Writing to a string cannot fail.
        let _ = write!(words, "\t{name}\t{:.0}\t{:.0}\t{width:.0}\t{height:.0}", rect.x0, rect.y0);
    }
    words + "\tend"
}

impl EditorApp {
    /// Reports the frame of the playback that was just shown, the frame that the clock stands at, and how many frames
    /// were dropped.
    pub(super) fn tell_played(&self) {
        let playback = &self.editor.time().playback;
        let clock = playback.clock_frame(self.editor.now_secs());
        if let (Some(tell), Some(clock)) = (self.telling.tell, clock) {
            let (frame, dropped) = (self.editor.session.frame, playback.dropped());
            tell(&format!("playing: frame {frame}, clock {clock:.3}, dropped {dropped}"));
        }
    }

    /// Reports what the window shows, each time it has come to rest on something new.
    pub(super) fn tell_rest(&mut self, ctx: &Context) {
        // In its first pass a menu is only measured: it cannot be clicked before the second.
        let menu_is_open = egui::Popup::is_any_open(ctx);
        let menu_is_shown = std::mem::replace(&mut self.telling.menu_was_open, menu_is_open) && menu_is_open;
        let (Some(tell), Some(version)) = (self.telling.tell, self.picture_flow.at_rest()) else { return };
        let over = match (self.is_modal(), menu_is_shown) {
            (true, _) => ", under a sheet",
            (false, true) => ", under a menu",
            (false, false) => "",
        };
        let words = format!("at rest, version {version}: {}{over}", value(&self.editor));
        if words != self.telling.rest {
            tell(&words);
            self.telling.rest = words;
        }
    }
}

/// What a screen reader says of the viewport.
pub(super) fn value(editor: &Editor) -> String {
    let session = &editor.session;
    let mode = match session.mode {
        Mode::Arrange => "Arrange",
        Mode::Paint => "Paint",
        Mode::Animate => "Animate",
    };
    let tool = format!("{:?}", session.tool()).to_lowercase();
    let camera = if editor.looking == Looking::Shot { "shot camera" } else { "free view" };
    let reference =
        if reference_frame(editor.document().scene()) == session.frame { ", reference" } else { "" };
    let compared = if session.compare { ", compared" } else { "" };
    format!("{mode}, {tool}, {camera}, frame {}{reference}{compared}", session.frame)
}
