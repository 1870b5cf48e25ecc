//! Tests of what needs particles: no place needs more than is found.

use super::*;
use glam::{DAffine3, DVec2};
use impasto_core::screen_map::{PixelLens, area_px};
use impasto_core::{ScreenMap, hash};

use crate::body_shape::BodyShape;
use crate::presence_bound::LEAST_COUNTED_FADE;

/// Triangles whose corners are bent, stretched and turned by different F, near to the eye and far from it, some
/// with strokes that are lifted off them.
#[test]
fn no_place_of_a_moved_piece_needs_more_than_the_piece() {
    let random = |which: u32| hash::unit(hash::scramble(which)) - 0.5;
    let vector = |which: u32| Vec3::new(random(which), random(which + 1), random(which + 2));
    let (mut seen, mut closest, mut turned_away) = (0, 0.0f64, 0);
    for case in 0..2000u32 {
        let from = 2000 * case;
        let lens = match case % 3 {
            0 => PixelLens::Orthographic { px_per_unit: 90.0 },
            _ => PixelLens::Perspective { focal_px: 400.0 },
        };
        let pose = DAffine3::from_scale(if case % 5 == 0 { DVec3::new(1.5, 0.7, 1.0) } else { DVec3::ONE });
        let view = glam::dcamera::rh::view::look_at_mat4(DVec3::Z * 2.0, DVec3::ZERO, DVec3::Y);
        let map = ScreenMap::new(view, pose, lens);
        let sighting =
            Sighting { map, half_size_px: DVec2::new(320.0, 180.0), near: 0.1, shape: BodyShape::default() };
        let offset = if case % 4 == 0 { 0.2 } else { 0.0 };
        let eye = Eye::new(&sighting, Reach { margin: 1.0, reach_px: 0.0, most_offset: f64::from(offset) });
        let much = if case % 2 == 0 { 0.1 } else { 1.2 };
        let turn = Mat3::from_axis_angle(vector(from).normalize(), 6.0 * random(from + 3));
        let gradient = |which: u32| {
            let [x, y, z] = [0, 3, 6].map(|column| vector(from + which + column) * much);
            turn + Mat3::from_cols(x, y, z)
        };
        let gradients = [10, 20, 30].map(gradient);
        let smooth = [40, 43, 46].map(|which| (Vec3::Z + vector(from + which)).normalize());
        let [a, b, c] = [50, 53, 56].map(|which| vector(from + which) * [1.0, 3.0][(case % 2) as usize]);
        let piece = CellPiece {
            vertices: [0; 3],
            corners: [a, b, c].map(Vec3::as_dvec3),
            normals: [Vec3::Z, smooth[0], smooth[1], smooth[2]].map(Vec3::as_dvec3),
        };
        let most = most_on_piece(&eye, &piece, gradients);
        turned_away += u32::from(most == 0.0);
        for sample in 0..40 {
            let weights = [0, 1, 2].map(|corner| random(from + 100 + 7 * sample + corner) + 0.5);
            let [u, v, w] = weights.map(|weight| weight / weights.iter().sum::<f32>());
            let blended = gradients[0] * u + gradients[1] * v + gradients[2] * w;
            let normal = (smooth[0] * u + smooth[1] * v + smooth[2] * w).normalize();
            let [x, y, z] = [blended.x_axis, blended.y_axis, blended.z_axis];
            let carried = Mat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * normal;
            let at = (a * u + b * v + c * w + carried.normalize() * offset).as_dvec3();
            let jacobian = map.jacobian(at);
            let facing = map.facing(jacobian, carried.normalize().as_dvec3()) as f32;
            let is_inside = map.project(at).abs().cmplt(sighting.half_size_px).all();
            if map.depth(at) <= sighting.near || !is_inside || facing <= 0.0 {
                continue;
            }
            seen += 1;
            let fade = f64::from(presence::of_facing(facing).max(LEAST_COUNTED_FADE));
            let needed = area_px(jacobian, carried.as_dvec3()) / fade;
            assert!(needed <= most * 1.000_1, "case {case}: {needed} of {most}");
            closest = closest.max(needed / most);
        }
    }
    assert!(seen > 5000 && turned_away > 100 && closest > 0.9, "{seen}, {turned_away}, {closest}");
}

#[test]
fn the_longest_order_makes_at_most_so_many() {
    assert_eq!(longest([1e3, 5e6], 1e5, |length| length * 0.01), 5e6);
    let length = longest([1e3, 5e6], 1e5, |length| length * 0.5);
    assert!((length - 2e5).abs() < 1.0, "{length}");
    assert_eq!(longest([3e5, 2e5], 2e5, |length| length * 0.5), 3e5);
}
