//! Reads the files of a scene with errors; boxes stand in for meshes that cannot be read.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::fix::Fix;
use super::{LoadOptions, Loss};
use crate::check;
use crate::document::{PatchRef, Scene};
use crate::limits;
use crate::load::files::{as_scene_problem, first_uses, has_cache, textures};
use crate::load::{folder_of, read_brush, read_cache, read_mesh, read_texture};
use crate::locate::Located;
use crate::mesh_file::{Material, MeshFile, Texture};
use crate::mesh_format::MeshReader;
use crate::point_cache::PointCache;
use crate::problem::{Problem, Severity};

/// Missing files are not searched for if the scene's folder and those below it hold more entries than this.
const MOST_ENTRIES: usize = 4000;

/// Missing files are searched for in folders at most this deep below the scene's folder.
const DEEPEST: usize = 4;

type Read<T> = Result<(Arc<T>, Vec<Problem>), Problem>;

/// Files that were read, and errors of files that could not be. Each file is tried only once over all passes.
pub(super) struct FileCache<'a> {
    path: &'a Path,
    options: &'a LoadOptions,
    meshes: BTreeMap<String, Read<MeshFile>>,
    point_caches: BTreeMap<String, Result<Arc<PointCache>, Problem>>,
    textures: BTreeMap<String, Read<Texture>>,
    brushes: BTreeMap<String, Read<Texture>>,
    /// The files in the scene's folder and below, as paths relative to it; `None` until they are first needed.
    nearby: Option<Vec<PathBuf>>,
}

/// The files of one pass.
#[derive(Default)]
pub(super) struct Found {
    pub(super) real: BTreeMap<String, Arc<MeshFile>>,
    pub(super) stand_ins: BTreeMap<String, Arc<MeshFile>>,
    pub(super) caches: BTreeMap<String, Arc<PointCache>>,
    pub(super) textures: BTreeMap<String, Arc<Texture>>,
    pub(super) brushes: BTreeMap<String, Arc<Texture>>,
    pub(super) warnings: Vec<Problem>,
    /// Meshes that boxes stand in for.
    pub(super) missing: Vec<Loss>,
    /// Files that nothing can stand in for: the problem, its field, and a fix.
    pub(super) refused: Vec<(Problem, String, Option<Fix>)>,
}

impl<'a> FileCache<'a> {
    pub(super) fn new(path: &'a Path, options: &'a LoadOptions) -> Self {
        let (meshes, point_caches, textures, brushes) = Default::default();
        Self { path, options, meshes, point_caches, textures, brushes, nearby: None }
    }

    pub(super) fn read(&mut self, scene: &Scene, located: &Located) -> Found {
        let mut found = Found::default();
        let (path, folders) = (self.path, &self.options.folders);
        for (name, field_path) in first_uses(scene, |object| Some(&object.mesh), "mesh") {
            let read =
                self.meshes.entry(name.to_owned()).or_insert_with(|| mesh(path, name, scene, self.options));
            match read.clone() {
                Ok((mesh, warnings)) => {
                    found.warnings.extend(warnings);
                    found.real.insert(name.to_owned(), mesh);
                }
                Err(problem) => {
                    found.stand_ins.insert(name.to_owned(), Arc::new(stand_in(scene, name)));
                    let users: Vec<String> = (0..scene.objects.len())
                        .filter(|&index| scene.objects[index].mesh == name)
                        .map(|index| format!("objects[{index}].mesh"))
                        .collect();
                    let fix = self.nearby_fix(name, &users, located);
                    found.missing.push(Loss {
                        problem: self.at(problem, &field_path, located),
                        instead: "A box stands in for it.".to_owned(),
                        mesh: Some(name.to_owned()),
                        fix,
                    });
                }
            }
        }
        for (name, field_path) in first_uses(scene, |object| object.morph.as_ref(), "morph") {
            if found.stand_ins.contains_key(name) {
                continue;
            }
            let read =
                self.meshes.entry(name.to_owned()).or_insert_with(|| mesh(path, name, scene, self.options));
            match read.clone() {
                Ok((mesh, warnings)) => {
                    if found.real.insert(name.to_owned(), mesh).is_none() {
                        found.warnings.extend(warnings);
                    }
                }
                Err(problem) => self.refuse(&mut found, problem, name, &field_path, located),
            }
        }
        for (name, field_path) in first_uses(scene, |object| object.cache.as_ref(), "cache") {
            let read = self.point_caches.entry(name.to_owned());
            match read.or_insert_with(|| read_cache(path, name, folders)).clone() {
                Ok(cache) => drop(found.caches.insert(name.to_owned(), cache)),
                Err(problem) => self.refuse(&mut found, problem, name, &field_path, located),
            }
        }
        for (name, field_path) in textures(scene) {
            let read = self
                .textures
                .entry(name.clone())
                .or_insert_with(|| read_texture(path, name, folders).map(super::super::shared));
            match read.clone() {
                Ok((texture, warnings)) => {
                    // Several materials may name the same picture.
                    if found.textures.insert(name.clone(), texture).is_none() {
                        found.warnings.extend(warnings);
                    }
                }
                Err(problem) => self.refuse(&mut found, problem, name, &field_path, located),
            }
        }
        for (name, field_path) in check::brush_pictures(scene).into_iter().take(limits::MAX_BRUSH_PICTURES) {
            let read = self
                .brushes
                .entry(name.to_owned())
                .or_insert_with(|| read_brush(path, name, folders).map(super::super::shared));
            match read.clone() {
                Ok((brush, warnings)) => {
                    if found.brushes.insert(name.to_owned(), brush).is_none() {
                        found.warnings.extend(warnings);
                    }
                }
                Err(problem) => self.refuse(&mut found, problem, name, &field_path, located),
            }
        }
        found
    }

    fn refuse(
        &mut self,
        found: &mut Found,
        problem: Problem,
        name: &str,
        field_path: &str,
        located: &Located,
    ) {
        let fix = self.nearby_fix(name, &[field_path.to_owned()], located);
        found.refused.push((self.at(problem, field_path, located), field_path.to_owned(), fix));
    }

    fn at(&self, problem: Problem, field_path: &str, located: &Located) -> Problem {
        // The line of an error within another file, such as a mesh, is kept in the message.
        let words = match problem.place {
            Some(place) if problem.path != self.path => format!("line {}: {}", place.line, problem.message),
            _ => problem.message.clone(),
        };
        let place = Some(located.place_of(field_path));
        let severity = problem.severity.max(Severity::Error);
        let problem = Problem { message: words, field_path: field_path.into(), severity, ..problem };
        as_scene_problem(problem, self.path, place)
    }

    /// A fix for a file that was not found: it names the only file in the scene's folder or below that has the same
    /// name. If no file has that name, the fix names the only file with nearly that name.
    fn nearby_fix(&mut self, name: &str, fields: &[String], located: &Located) -> Option<Fix> {
        let plain = name.trim().replace('\\', "/");
        let wanted = Path::new(&plain).file_name()?.to_str()?.to_lowercase();
        let folder = folder_of(self.path).to_owned();
        let nearby = self.nearby.get_or_insert_with(|| files_below(&folder));
        // If the file is where the scene says, something else is wrong with it.
        if wanted.len() > 128 || nearby.iter().any(|file| file == Path::new(&plain)) {
            return None;
        }
        let name_of = |file: &PathBuf| Some(file.file_name()?.to_str()?.to_lowercase());
        let same: Vec<&PathBuf> =
            nearby.iter().filter(|file| name_of(file).as_ref() == Some(&wanted)).collect();
        let extension = Path::new(&wanted).extension();
        let is_like = |file: &&PathBuf| {
            name_of(file).is_some_and(|other| {
                Path::new(&other).extension() == extension
                    && other.len() <= 128
                    && strsim::damerau_levenshtein(&other, &wanted) <= 2
            })
        };
        let (file, is_certain) = match same[..] {
            [file] => (file.clone(), true),
            [] => {
                let like: Vec<&PathBuf> = nearby.iter().filter(is_like).collect();
                let [file] = like[..] else { return None };
                (file.clone(), false)
            }
            _ => return None,
        };
        let written = file.to_str()?.replace('\\', "/");
        let edits = fields.iter().filter_map(|field| {
            let node = located.through_some(located.node_at(field)?);
            Some((node.start as usize..node.end as usize, format!("{written:?}")))
        });
        let edits: Vec<_> = edits.collect();
        let verb = format!("Use {}", file.file_name()?.to_str()?);
        (!edits.is_empty()).then_some(Fix { verb, is_certain, edits })
    }
}

fn mesh(path: &Path, name: &str, scene: &Scene, options: &LoadOptions) -> Read<MeshFile> {
    let with_points = has_cache(scene, name);
    read_mesh(&MeshReader::default(), path, name, &options.folders, with_points).map_err(|report| {
        let fatal = report.0.iter().find(|problem| problem.severity.is_fatal()).or(report.0.first());
        fatal.cloned().unwrap_or_else(|| super::error_in(path, None, "the mesh cannot be used", ""))
    })
}

/// The files in a folder and in the folders below it, as paths relative to it, sorted; none if there are too many.
/// Links are not followed.
fn files_below(root: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut open = vec![(PathBuf::new(), 0)];
    let mut seen = 0;
    while let Some((folder, depth)) = open.pop() {
        let Ok(entries) = std::fs::read_dir(root.join(&folder)) else { continue };
        for entry in entries.filter_map(Result::ok) {
            seen += 1;
            if seen > MOST_ENTRIES {
                // With an incomplete list, one cannot tell whether a name occurs only once.
                return Vec::new();
            }
            let Ok(kind) = entry.file_type() else { continue };
            let path = folder.join(entry.file_name());
            if kind.is_file() {
                files.push(path);
            } else if kind.is_dir() && depth < DEEPEST {
                open.push((path, depth + 1));
            }
        }
    }
    files.sort();
    files
}

/// A box of one unit that has every group and material that a scene looks for in the mesh.
fn stand_in(scene: &Scene, name: &str) -> MeshFile {
    let users: BTreeSet<&str> = scene
        .objects
        .iter()
        .filter(|object| object.mesh == name)
        .map(|object| object.name.as_str())
        .collect();
    let mut groups = BTreeSet::new();
    let mut materials = BTreeSet::new();
    groups.extend(
        scene.objects.iter().filter(|object| object.mesh == name).filter_map(|object| object.group.clone()),
    );
    for region in &scene.regions {
        if !region.on.object().is_some_and(|object| users.contains(object)) {
            continue;
        }
        for patch in region.on.patches() {
            match patch {
                PatchRef::Group(group) => drop(groups.insert(group.to_owned())),
                PatchRef::Material(material) => drop(materials.insert(material.to_owned())),
                PatchRef::Whole | PatchRef::Dabs(_) | PatchRef::Flood(..) => {}
            }
        }
    }
    let or_plain = |mut names: BTreeSet<String>| {
        if names.is_empty() {
            names.insert("box".to_owned());
        }
        names.into_iter().collect::<Vec<_>>()
    };
    let (groups, materials) = (or_plain(groups), or_plain(materials));
    let material = |name| Material::plain(name, [0.55, 0.53, 0.5]);
    let mesh = box_mesh(groups.len() as u32, materials.len() as u32);
    MeshFile::still(mesh, groups, materials.into_iter().map(material).collect())
}

fn box_mesh(groups: u32, materials: u32) -> impasto_core::TriangleMesh {
    use glam::Vec3;
    let mut mesh = impasto_core::TriangleMesh::default();
    for (axis, side) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0), (2, 1.0), (2, -1.0)] {
        let normal = Vec3::from_array(std::array::from_fn(|index| if index == axis { side } else { 0.0 }));
        let across =
            Vec3::from_array(std::array::from_fn(|index| f32::from(u8::from(index == (axis + 1) % 3))));
        let up = normal.cross(across);
        let first = mesh.positions.len() as u32;
        for (right, top) in [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)] {
            mesh.positions.push(normal * 0.5 + across * right + up * top);
            mesh.normals.push(normal);
        }
        for corners in [[0, 1, 2], [0, 2, 3]] {
            let index = mesh.triangles.len() as u32;
            mesh.polygon_of_triangle.push(index / 2);
            mesh.triangles.push(corners.map(|corner: u32| first + corner));
            mesh.group_of_triangle.push(index % groups);
            mesh.material_of_triangle.push(index % materials);
        }
    }
    mesh
}
