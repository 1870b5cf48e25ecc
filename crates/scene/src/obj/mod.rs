//! Reads OBJ files with their materials. Every line is checked first, so that problems name line and column; then tobj
//! reads the geometry.
//!
//! A face belongs to the group that the last `g` line names (by its whole text). After an `o` line without a `g` line
//! behind it, the `o` line names the group. Without either, the group is `default`. The same name is the same group.
//! Smoothing groups are not used: see `crate::surface::CREASE_ANGLE_DEG`.

mod cleaned;
mod geometry;
mod lint;
mod material_library;
mod materials;
mod oddities;
mod points;
mod scan;
mod text;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use impasto_core::TriangleMesh;

use crate::assets::{self, AssetError, AssetFolders};
use crate::mesh_file::{MeshFile, Points};
use crate::problem::{Problem, Report, Severity};
use crate::surface::{self, Builder, Built};
use lint::{Checked, Face};
use material_library::MaterialLibrary;

use text::Findings;

/// The largest OBJ file that is read, in bytes.
pub const MAX_FILE_BYTES: u64 = 512 << 20;

/// The largest MTL file that is read, in bytes.
pub const MAX_MTL_BYTES: u64 = 64 << 20;

/// Reads an OBJ file with the materials and pictures that it names.
///
/// `root` is the scene's folder: materials and pictures come from it and from `folders` only. Returns the mesh and the
/// warnings, in the order of the files. A missing material or picture is a warning; its faces get the colour that the
/// material states, or else grey.
///
/// # Errors
/// A [`Report`] of every error found, with lines and columns: a file that is missing or too large, numbers or indices
/// that are wrong, no face or no area at all, or a picture that claims more than the limits.
pub fn read(path: &Path, root: &Path, folders: &AssetFolders) -> Result<(MeshFile, Vec<Problem>), Report> {
    read_for(path, root, folders, false)
}

/// As [`read`]. With `with_points`, the points are kept for a point cache that moves the mesh.
pub(crate) fn read_for(
    path: &Path,
    root: &Path,
    folders: &AssetFolders,
    with_points: bool,
) -> Result<(MeshFile, Vec<Problem>), Report> {
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
    let built = build(&mut checked, &mut findings, with_points);
    let place_of = |offset: usize| findings.place(offset);
    let mut library = MaterialLibrary::new(path, root, folders);
    let materials = if built.is_some() { library.materials(&checked, &place_of)? } else { Vec::new() };
    let more = library.finish();
    let mut warnings = findings.finish()?;
    warnings.extend(more);
    let (mesh, points) = built.ok_or(Report(Vec::new()))?;
    let points = points.map(Arc::new);
    Ok((MeshFile { mesh, groups: checked.groups.list, materials, bend: None, points }, warnings))
}

/// The files that must come along when an OBJ file in `root` is copied to another folder: the MTL files and pictures
/// that the OBJ file names and that are found in `root`. Pictures are not opened.
///
/// # Errors
/// A [`Report`] where the file cannot be read or has errors.
pub fn companions(path: &Path, root: &Path) -> Result<BTreeSet<PathBuf>, Report> {
    let bytes = assets::read_regular_file(path, MAX_FILE_BYTES)
        .map_err(|error| Report(vec![unread(path, &error)]))?;
    let (text, _) = text::to_utf8(bytes);
    let mut findings = Findings::new(path, &text);
    let checked = lint::check(&text, &mut findings);
    let folders = AssetFolders::default();
    let found = MaterialLibrary::new(path, root, &folders)
        .files(&checked.libraries, &|offset| findings.place(offset));
    findings.finish().map(|_| found)
}

/// The problem of a mesh file that was not read. No folder was searched for it, so the advice is about its path alone.
fn unread(path: &Path, error: &AssetError) -> Problem {
    let mut problem = error.to_problem(Severity::Error, path, None);
    if matches!(error, AssetError::Missing { .. }) {
        problem.message = "there is no such file".to_owned();
        problem.mend = "check the path".to_owned();
    }
    problem
}

/// The mesh, and its points where they are asked for; `None` after an error.
fn build(
    checked: &mut Checked<'_>,
    findings: &mut Findings<'_>,
    with_points: bool,
) -> Option<(TriangleMesh, Option<Points>)> {
    let named = with_points.then(|| points::of(checked.cleaned.clone()));
    let mut geometry = match geometry::read(checked, findings, with_points) {
        Ok(geometry) => geometry,
        Err(error) => {
            findings.error_of_file(format!("tobj can not read the file: {error}"), "export the model again");
            return None;
        }
    };
    geometry.keeps_vertices = with_points;
    let builder = Builder::new(&geometry);
    let Built { mut mesh, face_of_triangle: faces, source_of_vertex } = builder.finish();
    mesh.group_of_triangle = faces.iter().map(|&face| checked.faces[face as usize].group).collect();
    mesh.material_of_triangle = faces.iter().map(|&face| checked.faces[face as usize].material).collect();
    tell(&builder.odd, &checked.faces, findings);
    if mesh.triangles.is_empty() {
        findings.error_of_file(
            "the faces have no area: all their corners lie on lines or points",
            "export the model again",
        );
        return None;
    }
    let points = named.map(|named| {
        let mut of_source = vec![0; geometry.positions.len()];
        for (&source, &point) in geometry.corners.iter().zip(&named.of_corner) {
            of_source[source as usize] = point;
        }
        let of_vertex = source_of_vertex.iter().map(|&source| of_source[source as usize]).collect();
        Points { count: named.count, of_vertex }
    });
    Some((mesh, points))
}

fn tell(odd: &surface::Oddities, faces: &[Face], findings: &mut Findings<'_>) {
    let told = [
        (odd.flat_faces, "this face has no area", "it is left out"),
        (
            odd.rough_faces,
            "this face crosses itself or has too many corners to cut with care",
            "cut it into triangles",
        ),
        (odd.large_faces, "this face has more than 1000 corners", "cut it into triangles before export"),
        (
            odd.along_faces,
            "the normals of this face run along it",
            "normals are worked out from the surface; export them again",
        ),
        (odd.doubled_faces, "this face lies on another one with the same corners", "it is left out"),
    ];
    for ((count, first), what, mend) in told {
        if count > 0 {
            let more = if count == 1 { String::new() } else { format!(" ({count} such faces)") };
            findings.warning(faces[first as usize].offset as usize, format!("{what}{more}"), mend);
        }
    }
}
