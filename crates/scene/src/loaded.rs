//! A scene with all files that it names, read and checked.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use crate::document::Scene;
pub use crate::found_files::FoundFiles;
use crate::mesh_file::{MeshFile, Texture};
use crate::point_cache::PointCache;
use crate::problem::Problem;

/// A scene and the files that it names. `check` has passed: names resolve, numbers are finite and in range, limits
/// hold.
#[derive(Clone, Debug)]
pub struct LoadedScene {
    /// The scene file, or the mesh file that the scene was made for.
    pub path: PathBuf,
    /// The document.
    pub scene: Scene,
    /// Mesh files, by the path written in the document.
    pub meshes: BTreeMap<String, Arc<MeshFile>>,
    /// Point caches, by the path written in the document.
    pub caches: BTreeMap<String, Arc<PointCache>>,
    /// Pictures that materials of the document name, by the path written there.
    pub textures: BTreeMap<String, Arc<Texture>>,
    /// Pictures that serve as brushes, by the path written in the document.
    pub brushes: BTreeMap<String, Arc<Texture>>,
    /// All files that were found while the scene was read: those above, and those that they name.
    pub files: FoundFiles,
    /// The problems that did not keep the scene from being loaded.
    pub warnings: Vec<Problem>,
}

impl LoadedScene {
    /// The scene file, then all files that were read with it. Output must not overwrite any of them.
    pub fn inputs(&self) -> Vec<PathBuf> {
        let found = self.files.places().into_keys().filter(|path| *path != self.path);
        std::iter::once(self.path.clone()).chain(found).collect()
    }
}
