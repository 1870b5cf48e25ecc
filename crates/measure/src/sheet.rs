//! Makes a scene of a flat sheet that carries another scene's strokes, to measure their density when it is tilted.

use std::path::Path;
use std::sync::Arc;

use glam::{DVec3, Vec3};
use impasto_core::TriangleMesh;
use impasto_scene::document::{Lens, StrokeSettings};
use impasto_scene::load;
use impasto_scene::loaded::LoadedScene;
use impasto_scene::mesh_file::{Material, MeshFile};
use impasto_scene::motion::CameraPose;
use impasto_scene::presets;

use crate::versions::body_alone;

const SHEET: &str = "#![enable(implicit_some)]
(
    version: 1,
    camera: (lens: Orthographic(height: 2, near: 0.1, far: 20), keys: [(frame: 0, eye: (0, 0, 8), target: (0, 0, 0))]),
    objects: [(name: \"sheet\", mesh: \"sheet\")],
)";

/// A scene of a sheet, 2 by 2 units, that fills a square picture. Its strokes, all of one size, have the length, width
/// and coverage that the body layer has in `region` of another scene, or outside all regions if `region` is `None`.
/// Returns `None` if the text of the sheet's scene, `SHEET`, cannot be read.
pub fn sheet(loaded: &LoadedScene, region: Option<usize>, side_px: u32) -> Option<LoadedScene> {
    let mut version = loaded.clone();
    let body = presets::resolve(&loaded.scene, region).body().clone();
    version.scene = load::parse(Path::new("sheet"), SHEET).ok()?;
    version.scene.size = (side_px, side_px);
    version.scene.seed = loaded.scene.seed;
    version.scene.strokes = StrokeSettings {
        length_px: Some(f64::from(body.length_px)),
        width_px: Some(f64::from(body.width_px)),
        coverage: Some(f64::from(body.coverage)),
        size_jitter: Some(0.0),
        contour: Some(0.0),
        ..StrokeSettings::default()
    };
    body_alone(&mut version.scene);
    version.meshes.insert("sheet".to_owned(), Arc::new(mesh()));
    Some(version)
}

fn mesh() -> MeshFile {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let mesh = TriangleMesh {
        positions: corners.map(|[x, y]| Vec3::new(x, y, 0.0)).to_vec(),
        normals: vec![Vec3::Z; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        polygon_of_triangle: vec![0, 0],
        group_of_triangle: vec![0, 0],
        material_of_triangle: vec![0, 0],
        ..TriangleMesh::default()
    };
    let material = Material::plain("sheet".to_owned(), [0.5; 3]);
    MeshFile::still(mesh, vec!["sheet".to_owned()], vec![material])
}

/// A camera that sees the sheet tilted by this angle.
pub fn camera(tilt_deg: f64) -> CameraPose {
    let (sin, cos) = tilt_deg.to_radians().sin_cos();
    CameraPose {
        eye: DVec3::new(0.0, -8.0 * sin, 8.0 * cos),
        target: DVec3::ZERO,
        roll_rad: 0.0,
        shift: glam::DVec2::ZERO,
        lens: Lens::Orthographic { height: 2.0, near: 0.1, far: 20.0 },
    }
}
