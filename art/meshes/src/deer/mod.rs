//! The mesh `deer`: a stag that stands and listens.

mod coat;
mod crown;
mod form;

use glam::DVec3;

use super::poly_mesh::{Look, PolyMesh};
use super::surface_net::{Grid, slope, tighten, weave};

use form::Form;

/// Height of the finished mesh at the withers. The form is built with a height of 1 there.
const WITHERS: f64 = 0.6;

/// A stag 1.15 units high with its antlers, standing on y = 0 and looking to +X.
pub fn deer() -> PolyMesh {
    let mut mesh = PolyMesh::new(
        "deer",
        "A standing stag that looks to +X, its hooves on y = 0; the body is one closed skin.",
        &[
            ("coat_01", "#4a2c1a"),
            ("coat_02", "#55331d"),
            ("coat_03", "#613a20"),
            ("coat_04", "#6c4124"),
            ("coat_05", "#774827"),
            ("coat_06", "#824f2b"),
            ("coat_07", "#8c562e"),
            ("coat_08", "#945d33"),
            ("coat_09", "#9d6437"),
            ("coat_10", "#a56c3d"),
            ("coat_11", "#ad7645"),
            ("coat_12", "#b67f4d"),
            ("coat_13", "#be8a58"),
            ("coat_14", "#c59766"),
            ("coat_15", "#cda374"),
            ("coat_16", "#d4af82"),
            ("coat_17", "#daba8f"),
            ("coat_18", "#e1c59e"),
            ("coat_19", "#e6d1ae"),
            ("coat_20", "#ecdcbe"),
            ("hoof", "#2b211c"),
            ("nose", "#241c1b"),
            ("eye", "#17100d"),
            ("ear_outside", "#7d4d2b"),
            ("ear_inside", "#d3ab86"),
            ("antler", "#a98459"),
            ("antler_tip", "#e3d0a8"),
        ],
    );
    mesh.polish(&["hoof", "nose"], 0.3, 60.0);
    mesh.polish(&["eye"], 0.9, 300.0);
    mesh.polish(&["antler", "antler_tip"], 0.2, 40.0);
    let form = Form::new();
    skin(&mut mesh, &form);
    crown::add_crown(&mut mesh, &form);
    let low = mesh.positions.iter().fold(DVec3::INFINITY, |low, &point| low.min(point));
    let high = mesh.positions.iter().fold(DVec3::NEG_INFINITY, |high, &point| high.max(point));
    let middle = DVec3::new(0.5 * (low.x + high.x), low.y, 0.5 * (low.z + high.z));
    for point in &mut mesh.positions {
        *point = (*point - middle) * WITHERS;
    }
    mesh.round_to(1e4);
    mesh.has_normals = true;
    mesh
}

fn skin(mesh: &mut PolyMesh, form: &Form) {
    let field = |point| form.distance(point);
    let swollen = form.swollen(0.020);
    let grid = Grid {
        low: DVec3::new(-0.80, -0.0787, -0.2603),
        high: DVec3::new(1.10, 1.52, 0.2603),
        cell: DVec3::new(0.0289, 0.0338, 0.0274),
    };
    let bare = Look { group: "body", material: "coat_08" };
    let points = weave(mesh, &grid, |point| swollen.distance(point), bare);
    tighten(mesh, points, field, 5);
    for face in &mut mesh.faces {
        let sum = face.corners.iter().map(|&corner| mesh.positions[corner]).sum::<DVec3>();
        let middle = sum / face.corners.len() as f64;
        face.look = coat::look(middle, slope(middle, field(middle), &field).normalize_or(DVec3::Y));
    }
}
