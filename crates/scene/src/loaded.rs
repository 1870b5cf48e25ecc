//! A scene with all files that it names, read and checked.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::sync::Arc;

use crate::document::Scene;
use crate::mesh_file::{MeshFile, Texture};
use crate::mesh_format;
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
    /// Everything that was wrong but could be repaired while reading.
    pub warnings: Vec<Problem>,
}

impl LoadedScene {
    /// The scene file and the files that it names, which output must not overwrite. Names are taken from the scene's
    /// folder.
    pub fn inputs(&self) -> Vec<PathBuf> {
        let folder = self.path.parent().map(PathBuf::from).unwrap_or_default();
        let meshes = self.meshes.keys().map(|name| mesh_format::file_and_node(name).0);
        let others =
            self.textures.keys().chain(self.brushes.keys()).chain(self.caches.keys()).chain(&self.scene.shot);
        let named: BTreeSet<&str> = meshes.chain(others.map(String::as_str)).collect();
        let named = named.into_iter().map(|name| folder.join(name));
        let with_sidecars = named.flat_map(|path| {
            let sidecar = mesh_format::sidecar_of(&path).filter(|sidecar| sidecar.is_file());
            std::iter::once(path).chain(sidecar)
        });
        std::iter::once(self.path.clone()).chain(with_sidecars).collect()
    }
}
