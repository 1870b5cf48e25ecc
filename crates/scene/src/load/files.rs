//! Reads the meshes, point caches and pictures that a document names.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use crate::check;
use crate::document::Scene;
use crate::limits;
use crate::mesh_file::{MeshFile, Texture};
use crate::mesh_format::MeshRead;
use crate::point_cache::PointCache;
use crate::problem::{Problem, Report};

pub(super) type TextureRead = Result<(Arc<Texture>, Vec<Problem>), Problem>;

/// How the files of one scene are read. Names are as the document writes them.
pub(super) struct Readers<'a> {
    /// `true` asks for the mesh's points too, which a point cache needs.
    pub(super) mesh: &'a dyn Fn(&str, bool) -> MeshRead,
    pub(super) cache: &'a dyn Fn(&str) -> Result<Arc<PointCache>, Problem>,
    pub(super) texture: &'a dyn Fn(&str) -> TextureRead,
    pub(super) brush: &'a dyn Fn(&str) -> TextureRead,
}

/// The files that were read, and the problems with them.
#[derive(Debug, Default)]
pub(super) struct Files {
    pub(super) meshes: BTreeMap<String, Arc<MeshFile>>,
    pub(super) caches: BTreeMap<String, Arc<PointCache>>,
    pub(super) textures: BTreeMap<String, Arc<Texture>>,
    pub(super) brushes: BTreeMap<String, Arc<Texture>>,
    pub(super) problems: Vec<Problem>,
}

impl Files {
    /// Reads every file once, however many objects name it. `at` gives a problem the position of the field with this
    /// path.
    pub(super) fn read(scene: &Scene, readers: &Readers<'_>, at: impl Fn(Problem, &str) -> Problem) -> Self {
        let mut files = Self::default();
        let meshes = first_uses(scene, |object| Some(&object.mesh), "mesh");
        let known: std::collections::HashSet<&str> = meshes.iter().map(|(name, _)| *name).collect();
        let mut morphs = first_uses(scene, |object| object.morph.as_ref(), "morph");
        morphs.retain(|(name, _)| !known.contains(name));
        for (name, field_path) in meshes.into_iter().chain(morphs) {
            match (readers.mesh)(name, has_cache(scene, name)) {
                Ok((mesh, warnings)) => {
                    files.problems.extend(warnings);
                    files.meshes.insert(name.to_owned(), mesh);
                }
                Err(Report(problems)) => {
                    // A problem without a place in the mesh file gets the place of the field that names the file.
                    files.problems.extend(problems.into_iter().map(|problem| match problem.place {
                        Some(_) => problem,
                        None => at(problem, &field_path),
                    }));
                }
            }
        }
        for (name, field_path) in first_uses(scene, |object| object.cache.as_ref(), "cache") {
            match (readers.cache)(name) {
                Ok(cache) => drop(files.caches.insert(name.to_owned(), cache)),
                Err(problem) => files.problems.push(at(problem, &field_path)),
            }
        }
        let mut seen = std::collections::HashSet::new();
        for (name, field_path) in textures(scene).filter(|(name, _)| seen.insert(name.as_str())) {
            match (readers.texture)(name) {
                Ok((texture, warnings)) => {
                    files.problems.extend(warnings);
                    files.textures.insert(name.to_owned(), texture);
                }
                Err(problem) => files.problems.push(at(problem, &field_path)),
            }
        }
        for (name, field_path) in check::brush_pictures(scene).into_iter().take(limits::MAX_BRUSH_PICTURES) {
            match (readers.brush)(name) {
                Ok((texture, warnings)) => {
                    files.problems.extend(warnings);
                    files.brushes.insert(name.to_owned(), texture);
                }
                Err(problem) => files.problems.push(at(problem, &field_path)),
            }
        }
        files
    }
}

/// Whether a point cache moves any object with this mesh.
pub(super) fn has_cache(scene: &Scene, mesh: &str) -> bool {
    scene.objects.iter().any(|object| object.mesh == mesh && object.cache.is_some())
}

/// Each use of a picture by a material: its name, and the path of the field that names it, in the order of the file.
pub(super) fn textures(scene: &Scene) -> impl Iterator<Item = (&String, String)> {
    scene.objects.iter().enumerate().flat_map(|(index, object)| {
        let textures = object.material.iter().flat_map(crate::document::MaterialOverride::textures);
        textures.map(move |(name, field)| (name, format!("objects[{index}].material.{field}")))
    })
}

/// Each different name that objects give in a field, with the path of the first such field, in the order of the file.
pub(super) fn first_uses<'a>(
    scene: &'a Scene,
    name_of: impl Fn(&'a crate::document::Object) -> Option<&'a String>,
    field: &str,
) -> Vec<(&'a str, String)> {
    let mut seen = std::collections::HashSet::new();
    let mut uses = Vec::new();
    for (index, object) in scene.objects.iter().enumerate() {
        if let Some(name) = name_of(object).filter(|name| seen.insert(name.as_str())) {
            uses.push((name.as_str(), format!("objects[{index}].{field}")));
        }
    }
    uses
}

/// Turns a problem of another file into one of the scene file, with a message that names the other file.
pub(super) fn as_scene_problem(
    problem: Problem,
    scene_path: &Path,
    place: Option<crate::problem::TextPosition>,
) -> Problem {
    let file = problem.path.display().to_string();
    let message = if problem.path == scene_path || problem.message.contains(&file) {
        problem.message
    } else {
        format!("{file}: {}", problem.message)
    };
    Problem { path: scene_path.to_owned(), place, message, ..problem }
}
