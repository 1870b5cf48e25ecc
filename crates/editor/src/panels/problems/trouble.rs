//! What failed in the window and is not settled yet: a save, a copy of unsaved work, a file that was to be read.

use std::path::PathBuf;

use impasto_editor_model::PictureFor;
use impasto_editor_model::command::StrokesOf;
use impasto_editor_model::watch::News;

/// A failure that is listed until it is settled.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Trouble {
    /// What failed.
    pub of: TroubleOf,
    /// What failed and why, as one sentence.
    pub words: String,
    /// How things stand now and, where the buttons do not say it, what to do.
    pub mend: String,
    /// What can be done, the best first; never empty.
    pub settles: &'static [Settle],
}

/// What a [`Trouble`] is about. A new trouble replaces an older one about the same thing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TroubleOf {
    /// The document was not saved to this file; `None` stands for the document's own file.
    Save(Option<PathBuf>),
    /// Unsaved work was not copied.
    Copy,
    /// A scene or a mesh was not opened.
    Open(PathBuf),
    /// What changed on disk was not read.
    ChangedOutside(News),
    /// The mesh at this path was not read for this.
    Mesh(MeshFor, PathBuf),
    /// The picture at this path could not be used for this.
    Picture(PictureFor, PathBuf),
    /// A preset was not applied to these settings.
    Preset(StrokesOf, PathBuf),
    /// These settings were not saved as a preset.
    SavePreset(StrokesOf, PathBuf),
}

impl TroubleOf {
    /// Whether saving the document settles the trouble. Saving also settles a change by another program, because the
    /// document's file then no longer holds what that program wrote.
    pub fn is_settled_by_saving(&self) -> bool {
        matches!(self, Self::Save(_) | Self::Copy | Self::ChangedOutside(News::Scene))
    }
}

/// What a mesh is read for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MeshFor {
    /// To add a new object.
    Import,
    /// To replace the mesh of this object.
    Replace(String),
}

/// What settles a trouble.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Settle {
    /// Do again what failed.
    Retry,
    /// Choose another file in place of the one that is missing.
    Locate,
    /// Save the scene elsewhere.
    SaveAs,
    /// Take it off the list.
    Dismiss,
}

impl Settle {
    /// The words on its button, and the button's name for screen readers.
    pub(super) fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Retry => ("Retry", "Retry"),
            Self::Locate => ("Locate\u{2026}", "Locate"),
            Self::SaveAs => ("Save as\u{2026}", "Save as"),
            Self::Dismiss => ("Dismiss", "Dismiss"),
        }
    }
}
