//! Tests of the free camera: what stays in place while it orbits, pans, zooms and frames.

use super::*;

const SIZE_PX: DVec2 = DVec2::new(1280.0, 720.0);

fn pose(eye: [f64; 3], target: [f64; 3], roll_deg: f64) -> CameraPose {
    CameraPose {
        eye: DVec3::from(eye),
        target: DVec3::from(target),
        roll_rad: roll_deg.to_radians(),
        shift: DVec2::ZERO,
        lens: Lens::Perspective { fov_y_deg: 32.0, near: 0.05, far: 100.0 },
    }
}

/// Upright, rolled, steep and nearly straight-down views, each through both lenses.
fn views() -> Vec<FreeView> {
    let mut views: Vec<FreeView> = [
        pose([0.0, 1.1, 3.4], [0.0, 0.48, 0.0], 0.0),
        pose([0.3, 1.4, 3.6], [0.1, 0.45, 0.2], 37.0),
        pose([-2.0, 5.0, -0.4], [0.1, 0.45, 0.2], -143.0),
        pose([0.0, 5.0, 1e-4], [0.0, 0.0, 0.0], 90.0),
    ]
    .map(FreeView::new)
    .into();
    let mut parallel = views.clone();
    parallel.iter_mut().for_each(FreeView::toggle_orthographic);
    views.extend(parallel);
    views
}

#[test]
fn leaving_the_shot_moves_nothing() {
    let shot = pose([0.3, 1.4, 3.6], [0.1, 0.45, 0.2], 37.0);
    let mut looking = Looking::default();
    assert_eq!(looking.pose(&shot), &shot);
    assert_eq!(looking.free(&shot).pose(), &shot);
    looking.free(&shot).orbit(DVec2::new(30.0, 0.0), shot.target);
    assert_ne!(looking.pose(&shot), &shot, "a second call of `free` must not undo the orbit");
}

#[test]
fn what_is_orbited_stays_where_it_shows() {
    for mut view in views() {
        for about in [view.pose().target, view.pose().target + DVec3::new(0.2, -0.1, 0.15)] {
            let before = view.view(SIZE_PX).project(about).unwrap();
            for delta in [[40.0, 0.0], [0.0, 25.0], [-90.0, -300.0], [13.0, 700.0]] {
                view.orbit(DVec2::from(delta), about);
                let after = view.view(SIZE_PX).project(about).unwrap();
                assert!((after - before).length() < 1e-6, "{delta:?}: {before} {after}");
                let gaze = view.view(SIZE_PX).axes()[2];
                assert!(gaze.y.abs() < 1.0 - 1e-10 && view.pose().view_from_world().is_finite());
            }
        }
    }
}

#[test]
fn orbiting_follows_the_pointer_whatever_the_roll() {
    for roll_deg in [0.0, 37.0, -143.0] {
        for delta in [DVec2::new(4.0, 0.0), DVec2::new(0.0, 4.0), DVec2::new(-3.0, 2.0)] {
            let mut view = FreeView::new(pose([0.0, 0.0, 4.0], [0.0; 3], roll_deg));
            // The point of a unit ball that is nearest to the eye.
            let held = DVec3::new(0.0, 0.0, 1.0);
            let before = view.view(SIZE_PX).project(held).unwrap();
            view.orbit(delta, DVec3::ZERO);
            let moved = view.view(SIZE_PX).project(held).unwrap() - before;
            assert!(moved.normalize().dot(delta.normalize()) > 0.999, "{roll_deg}: {delta} {moved}");
        }
    }
}

#[test]
fn orbiting_stops_short_of_the_pole_and_comes_back() {
    let mut view = FreeView::new(pose([0.0, 0.5, 4.0], [0.0, 0.5, 0.0], 0.0));
    view.orbit(DVec2::new(0.0, 4000.0), view.pose().target);
    let steepest = view.view(SIZE_PX).axes()[2].y.asin().to_degrees();
    assert!((-89.6..-89.4).contains(&steepest), "{steepest}");
    view.orbit(DVec2::new(0.0, -300.0), view.pose().target);
    let back = view.view(SIZE_PX).axes()[2].y.asin().to_degrees();
    assert!((back - steepest - 90.0).abs() < 1e-6, "{back}");
}

#[test]
fn zooming_keeps_the_point_under_the_cursor() {
    for mut view in views() {
        let at_px = DVec2::new(400.0, 610.0);
        let point = view.view(SIZE_PX).at_depth_of(at_px, view.pose().target + DVec3::new(0.1, 0.1, 0.1));
        for steps in [1.0, 3.0, -2.5, 0.25] {
            let before = view.view(SIZE_PX).px_per_unit(view.pose().target);
            view.zoom(steps, point);
            let after = view.view(SIZE_PX).project(point).unwrap();
            assert!((after - at_px).length() < 1e-6, "{after}");
            let grown = view.view(SIZE_PX).px_per_unit(view.pose().target) / before;
            assert!((grown - ZOOM_PER_STEP.powf(-steps)).abs() < 1e-9);
        }
        let depths = |view: &FreeView| match view.pose().lens {
            Lens::Perspective { near, far, .. } => Some([near, far]),
            Lens::Orthographic { .. } => None,
        };
        view.zoom(1e9, point);
        if let Some([near, far]) = depths(&view) {
            assert!(near < view.distance() && view.distance() < far, "too far off: {near}, {far}");
        }
        view.zoom(-1e9, point);
        if let Some([near, far]) = depths(&view) {
            assert!(near < view.distance() && view.distance() < far, "too near: {near}, {far}");
        }
        // Back at a usual distance, the clip planes are near each other again, so that depths can be told apart.
        let back = (1.0 / view.distance()).ln() / ZOOM_PER_STEP.ln();
        view.zoom(back, point);
        if let Some([near, far]) = depths(&view) {
            assert!((near - 0.01).abs() < 1e-6 && far == 100.0, "{near}, {far}");
        }
        assert!(view.pose().view_from_world().is_finite());
    }
}

#[test]
fn panning_moves_what_is_held_with_the_pointer() {
    for mut view in views() {
        let held = view.pose().target + DVec3::new(0.2, 0.1, -0.1);
        let before = view.view(SIZE_PX).project(held).unwrap();
        let delta = DVec2::new(31.0, -17.0);
        view.pan(delta, held, SIZE_PX);
        let moved = view.view(SIZE_PX).project(held).unwrap() - before;
        assert!((moved - delta).length() < 1e-6, "{moved}");
    }
}

#[test]
fn what_is_framed_fills_the_picture() {
    let bounds = [DVec3::new(-3.0, 0.0, 1.0), DVec3::new(-1.0, 5.0, 1.5)];
    for mut view in views() {
        for size_px in [SIZE_PX, DVec2::new(300.0, 900.0)] {
            view.frame(bounds, size_px);
            let seen = view.view(size_px);
            let reaches = (0..8).map(|corner| {
                let pick = |axis: usize| bounds[corner >> axis & 1][axis];
                let at_px = seen.project(DVec3::new(pick(0), pick(1), pick(2))).expect("in front");
                ((at_px / size_px - 0.5) * 2.0).abs().max_element()
            });
            let most = reaches.fold(0.0, f64::max);
            assert!((most - 0.9).abs() < 1e-9, "{most}");
        }
    }
}

#[test]
fn axis_views_are_upright() {
    for (axis, right, up) in [
        (AxisView::Right, DVec3::NEG_Z, DVec3::Y),
        (AxisView::Left, DVec3::Z, DVec3::Y),
        (AxisView::Top, DVec3::X, DVec3::NEG_Z),
        (AxisView::Bottom, DVec3::X, DVec3::Z),
        (AxisView::Front, DVec3::X, DVec3::Y),
        (AxisView::Back, DVec3::NEG_X, DVec3::Y),
    ] {
        for mut view in views() {
            let (target, distance) = (view.pose().target, view.distance());
            view.look_along(axis);
            let axes = view.view(SIZE_PX).axes();
            assert!(axes[0].dot(right) > 0.99999 && axes[1].dot(up) > 0.99999, "{axis:?}: {axes:?}");
            assert!(view.pose().target == target && (view.distance() - distance).abs() < 1e-9);
            let sine = axes[2].cross(DVec3::Y).length();
            assert!(sine > 1e-6, "a scene file refuses a gaze nearer to straight up or down");
        }
    }
}

#[test]
fn orthographic_and_back_keeps_the_size_of_the_picture() {
    for mut view in views() {
        let before = view.clone();
        let size = view.view(SIZE_PX).px_per_unit(view.pose().target);
        view.toggle_orthographic();
        assert!((view.view(SIZE_PX).px_per_unit(view.pose().target) / size - 1.0).abs() < 1e-9);
        view.toggle_orthographic();
        assert!((view.view(SIZE_PX).px_per_unit(view.pose().target) / size - 1.0).abs() < 1e-9);
        assert!((view.pose().eye - before.pose().eye).length() < 1e-9);
    }
}
