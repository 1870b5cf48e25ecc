//! Tests of stroke angles, as the camera rolls and as it moves sideways, against answers in closed form. The answers
//! come from the scene's numbers by plain trigonometry, without the code under test.

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::{DAffine3, DMat2, DMat3, DVec2, DVec3};
use impasto_painting::frame::LayerKind;
use impasto_painting::{Frame, FrameOptions, Rotation, prepare};
use impasto_scene::document::{CameraKey, Lens, ObjectKey, RotatingStrokes, Scene, Solver, Style};
use impasto_tests::shapes;

fn options(size_px: [u32; 2]) -> FrameOptions {
    FrameOptions::new(size_px)
}

fn degrees_apart(first: f64, second: f64) -> f64 {
    let turn = (first - second).rem_euclid(TAU);
    turn.min(TAU - turn).to_degrees()
}

/// Angles of the body layer's strokes by particle.
fn angles(frame: &Frame) -> std::collections::BTreeMap<(u32, u32), f64> {
    let run = frame.layers.iter().find(|run| run.kind == LayerKind::Body).expect("a body layer");
    let range = run.first as usize..(run.first + run.count) as usize;
    frame.strokes[range.clone()]
        .iter()
        .zip(&frame.sources[range])
        .map(|(stroke, source)| ((stroke.body_id, source.particle), f64::from(stroke.angle_rad)))
        .collect()
}

fn with_solver(mut scene: Scene, solver: Solver) -> Scene {
    scene.style = Style::RotatingStrokes(RotatingStrokes { solver, ..Default::default() });
    scene
}

const ROLLS_DEG: [f64; 7] = [1.0, 7.0, 30.0, 77.0, 137.0, 180.0, 359.0];

/// A sphere off the middle, seen a little from above, by a camera that has rolled by these degrees at frames 1, 2, 3
/// and so on.
fn rolling_scene(size: (u32, u32), rolls_deg: &[f64]) -> Scene {
    let mut scene = shapes::scene(vec![shapes::object("sphere", 20_000)]);
    scene.size = size;
    scene.timeline.last = rolls_deg.len() as i64;
    let mut key = shapes::camera_key(0.0, [0.7, 1.3, 4.2], [0.2, 0.1, 0.0]);
    key.roll_deg = 13.0;
    let rolled = |(index, roll_deg): (usize, &f64)| CameraKey {
        frame: (index + 1) as f64,
        roll_deg: 13.0 + roll_deg,
        ..key.clone()
    };
    scene.camera.keys = rolls_deg.iter().enumerate().map(rolled).collect();
    scene.camera.keys.insert(0, key);
    scene
}

#[test]
fn a_camera_roll_turns_every_stroke_back() {
    for size in [(500, 500), (640, 360), (270, 630)] {
        for solver in [Solver::Tangent, Solver::Horn, Solver::HornExact] {
            let scene = with_solver(rolling_scene(size, &ROLLS_DEG), solver);
            let painting = prepare(shapes::loaded(scene, [shapes::sphere(32, 16)])).unwrap();
            let before = angles(&painting.at(0.0, &options(size.into())));
            for (index, roll_deg) in ROLLS_DEG.into_iter().enumerate() {
                let after = angles(&painting.at((index + 1) as f64, &options(size.into())));
                let mut worst = 0.0f64;
                let mut shared = 0;
                for (particle, angle) in &before {
                    if let Some(turned) = after.get(particle) {
                        worst = worst.max(degrees_apart(*turned, angle - roll_deg.to_radians()));
                        shared += 1;
                    }
                }
                assert!(
                    shared >= 500,
                    "{size:?} {solver:?} {roll_deg}: only {shared} strokes in both frames"
                );
                assert!(
                    worst <= 1e-3,
                    "{size:?} {solver:?} roll {roll_deg}: off by {worst} degrees ({shared} strokes)"
                );
            }
        }
    }
}

/// A scene with a sheet tilted by about 40° about an oblique axis, and a camera that moves by `shift`. Also returns the
/// sheet's pose.
fn lateral_scene(lens: Lens, shift: [f64; 3]) -> (Scene, DAffine3) {
    let mut scene = shapes::scene(vec![shapes::object("sheet", 6000)]);
    scene.camera.lens = lens;
    scene.timeline.last = 1;
    let (eye, target) = ([0.0, 0.0, 4.0], [0.0, 0.0, 0.0]);
    let moved = |at: [f64; 3]| [at[0] + shift[0], at[1] + shift[1], at[2] + shift[2]];
    scene.camera.keys =
        vec![shapes::camera_key(0.0, eye, target), shapes::camera_key(1.0, moved(eye), moved(target))];
    scene.objects[0].keys =
        vec![ObjectKey { translation: [0.0; 3], rotation_deg: [-30.0, 25.0, 10.0], ..ObjectKey::at(0.0) }];
    let pose = DAffine3::from_mat3(
        DMat3::from_rotation_z(10f64.to_radians())
            * DMat3::from_rotation_y(25f64.to_radians())
            * DMat3::from_rotation_x((-30f64).to_radians()),
    );
    (scene, pose)
}

/// The turn, in radians, of a stroke at the point `at` of a flat surface when the camera moves by `shift` (right, up).
/// In camera space before the move, the surface is the plane n·X = d, where n is `normal` and d is `distance`. Its
/// picture changes by a homography, and the turn is the rotation in the homography's derivative at the point.
fn homography_angle(normal: DVec3, distance: f64, shift: DVec2, at: DVec3) -> f64 {
    // x' = (X − s)/Z' with Z' = Z: the homography I − s nᵀ/d acting on (x, y, 1), x = X/Z.
    let s = shift.extend(0.0);
    let h = |row: DVec3, index: usize| row - s[index] * normal / distance;
    let rows = [h(DVec3::X, 0), h(DVec3::Y, 1), h(DVec3::Z, 2)];
    let p = DVec3::new(at.x / at.z, at.y / at.z, 1.0);
    let w = rows[2].dot(p);
    let image = DVec2::new(rows[0].dot(p), rows[1].dot(p)) / w;
    let derivative = |axis: usize| {
        DVec2::new(rows[0][axis] - image.x * rows[2][axis], rows[1][axis] - image.y * rows[2][axis]) / w
    };
    let a = DMat2::from_cols(derivative(0), derivative(1));
    (a.x_axis.y - a.y_axis.x).atan2(a.x_axis.x + a.y_axis.y)
}

#[test]
fn a_lateral_move_turns_strokes_by_the_planes_own_homography() {
    let lens = Lens::Perspective { fov_y_deg: 35.0, near: 0.05, far: 100.0 };
    for shift in [[0.5, 0.0, 0.0], [-0.4, 0.0, 0.0], [0.0, 0.45, 0.0], [0.0, -0.5, 0.0], [0.3, 0.35, 0.0]] {
        let (scene, pose) = lateral_scene(lens.clone(), shift);
        let painting = prepare(shapes::loaded(scene, [shapes::sheet(8)])).unwrap();
        let before = painting.at(0.0, &options([640, 360]));
        let after = angles(&painting.at(1.0, &options([640, 360])));
        // Turns a point or a normal into camera space with Z forward (x right, y up): negates its z.
        let flip = |v: DVec3| DVec3::new(v.x, v.y, -v.z);
        let normal = flip(pose.matrix3 * DVec3::Z);
        let distance = normal.dot(flip(DVec3::new(0.0, 0.0, -4.0)));
        let (mut worst, mut count, mut largest) = (0.0f64, 0, 0.0f64);
        for (particle, angle) in angles(&before) {
            let Some(turned) = after.get(&particle) else { continue };
            let at = painting.particles(0).at(particle.1 as usize).position.as_dvec3();
            let at = flip(pose.transform_point3(at) - DVec3::new(0.0, 0.0, 4.0));
            let expected = homography_angle(normal, distance, DVec2::new(shift[0], shift[1]), at);
            worst = worst.max(degrees_apart(*turned, angle + expected));
            largest = largest.max(expected.abs().to_degrees());
            count += 1;
        }
        println!(
            "shift {shift:?}: {count} strokes, largest turn {largest:.2}, worst error {worst:.6} degrees"
        );
        assert!(count >= 500, "{count} strokes");
        assert!(largest > 0.5, "the move must turn strokes at all for this test to see anything: {largest}");
        assert!(worst <= 0.01, "shift {shift:?}: off by {worst} degrees");
    }
}

#[test]
fn a_lateral_move_of_an_orthographic_camera_turns_nothing() {
    let lens = Lens::Orthographic { height: 2.6, near: 0.05, far: 100.0 };
    for shift in [[0.5, 0.0, 0.0], [0.0, -0.5, 0.0]] {
        let (scene, _) = lateral_scene(lens.clone(), shift);
        let painting = prepare(shapes::loaded(scene, [shapes::sheet(8)])).unwrap();
        let before = angles(&painting.at(0.0, &options([640, 360])));
        let after = angles(&painting.at(1.0, &options([640, 360])));
        let shared: Vec<f64> = before
            .iter()
            .filter_map(|(particle, angle)| Some(degrees_apart(*after.get(particle)?, *angle)))
            .collect();
        assert!(shared.len() >= 500);
        assert!(
            shared.iter().all(|&error| error <= 1e-4),
            "an orthographic pan must leave strokes as they are"
        );
    }
}

#[test]
fn a_turning_object_is_a_turning_camera_seen_backwards() {
    // An object that turns by −a about Z, which points at the eye, gives the picture of a camera that rolls by +a.
    let mut scene = shapes::scene(vec![shapes::object("sphere", 8000)]);
    scene.timeline.last = 1;
    let key = |frame: f64, z: f64| ObjectKey {
        translation: [0.0; 3],
        rotation_deg: [0.0, 0.0, z],
        ..ObjectKey::at(frame)
    };
    scene.objects[0].keys = vec![key(0.0, 0.0), key(1.0, -77.0)];
    let painting = prepare(shapes::loaded(scene, [shapes::sphere(32, 16)])).unwrap();
    let before = angles(&painting.at(0.0, &options([640, 360])));
    let after = angles(&painting.at(1.0, &options([640, 360])));
    let errors: Vec<f64> = before
        .iter()
        .filter_map(|(particle, angle)| {
            Some(degrees_apart(*after.get(particle)?, angle - 77f64.to_radians()))
        })
        .collect();
    assert!(errors.len() >= 500);
    assert!(errors.iter().all(|&error| error <= 1e-3), "{:?}", errors.iter().copied().fold(0.0, f64::max));
}

#[test]
fn frames_do_not_depend_on_threads_or_on_what_came_before() {
    let scene = rolling_scene((640, 360), &[137.0]);
    let loaded = shapes::loaded(scene, [shapes::sphere(32, 16)]);
    let on_threads = |threads: usize, frames: &[f64]| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let painting = prepare(Arc::clone(&loaded)).unwrap();
            frames.iter().map(|&frame| painting.at(frame, &options([640, 360])).strokes).next_back().unwrap()
        })
    };
    let alone = on_threads(1, &[0.5]);
    assert!(alone.len() > 500);
    assert_eq!(alone, on_threads(2, &[0.0, 0.25, 0.5]));
    assert_eq!(alone, on_threads(7, &[1.0, 0.5]));
}

#[test]
fn back_at_the_reference_every_stroke_is_as_it_was() {
    let mut scene = rolling_scene((640, 360), &[0.0]);
    let start = scene.camera.keys[0].clone();
    let away = CameraKey { frame: 1.0, eye: [3.0, 2.0, 2.5], roll_deg: 80.0, ..start.clone() };
    scene.timeline.last = 2;
    scene.camera.keys = vec![start.clone(), away, CameraKey { frame: 2.0, ..start }];
    let painting = prepare(shapes::loaded(scene, [shapes::sphere(32, 16)])).unwrap();
    let (first, last) = (painting.at(0.0, &options([640, 360])), painting.at(2.0, &options([640, 360])));
    assert_eq!(first.strokes, last.strokes);
    // Where the reference sees the surface well, strokes lie at the stated angle.
    for (stroke, source) in first.strokes.iter().zip(&first.sources) {
        if source.facing >= 0.5 {
            assert!(degrees_apart(f64::from(stroke.angle_rad), 20f64.to_radians()) < 1e-3);
        }
    }
}

#[test]
fn strokes_can_be_kept_from_turning_and_turned_by_chance() {
    let scene = with_solver(rolling_scene((640, 360), &[30.0]), Solver::Tangent);
    let painting = prepare(shapes::loaded(scene, [shapes::sphere(32, 16)])).unwrap();
    let at = |frame: f64, rotation: Rotation| {
        angles(&painting.at(frame, &FrameOptions { rotation, ..options([640, 360]) }))
    };
    let apart =
        |a: &std::collections::BTreeMap<_, f64>, b: &std::collections::BTreeMap<_, f64>| -> Vec<f64> {
            a.iter().filter_map(|(key, angle)| Some(degrees_apart(*angle, *b.get(key)?))).collect()
        };
    let still = apart(&at(0.0, Rotation::Off), &at(1.0, Rotation::Off));
    assert!(still.len() > 500 && still.iter().all(|&off| off == 0.0), "{} strokes, some turn", still.len());
    // In the reference pose nothing turns where the reference sees the surface well.
    let unturned = apart(&at(0.0, Rotation::Off), &at(0.0, Rotation::On));
    let same = unturned.iter().filter(|&&off| off < 1e-3).count();
    assert!(2 * same > unturned.len(), "{same} of {} strokes lie as in the reference pose", unturned.len());
    let turned = apart(&at(1.0, Rotation::Off), &at(1.0, Rotation::On));
    assert!(
        turned.iter().filter(|&&off| off > 20.0).count() * 2 > turned.len(),
        "most strokes must turn by over 20 degrees when the camera rolls by 30"
    );
    let random = apart(&at(0.0, Rotation::Random), &at(1.0, Rotation::Random));
    let mean = random.iter().sum::<f64>() / random.len() as f64;
    assert!((80.0..100.0).contains(&mean), "two random angles are 90 degrees apart on average: {mean}");
    assert_eq!(at(0.0, Rotation::Random), at(0.0, Rotation::Random), "the same frame is the same picture");
}
