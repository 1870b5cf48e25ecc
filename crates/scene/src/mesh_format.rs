//! Reads mesh files of all formats, OBJ and glTF, in one way: other modules need not know the format.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::assets::AssetFolders;
use crate::gltf::{self, InstanceKey, Shared};
use crate::mesh_file::MeshFile;
use crate::obj;
use crate::problem::{Problem, Report};
use crate::texture;

/// The separator between a mesh file's name and the name of a node in it: `props.glb#Lamp`.
const NODE: char = '#';

/// A mesh that was read, with the warnings. Nodes that show the same mesh with the same uneven scale and shear share it
/// in memory.
pub type MeshRead = Result<(Arc<MeshFile>, Vec<Problem>), Report>;

/// Endings of mesh files, in lower case.
pub const ENDINGS: [&str; 3] = ["obj", "gltf", "glb"];

/// Whether a file is a mesh file, by its ending.
pub fn is_mesh(path: &Path) -> bool {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    ending.is_some_and(|ending| ENDINGS.contains(&ending.as_str()))
}

/// The size in bytes above which a file with this ending is refused: a mesh file, one that a mesh file names, or a
/// point cache.
pub fn max_bytes(path: &Path) -> u64 {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    match ending.as_deref() {
        Some("obj") => obj::MAX_FILE_BYTES,
        Some("mtl") => obj::MAX_MTL_BYTES,
        Some("gltf" | "glb" | "bin") => gltf::MAX_FILE_BYTES,
        // A point cache is never read whole.
        Some("pc2") => u64::MAX,
        _ => texture::MAX_FILE_BYTES,
    }
}

/// The files that must come along when a mesh file in `root` is copied to another folder: those in `root` that the mesh
/// file names. For glTF, these include its sidecar and the point caches that the sidecar names.
///
/// # Errors
/// A [`Report`] where the file cannot be read or has errors.
pub fn companions(path: &Path, root: &Path) -> Result<BTreeSet<PathBuf>, Report> {
    if gltf::is_gltf(path) { gltf::companions(path, root) } else { obj::companions(path, root) }
}

/// Where the sidecar of a mesh file would lie; `None` for a format that has none.
pub fn sidecar_of(path: &Path) -> Option<PathBuf> {
    gltf::is_gltf(path).then(|| gltf::sidecar_beside(path))
}

/// Splits the name that a scene gives a mesh into a file and a node. The node is `None` for a whole file; only glTF
/// files have nodes.
pub fn file_and_node(name: &str) -> (&str, Option<&str>) {
    match name.split_once(NODE) {
        Some((file, node)) if gltf::is_gltf(Path::new(file)) => (file, Some(node)),
        _ => (name, None),
    }
}

/// The name that a scene gives the mesh of a node.
pub fn name_of_node(file: &str, node: &str) -> String {
    format!("{file}{NODE}{node}")
}

/// The canonical path of a file, so that different paths to it are one key; the path itself if it cannot be resolved.
fn one_name(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_owned())
}

/// Reads mesh files. A glTF file is read once, however many of its nodes are asked for.
#[derive(Default)]
pub(crate) struct MeshReader {
    open: RefCell<BTreeMap<PathBuf, Shared>>,
    instances: RefCell<BTreeMap<(PathBuf, InstanceKey), Arc<MeshFile>>>,
}

impl MeshReader {
    /// Reads a mesh file, or one node of it. With `with_points`, an OBJ file is read with its points, for a point
    /// cache. A glTF node has its points anyway, if the file states them.
    pub fn read(
        &self,
        path: &Path,
        node: Option<&str>,
        (root, folders): (&Path, &AssetFolders),
        with_points: bool,
    ) -> MeshRead {
        if !gltf::is_gltf(path) {
            let read = obj::read_for(path, root, folders, with_points);
            return read.map(|(mesh, warnings)| (Arc::new(mesh), warnings));
        }
        let (file, warnings) = self.open(path, root, folders)?;
        let Some(node) = node else { return file.whole().map(|mesh| (Arc::new(mesh), warnings)) };
        let key = file.instance_key(node).map(|key| (one_name(path), key));
        let known = key.as_ref().and_then(|key| self.instances.borrow().get(key).cloned());
        let mesh = match known {
            Some(mesh) => mesh,
            None => Arc::new(file.of_node(node)?),
        };
        if let Some(key) = key {
            self.instances.borrow_mut().insert(key, Arc::clone(&mesh));
        }
        Ok((mesh, warnings))
    }

    /// Reads a glTF file. A file that was read before is returned again, without its warnings.
    pub fn open(
        &self,
        path: &Path,
        root: &Path,
        folders: &AssetFolders,
    ) -> Result<(Shared, Vec<Problem>), Report> {
        let one_name = one_name(path);
        if let Some(known) = self.open.borrow().get(&one_name) {
            return Ok((Arc::clone(known), Vec::new()));
        }
        let (file, warnings) = gltf::open(path, root, folders)?;
        let file = Arc::new(file);
        self.open.borrow_mut().insert(one_name, Arc::clone(&file));
        Ok((file, warnings))
    }
}
