//! Which files a scene may read: those under its own folder and under the folders that the user names.

use std::path::PathBuf;

/// The folders that a scene's files may come from.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AssetFolders {
    /// Searched after the scene file's own folder, in order (`--asset-dir`).
    pub extra: Vec<PathBuf>,
}
