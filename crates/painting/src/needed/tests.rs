//! Tests of where particles are needed: no place needs more than the bound that is found for it.

use super::*;
use glam::{DAffine3, DVec2};
use impasto_core::screen_map::{PixelLens, area_px};
use impasto_core::{ScreenMap, TriangleMesh, hash};

use crate::body_shape::BodyShape;
use crate::presence_bound::LEAST_COUNTED_FADE;

/// Triangles near the eye, round it and far from it. A different deformation gradient at each corner bends, stretches
/// and turns them. Some have strokes that are lifted off them, some have smooth normals that lie on both sides of them.
#[test]
fn no_place_of_a_moved_piece_needs_more_than_the_piece() {
    let random = |which: u32| hash::unit(hash::scramble(which)) - 0.5;
    let vector = |which: u32| Vec3::new(random(which), random(which + 1), random(which + 2));
    let (mut seen, mut lifted, mut at_eye, mut closest, mut turned_away) = (0, 0, 0, 0.0f64, 0);
    for case in 0..6000u32 {
        let from = 2000 * case;
        let is = |which: u32, share: f32| random(from + 1900 + which) + 0.5 < share;
        let lens = if is(0, 0.3) {
            PixelLens::Orthographic { px_per_unit: 90.0 }
        } else {
            PixelLens::Perspective { focal_px: 400.0 }
        };
        let pose = DAffine3::from_scale(if is(1, 0.2) { DVec3::new(1.5, 0.7, 1.0) } else { DVec3::ONE });
        let view = glam::dcamera::rh::view::look_at_mat4(DVec3::Z * 2.0, DVec3::ZERO, DVec3::Y);
        let shift_px = if is(2, 0.2) { DVec2::new(90.0, -40.0) } else { DVec2::ZERO };
        let map = ScreenMap::new(view, pose, lens).shifted(shift_px);
        let half_size_px = DVec2::new(320.0, 180.0);
        let sighting = Sighting { map, half_size_px, near: 0.1, shape: BodyShape::default() };
        let offset = if is(3, 0.3) { 0.2 } else { 0.0 };
        let reach = Reach { margin: 1.0, reach_px: 0.0, following: None, offsets: [f64::from(offset); 2] };
        let eye = Eye::new(&sighting, reach);
        let much = if is(4, 0.5) { 0.1 } else { 1.2 };
        let turn = Mat3::from_axis_angle(vector(from).normalize(), 6.0 * random(from + 3));
        let gradient = |which: u32| {
            let [x, y, z] = [0, 3, 6].map(|column| vector(from + which + column) * much);
            turn + Mat3::from_cols(x, y, z)
        };
        let gradients = [10, 20, 30].map(gradient);
        let around = if is(5, 0.1) { 3.0 } else { 1.0 };
        let smooth = [40, 43, 46].map(|which| (Vec3::Z + vector(from + which) * around).normalize());
        let is_even = smooth.iter().all(|normal| normal.z > 0.0);
        let span = if is(6, 0.5) { 1.0 } else { 5.0 };
        let [a, b, c] = [50, 53, 56].map(|which| vector(from + which) * span);
        let piece = CellPiece {
            vertices: [0; 3],
            corners: [a, b, c].map(Vec3::as_dvec3),
            flat: DVec3::Z,
            smooth: is_even.then_some(smooth.map(Vec3::as_dvec3)),
        };
        let most = most_on_piece(&eye, &piece, gradients);
        turned_away += u32::from(most == 0.0 && !eye.seen_part(piece.corners).is_empty());
        at_eye += u32::from(piece.corners.iter().any(|&corner| map.depth(corner) < sighting.near));
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
            let is_inside = map.project(at).abs().cmplt(half_size_px).all();
            if map.depth(at) <= sighting.near || !is_inside || facing <= 0.0 {
                continue;
            }
            seen += 1;
            lifted += u32::from(offset > 0.0 && much > 1.0);
            let fade = f64::from(presence::of_facing(facing).max(LEAST_COUNTED_FADE));
            let needed = area_px(jacobian, carried.as_dvec3()) / fade;
            assert!(needed <= most * 1.000_1, "case {case}: {needed} of {most}");
            closest = closest.max(needed / most);
        }
    }
    assert!(seen > 20_000 && lifted > 1000, "{seen}, {lifted} of them lifted");
    assert!(at_eye > 300 && turned_away > 300 && closest > 0.9, "{at_eye}, {turned_away}, {closest}");
}

/// A cell of a hundredth of the surface is seen very closely, one of a half from afar, and the rest not at all.
#[test]
fn near_spots_get_more_only_on_bodies_at_rest() {
    let square = TriangleMesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        normals: vec![Vec3::Z; 3],
        triangles: vec![[0, 1, 2]],
        ..TriangleMesh::default()
    };
    let surface = Surface::new(&square, |_| true);
    let cells = Cells::new(&surface);
    let seen = |share: f64, px_per_area: f64| {
        let mut seen = SeenCell::whole(&cells.all()[0], px_per_area);
        seen.px_in_picture = px_per_area;
        seen.cell.share = share;
        (seen, [1.0; LAYERS])
    };
    let tree = |far: f64| SeenTree::new(vec![seen(0.01, 1e12), seen(0.5, far), seen(0.49, 0.0)]);
    let made = |tree: &SeenTree, kind_of_body| {
        // In whole thousands, since the length of an order is only found roughly.
        let thousands = |count: CoatCount| ((count.made as f64 - LEAST_ON_WHOLE) / 1000.0).round();
        tree.count(0, 400_000.0, kind_of_body).map(thousands)
    };
    let few = tree(20_000.0);
    assert_eq!(made(&few, KindOfBody::AtRest), Some(200.0));
    assert_eq!(made(&few, KindOfBody::Heap), Some(MOST_MADE_OF_HEAP / 1000.0));
    assert_eq!(made(&few, KindOfBody::Moving), Some(14.0));
    // What is seen needs a little less than half of all particles, or a little more.
    for (far, [at_rest, moving]) in
        [(380_000.0, [Some(200.0), Some(194.0)]), (400_000.0, [None, Some(204.0)])]
    {
        let most = tree(far);
        assert_eq!(made(&most, KindOfBody::AtRest), at_rest);
        assert_eq!(made(&most, KindOfBody::Moving), moving);
    }
}

#[test]
fn the_longest_order_makes_at_most_so_many() {
    assert_eq!(longest([1e3, 5e6], 1e5, |length| length * 0.01), 5e6);
    let length = longest([1e3, 5e6], 1e5, |length| length * 0.5);
    assert!((length - 2e5).abs() < 1.0, "{length}");
    assert_eq!(longest([3e5, 2e5], 2e5, |length| length * 0.5), 3e5);
}
