//! OBJ files with their materials, made safe: every line is checked and located here, and only then read through tobj.
//!
//! Groups: faces belong to the last `g` line (its whole text), or to the last `o` where no `g` followed it, or to
//! `default`. The same name is the same group. Smoothing groups are not used: see `surface::CREASE_ANGLE_DEG`.

mod lint;
mod materials;
mod polygon;
mod surface;
mod text;

use std::collections::{BTreeMap, HashMap};
use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

use glam::{Vec2, Vec3};

use crate::assets::{self, Asset, AssetError, AssetFolders, AssetRequest};
use crate::mesh_file::{Material, MeshFile, Texture};
use crate::problem::{Place, Problem, Report, Severity};
use crate::texture;
use lint::{Checked, NONE};
use materials::{Described, GREY};
use surface::{Builder, SurfaceCorner};
use text::Findings;

/// The largest OBJ file that is read, in bytes.
pub const MAX_FILE_BYTES: u64 = 512 << 20;

/// The largest MTL file that is read, in bytes.
pub const MAX_MTL_BYTES: u64 = 64 << 20;

/// Models smaller than this across are scaled to 1: their areas would vanish in single precision.
const LEAST_EXTENT: f64 = 1e-9;

/// Reads an OBJ file with the materials and pictures that it names.
///
/// `root` is the scene's folder: materials and pictures come from it and from `folders` only. Beside the mesh come
/// the warnings, in the order of the files; a missing material or picture is one of them, and its faces are grey.
///
/// # Errors
/// A [`Report`] of every error found, with lines and columns: a file that is missing or too large, numbers or indices
/// that are wrong, no face or no area at all, or a picture that claims more than the limits.
pub fn read(path: &Path, root: &Path, folders: &AssetFolders) -> Result<(MeshFile, Vec<Problem>), Report> {
    let bytes = assets::read_regular_file(path, MAX_FILE_BYTES)
        .map_err(|error| Report(vec![error.to_problem(Severity::Error, path, None)]))?;
    let (text, was_utf16) = text::to_utf8(bytes);
    let mut findings = Findings::new(path, &text);
    if was_utf16 {
        findings.warning(0, "the file is UTF-16", "save it as UTF-8");
    }
    let mut checked = lint::check(&text, &mut findings);
    if findings.has_errors() {
        return Err(findings.finish().err().unwrap_or(Report(Vec::new())));
    }
    enlarge_tiny(&mut checked, &mut findings);
    let mesh = build(&checked, &mut findings);
    let place_of = |offset: usize| findings.place(offset);
    let mut shelf = Shelf { path, root, folders, warnings: Vec::new(), pictures: BTreeMap::new() };
    let materials = if mesh.is_some() { shelf.materials(&checked, &place_of)? } else { Vec::new() };
    let more = shelf.warnings;
    let mut warnings = findings.finish()?;
    warnings.extend(more);
    let mesh = mesh.ok_or(Report(Vec::new()))?;
    Ok((MeshFile { mesh, groups: checked.groups.list, materials }, warnings))
}

fn enlarge_tiny(checked: &mut Checked, findings: &mut Findings<'_>) {
    let used = || checked.corners.iter().map(|corner| checked.positions[corner.position as usize]);
    let extent = (0..3)
        .map(|axis| {
            let (low, high) =
                used().fold((f64::MAX, f64::MIN), |(low, high), at| (low.min(at[axis]), high.max(at[axis])));
            high - low
        })
        .fold(0.0, f64::max);
    if extent > 0.0 && extent < LEAST_EXTENT {
        checked.positions.iter_mut().flatten().for_each(|value| *value /= extent);
        let message = format!("the model is only {extent:e} across, too small for single precision");
        let offset = checked.faces.first().map_or(0, |face| face.offset);
        findings.warning(offset, message, "it is scaled to a size of 1; export it in other units");
    }
}

/// The numbers through tobj, the faces through the builder; `None` after an error.
fn build(checked: &Checked, findings: &mut Findings<'_>) -> Option<impasto_core::TriangleMesh> {
    let options = tobj::LoadOptions::default();
    let plain = plain_text(checked);
    let model = tobj::load_obj_buf(&mut plain.as_bytes(), &options, |_| Err(tobj::LoadError::OpenFileFailed));
    drop(plain);
    let Some(read) = model.ok().and_then(|(models, _)| models.into_iter().next()).map(|model| model.mesh)
    else {
        findings.error_of_file("the polygons could not be read", "export the model again");
        return None;
    };
    let (places, place_of_position) = weld(&read.positions);
    let mut builder = Builder::new(&places);
    let mut start = 0;
    for (number, face) in checked.faces.iter().enumerate() {
        let corners: Vec<SurfaceCorner> = (start..face.end)
            .map(|at| {
                let uv = read.texcoord_indices[at] as usize * 2;
                let normal = read.normal_indices[at] as usize * 3;
                let normal = Vec3::from_slice(&read.normals[normal..normal + 3]);
                SurfaceCorner {
                    place: place_of_position[read.indices[at] as usize],
                    uv: (checked.corners[at].uv != NONE)
                        .then(|| Vec2::from_slice(&read.texcoords[uv..uv + 2])),
                    normal: (checked.corners[at].normal != NONE && normal != Vec3::ZERO).then_some(normal),
                }
            })
            .collect();
        builder.add(number, &corners);
        start = face.end;
    }
    let (mut mesh, faces) = builder.finish();
    mesh.group_of_triangle = faces.iter().map(|&face| checked.faces[face].group).collect();
    mesh.material_of_triangle = faces.iter().map(|&face| checked.faces[face].material).collect();
    tell(&builder.odd, checked, findings);
    if mesh.triangles.is_empty() {
        findings.error_of_file(
            "the faces have no area: all their corners lie on lines or points",
            "export the model again",
        );
        return None;
    }
    Some(mesh)
}

fn tell(odd: &surface::Oddities, checked: &Checked, findings: &mut Findings<'_>) {
    let told = [
        (odd.flat_faces, "this face has no area", "it is left out"),
        (
            odd.rough_faces,
            "this face crosses itself or has too many corners to cut with care",
            "cut it into triangles",
        ),
        (odd.large_faces, "this face has more than 1000 corners", "cut it into triangles before export"),
    ];
    for ((count, first), what, mend) in told {
        if count > 0 {
            let more = if count == 1 { String::new() } else { format!(" ({count} such faces)") };
            findings.warning(checked.faces[first].offset, format!("{what}{more}"), mend);
        }
    }
}

/// The checked numbers as the plainest OBJ there is: every corner has all three indices, the last texture coordinate
/// and normal standing for those that a corner does not have.
fn plain_text(checked: &Checked) -> String {
    let mut text = String::new();
    for [x, y, z] in checked.positions.iter().map(|at| at.map(|value| value as f32)) {
        let _ = writeln!(text, "v {x:e} {y:e} {z:e}");
    }
    for [u, v] in checked.uvs.iter().chain([&[0.0; 2]]) {
        let _ = writeln!(text, "vt {u:e} {v:e}");
    }
    for [x, y, z] in checked.normals.iter().chain([&[0.0; 3]]) {
        let _ = writeln!(text, "vn {x:e} {y:e} {z:e}");
    }
    let or_last = |index: u32, count: usize| if index == NONE { count + 1 } else { index as usize + 1 };
    let mut start = 0;
    for face in &checked.faces {
        text.push('f');
        for corner in &checked.corners[start..face.end] {
            let uv = or_last(corner.uv, checked.uvs.len());
            let normal = or_last(corner.normal, checked.normals.len());
            let _ = write!(text, " {}/{uv}/{normal}", corner.position + 1);
        }
        text.push('\n');
        start = face.end;
    }
    text
}

/// One place for all positions that are equal, so that seams of the file's vertices do not show as creases.
fn weld(positions: &[f32]) -> (Vec<Vec3>, Vec<u32>) {
    let mut places = Vec::new();
    let mut numbers: HashMap<[u32; 3], u32> = HashMap::new();
    let place_of_position = positions
        .chunks_exact(3)
        .map(|at| {
            // Adding 0 makes -0 and 0 the same.
            let at = [at[0] + 0.0, at[1] + 0.0, at[2] + 0.0];
            *numbers.entry(at.map(f32::to_bits)).or_insert_with(|| {
                places.push(Vec3::from_array(at));
                places.len() as u32 - 1
            })
        })
        .collect();
    (places, place_of_position)
}

/// Where materials and pictures are looked for, and what was found so far.
struct Shelf<'a> {
    path: &'a Path,
    root: &'a Path,
    folders: &'a AssetFolders,
    warnings: Vec<Problem>,
    /// By the MTL file and the name written there, so that each is read, and told of, once.
    pictures: BTreeMap<String, Option<Arc<Texture>>>,
}

impl Shelf<'_> {
    fn materials(
        &mut self,
        checked: &Checked,
        place_of: &dyn Fn(usize) -> Place,
    ) -> Result<Vec<Material>, Report> {
        let mut described: HashMap<String, (Described, std::path::PathBuf)> = HashMap::new();
        let mut is_incomplete = false;
        for library in &checked.libraries {
            let whole = self.open(&library.name);
            let is_split = matches!(whole, Err(AssetError::Missing { .. } | AssetError::Refused { .. }))
                && library.words.len() > 1;
            let found = if is_split {
                library.words.iter().map(|word| self.open(word)).collect()
            } else {
                vec![whole]
            };
            for asset in found {
                match asset {
                    Ok(Asset { path, bytes }) => {
                        let (list, warnings) = materials::parse(&path, bytes);
                        self.warnings.extend(warnings);
                        for material in list {
                            described
                                .entry(material.name.clone())
                                .or_insert_with(|| (material, path.clone()));
                        }
                    }
                    Err(error) => {
                        is_incomplete = true;
                        let place = Some(place_of(library.offset));
                        let mut problem = error.to_problem(Severity::Warning, self.path, place);
                        problem.severity = Severity::Warning;
                        problem.message = format!("no materials from here: {}", problem.message);
                        self.warnings.push(problem);
                    }
                }
            }
        }
        let unknown = |name: &&String| !name.is_empty() && !described.contains_key(*name);
        let missing: Vec<&String> = checked.materials.list.iter().filter(unknown).collect();
        if let Some(first) = missing.first().filter(|_| !is_incomplete) {
            let at = checked.materials.list.iter().position(|name| name == *first).unwrap_or(0);
            let more =
                if missing.len() > 1 { format!(" (and {} more)", missing.len() - 1) } else { String::new() };
            self.warnings.push(Problem {
                severity: Severity::Warning,
                path: self.path.to_owned(),
                place: checked.material_offsets.get(at).map(|&offset| place_of(offset)),
                message: format!("no file describes the material {first:?}{more}; grey is used"),
                mend: "name its MTL file with mtllib".to_owned(),
            });
        }
        let mut materials = Vec::new();
        for name in &checked.materials.list {
            let Some((material, mtl)) = described.get(name) else {
                materials.push(Material { name: name.clone(), color: GREY, texture: None });
                continue;
            };
            let texture = match &material.picture {
                Some(picture) => self.picture(mtl, picture)?,
                None => None,
            };
            materials.push(Material { name: name.clone(), color: material.color, texture });
        }
        if materials.is_empty() {
            materials.push(Material { name: String::new(), color: GREY, texture: None });
        }
        Ok(materials)
    }

    fn open(&self, name: &str) -> Result<Asset, AssetError> {
        let name = name.trim_matches('"');
        self.folders.open(&AssetRequest {
            beside: self.path,
            root: self.root,
            name,
            max_bytes: MAX_MTL_BYTES,
        })
    }

    fn picture(&mut self, mtl: &Path, name: &str) -> Result<Option<Arc<Texture>>, Report> {
        let key = format!("{}\n{name}", mtl.display());
        if let Some(known) = self.pictures.get(&key) {
            return Ok(known.clone());
        }
        let request = AssetRequest { beside: mtl, root: self.root, name, max_bytes: texture::MAX_FILE_BYTES };
        let texture = match texture::read(self.folders, &request) {
            Ok(decoded) => {
                self.warnings.extend(decoded.warnings);
                Some(Arc::new(decoded.texture))
            }
            Err(problem) if problem.severity.is_fatal() => {
                let mut problems = std::mem::take(&mut self.warnings);
                problems.push(problem);
                return Err(Report(problems));
            }
            Err(problem) => {
                self.warnings.push(problem);
                None
            }
        };
        self.pictures.insert(key, texture.clone());
        Ok(texture)
    }
}
