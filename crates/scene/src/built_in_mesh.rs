//! Built-in meshes, which need no file. Their names begin with `impasto:`; no file is looked for under such a name.

use std::f32::consts::FRAC_PI_2;

use glam::{Vec2, Vec3};
use impasto_core::TriangleMesh;

use crate::mesh_file::{Material, MeshFile};

/// The beginning of the names of built-in meshes.
pub const PREFIX: &str = "impasto:";

/// Whether a mesh of this name needs no file.
pub fn is_built_in(name: &str) -> bool {
    name.starts_with(PREFIX)
}

/// A photographer's backdrop, a floor that bends up into a wall: 2 wide and 1.3 high, from z = 1 back to −0.28. The
/// floor lies at height 0.
pub const BACKDROP: &str = "impasto:backdrop";

/// A patch of floor with an uneven border: a disc of radius about 1 at height 0.
pub const PATCH: &str = "impasto:patch";

/// The names of all built-in meshes.
pub const ALL: [&str; 2] = [BACKDROP, PATCH];

/// The group of the backdrop's floor, up to the middle of the bend. All of the patch is in a group of this name.
pub const FLOOR: &str = "floor";
/// The group of the backdrop's wall, from the middle of the bend up.
pub const WALL: &str = "wall";

const FRONT: f32 = 1.0;
const BACK: f32 = -0.28;
const HEIGHT: f32 = 1.3;

/// Radius of the bend between floor and wall.
const BEND: f32 = 0.12;

/// Number of quads across the backdrop.
const ACROSS: usize = 24;
/// Numbers of quads along the profile: on the floor, in the bend, up the wall.
const ALONG: [usize; 3] = [16, 10, 14];

/// The built-in mesh of this name, if there is one.
pub fn of_name(name: &str) -> Option<MeshFile> {
    let (mesh, groups): (TriangleMesh, &[&str]) = match name {
        BACKDROP => (backdrop(), &[FLOOR, WALL]),
        PATCH => (patch(), &[FLOOR]),
        _ => return None,
    };
    let material = Material::plain("ground".to_owned(), [0.42, 0.40, 0.35]);
    let groups = groups.iter().map(|&group| group.to_owned()).collect();
    Some(MeshFile::still(mesh, groups, vec![material]))
}

/// Rings of quads round a centre, with triangles in the innermost. Each ring has the uneven outline of the border.
fn patch() -> TriangleMesh {
    const RINGS: u32 = 8;
    const AROUND: u32 = 64;
    let mut mesh = TriangleMesh::default();
    for ring in 0..=RINGS {
        for step in 0..AROUND {
            let angle = std::f32::consts::TAU * step as f32 / AROUND as f32;
            // Each sine makes a whole number of waves round the disc, so that the border closes.
            let uneven = 0.05 * (3.0 * angle + 0.7).sin()
                + 0.035 * (5.0 * angle + 2.0).sin()
                + 0.02 * (11.0 * angle).sin();
            let at = Vec2::from_angle(angle) * (ring as f32 / RINGS as f32) * (1.0 + uneven);
            mesh.positions.push(Vec3::new(at.x, 0.0, at.y));
            mesh.normals.push(Vec3::Y);
            mesh.uvs.push(at * 0.5 + 0.5);
        }
    }
    for ring in 0..RINGS {
        for step in 0..AROUND {
            let at = |ring: u32, step: u32| ring * AROUND + step % AROUND;
            let [a, b, c, d] =
                [at(ring, step), at(ring, step + 1), at(ring + 1, step + 1), at(ring + 1, step)];
            let quad: &[[u32; 3]] = if ring == 0 { &[[a, c, d]] } else { &[[a, b, c], [a, c, d]] };
            for &triangle in quad {
                mesh.triangles.push(triangle);
                mesh.polygon_of_triangle.push(ring * AROUND + step);
                mesh.group_of_triangle.push(0);
                mesh.material_of_triangle.push(0);
            }
        }
    }
    mesh
}

/// Height, depth and normal along the profile, from the front of the floor to the top of the wall.
fn profile() -> Vec<(f32, f32, Vec3)> {
    let share = |index: usize, count: usize| index as f32 / count as f32;
    let floor = (0..ALONG[0]).map(|i| {
        let z = FRONT + (BACK + BEND - FRONT) * share(i, ALONG[0]);
        (0.0, z, Vec3::Y)
    });
    let bend = (0..ALONG[1]).map(|i| {
        let (sin, cos) = (FRAC_PI_2 * share(i, ALONG[1])).sin_cos();
        (BEND * (1.0 - cos), BACK + BEND * (1.0 - sin), Vec3::new(0.0, cos, sin))
    });
    let wall = (0..=ALONG[2]).map(|i| (BEND + (HEIGHT - BEND) * share(i, ALONG[2]), BACK, Vec3::Z));
    floor.chain(bend).chain(wall).collect()
}

fn backdrop() -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    let profile = profile();
    let rows = profile.len() - 1;
    for (row, &(y, z, normal)) in profile.iter().enumerate() {
        for column in 0..=ACROSS {
            let u = column as f32 / ACROSS as f32;
            mesh.positions.push(Vec3::new(2.0 * u - 1.0, y, z));
            mesh.normals.push(normal);
            mesh.uvs.push(Vec2::new(u, row as f32 / rows as f32));
        }
    }
    let vertices_across = ACROSS as u32 + 1;
    for row in 0..rows as u32 {
        for column in 0..ACROSS as u32 {
            let polygon = row * ACROSS as u32 + column;
            let a = row * vertices_across + column;
            let (b, c, d) = (a + 1, a + vertices_across + 1, a + vertices_across);
            for triangle in [[a, b, c], [a, c, d]] {
                mesh.triangles.push(triangle);
                mesh.polygon_of_triangle.push(polygon);
                mesh.group_of_triangle.push(u32::from(row >= ALONG[0] as u32 + ALONG[1] as u32 / 2));
                mesh.material_of_triangle.push(0);
            }
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_patch_faces_up_and_is_about_as_large_as_a_disc() {
        let mesh = of_name(PATCH).unwrap().mesh;
        let across = |triangle| {
            let [a, b, c] = mesh.corners(triangle);
            (b - a).cross(c - a)
        };
        assert!((0..mesh.triangles.len()).all(|triangle| across(triangle).y > 0.0));
        let area: f32 = (0..mesh.triangles.len()).map(|triangle| across(triangle).y / 2.0).sum();
        assert!((area / std::f32::consts::PI - 1.0).abs() < 0.02, "{area}");
    }

    #[test]
    fn the_backdrop_faces_up_and_forward() {
        let mesh = of_name(BACKDROP).unwrap().mesh;
        for triangle in 0..mesh.triangles.len() {
            let [a, b, c] = mesh.corners(triangle);
            let across = (b - a).cross(c - a).normalize();
            let normal = mesh.normals[mesh.triangles[triangle][0] as usize];
            assert!(across.dot(normal) > 0.9, "triangle {triangle}: {across} against {normal}");
        }
        let (low, high) = mesh.bounds().unwrap();
        assert!((low - Vec3::new(-1.0, 0.0, BACK)).length() < 1e-6);
        assert!((high - Vec3::new(1.0, HEIGHT, FRONT)).length() < 1e-6);
        assert!(of_name("impasto:ladder").is_none());
    }
}
