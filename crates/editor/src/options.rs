//! What the command line may say about the editor.

use std::path::PathBuf;

use crate::files::dialogs::Source;
use crate::files::preferences::DriverChoice;

/// What `impasto edit` was told.
#[derive(Clone, Debug, Default)]
pub struct EditOptions {
    /// The scene or mesh to open; none for an empty window.
    pub path: Option<PathBuf>,
    /// What draws the paintings; none for what the preferences say.
    pub driver: Option<DriverChoice>,
    /// Whose file dialogs.
    pub dialogs: Source,
    /// A folder of shaders that stand in for the program's own.
    pub shaders: Option<PathBuf>,
    /// Hears what the window shows, each time that its exact pictures are there, and where its controls are.
    pub tell: Option<fn(&str)>,
}
