//! Guides as if drawn with the mouse in a view: each point is where the ray through a pixel first hits the mesh.

use glam::{DMat4, DVec2, DVec3, Vec3};
use impasto_core::TriangleMesh;
use impasto_scene::document::{Falloff, Guide, GuideMode, GuidePoint, GuideView, Lens};
use impasto_scene::motion::CameraPose;

/// A camera that looks from `eye` at `target` through a lens of 35°.
pub fn camera(eye: [f64; 3], target: [f64; 3]) -> CameraPose {
    CameraPose {
        eye: DVec3::from(eye),
        target: DVec3::from(target),
        roll_rad: 0.0,
        shift: DVec2::ZERO,
        lens: Lens::Perspective { fov_y_deg: 35.0, near: 0.05, far: 100.0 },
    }
}

/// A straight gesture of 24 points on the mesh, from one place of the picture to another (pixels from its centre, Y
/// up); `None` if a ray misses. The lens must be that of [`camera`].
pub fn drag(mesh: &TriangleMesh, camera: &CameraPose, height_px: f64, ends_px: [DVec2; 2]) -> Option<Guide> {
    let world_from_view: DMat4 = camera.view_from_world().inverse();
    let focal_px = 0.5 * height_px / 17.5f64.to_radians().tan();
    let points: Option<Vec<GuidePoint>> = (0..24)
        .map(|step| {
            let at = ends_px[0].lerp(ends_px[1], f64::from(step) / 23.0);
            let ray = world_from_view.transform_vector3(DVec3::new(at.x, at.y, -focal_px)).normalize();
            let (position, normal) = first_hit(mesh, camera.eye, ray)?;
            Some(GuidePoint { at: position.to_array(), normal: normal.to_array(), turn_deg: 0.0 })
        })
        .collect();
    Some(Guide {
        mode: GuideMode::Comb,
        curve: false,
        object: None,
        view: Some(GuideView { eye: camera.eye.to_array(), target: camera.target.to_array(), frame: None }),
        points: points?,
        radius: 0.25,
        strength: 1.0,
        falloff: Falloff::Smooth,
    })
}

/// Where a ray first hits the front of a triangle (Möller and Trumbore 1997): the place and its smooth normal.
fn first_hit(mesh: &TriangleMesh, from: DVec3, ray: DVec3) -> Option<(DVec3, DVec3)> {
    let mut nearest: Option<(f64, DVec3)> = None;
    for (triangle, corners) in mesh.triangles.iter().enumerate() {
        let [a, b, c] = mesh.corners(triangle).map(Vec3::as_dvec3);
        let (ab, ac) = (b - a, c - a);
        let across = ray.cross(ac);
        let determinant = ab.dot(across);
        let to_eye = from - a;
        let v = to_eye.dot(across) / determinant;
        let w = ray.dot(to_eye.cross(ab)) / determinant;
        let distance = ac.dot(to_eye.cross(ab)) / determinant;
        let hits = determinant > 0.0 && v >= 0.0 && w >= 0.0 && v + w <= 1.0 && distance > 0.0;
        if hits && nearest.is_none_or(|(least, _)| distance < least) {
            let [na, nb, nc] = corners.map(|vertex| mesh.normals[vertex as usize].as_dvec3());
            nearest = Some((distance, (na * (1.0 - v - w) + nb * v + nc * w).normalize()));
        }
    }
    nearest.map(|(distance, normal)| (from + ray * distance, normal))
}
