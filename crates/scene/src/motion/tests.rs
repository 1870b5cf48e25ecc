//! Tests of keyframes: camera, eases, parents and held poses.

use glam::{DVec3, DVec4};

use super::*;
use crate::document::{BackgroundKey, Camera, Color, Ease, Light, LightKey, LightKind, StrokesKey};

fn key(frame: f64) -> ObjectKey {
    ObjectKey::at(frame)
}

fn object(name: &str, parent: Option<&str>, keys: Vec<ObjectKey>) -> Object {
    Object { parent: parent.map(str::to_owned), keys, ..Object::new(name, "cube.obj") }
}

fn camera_key(frame: f64, roll_deg: f64) -> CameraKey {
    CameraKey { frame, eye: [0.0, 0.0, 4.0], target: [0.0; 3], roll_deg, fov_y_deg: None, ease: Ease::Linear }
}

fn scene(camera_keys: Vec<CameraKey>, objects: Vec<Object>) -> Scene {
    Scene {
        version: Scene::VERSION,
        size: (640, 360),
        seed: 0,
        background: Default::default(),
        background_keys: Vec::new(),
        exposure: 0.0,
        shot: None,
        stage: Default::default(),
        timeline: Default::default(),
        reference: Default::default(),
        further_references: Vec::new(),
        camera: Camera { of_shot: None, lens: Lens::default(), keys: camera_keys },
        lights: Vec::new(),
        objects,
        strokes: Default::default(),
        regions: Vec::new(),
        touches: Vec::new(),
        style: Default::default(),
        aovs: Vec::new(),
    }
}

/// The angle at which a point in world space shows on the screen, round the picture's middle, degrees.
fn screen_angle_deg(view_from_world: DMat4, point_in_world: DVec3) -> f64 {
    let point = view_from_world * point_in_world.extend(1.0);
    (point.y / -point.z).atan2(point.x / -point.z).to_degrees()
}

#[test]
fn the_camera_looks_down_minus_z_with_y_up() {
    let pose = camera_at(&scene(vec![camera_key(0.0, 0.0)], vec![]), 0.0);
    let view_from_world = pose.view_from_world();
    let expected =
        [(DVec3::ZERO, [0.0, 0.0, -4.0]), (DVec3::X, [1.0, 0.0, -4.0]), (DVec3::Y, [0.0, 1.0, -4.0])];
    for (point, in_view) in expected {
        assert_eq!(view_from_world * point.extend(1.0), DVec4::new(in_view[0], in_view[1], in_view[2], 1.0));
    }
}

#[test]
fn roll_turns_the_picture_the_other_way() {
    let point = DVec3::new(0.3, 0.1, 0.2);
    let level = camera_at(&scene(vec![camera_key(0.0, 0.0)], vec![]), 0.0).view_from_world();
    for roll_deg in [1.0, 7.0, 30.0, 77.0, 137.0, 180.0, 359.0] {
        let rolled = camera_at(&scene(vec![camera_key(0.0, roll_deg)], vec![]), 0.0).view_from_world();
        let turn = screen_angle_deg(rolled, point) - screen_angle_deg(level, point) + roll_deg;
        assert!((turn - (turn / 360.0).round() * 360.0).abs() < 1e-9, "roll {roll_deg}: off by {turn}");
    }
}

#[test]
fn a_whole_roll_is_bit_for_bit_no_roll() {
    let scene = scene(vec![camera_key(0.0, 0.0), camera_key(100.0, 720.0)], vec![]);
    assert_eq!(camera_at(&scene, 0.0).view_from_world(), camera_at(&scene, 50.0).view_from_world());
    assert_eq!(camera_at(&scene, 0.0).view_from_world(), camera_at(&scene, 100.0).view_from_world());
    assert!((camera_at(&scene, 12.5).roll_rad.to_degrees() - 90.0).abs() < 1e-12);
}

#[test]
fn the_field_of_view_is_kept_until_a_key_changes_it() {
    let mut keys =
        vec![camera_key(0.0, 0.0), camera_key(10.0, 0.0), camera_key(20.0, 0.0), camera_key(30.0, 0.0)];
    keys[1].fov_y_deg = Some(40.0);
    keys[3].fov_y_deg = Some(60.0);
    let scene = scene(keys, vec![]);
    let fov = |frame| match camera_at(&scene, frame).lens {
        Lens::Perspective { fov_y_deg, .. } => fov_y_deg,
        Lens::Orthographic { .. } => panic!("the lens changed its kind"),
    };
    assert_eq!([0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 99.0].map(fov), [35.0, 37.5, 40.0, 40.0, 40.0, 50.0, 60.0]);
}

#[test]
fn eases_are_step_linear_and_smooth() {
    for (ease, at_quarter) in [(Ease::Step, 0.0), (Ease::Linear, 2.5), (Ease::Smooth, 1.5625)] {
        let keys =
            vec![ObjectKey { ease, ..key(4.0) }, ObjectKey { translation: [10.0, 0.0, 0.0], ..key(8.0) }];
        let scene = scene(vec![], vec![object("a", None, keys)]);
        let x_at = |frame| poses_at(&scene, frame)[0].translation.x;
        assert_eq!([-100.0, 4.0, 5.0, 8.0, 100.0].map(x_at), [0.0, 0.0, at_quarter, 10.0, 10.0], "{ease:?}");
    }
}

#[test]
fn an_overshoot_moves_and_turns_but_keeps_what_has_limits() {
    let ease = Ease::Curve([0.5, -2.0], [0.5, 3.0]);
    let [least, most] = ease.reach();
    let from = ObjectKey { ease, scale: Scale::even(500.0), ..key(0.0) };
    let to = ObjectKey {
        translation: [10.0, 0.0, 0.0],
        rotation_deg: [0.0, 0.0, 90.0],
        scale: Scale::even(1000.0),
        morph: 1.0,
        ..key(1000.0)
    };
    let mut scene = scene(
        vec![
            CameraKey { fov_y_deg: Some(2.0), ease, ..camera_key(0.0, 0.0) },
            CameraKey { fov_y_deg: Some(169.0), ..camera_key(1000.0, 0.0) },
        ],
        vec![object("a", None, vec![from, to])],
    );
    scene.background_keys = vec![
        BackgroundKey { frame: 0.0, color: Color([0.1; 3]), ease },
        BackgroundKey { frame: 1000.0, color: Color([0.9; 3]), ease },
    ];
    let mut light = Light::new("lamp", LightKind::Point);
    light.keys = vec![
        LightKey { intensity: Some(1.0), position: Some([0.0; 3]), ease, ..LightKey::at(0.0) },
        LightKey { intensity: Some(9.0), position: Some([1.0, 0.0, 0.0]), ..LightKey::at(1000.0) },
    ];
    let strokes = [
        StrokesKey { size: 0.1, coverage: 0.2, palette_mix: 0.1, ease, ..StrokesKey::at(0.0) },
        StrokesKey { size: 19.0, coverage: 3.9, dryness: 0.9, ..StrokesKey::at(1000.0) },
    ];
    let (mut lowest, mut highest) = (f64::INFINITY, f64::NEG_INFINITY);
    for frame in (0..=1000).map(f64::from) {
        let key = key_at(&scene, &scene.objects[0], frame);
        let moved = key.translation[0] / 10.0;
        (lowest, highest) = (lowest.min(moved), highest.max(moved));
        assert!((key.rotation_deg[2] / 90.0 - moved).abs() < 1e-12);
        assert!(limits::KEY_SCALE.contains(&key.scale.0[0]) && (0.0..=1.0).contains(&key.morph), "{key:?}");
        assert!(poses_at(&scene, frame)[0].matrix3.x_axis.length() <= 1000.0 + 1e-6);
        assert!((0.0..=1.0).contains(&morphs_at(&scene, frame)[0]));
        let Lens::Perspective { fov_y_deg, .. } = camera_at(&scene, frame).lens else {
            panic!("another lens")
        };
        assert!(limits::FOV_Y_DEG.contains(&fov_y_deg), "{fov_y_deg}");
        assert!(background_at(&scene, frame).0.iter().all(|channel| (0.0..=1.0).contains(channel)));
        let light = light_at(&scene, &light, frame);
        assert!(light.intensity >= 0.0, "{}", light.intensity);
        assert!((light.position.unwrap_or_default()[0] - moved).abs() < 1e-12);
        let strokes = stroke_key_at(&strokes, frame);
        assert!(limits::KEY_STROKE_SIZE.contains(&strokes.size), "{}", strokes.size);
        assert!(limits::KEY_COVERAGE.contains(&strokes.coverage), "{}", strokes.coverage);
        assert!((0.0..=1.0).contains(&strokes.dryness) && (0.0..=1.0).contains(&strokes.palette_mix));
    }
    assert!((lowest - least).abs() < 1e-3 && (highest - most).abs() < 1e-3, "{lowest} to {highest}");
    assert!(least < -0.2 && most > 1.2, "{least} to {most}");
    assert_eq!(farthest_morph(&scene.objects[0]), 1.0);
    scene.objects[0].keys[1].morph = 0.5;
    assert_eq!(farthest_morph(&scene.objects[0]), 0.5 * most);
}

#[test]
fn euler_angles_turn_about_x_then_y_then_z() {
    // The three turns by 90 degrees take +Y first to +Z, then to +X, then back to +Y.
    let rotation = rotation_from_euler_deg(DVec3::splat(90.0));
    assert_eq!(rotation * DVec3::Y, DVec3::Y);
    // They take +X to −Z: the turn about Y does that, and those about X and Z change nothing.
    assert_eq!(rotation * DVec3::X, DVec3::NEG_Z);
    let odd = rotation_from_euler_deg(DVec3::new(10.0, 20.0, 30.0));
    assert!((odd.determinant() - 1.0).abs() < 1e-12);
    // The closed form of Rz·Ry·Rx, first column.
    let (y, z) = (20f64.to_radians(), 30f64.to_radians());
    let first_column = DVec3::new(z.cos() * y.cos(), z.sin() * y.cos(), -y.sin());
    assert!((odd.x_axis - first_column).length() < 1e-15);
}

#[test]
fn a_rotation_by_720_degrees_is_two_turns() {
    let keys = vec![key(0.0), ObjectKey { rotation_deg: [0.0, 0.0, 720.0], ..key(80.0) }];
    let scene = scene(vec![], vec![object("a", None, keys)]);
    for (frame, x, y) in
        [(10.0, 0.0, 1.0), (20.0, -1.0, 0.0), (30.0, 0.0, -1.0), (40.0, 1.0, 0.0), (50.0, 0.0, 1.0)]
    {
        assert_eq!(
            poses_at(&scene, frame)[0].transform_vector3(DVec3::X),
            DVec3::new(x, y, 0.0),
            "frame {frame}"
        );
    }
}

#[test]
fn a_child_follows_a_parent_that_is_listed_after_it() {
    let moved = vec![ObjectKey { translation: [1.0, 2.0, 3.0], rotation_deg: [0.0, 0.0, 90.0], ..key(0.0) }];
    let offset = vec![ObjectKey { translation: [1.0, 0.0, 0.0], ..key(0.0) }];
    let scene = scene(vec![], vec![object("b", Some("a"), offset), object("a", None, moved)]);
    let poses = poses_at(&scene, 0.0);
    assert_eq!(poses[0].translation, DVec3::new(1.0, 3.0, 3.0));
    assert_eq!(poses[1].translation, DVec3::new(1.0, 2.0, 3.0));
}

#[test]
fn a_chain_of_ten_thousand_parents_is_followed_to_its_end() {
    let step = || vec![ObjectKey { translation: [1.0, 0.0, 0.0], ..key(0.0) }];
    let name = |index: usize| format!("o{index}");
    let child = |index: usize| object(&name(index), Some(name(index + 1)).as_deref(), step());
    let mut objects: Vec<Object> = (0..10_000).map(child).collect();
    objects.push(object(&name(10_000), None, step()));
    assert_eq!(poses_at(&scene(vec![], objects), 0.0)[0].translation.x, 10_001.0);
}

#[test]
fn cycles_and_unknown_parents_do_not_hang() {
    let with = |name: &str, parent: &str| object(name, Some(parent), vec![key(0.0)]);
    let objects = vec![with("a", "b"), with("b", "c"), with("c", "b"), with("d", "d"), with("e", "nobody")];
    let poses = poses_at(&scene(vec![], objects.clone()), 0.0);
    assert!(poses.iter().all(|pose| *pose == DAffine3::IDENTITY));
    assert_eq!(cycle_closers(&[Some(1), Some(2), Some(1), Some(3), None]), [1, 3]);
}

#[test]
fn the_view_is_finite_even_where_check_would_refuse_it() {
    for (eye, target) in [([0.0, 5.0, 0.0], [0.0; 3]), ([1.0; 3], [1.0; 3])] {
        let pose = CameraPose {
            eye: eye.into(),
            target: target.into(),
            roll_rad: 0.0,
            shift: DVec2::ZERO,
            lens: Lens::default(),
        };
        assert!(pose.view_from_world().is_finite());
    }
    assert!(camera_at(&scene(vec![], vec![]), 3.0).view_from_world().is_finite());
}

#[test]
fn a_pose_is_held_for_as_many_frames_as_its_object_says() {
    let moving = |hold: u32| {
        let mut keys = vec![key(2.0), key(26.0)];
        keys[1].translation = [24.0, 0.0, 0.0];
        Object { hold, ..object("a", None, keys) }
    };
    let x_at = |hold: u32, frame: f64| {
        let mut scene = scene(vec![camera_key(0.0, 0.0)], vec![moving(hold)]);
        (scene.timeline.first, scene.timeline.last) = (2, 26);
        poses_at(&scene, frame)[0].translation.x
    };
    for (hold, expected) in [
        (1, [0.0, 1.0, 2.0, 3.0, 4.0, 4.5]),
        (2, [0.0, 0.0, 2.0, 2.0, 4.0, 4.0]),
        (3, [0.0, 0.0, 0.0, 3.0, 3.0, 3.0]),
    ] {
        for (frame, x) in [2.0, 3.0, 4.0, 5.0, 6.0, 6.5].into_iter().zip(expected) {
            assert!((x_at(hold, frame) - x).abs() < 1e-9, "on {hold}s at {frame}: {}", x_at(hold, frame));
        }
    }
}

#[test]
fn an_object_that_holds_its_pose_holds_all_that_moves_it() {
    let mut keys = vec![key(2.0), key(26.0)];
    keys[1].morph = 0.96;
    let held = Object { hold: 3, ..object("held", None, keys.clone()) };
    let mut scene = scene(vec![camera_key(0.0, 0.0)], vec![held, object("free", None, keys)]);
    (scene.timeline.first, scene.timeline.last, scene.timeline.fps) = (2, 26, 12.0);
    let close = |found: Vec<f64>, wanted: [f64; 2]| {
        let is_close = found.len() == 2 && found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(is_close, "{found:?} for {wanted:?}");
    };
    close(cache_frames_at(&scene, 6.5), [5.0, 6.5]);
    close(seconds_at(&scene, 6.5), [5.0 / 12.0, 6.5 / 12.0]);
    close(morphs_at(&scene, 6.5), [0.12, 0.18]);
}

#[test]
fn a_pose_comes_back_as_a_key() {
    for scale in [[1.0; 3], [2.5; 3], [0.5, 3.0, 1.25]] {
        let stated = ObjectKey {
            translation: [1.0, -2.0, 3.0],
            rotation_deg: [20.0, -35.0, 50.0],
            scale: Scale(scale),
            ..key(4.0)
        };
        let scene = scene(vec![camera_key(0.0, 0.0)], vec![object("a", None, vec![stated.clone()])]);
        let pose = poses_at(&scene, 4.0)[0];
        let rotation = rotation_from_euler_deg(DVec3::from(stated.rotation_deg));
        let step = DVec3::new(0.3, 0.2, -0.7);
        let wanted = rotation * (DVec3::from(scale) * step);
        assert!((pose.transform_vector3(step) - wanted).length() < 1e-12, "{scale:?}");
        let found = key_of_pose(pose, 4.0);
        assert_eq!((found.frame, found.translation), (4.0, stated.translation));
        let off = DVec3::from(found.rotation_deg) - DVec3::from(stated.rotation_deg);
        assert!(off.length() < 1e-9, "{:?}", found.rotation_deg);
        assert!((DVec3::from(found.scale.0) - DVec3::from(scale)).length() < 1e-12, "{:?}", found.scale);
    }
    // An even scale stays one number, whatever rounding does to the lengths of the axes.
    for angle in 1..40 {
        let rotation = rotation_from_euler_deg(DVec3::new(1.0, 2.0, 3.0) * f64::from(angle));
        let Scale([x, y, z]) = key_of_pose(DAffine3::from_mat3(rotation * 0.3), 0.0).scale;
        assert!(x == y && y == z && (x - 0.3).abs() < 1e-12, "{x} {y} {z}");
    }
    let huge = key_of_pose(DAffine3::from_scale(DVec3::splat(1e9)), 0.0);
    assert_eq!(huge.scale, Scale::even(*limits::KEY_SCALE.end()));
}

#[test]
fn euler_angles_come_back() {
    for angles in [[10.0, 20.0, 30.0], [-170.0, 80.0, 5.0], [0.0, 90.0, 40.0], [3.0, -90.0, 0.0]] {
        let rotation = rotation_from_euler_deg(DVec3::from(angles));
        let again = rotation_from_euler_deg(euler_deg_from_rotation(rotation));
        assert!(again.abs_diff_eq(rotation, 1e-9), "{angles:?}");
    }
}

#[test]
fn any_turn_of_a_camera_matrix_is_kept() {
    for (axis, angle_deg) in [
        (DVec3::Y, 7.0f64),
        (DVec3::Z, 30.0),
        (DVec3::new(1.0, 2.0, 3.0), 137.0),
        (DVec3::X, -90.0),
        (DVec3::new(1.0, 0.0, 1.0), 179.0),
    ] {
        let turn = glam::DQuat::from_axis_angle(axis.normalize(), angle_deg.to_radians());
        let world_from_view = DMat4::from_rotation_translation(turn, DVec3::new(1.0, -2.0, 0.5));
        let pose = CameraPose::of_matrix(world_from_view, Lens::default(), DVec2::ZERO);
        let again = pose.view_from_world() * world_from_view;
        assert!(again.abs_diff_eq(DMat4::IDENTITY, 1e-9), "{axis} {angle_deg}: {again}");
    }
}
