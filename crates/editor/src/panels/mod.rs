//! The panels round the viewport. Each is a function that shows a [`PanelInput`] and gives what the user asks for as a
//! list of [`Ask`]; no panel changes the document or the session itself.
//!
//! Each bar cuts its own space off the `Ui` that it is given, so the order of the calls decides the layout: top bar,
//! status line, `strip`, problems, right column, options bar, rail. What is left is the viewport.

mod areas;
pub mod ask_close;
mod context_menu;
pub mod empty;
pub mod frame_viewer;
pub mod key_sheet;
mod menus;
pub mod options_bar;
pub mod palette;
mod preference;
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

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

pub mod brush_thumbnails;
mod column;
mod column_state;
mod inspector;
mod tree;

use egui::TextureHandle;
use impasto_editor_model::command::{Command, StrokesOf};
use impasto_editor_model::editor::Mend;
use impasto_editor_model::keymap::{Action, Keymap, OwnKeys, Scope};
use impasto_editor_model::session::{Mode, Tool};
use impasto_editor_model::timeline::{TimeHand, TimelineEvent};
use impasto_editor_model::{Document, Item, PictureFor, Selection, Session};
use impasto_painting::Painting;

pub use areas::{Area, area, next_area};
pub use column::{column, column_fits};
pub use column_state::{open_add_menu, rename};
pub use context_menu::{context_menu, open_context_menu};
pub use inspector::{Control, controls, inspector, reach};
pub use preference::Preference;
use problems::{Settle, Trouble};

use crate::files::own_presets::OwnPreset;
pub use tree::tree;

/// What the panels show.
#[derive(Clone, Copy)]
pub struct PanelInput<'a> {
    /// The document.
    pub document: &'a Document,
    /// Mode, tools, view.
    pub session: &'a Session,
    /// Whether the right column is shown where it fits ([`column_fits`]).
    pub has_column: bool,
    /// Playback and selected keys.
    pub time: &'a TimeHand,
    /// The painting that was prepared last, perhaps from an earlier version of the document; `None` if there is none.
    pub painting: Option<&'a Painting>,
    /// The key bindings in use; menus and tooltips take the texts of shortcuts from them.
    pub keymap: &'a Keymap,
    /// What is going on, and what the mouse and the keys would do now: `[Drag] comb  [Shift] smooth`.
    pub status: &'a str,
    /// Numbers about the picture, and the work in the background.
    pub numbers: Numbers<'a>,
    /// Recently opened files, the latest first.
    pub recent: &'a [PathBuf],
    /// What failed in the window and is not settled yet.
    pub troubles: &'a [Trouble],
    /// Missing meshes for which the scene's folder has a file that is probably the right one, each with this file.
    pub likely_meshes: &'a [(String, String)],
    /// Presets of the user's own.
    pub presets: &'a [OwnPreset],
    /// Pictures of the scene, one for each preset. The key is the name of a built-in preset, or the file of one of the
    /// user's own. Some may not be painted yet.
    pub preset_pictures: &'a BTreeMap<String, TextureHandle>,
}

impl<'a> PanelInput<'a> {
    /// What panels show of a document while there is nothing else to show: no painting, no recent file, no trouble.
    pub fn of(document: &'a Document, session: &'a Session, time: &'a TimeHand, keymap: &'a Keymap) -> Self {
        Self {
            document,
            session,
            has_column: true,
            time,
            painting: None,
            keymap,
            status: "",
            numbers: Numbers::default(),
            recent: &[],
            troubles: &[],
            likely_meshes: &[],
            presets: &[],
            preset_pictures: const { &BTreeMap::new() },
        }
    }

    /// The shortcut of an action, as text: the first that does the action in the current mode, else the first that does
    /// nothing in this mode. Empty if there is none.
    pub fn keys_of(&self, action: Action) -> String {
        let scope = match self.session.mode {
            Mode::Arrange => Scope::Arrange,
            Mode::Paint => Scope::Paint,
            Mode::Animate => Scope::Animate,
        };
        self.keymap.shortcut_text_in(action, scope).unwrap_or_default()
    }

    /// `words` with `{}` replaced by the shortcut of an action; empty if it has none. For keys within a sentence. Hints
    /// of the form `[F] radius` go through [`Keymap::in_own_keys`] instead.
    pub fn with_keys_of(&self, action: Action, words: &str) -> String {
        let keys = self.keys_of(action);
        if keys.is_empty() { String::new() } else { words.replace("{}", &keys) }
    }

    /// Why an action cannot be done now, in the words of its tooltip; `None` if it can.
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
            Action::SelectAll | Action::FrameAll | Action::Render | Action::ExportMovie
                if self.document.scene().objects.is_empty() =>
            {
                Some("The scene is empty")
            }
            _ => None,
        }
    }

    /// Copies the session, applies the change to the copy, and asks for it to be used.
    fn session_with(&self, change: impl FnOnce(&mut Session)) -> Ask {
        let mut session = self.session.clone();
        change(&mut session);
        Ask::Session(Box::new(session))
    }
}

/// Numbers about the picture for the status line, the inspector and the rulers, and the work in the background.
#[derive(Clone, Copy, Debug, Default)]
pub struct Numbers<'a> {
    /// Strokes in the last exact picture.
    pub strokes: usize,
    /// The strokes of each region in that picture, by the region's name.
    pub strokes_of: &'a [(String, usize)],
    /// Pictures per second, while something moves.
    pub pictures_per_second: Option<f64>,
    /// The graphics driver, such as *llvmpipe*.
    pub driver: &'a str,
    /// The frames whose exact pictures are cached, in order: they play exactly.
    pub finished: &'a [i64],
    /// Work that runs in the background.
    pub works: &'a [work::Work],
}

/// What a panel asks for.
#[derive(Debug)]
pub enum Ask {
    /// Carry out this command, as one entry of the history.
    Do(Command),
    /// As `Do`, but commands that follow each other within a second and have the same text (the second value) become
    /// one entry of the history, as while the wheel turns over a number.
    DoMerged(Command, String),
    /// Show the document as this command would leave it (while a slider is dragged). `Do` or `EndPreview` follows.
    Preview(Command),
    /// End the preview, and show the document as it is.
    EndPreview,
    /// Select this.
    Select(Selection),
    /// Let the user choose a mesh file, and give it to this object.
    ChooseMesh(String),
    /// Repair a problem of the document, or read the document again.
    Mend(Mend),
    /// Let the user locate a missing file, and copy it to this path, where the scene looks for it.
    BringFile(PathBuf),
    /// Show the list of problems, or hide it if it is shown.
    ShowProblems,
    /// Settle the trouble with this index.
    Settle(usize, Settle),
    /// Let the user choose a picture for this.
    ChoosePicture(PictureFor),
    /// Use the picture of this name, a path relative to the scene's folder, for this; `None` for no picture.
    NamePicture(PictureFor, Option<String>),
    /// Show the menu of this item, or with `None` that of the view, at the pointer.
    Menu(Option<Item>),
    /// Give this control of the inspector the focus.
    Reach(Control),
    /// Take this tool up.
    TakeUp(Tool),
    /// Keep this as a preference.
    Prefer(Preference),
    /// Let the user choose a file, and write a copy of the scene there.
    SaveCopy,
    /// Carry out this action, as its key would.
    Act(Action),
    /// Take over this session: mode, tools, overlays and frame. If its mode differs from the current one, take over
    /// only the mode; else if its tool differs, only the tool.
    Session(Box<Session>),
    /// Do this on the timeline.
    Timeline(TimelineEvent),
    /// Open this file.
    Open(PathBuf),
    /// Put these words on the clipboard.
    Copy(String),
    /// Ask the user whether the frame with this number is to become the reference.
    Recapture(i64),
    /// Stop this work in the background.
    StopWork(work::WorkKind),
    /// Read which presets of the user's own there are, for the list of presets.
    ListPresets,
    /// Paint the pictures for the list of presets, which is open for these strokes. Sent in each pass while the list is
    /// open.
    PicturePresets(StrokesOf),
    /// Let the user choose a file, and save these settings as a preset there.
    SavePreset(StrokesOf),
    /// Let the user choose a preset, and replace these settings by it.
    LoadPreset(StrokesOf),
    /// Replace these settings by the preset in this file.
    UsePreset(StrokesOf, PathBuf),
    /// Show the first-run sheet.
    Welcome,
    /// Show the sheet that changes keys.
    KeySheet,
    /// Keep these keys in place of the preset's.
    OwnKeys(OwnKeys),
}

/// A file's name to show, without its folder.
fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}

/// The width of some text, in points.
fn text_width(ui: &egui::Ui, text: &str, font: egui::FontId) -> f32 {
    ui.painter().layout_no_wrap(text.to_owned(), font, egui::Color32::WHITE).size().x
}

/// Shows something in `rect` without taking room from `ui`: later widgets are laid out as if it were not there.
fn within<R>(
    ui: &mut egui::Ui,
    rect: egui::Rect,
    layout: egui::Layout,
    show: impl FnOnce(&mut egui::Ui) -> R,
) -> R {
    show(&mut ui.new_child(egui::UiBuilder::new().max_rect(rect).layout(layout)))
}

/// From left to right, centred vertically.
fn row() -> egui::Layout {
    egui::Layout::left_to_right(egui::Align::Center)
}

/// From right to left, centred vertically.
fn row_from_right() -> egui::Layout {
    egui::Layout::right_to_left(egui::Align::Center)
}

/// A short vertical line between groups of a bar.
fn divider(ui: &mut egui::Ui) {
    let (rect, _) = ui.allocate_exact_size(egui::vec2(9.0, 20.0), egui::Sense::hover());
    ui.painter().vline(rect.center().x, rect.y_range(), (1.0, crate::theme::Tokens::of(ui).div));
}
