//! The panels round the viewport. Each is a function from what is shown to what is asked for; none changes anything itself.

pub mod brush_thumbnails;
mod column_state;
mod inspector;
mod tree;

use impasto_editor_model::command::Command;
use impasto_editor_model::keymap::{Action, Preset};
use impasto_editor_model::{Document, Selection, Session};
use impasto_painting::Painting;

pub use column_state::rename;
pub use inspector::inspector;
pub use tree::tree;

/// What the panels show.
#[derive(Clone, Copy)]
pub struct Shown<'a> {
    /// The document.
    pub document: &'a Document,
    /// Mode, tools, view.
    pub session: &'a Session,
    /// The painting as it was prepared last, perhaps of an earlier version; none before the first.
    pub painting: Option<&'a Painting>,
    /// Whose habits the keys follow.
    pub keys: Preset,
    /// What the mouse would do now, with keys: `[Drag] comb  [Shift] smooth`.
    pub status: &'a str,
    /// Numbers for the status line.
    pub numbers: Numbers<'a>,
}

/// Numbers for the status line.
#[derive(Clone, Copy, Debug, Default)]
pub struct Numbers<'a> {
    /// Strokes in the last exact picture.
    pub strokes: usize,
    /// Pictures a second, while something moves.
    pub pictures_per_second: Option<f64>,
    /// Who draws: *llvmpipe*.
    pub driver: &'a str,
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
    /// Do what a key would do.
    Act(Action),
    /// Mode, tools, overlays and frame as they are in this session.
    Session(Box<Session>),
}
