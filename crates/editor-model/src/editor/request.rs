//! What the editor asks of the window: files, menus, questions; and the messages that it shows.

use crate::command::Command;
use crate::selection::Item;

/// A request that only the window can fulfil.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// Opens a new, empty scene; asks about unsaved work first.
    New,
    /// Asks for a scene or a mesh to open.
    Open,
    /// Writes to the document's own file, or asks for one.
    Save,
    /// Asks for a file to write to.
    SaveAs,
    /// Asks for a file to write a copy to.
    SaveCopy,
    /// Reads the document's file again without a question, since undo brings unsaved edits back.
    Revert,
    /// Closes the window; asks about unsaved work first.
    Quit,
    /// Asks for a mesh to add.
    Import,
    /// Shows the command search.
    Palette,
    /// Shows the list of all keys.
    Shortcuts,
    /// Lets the user type a new name for what is selected.
    Rename,
    /// Shows the menu of things to add.
    Add,
    /// Shows the menu of the thing under the pointer, or of the view if nothing is there.
    Menu(Option<Item>),
    /// Shows or folds the right column.
    ToggleColumn,
    /// Shows only the viewport, or everything.
    MaximiseViewport,
    /// Gives the keyboard to the next area of the window.
    NextArea,
    /// Shows the dialog in which the user sets what is rendered.
    Render,
    /// Shows the dialog of [`Self::Render`] for a movie.
    ExportMovie,
    /// Reads the scene from the text that is edited in the panel of problems.
    ReadSource,
    /// Asks whether this frame is to become the reference.
    Recapture(i64),
    /// Asks whether to carry out this command, although it takes triangles from other regions. The text says how many:
    /// *340 triangles of skin*.
    TakeFaces(Box<Command>, String),
}

/// A message to show for a while.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Said {
    /// The words.
    pub words: String,
    /// The action that a click on the message triggers.
    pub offers: Option<Offer>,
    /// Whether it reports something that was refused.
    pub is_refusal: bool,
}

/// An action that a message offers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Offer {
    /// Undoes the last entry of the history.
    Undo,
    /// Restores the pose that was left without a key.
    PoseAgain,
}
