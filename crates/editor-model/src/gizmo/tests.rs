//! Tests of the gizmo: the size of its handles, where they are hit, and which half of a ring shows.

use glam::DQuat;
use impasto_scene::document::Lens;
use impasto_scene::motion::CameraPose;

use super::*;

fn view(eye: [f64; 3]) -> View {
    let camera = CameraPose {
        eye: DVec3::from(eye),
        target: DVec3::new(0.4, 0.3, 0.2),
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

fn arm(gizmo: &Gizmo, axis: Axis) -> Option<[DVec2; 2]> {
    gizmo.handles().iter().find_map(|handle| match handle.shape {
        HandleShape::Arm { from_px, to_px, .. } if handle.constraint == Constraint::Axis(axis) => {
            Some([from_px, to_px])
        }
        _ => None,
    })
}

#[test]
fn handles_keep_their_size_at_any_distance() {
    for far in [1.0, 3.0, 30.0] {
        let eye = DVec3::new(0.4, 0.3, 0.2) + DVec3::new(1.0, 0.8, 2.0) * far;
        let gizmo = Gizmo::new(Operation::Move, Axes::World, pose(), &view(eye.to_array()));
        let shown = Axis::ALL.map(|axis| {
            let [from, to] = arm(&gizmo, axis).unwrap();
            (to - from).length_squared()
        });
        // Projected onto a plane, three orthogonal unit vectors have squared lengths that add up to two.
        let sum: f64 = shown.iter().sum();
        assert!((sum - 2.0 * 90.0 * 90.0).abs() < 1e-6, "{sum}");
    }
}

#[test]
fn every_handle_is_hit_where_it_is_drawn() {
    for operation in [Operation::Move, Operation::Turn, Operation::Scale] {
        for space in [Axes::World, Axes::Local, Axes::View] {
            let gizmo = Gizmo::new(operation, space, pose(), &view([3.4, 2.7, 6.2]));
            assert!(gizmo.handles().len() >= 4, "{operation:?} {space:?}");
            for handle in gizmo.handles() {
                let at_px = match &handle.shape {
                    HandleShape::Arm { from_px, to_px, .. } => from_px.lerp(*to_px, 0.9),
                    HandleShape::Square { corners_px } => corners_px.iter().sum::<DVec2>() / 4.0,
                    HandleShape::Ring { points_px } => points_px[RING_PIECES / 3],
                    HandleShape::Centre { at_px } => *at_px,
                };
                let hit = gizmo.hit(at_px).expect("something is there");
                assert_eq!(hit.operation, operation);
                let same = std::mem::discriminant(&hit.shape) == std::mem::discriminant(&handle.shape);
                assert!(hit.constraint == handle.constraint || same, "{handle:?} hits {hit:?}");
            }
            assert_eq!(gizmo.hit(DVec2::new(5.0, 5.0)), None);
        }
    }
}

#[test]
fn an_arm_that_points_at_the_eye_is_left_out() {
    let gizmo = Gizmo::new(Operation::Move, Axes::World, pose(), &view([0.4, 0.3, 9.0]));
    assert!(arm(&gizmo, Axis::Z).is_none() && arm(&gizmo, Axis::X).is_some());
    let squares: Vec<_> = gizmo
        .handles()
        .iter()
        .filter(|handle| matches!(handle.shape, HandleShape::Square { .. }))
        .map(|handle| handle.constraint)
        .collect();
    assert_eq!(squares, [Constraint::Plane(Axis::Z)]);
    let hit = gizmo.hit(DVec2::new(450.0 + 60.0, 300.0)).unwrap();
    assert_eq!(hit.constraint, Constraint::Axis(Axis::X));
}

#[test]
fn rings_show_the_half_that_faces_the_eye() {
    let view = view([3.4, 2.7, 6.2]);
    let gizmo = Gizmo::new(Operation::Turn, Axes::World, pose(), &view);
    let centre = view.project(pose().translation).unwrap();
    for handle in gizmo.handles() {
        let HandleShape::Ring { points_px } = &handle.shape else { panic!() };
        if let Constraint::Axis(axis) = handle.constraint {
            // Points of the circle in the world that are nearer to the eye than its centre.
            let [first, second] = axis.others().map(Axis::unit);
            for step in 0..64 {
                let (sin, cos) = (f64::from(step) * 0.1).sin_cos();
                let offset = first * cos + second * sin;
                let [right, up, gaze] = view.axes();
                if offset.dot(gaze) < -0.05 {
                    let wanted = centre + DVec2::new(offset.dot(right), -offset.dot(up)) * 90.0;
                    let gap = points_px
                        .windows(2)
                        .map(|pair| off_px(wanted, pair[0], pair[1]))
                        .fold(f64::INFINITY, f64::min);
                    assert!(gap < 0.2, "{axis:?}: {gap}");
                }
            }
        } else {
            assert!(points_px.iter().all(|point| (point.distance(centre) - 135.0).abs() < 1e-9));
        }
    }
}

#[test]
fn behind_the_camera_there_are_no_handles() {
    let away = DAffine3::from_translation(DVec3::new(3.4, 2.7, 16.2));
    let gizmo = Gizmo::new(Operation::Move, Axes::World, away, &view([3.4, 2.7, 6.2]));
    assert!(gizmo.handles().is_empty() && gizmo.hit(DVec2::ZERO).is_none());
}
