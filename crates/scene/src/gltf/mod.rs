//! Reads glTF files (`.gltf`, `.glb`) as mesh files: the whole file at rest, or one node of it. `crate::shot` reads
//! them as shots.
//!
//! A node's mesh includes the uneven scale and shear of the node's place in the world at rest. Turn, place and even
//! scale are left to the object's pose. A triangle's group is the one that the file states (`_GROUP`), or else that of
//! its primitive (in a mesh of the whole file: its node); materials keep their names.

mod bend;
mod joints;
mod materials;
mod sidecar;
mod stretch;
mod surface;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DAffine3, DMat3};
use impasto_core::bending::BendPose;
use impasto_gltf::{Animator, Finding, Gltf, Playing, Posed, Severity as Level};

use crate::assets::{self, AssetError, AssetFolders, AssetRequest};
use crate::mesh_file::{Material, MeshFile};
use crate::nearest;
use crate::problem::{Problem, Report, Severity};

pub(crate) use sidecar::{Sidecar, path_beside as sidecar_beside};
pub(crate) use stretch::stretch_of;

/// The largest glTF file that is read, in bytes.
pub const MAX_FILE_BYTES: u64 = 2 << 30;

/// A glTF file that was read, with its pictures.
#[derive(Debug)]
pub(crate) struct GltfFile {
    pub path: PathBuf,
    pub gltf: Gltf,
    /// Where everything stands without animation.
    pub rest: Posed,
    /// For each node, whether it is in the scene that is shown.
    in_scene: Vec<bool>,
    /// The file's materials, and last the default one.
    materials: Vec<Material>,
    /// What the file itself cannot say.
    pub sidecar: Sidecar,
}

/// Reads a glTF file with the files that it names. These must lie in `root`, the scene's folder, or in `folders`.
///
/// # Errors
/// All errors that [`impasto_gltf::read`] finds, each with its JSON pointer; or that the file or its sidecar cannot be
/// read.
pub(crate) fn open(
    path: &Path,
    root: &Path,
    folders: &AssetFolders,
) -> Result<(GltfFile, Vec<Problem>), Report> {
    let bytes = assets::read_regular_file(path, MAX_FILE_BYTES).map_err(|error| unread(path, &error))?;
    let sidecar = sidecar::read(path, root, folders)?;
    let mut open = |name: &str, max_bytes: u64| {
        let request = AssetRequest { beside: path, root, name, max_bytes };
        folders.open(&request).map(|asset| asset.bytes).map_err(|error| error.to_string())
    };
    let problem = |finding: Finding| in_file(path, &finding);
    let (mut gltf, findings) = impasto_gltf::read(bytes, &mut open)
        .map_err(|findings| Report(findings.into_iter().map(problem).collect()))?;
    let mut warnings: Vec<Problem> = findings.into_iter().map(problem).collect();
    // This does not fail: only an animation that is asked for by name may be missing.
    let unnamed = |_| Report(Vec::new());
    let rest = Animator::new(&gltf, Playing::None).map_err(unnamed)?.0.pose(0.0);
    let materials = materials::of(path, &gltf, &mut warnings);
    // The pictures' bytes keep the whole file in memory. Once decoded, they are not needed any more.
    gltf.images.iter_mut().for_each(|image| image.bytes = None);
    let mut in_scene = vec![false; gltf.nodes.len()];
    let mut open = gltf.roots.clone();
    while let Some(node) = open.pop() {
        in_scene[node] = true;
        open.extend(&gltf.nodes[node].children);
    }
    Ok((GltfFile { path: path.to_owned(), gltf, rest, in_scene, materials, sidecar }, warnings))
}

/// The files that are found in `root` and belong to a glTF file there: those that it names, its sidecar, and the point
/// caches that the sidecar names.
///
/// # Errors
/// A [`Report`] where the file cannot be read or has errors.
pub(crate) fn companions(path: &Path, root: &Path) -> Result<BTreeSet<PathBuf>, Report> {
    let bytes = assets::read_regular_file(path, MAX_FILE_BYTES).map_err(|error| unread(path, &error))?;
    let mut found = BTreeSet::new();
    let mut open = |name: &str, max_bytes: u64| {
        let request = AssetRequest { beside: path, root, name, max_bytes };
        let asset = AssetFolders::default().open(&request).map_err(|error| error.to_string())?;
        found.insert(asset.path);
        Ok(asset.bytes)
    };
    let read = impasto_gltf::read(bytes, &mut open);
    let problem = |finding: &Finding| in_file(path, finding);
    read.map(|_| ()).map_err(|findings| Report(findings.iter().map(problem).collect()))?;
    found.extend(sidecar::companions(path, root)?);
    Ok(found)
}

impl GltfFile {
    /// The whole file at rest as one mesh. Triangles without a group in the file have their node as group.
    ///
    /// # Errors
    /// It shows no triangle.
    pub fn whole(&self) -> Result<MeshFile, Report> {
        let placed = |node: usize| {
            // The joints of a skin place it in the world, whatever its own node says.
            let is_skinned = self.gltf.nodes[node].skin.is_some();
            let place = if is_skinned { DAffine3::IDENTITY } else { self.rest.world_from_node[node] };
            self.rest.is_visible[node].then_some((node, place))
        };
        let nodes: Vec<(usize, DAffine3)> = (0..self.gltf.nodes.len()).filter_map(placed).collect();
        let nodes = nodes.iter().filter(|(node, _)| self.gltf.nodes[*node].mesh.is_some());
        surface::mesh_of_nodes(self, nodes).ok_or_else(|| self.bare("the file shows no triangle"))
    }

    /// The mesh of one node, with its [`Self::stretch`] applied.
    ///
    /// # Errors
    /// There is no such node, or it shows no triangle.
    pub fn of_node(&self, name: &str) -> Result<MeshFile, Report> {
        let Some(node) = self.node(name) else {
            let names = self.gltf.nodes.iter().filter(|node| node.mesh.is_some());
            let mut report = self.bare(&format!("there is no node {name:?} in the file"));
            let near = nearest::nearest(name, names.map(|node| node.name.as_str()));
            report.0[0].mend = near.map_or_else(String::new, |near| format!("did you mean {near:?}?"));
            return Err(report);
        };
        let stretch = DAffine3::from_mat3(self.stretch(node));
        let mesh = surface::mesh_of_node(self, (node, stretch));
        mesh.ok_or_else(|| self.bare(&format!("the node {name:?} shows no triangle")))
    }

    /// Whether joints or morph targets bend a node's mesh.
    pub fn bends(&self, node: usize) -> bool {
        bend::bends(self, node)
    }

    /// The weights of a node's targets, and for each of its joints the transform into model space from the space in
    /// which the mesh was bound.
    pub fn bend_pose(&self, node: usize, posed: &Posed) -> BendPose {
        bend::pose(self, node, posed)
    }

    /// Whether a node is in the scene that is shown.
    pub fn is_in_scene(&self, node: usize) -> bool {
        self.in_scene[node]
    }

    /// The node of this name.
    pub fn node(&self, name: &str) -> Option<usize> {
        self.gltf.nodes.iter().position(|node| node.name == name)
    }

    /// A key for the mesh of a node: nodes with equal keys have equal meshes. `None` if there is no such node, if the
    /// node has no mesh, or if its mesh depends on more than the file's mesh and the stretch.
    pub fn instance_key(&self, name: &str) -> Option<InstanceKey> {
        let index = self.node(name)?;
        let node = &self.gltf.nodes[index];
        let is_plain = node.skin.is_none() && node.weights.is_none() && node.instances.is_none();
        let stretch = self.stretch(index).to_cols_array().map(f64::to_bits);
        node.mesh.filter(|_| is_plain).map(|mesh| (mesh, stretch))
    }

    /// The matrix that is applied to the mesh of a node: the stretch of its place in the world at rest. The identity
    /// for a skinned mesh, which its joints place.
    pub fn stretch(&self, node: usize) -> DMat3 {
        match self.gltf.nodes[node].skin {
            Some(_) => DMat3::IDENTITY,
            None => stretch_of(self.rest.world_from_node[node].matrix3),
        }
    }

    fn bare(&self, message: &str) -> Report {
        Report(vec![Problem {
            severity: Severity::Error,
            path: self.path.clone(),
            place: None,
            field_path: Box::default(),
            message: message.to_owned(),
            mend: "export a mesh of triangles".to_owned(),
        }])
    }
}

fn in_file(path: &Path, finding: &Finding) -> Problem {
    let severity = match finding.severity {
        Level::Warning => Severity::Warning,
        Level::Error | Level::Unsupported => Severity::Error,
        Level::Limit => Severity::Limit,
    };
    let message = match finding.pointer.as_str() {
        "" => finding.message.clone(),
        pointer => format!("{pointer}: {}", finding.message),
    };
    Problem {
        severity,
        path: path.to_owned(),
        place: None,
        field_path: Box::default(),
        message,
        mend: finding.mend.to_string(),
    }
}

fn unread(path: &Path, error: &AssetError) -> Report {
    let mut problem = error.to_problem(Severity::Error, path, None);
    if matches!(error, AssetError::Missing { .. }) {
        problem.message = "there is no such file".to_owned();
        problem.mend = "check the path".to_owned();
    }
    Report(vec![problem])
}

/// Whether a file is glTF, by its ending.
pub fn is_gltf(path: &Path) -> bool {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    matches!(ending.as_deref(), Some("gltf" | "glb"))
}

/// The index of a mesh in the file, and the bits of the stretch that is applied to it.
pub(crate) type InstanceKey = (usize, [u64; 9]);

/// A file that was read, shared by everything in a scene that names it.
pub(crate) type Shared = Arc<GltfFile>;
