//! OBJ files with their materials, made safe: every line is checked and located here.
//!
//! Groups: faces belong to the last `g` line (its whole text), or to the last `o` where no `g` followed it, or to
//! `default`. The same name is the same group. Smoothing groups are not used: see `surface::CREASE_ANGLE_DEG`.

mod lint;
mod materials;
mod number;
mod oddities;
mod plain;
mod polygon;
mod shelf;
mod surface;
mod text;
mod weld;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use crate::assets::{self, AssetError, AssetFolders};
use crate::mesh_file::MeshFile;
use crate::problem::{Problem, Report, Severity};
use lint::Checked;
use plain::NONE;
use shelf::Shelf;
use surface::{Builder, SHARE, Values};
use text::Findings;
use weld::weld;

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
    let mesh = build(&mut checked, &mut findings);
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
    let Some(first) = used().next() else { return };
    // Nearly every model shows at its second corner that it is not tiny.
    if used().any(|at| (0..3).any(|axis| (at[axis] - first[axis]).abs() >= LEAST_EXTENT)) {
        return;
    }
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
        let offset = checked.faces.first().map_or(0, |face| face.offset as usize);
        findings.warning(offset, message, "it is scaled to a size of 1; export it in other units");
    }
}

/// The faces through the builder; `None` after an error.
fn build(checked: &mut Checked, findings: &mut Findings<'_>) -> Option<impasto_core::TriangleMesh> {
    let (places, place_of_position) = weld(&checked.positions);
    let normals = &checked.normals;
    checked.corners.par_iter_mut().with_min_len(SHARE).for_each(|corner| {
        corner.position = place_of_position[corner.position as usize];
        if corner.normal != NONE && normals[corner.normal as usize] == [0.0; 3] {
            corner.normal = NONE;
        }
    });
    let values =
        Values { places: &places, uvs: &checked.uvs, normals: &checked.normals, corners: &checked.corners };
    let builder = Builder::new(values, &checked.faces);
    let (mut mesh, faces) = builder.finish();
    mesh.group_of_triangle = faces.iter().map(|&face| checked.faces[face as usize].group).collect();
    mesh.material_of_triangle = faces.iter().map(|&face| checked.faces[face as usize].material).collect();
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
            findings.warning(checked.faces[first as usize].offset as usize, format!("{what}{more}"), mend);
        }
    }
}
