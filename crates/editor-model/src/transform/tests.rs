//! Tests of moving, turning and scaling with the pointer and with keys.

use impasto_scene::motion::CameraPose;

use super::*;

fn applied(delta: TransformDelta, axes: DMat3) -> DAffine3 {
    delta.world_from_world(pose().translation, axes) * pose()
}

fn view() -> View {
    let camera = CameraPose {
        eye: DVec3::new(1.0, 2.0, 6.0),
        target: DVec3::new(0.5, 0.4, 0.0),
        roll_rad: 0.0,
        shift: DVec2::ZERO,
        lens: Lens::Perspective { fov_y_deg: 40.0, near: 0.05, far: 100.0 },
    };
    View { camera, size_px: DVec2::new(900.0, 600.0) }
}

fn pose() -> DAffine3 {
    DAffine3::from_scale_rotation_translation(
        DVec3::splat(1.5),
        DQuat::from_rotation_y(0.5),
        DVec3::new(0.4, 0.3, 0.2),
    )
}

fn start(at_px: DVec2) -> TransformStart {
    TransformStart {
        name: "apple".to_owned(),
        world_from_model: pose(),
        view: view(),
        at_px,
        space: Axes::World,
    }
}

fn moved(to_px: DVec2) -> TransformEvent {
    TransformEvent::Move { at_px: to_px, snap: Snap::Free }
}

fn typed(transform: &mut Transforming, text: &str) -> TransformDelta {
    for character in text.chars() {
        transform.take(TransformEvent::Typed(character));
    }
    transform.delta()
}

/// Where the object's origin shows after a delta.
fn shown(transform: &Transforming) -> DVec2 {
    let moved = applied(transform.delta(), transform.world_from_space());
    view().project(moved.translation).unwrap()
}

#[test]
fn typing_g_x_and_a_number_moves_along_x() {
    let mut transform = Transforming::new(Operation::Move, start(DVec2::new(300.0, 200.0)));
    transform.take(TransformEvent::Axis(Axis::X));
    assert_eq!(typed(&mut transform, "0.8"), TransformDelta::Move(DVec3::new(0.8, 0.0, 0.0)));
    transform.take(TransformEvent::Typed('-'));
    transform.take(TransformEvent::Backspace);
    assert_eq!(typed(&mut transform, "25"), TransformDelta::Move(DVec3::new(-0.25, 0.0, 0.0)));
    assert_eq!(
        transform.take(TransformEvent::Keep),
        TransformStep::Kept(Some(TransformDelta::Move(DVec3::new(-0.25, 0.0, 0.0))))
    );
    assert_eq!(transform.take(TransformEvent::Back), TransformStep::Back);
}

#[test]
fn the_status_line_says_what_happens() {
    let mut transform = Transforming::new(Operation::Move, start(DVec2::new(300.0, 200.0)));
    transform.take(TransformEvent::Axis(Axis::X));
    typed(&mut transform, "0.80");
    assert_eq!(
        transform.status(),
        "Move apple  X 0.80   [X Y Z] axis  [Shift X] plane  type a number  [Enter] keep  [Esc] back"
    );
    let mut transform = Transforming::new(Operation::Turn, start(DVec2::new(300.0, 200.0)));
    transform.take(TransformEvent::Axis(Axis::Z));
    typed(&mut transform, "-140");
    assert!(transform.status().starts_with("Turn apple  Z -140°   ["), "{}", transform.status());
    transform.take(TransformEvent::Axis(Axis::Z));
    assert!(transform.status().starts_with("Turn apple  Z local -140°   ["), "{}", transform.status());
    let transform = Transforming::new(Operation::Scale, start(DVec2::new(300.0, 200.0)));
    assert!(transform.status().starts_with("Scale apple  1.000   ["), "{}", transform.status());
}

#[test]
fn an_axis_again_is_the_objects_own_and_a_third_time_none() {
    let mut transform = Transforming::new(Operation::Move, start(DVec2::new(300.0, 200.0)));
    let mut press = |event| {
        transform.take(event);
        (transform.constraint(), transform.space())
    };
    let axis = TransformEvent::Axis(Axis::Y);
    assert_eq!(press(axis), (Constraint::Axis(Axis::Y), Axes::World));
    assert_eq!(press(axis), (Constraint::Axis(Axis::Y), Axes::Local));
    assert_eq!(press(axis), (Constraint::None, Axes::World));
    assert_eq!(press(axis), (Constraint::Axis(Axis::Y), Axes::World));
    let plane = TransformEvent::Plane(Axis::Y);
    assert_eq!(press(plane), (Constraint::Plane(Axis::Y), Axes::World));
    assert_eq!(press(plane), (Constraint::Plane(Axis::Y), Axes::Local));
    assert_eq!(press(TransformEvent::Axis(Axis::Z)), (Constraint::Axis(Axis::Z), Axes::World));
    let mut local =
        Transforming::new(Operation::Move, TransformStart { space: Axes::Local, ..start(DVec2::ZERO) });
    local.take(axis);
    assert_eq!(local.space(), Axes::Local);
    local.take(axis);
    assert_eq!(local.space(), Axes::World);
}

#[test]
fn what_is_moved_freely_stays_under_the_pointer() {
    let pivot_px = view().project(pose().translation).unwrap();
    let grip = DVec2::new(30.0, -12.0);
    let mut transform = Transforming::new(Operation::Move, start(pivot_px + grip));
    for to in [DVec2::new(80.0, -33.0), DVec2::new(-200.0, 140.0)] {
        transform.take(moved(pivot_px + grip + to));
        assert!((shown(&transform) - pivot_px - to).length() < 1e-6);
    }
    assert_eq!(
        Transforming::new(Operation::Move, start(pivot_px)).take(TransformEvent::Keep),
        TransformStep::Kept(None)
    );
}

#[test]
fn along_an_axis_the_origin_follows_the_pointer_on_that_axis() {
    let pivot_px = view().project(pose().translation).unwrap();
    for axis in Axis::ALL {
        for space in [Axes::World, Axes::Local] {
            let mut transform =
                Transforming::new(Operation::Move, TransformStart { space, ..start(pivot_px) });
            transform.take(TransformEvent::Axis(axis));
            let world = transform.world_from_space() * axis.unit();
            for by in [0.7, -1.3] {
                let to = view().project(pose().translation + world * by).unwrap();
                // A pointer beside the axis counts as its nearest point on the axis.
                let beside = (to - pivot_px).perp().normalize() * 25.0;
                transform.take(moved(to + beside));
                let TransformDelta::Move(delta) = transform.delta() else { panic!() };
                assert!((delta - axis.unit() * by).length() < 1e-6, "{axis:?} {space:?}: {delta}");
            }
        }
    }
}

#[test]
fn in_a_plane_the_origin_stays_under_the_pointer() {
    let pivot_px = view().project(pose().translation).unwrap();
    let mut transform = Transforming::new(Operation::Move, start(pivot_px));
    transform.take(TransformEvent::Plane(Axis::Y));
    let to = pivot_px + DVec2::new(60.0, 20.0);
    transform.take(moved(to));
    let TransformDelta::Move(delta) = transform.delta() else { panic!() };
    assert!(delta.y == 0.0 && (shown(&transform) - to).length() < 1e-6, "{delta}");
}

#[test]
fn steps_of_a_tenth_and_of_five_degrees() {
    let pivot_px = view().project(pose().translation).unwrap();
    let event = |at_px| TransformEvent::Move { at_px, snap: Snap::Steps };
    let mut transform = Transforming::new(Operation::Move, start(pivot_px));
    transform.take(event(pivot_px + DVec2::new(61.0, 23.0)));
    let TransformDelta::Move(delta) = transform.delta() else { panic!() };
    assert!(delta.length() > 0.2 && ((delta * 10.0).round() - delta * 10.0).length() < 1e-9, "{delta}");
    let mut transform = Transforming::new(Operation::Turn, start(pivot_px + DVec2::X * 50.0));
    transform.take(event(pivot_px + DVec2::new(50.0, -23.0)));
    let TransformDelta::Turn { angle_rad, .. } = transform.delta() else { panic!() };
    assert!((angle_rad.to_degrees() - 25.0).abs() < 1e-9, "{}", angle_rad.to_degrees());
}

#[test]
fn turning_follows_the_pointer_round_more_than_once() {
    let pivot_px = view().project(pose().translation).unwrap();
    let arm = |angle_rad: f64| pivot_px + DVec2::from_angle(angle_rad) * DVec2::new(1.0, -1.0) * 80.0;
    for axis in [None, Some(Axis::Y), Some(Axis::Z)] {
        let mut transform = Transforming::new(Operation::Turn, start(arm(0.3)));
        if let Some(axis) = axis {
            transform.take(TransformEvent::Axis(axis));
        }
        for step in 1..=100 {
            transform.take(moved(arm(0.3 + 0.08 * f64::from(step))));
        }
        let TransformDelta::Turn { angle_rad, .. } = transform.delta() else { panic!() };
        assert!((angle_rad - 8.0).abs() < 1e-9, "{axis:?}: {angle_rad}");
    }
    // A free turn follows the pointer: as seen from the eye, the object turns counter-clockwise too.
    let mut transform = Transforming::new(Operation::Turn, start(arm(0.0)));
    transform.take(moved(arm(0.5)));
    let turned = applied(transform.delta(), transform.world_from_space());
    let gaze = view().axes()[2];
    let was = pose().matrix3.x_axis.reject_from(gaze);
    let now = turned.matrix3.x_axis.reject_from(gaze);
    assert!((was.angle_between(now) - 0.5).abs() < 1e-9 && was.cross(now).dot(gaze) < 0.0);
    assert!((turned.translation - pose().translation).length() < 1e-12);
}

#[test]
fn an_axis_turn_follows_the_pointer_from_behind_too() {
    let mut start = start(DVec2::ZERO);
    // From the other side, +Z points away from the eye.
    start.view.camera.eye = DVec3::new(0.4, 0.3, -6.0);
    start.view.camera.target = DVec3::new(0.4, 0.3, 0.2);
    let pivot_px = start.view.project(pose().translation).unwrap();
    start.at_px = pivot_px + DVec2::X * 50.0;
    let mut transform = Transforming::new(Operation::Turn, start);
    transform.take(TransformEvent::Axis(Axis::Z));
    transform.take(moved(pivot_px + DVec2::new(0.0, -50.0)));
    let TransformDelta::Turn { angle_rad, .. } = transform.delta() else { panic!() };
    assert!((angle_rad + std::f64::consts::FRAC_PI_2).abs() < 1e-9, "{angle_rad}");
}

#[test]
fn scaling_by_the_distance_and_by_numbers() {
    let pivot_px = view().project(pose().translation).unwrap();
    let mut transform = Transforming::new(Operation::Scale, start(pivot_px + DVec2::X * 50.0));
    transform.take(moved(pivot_px + DVec2::Y * 100.0));
    assert_eq!(transform.delta(), TransformDelta::Scale(DVec3::splat(2.0)));
    transform.take(TransformEvent::Axis(Axis::Y));
    assert_eq!(transform.delta(), TransformDelta::Scale(DVec3::new(1.0, 2.0, 1.0)));
    transform.take(TransformEvent::Plane(Axis::Y));
    assert_eq!(transform.delta(), TransformDelta::Scale(DVec3::new(2.0, 1.0, 2.0)));
    // Freely to any factor, in steps of a tenth with Ctrl.
    let mut transform = Transforming::new(Operation::Scale, start(pivot_px + DVec2::X * 50.0));
    for (snap, factor) in [(Snap::Free, 1.23), (Snap::Steps, 1.2)] {
        transform.take(TransformEvent::Move { at_px: pivot_px + DVec2::Y * 61.5, snap });
        let TransformDelta::Scale(by) = transform.delta() else { panic!("{:?}", transform.delta()) };
        assert!((by - DVec3::splat(factor)).length() < 1e-9, "{by}");
    }
    for nothing in ["0", "-0."] {
        let mut transform = Transforming::new(Operation::Scale, start(pivot_px + DVec2::X * 50.0));
        let TransformDelta::Scale(by) = typed(&mut transform, nothing) else { panic!() };
        assert!(by.min_element() > 0.0, "a thing cannot be scaled to nothing");
    }
    let grown = applied(TransformDelta::Scale(DVec3::splat(2.0)), DMat3::IDENTITY);
    assert!(
        (grown.matrix3.x_axis.length() - 3.0).abs() < 1e-12
            && (grown.translation - pose().translation).length() < 1e-12
    );
}

#[test]
fn hostile_typing_and_pointers_do_no_harm() {
    for operation in [Operation::Move, Operation::Turn, Operation::Scale] {
        let mut transform = Transforming::new(operation, start(DVec2::ZERO));
        typed(&mut transform, "--..1e9999999999999999.5,x\u{0}-");
        transform.take(moved(DVec2::NAN));
        transform.take(moved(DVec2::splat(1e30)));
        for axis in Axis::ALL {
            transform.take(TransformEvent::Plane(axis));
            let after = applied(transform.delta(), transform.world_from_space());
            assert!(after.is_finite(), "{operation:?}");
        }
        for _ in 0..99 {
            transform.take(TransformEvent::Backspace);
        }
        assert!(applied(transform.delta(), transform.world_from_space()).is_finite());
    }
}
