//! The options of `impasto edit`.

use std::path::PathBuf;

use crate::files::dialogs::Source;
use crate::files::preferences::DriverChoice;

/// The options of `impasto edit`.
#[derive(Clone, Debug, Default)]
pub struct EditOptions {
    /// The scene or mesh to open; none for an empty window.
    pub path: Option<PathBuf>,
    /// The driver that draws the paintings; none for the one in the preferences.
    pub driver: Option<DriverChoice>,
    /// Where file dialogs come from.
    pub dialogs: Source,
    /// A folder of shaders that replace the program's own.
    pub shaders: Option<PathBuf>,
    /// Whether to follow another program, which writes its frame and view to standard input.
    pub follow: bool,
    /// Called with a report for tests and scripts: what the window shows whenever its exact pictures are done, the
    /// frames that are played, and where the controls are.
    pub tell: Option<fn(&str)>,
}
