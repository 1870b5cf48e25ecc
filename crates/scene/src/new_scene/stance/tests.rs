//! Tests of stances on forms whose answer is known: a mug, a person, a room, an aircraft.

use std::f32::consts::TAU;

use glam::Vec3;
use impasto_core::TriangleMesh;

use super::*;
use crate::mesh_file::Material;

/// Faces with flat normals, as triangles of corners.
#[derive(Default)]
struct Faces(Vec<[Vec3; 3]>);

impl Faces {
    fn quad(&mut self, [a, b, c, d]: [Vec3; 4]) {
        self.0.extend([[a, b, c], [a, c, d]]);
    }

    /// A box, wound outwards.
    fn cuboid(&mut self, low: [f32; 3], high: [f32; 3]) {
        let (low, high) = (Vec3::from(low), Vec3::from(high));
        let at = |x: bool, y: bool, z: bool| Vec3::select(glam::BVec3::new(x, y, z), high, low);
        let (o, i) = (false, true);
        self.quad([at(o, o, o), at(o, o, i), at(o, i, i), at(o, i, o)]);
        self.quad([at(i, o, o), at(i, i, o), at(i, i, i), at(i, o, i)]);
        self.quad([at(o, o, o), at(i, o, o), at(i, o, i), at(o, o, i)]);
        self.quad([at(o, i, o), at(o, i, i), at(i, i, i), at(i, i, o)]);
        self.quad([at(o, o, o), at(o, i, o), at(i, i, o), at(i, o, o)]);
        self.quad([at(o, o, i), at(i, o, i), at(i, i, i), at(o, i, i)]);
    }

    /// A profile (radius and height) turned about Y, wound outwards where it rises.
    fn lathe(&mut self, profile: &[[f32; 2]]) {
        let around = |[radius, height]: [f32; 2], step: u32| {
            let (sin, cos) = (TAU * step as f32 / 40.0).sin_cos();
            Vec3::new(radius * cos, height, -radius * sin)
        };
        for ends in profile.windows(2) {
            for step in 0..40 {
                let [low, high] = [ends[0], ends[1]];
                self.quad([
                    around(low, step),
                    around(low, step + 1),
                    around(high, step + 1),
                    around(high, step),
                ]);
            }
        }
    }

    fn stance(&self, from_y_up: impl Fn(Vec3) -> Vec3) -> Stance {
        let corners: Vec<Vec3> = self.0.iter().flatten().map(|&corner| from_y_up(corner)).collect();
        let normals = corners
            .chunks(3)
            .flat_map(|of| [(of[1] - of[0]).cross(of[2] - of[0]).normalize_or(Vec3::Y); 3])
            .collect();
        let count = self.0.len();
        let mesh = TriangleMesh {
            normals,
            triangles: (0..count as u32).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]).collect(),
            material_of_triangle: vec![0; count],
            group_of_triangle: vec![0; count],
            positions: corners,
            ..TriangleMesh::default()
        };
        let material = Material::plain(String::new(), [0.8; 3]);
        Samples::of(&MeshFile::still(mesh, vec![String::new()], vec![material])).stance(None, ViewFrom::Auto)
    }
}

fn as_it_is(at: Vec3) -> Vec3 {
    at
}

fn with_z_up(at: Vec3) -> Vec3 {
    Vec3::new(at.x, -at.z, at.y)
}

#[test]
fn a_mug_stands_on_its_bottom_whichever_axis_of_its_file_is_up() {
    let mut mug = Faces::default();
    mug.lathe(&[[0.0, 0.0], [0.4, 0.0], [0.4, 1.0], [0.35, 1.0], [0.35, 0.08], [0.0, 0.08]]);
    // The handle.
    mug.cuboid([0.38, 0.25, -0.05], [0.65, 0.33, 0.05]);
    mug.cuboid([0.38, 0.67, -0.05], [0.65, 0.75, 0.05]);
    mug.cuboid([0.57, 0.25, -0.05], [0.65, 0.75, 0.05]);
    assert_eq!(mug.stance(as_it_is).up, Up::Y);
    assert_eq!(mug.stance(with_z_up).up, Up::Z);
}

#[test]
fn a_person_on_small_round_feet_does_not_lie_down() {
    let mut person = Faces::default();
    let ball = |middle: f32, half: [f32; 2]| {
        let turn = |step: i32| (step as f32 / 8.0 - 0.5) * std::f32::consts::PI;
        (0..=8).map(move |step| [half[0] * turn(step).cos(), middle + half[1] * turn(step).sin()])
    };
    for (middle, half) in [(1.58, [0.11, 0.15]), (1.15, [0.2, 0.32])] {
        person.lathe(&ball(middle, half).collect::<Vec<_>>());
    }
    for side in [-1.0, 1.0] {
        let mut leg = Faces::default();
        leg.lathe(&ball(0.45, [0.09, 0.45]).collect::<Vec<_>>());
        person.0.extend(leg.0.iter().map(|face| face.map(|at| at + Vec3::X * (0.11 * side))));
    }
    assert_eq!(person.stance(as_it_is).up, Up::Y);
}

#[test]
fn a_room_is_seen_through_its_opening() {
    // Five walls, wound inwards; the sixth, towards −Z, is not there. Two boxes stand inside.
    let mut room = Faces::default();
    room.cuboid([-1.0, 0.0, -1.0], [1.0, 2.0, 1.0]);
    room.0.retain(|face| !face.iter().all(|corner| corner.z < -0.9));
    room.0.iter_mut().for_each(|face| face.swap(1, 2));
    room.cuboid([-0.6, 0.0, 0.1], [0.0, 1.2, 0.6]);
    room.cuboid([0.1, 0.0, -0.5], [0.6, 0.6, 0.0]);
    let stance = room.stance(as_it_is);
    assert_eq!(stance.up, Up::Y);
    assert!(stance.view.z < -0.5, "it is seen from {}", stance.view);
}

#[test]
fn an_aircraft_shows_its_nose_and_not_its_high_tail() {
    let mut aircraft = Faces::default();
    // A hull along Z with a round nose at +Z, wings, and a tail with a fin.
    let mut hull = Faces::default();
    hull.lathe(&[[0.0, -3.0], [0.25, -2.5], [0.4, -1.0], [0.4, 2.0], [0.3, 2.6], [0.0, 3.0]]);
    aircraft.0.extend(hull.0.iter().map(|face| face.map(|at| Vec3::new(at.x, -at.z, at.y))));
    aircraft.cuboid([-3.0, -0.1, -0.6], [3.0, 0.0, 0.3]);
    aircraft.cuboid([-1.0, 0.1, -2.9], [1.0, 0.2, -2.4]);
    aircraft.cuboid([-0.05, 0.1, -3.0], [0.05, 1.0, -2.4]);
    let stance = aircraft.stance(as_it_is);
    assert_eq!(stance.up, Up::Y);
    assert!(stance.view.z > 0.3, "it is seen from {}", stance.view);
}
