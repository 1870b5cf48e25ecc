//! Tests that a heap of faces has its strokes where they can be seen, and few inside.

use glam::{DVec2, DVec3, Vec3};
use impasto_core::{TriangleMesh, hash, presence};
use impasto_painting::{FrameOptions, PrepareOptions, Preparer, SeenFrom};
use impasto_scene::motion::CameraPose;
use impasto_tests::shapes;

const SIZE_PX: [u32; 2] = [640, 360];

/// Triangles at random places and angles in a cube with sides of two units.
fn heap(triangles: u32) -> TriangleMesh {
    let random =
        |number: u32, which: u32| 2.0 * hash::unit(hash::combine(hash::combine(9, number), which)) - 1.0;
    let at = |number: u32, which: u32| {
        Vec3::new(random(number, which), random(number, which + 1), random(number, which + 2))
    };
    let mut mesh = TriangleMesh::default();
    for triangle in 0..triangles {
        let middle = 0.8 * at(triangle, 0);
        let corners = [3, 6, 9].map(|which| 0.2 * at(triangle, which));
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or(Vec3::Y);
        mesh.positions.extend(corners.map(|corner| middle + corner));
        mesh.normals.extend([normal; 3]);
        mesh.triangles.push([0, 1, 2].map(|corner| 3 * triangle + corner));
    }
    mesh
}

#[test]
fn inside_a_heap_there_are_few_strokes_and_on_it_no_fewer() {
    let mut scene = shapes::scene(vec![shapes::object("heap", 1)]);
    scene.objects[0].particles = None;
    scene.size = (SIZE_PX[0], SIZE_PX[1]);
    scene.camera.keys = vec![shapes::camera_key(0.0, [0.0, 1.2, 6.0], [0.0, 0.0, 0.0])];
    scene.strokes.layers = shapes::body_layer_alone();
    let pose = |eye: [f64; 3]| CameraPose {
        eye: eye.into(),
        target: DVec3::ZERO,
        roll_rad: 0.0,
        shift: DVec2::ZERO,
        lens: scene.camera.lens.clone(),
    };
    let (shot, behind) = (pose([0.0, 1.2, 6.0]), pose([0.0, 1.2, -6.0]));
    // Returns the number of particles, and how many times over strokes cover the middle 120 × 120 pixels: first those
    // on the front of the heap (more than 0.75 units before its middle), then those behind its middle.
    let of = |seen_from: SeenFrom<'_>, camera: &CameraPose| {
        let loaded = shapes::loaded(scene.clone(), [heap(9000)]);
        let options = PrepareOptions { seen_from, ..PrepareOptions::default() };
        let painting = Preparer::default().prepare_with(loaded, &options).unwrap();
        let frame = painting.seen_by(camera, 0.0, &FrameOptions::new(SIZE_PX));
        let mut covered = [0.0f32; 2];
        for stroke in frame.strokes.iter() {
            let [x, y] = [stroke.center_px[0] - 320.0, stroke.center_px[1] - 180.0].map(f32::abs);
            let deep = f64::from(stroke.depth) - camera.eye.length();
            if x < 60.0 && y < 60.0 {
                let there = presence::of_supply(stroke.supply_ln) * stroke.facing_fade;
                let band = if deep < -0.75 {
                    0
                } else if deep > 0.0 {
                    1
                } else {
                    continue;
                };
                covered[band] += there * stroke.length_px * stroke.width_px / (120.0 * 120.0);
            }
        }
        (painting.particle_total(), covered)
    };
    let (all, [front, inside]) = of(SeenFrom::Anywhere, &shot);
    let (made, [front_of_shot, inside_of_shot]) = of(SeenFrom::SHOT, &shot);
    assert!(made * 3 < all, "{made} of {all} particles");
    // At least the first 8,192 particles of a layer lie everywhere; hardly any of the others are made inside.
    assert!(inside > 1.0 && inside_of_shot < 0.45 * inside, "{inside} before, {inside_of_shot} now");
    assert!(front > 0.5 && front_of_shot > 0.95 * front, "{front} before, {front_of_shot} now");
    // Another camera sees the other side.
    let also = [(behind.clone(), 0.0)];
    let (_, [back, _]) = of(SeenFrom::Anywhere, &behind);
    let (_, [back_unseen, _]) = of(SeenFrom::SHOT, &behind);
    let (_, [back_seen, _]) = of(SeenFrom::Shot { also: &also, margin: SeenFrom::MARGIN }, &behind);
    assert!(
        back_unseen < 0.7 * back && back_seen > 0.95 * back,
        "{back} before, {back_unseen}, {back_seen} now"
    );
}
