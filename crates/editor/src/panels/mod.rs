//! The panels round the viewport. Each is a function from what is shown to what is asked for; none changes anything itself.
//!
//! The bars take their own strip off the `Ui` that they are handed, so their order is the window's: top bar, status line, strip,
//! right column, options bar, rail; what is left is the viewport.

mod areas;
pub mod ask_close;
pub mod empty;
mod menus;
pub mod options_bar;
pub mod palette;
pub mod problems;
pub mod rail;
pub mod render_sheet;
pub mod shortcuts;
pub mod status_line;
pub mod strip;
pub mod timeline;
mod tool_names;
pub mod top_bar;
pub mod welcome;
pub mod work;

use std::path::{Path, PathBuf};

pub mod brush_thumbnails;
mod column;
mod column_state;
mod inspector;
mod tree;

use impasto_editor_model::command::Command;
use impasto_editor_model::editor::Mend;
use impasto_editor_model::keymap::{Action, Keymap, Preset};
use impasto_editor_model::timeline::{TimeHand, TimelineEvent};
use impasto_editor_model::{Document, Selection, Session};
use impasto_painting::Painting;

pub use areas::{Area, area, next_area};
pub use column::{column, column_fits};
pub use column_state::{open_add_menu, rename};
pub use inspector::inspector;
pub use tree::tree;

/// What the panels show.
#[derive(Clone, Copy)]
pub struct PanelInput<'a> {
    /// The document.
    pub document: &'a Document,
    /// Mode, tools, view.
    pub session: &'a Session,
    /// Playback and selected keys.
    pub time: &'a TimeHand,
    /// The painting as it was prepared last, perhaps of an earlier version; none before the first.
    pub painting: Option<&'a Painting>,
    /// Whose habits the keys follow.
    pub keys: Preset,
    /// What the mouse would do now, with keys: `[Drag] comb  [Shift] smooth`.
    pub status: &'a str,
    /// Numbers for the status line.
    pub numbers: Numbers<'a>,
    /// Files that were open lately, the latest first.
    pub recent: &'a [PathBuf],
    /// For each mesh that is not there, the one of the scene's folder that is likely meant.
    pub likely_meshes: &'a [(String, String)],
}

impl PanelInput<'_> {
    /// The keys as menus and tooltips write them.
    pub fn keymap(&self) -> Keymap {
        Keymap { preset: self.keys, ..Keymap::default() }
    }

    /// The keys of an action, empty where it has none.
    pub fn keys_of(&self, action: Action) -> String {
        self.keymap().shortcut_text(action).unwrap_or_default()
    }

    /// Why an action cannot be done now, in the words of its tooltip; none where it can.
    pub fn why_not(&self, action: Action) -> Option<&'static str> {
        let selected = self.document.selection().active().is_some();
        match action {
            Action::Revert if self.document.file().is_none() => Some("This scene has no file yet"),
            Action::Undo if self.document.undo_text().is_none() => Some("There is nothing to take back"),
            Action::Redo if self.document.redo_text().is_none() => Some("Nothing was taken back"),
            Action::Delete
            | Action::Duplicate
            | Action::Rename
            | Action::Hide
            | Action::Lock
            | Action::SelectNone
            | Action::FrameSelected
                if !selected =>
            {
                Some("Nothing is selected")
            }
            Action::SelectAll | Action::FrameAll | Action::Render
                if self.document.scene().objects.is_empty() =>
            {
                Some("The scene is empty")
            }
            _ => None,
        }
    }

    /// The session after a change: what a panel asks for.
    fn session_with(&self, change: impl FnOnce(&mut Session)) -> Ask {
        let mut session = self.session.clone();
        change(&mut session);
        Ask::Session(Box::new(session))
    }
}

/// Numbers for the status line.
#[derive(Clone, Copy, Debug, Default)]
pub struct Numbers<'a> {
    /// Strokes in the last exact picture.
    pub strokes: usize,
    /// Of them, those of each region, by its name.
    pub strokes_of: &'a [(String, usize)],
    /// Pictures a second, while something moves.
    pub pictures_per_second: Option<f64>,
    /// Who draws: *llvmpipe*.
    pub driver: &'a str,
    /// What runs beside the window.
    pub works: &'a [work::Work],
}

/// What a panel asks for.
#[derive(Debug)]
pub enum Ask {
    /// Carry this out: one entry of the history.
    Do(Command),
    /// As `Do`; steps of one key within a second are one entry (the wheel over a field).
    DoMerged(Command, String),
    /// Show the document as this would leave it (a slider under the hand); `Do` or `EndPreview` follows.
    Preview(Command),
    /// Show the document as it is again.
    EndPreview,
    /// Select this.
    Select(Selection),
    /// Ask for a mesh file and give it to this object.
    ChooseMesh(String),
    /// Do something about what is wrong with the document.
    Mend(Mend),
    /// Ask for a file, and write a copy of the scene there.
    SaveCopy,
    /// Do what a key would do.
    Act(Action),
    /// Mode, tools, overlays and frame as they are in this session.
    Session(Box<Session>),
    /// Do this on the timeline.
    Timeline(TimelineEvent),
    /// Open this file.
    Open(PathBuf),
    /// Put these words on the clipboard.
    Copy(String),
    /// Ask whether this frame becomes the reference.
    Recapture(i64),
    /// Stop what takes its time.
    StopWork(work::WorkKind),
    /// Show the first-run sheet.
    Welcome,
}

/// A file's name for people, without its folder.
fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}

/// How wide some text stands, points.
fn text_width(ui: &egui::Ui, text: &str, font: egui::FontId) -> f32 {
    ui.painter().layout_no_wrap(text.to_owned(), font, egui::Color32::WHITE).size().x
}

/// Puts something at a place of its own; what comes after it in `ui` stands where it would without it.
fn within<R>(
    ui: &mut egui::Ui,
    rect: egui::Rect,
    layout: egui::Layout,
    show: impl FnOnce(&mut egui::Ui) -> R,
) -> R {
    show(&mut ui.new_child(egui::UiBuilder::new().max_rect(rect).layout(layout)))
}

/// From left to right, in the middle of the height.
fn row() -> egui::Layout {
    egui::Layout::left_to_right(egui::Align::Center)
}

/// From right to left, in the middle of the height.
fn row_from_right() -> egui::Layout {
    egui::Layout::right_to_left(egui::Align::Center)
}

/// A short upright line between groups of a bar.
fn divider(ui: &mut egui::Ui) {
    let (rect, _) = ui.allocate_exact_size(egui::vec2(9.0, 20.0), egui::Sense::hover());
    ui.painter().vline(rect.center().x, rect.y_range(), (1.0, crate::theme::Tokens::of(ui).div));
}
