//! OBJ files with their materials, made safe: every line is checked and located here, and only then read through tobj.
//!
//! Groups: faces belong to the last `g` line (its whole text), or to the last `o` where no `g` followed it, or to
//! `default`. The same name is the same group. Smoothing groups are not used: see `surface::CREASE_ANGLE_DEG`.

mod lint;
mod materials;
mod polygon;
mod shelf;
mod surface;
mod text;

use std::collections::{BTreeSet, HashMap};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use glam::{Vec2, Vec3};

use crate::assets::{self, AssetError, AssetFolders};
use crate::mesh_file::MeshFile;
use crate::problem::{Problem, Report, Severity};
use lint::{Checked, NONE};
use shelf::Shelf;
use surface::{Builder, SurfaceCorner};
use text::Findings;

/// The largest OBJ file that is read, in bytes.
pub const MAX_FILE_BYTES: u64 = 512 << 20;

/// The largest MTL file that is read, in bytes.
pub const MAX_MTL_BYTES: u64 = 64 << 20;

/// Models smaller than this across are scaled to 1: their areas would vanish in single precision.
const LEAST_EXTENT: f64 = 1e-6;

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
        .map_err(|error| Report(vec![unread(path, &error)]))?;
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
    let mut shelf = Shelf::new(path, root, folders);
    let materials = if mesh.is_some() { shelf.materials(&checked, &place_of)? } else { Vec::new() };
    let more = shelf.finish();
    let mut warnings = findings.finish()?;
    warnings.extend(more);
    let mesh = mesh.ok_or(Report(Vec::new()))?;
    Ok((MeshFile { mesh, groups: checked.groups.list, materials }, warnings))
}

/// The MTL files and pictures that an OBJ file in `root` names and that are found in `root`: what has to go with it to
/// another folder. Pictures are found, not opened.
///
/// # Errors
/// A [`Report`] where the file can not be read or has errors.
pub fn companions(path: &Path, root: &Path) -> Result<BTreeSet<PathBuf>, Report> {
    let bytes = assets::read_regular_file(path, MAX_FILE_BYTES)
        .map_err(|error| Report(vec![unread(path, &error)]))?;
    let (text, _) = text::to_utf8(bytes);
    let mut findings = Findings::new(path, &text);
    let checked = lint::check(&text, &mut findings);
    let folders = AssetFolders::default();
    let found = Shelf::new(path, root, &folders).files(&checked.libraries, &|offset| findings.place(offset));
    findings.finish().map(|_| found)
}

/// The mesh file itself was not read: no folder was searched for it, so only its path can be mended.
fn unread(path: &Path, error: &AssetError) -> Problem {
    let mut problem = error.to_problem(Severity::Error, path, None);
    if matches!(error, AssetError::Missing { .. }) {
        problem.message = "there is no such file".to_owned();
        problem.mend = "check the path".to_owned();
    }
    problem
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
