//! Tests of gestures on surfaces: they do not depend on the rate of pointer events, are cut at gaps, and are mirrored.

use glam::DQuat;
use impasto_scene::document::{GuideMode, GuideView, Lens};
use impasto_scene::motion::CameraPose;

use super::*;
use crate::picking::SurfacePoint;

const SIZE_PX: DVec2 = DVec2::new(640.0, 360.0);

fn camera(eye: [f64; 3], target: [f64; 3]) -> CameraPose {
    CameraPose {
        eye: DVec3::from(eye),
        target: DVec3::from(target),
        roll_rad: 0.0,
        shift: DVec2::ZERO,
        lens: Lens::Perspective { fov_y_deg: 35.0, near: 0.05, far: 100.0 },
    }
}

fn front() -> View {
    View { camera: camera([0.0, 0.0, 4.0], [0.0; 3]), size_px: SIZE_PX }
}

fn hit(object: usize, position: DVec3, normal: DVec3) -> Hit {
    Hit {
        object,
        triangle: 0,
        barycentric: [1.0, 0.0, 0.0],
        position_in_model: position,
        normal_in_model: normal,
        face_normal_in_model: normal,
        position_in_world: position,
        distance: 1.0,
        front: true,
        flipped: false,
    }
}

/// Where the ray through a pixel hits the unit ball round the origin.
fn on_ball(view: &View, at_px: DVec2) -> Option<Hit> {
    let ray = view.ray(at_px);
    let (along, square) = (ray.origin.dot(ray.direction), ray.origin.length_squared() - 1.0);
    let root = along * along - square;
    (root >= 0.0).then(|| {
        let at = ray.origin - ray.direction * (along + root.sqrt());
        hit(0, at, at)
    })
}

/// Where the ray through a pixel hits the plane z = 0.
fn on_plane(view: &View, at_px: DVec2) -> Option<Hit> {
    let ray = view.ray(at_px);
    Some(hit(0, ray.origin - ray.direction * (ray.origin.z / ray.direction.z), DVec3::Z))
}

const SETTINGS: PathSettings = PathSettings { radius_px: 40.0, steady: 0.0, faces: Faces::Front };

fn style() -> GuideStyle {
    GuideStyle {
        mode: GuideMode::Comb,
        object: None,
        strength: 0.8,
        falloff: Falloff::Smooth,
        sense: PathSense::Along,
    }
}

fn drag(
    events: &[DVec2],
    settings: &PathSettings,
    pick: &mut dyn FnMut(DVec2) -> Option<Hit>,
) -> SurfacePath {
    let first = pick(events[0]).expect("the press is on the surface");
    let mut path = SurfacePath::press(events[0], &first, &front(), DAffine3::IDENTITY, settings);
    for &event in &events[1..] {
        path.move_to(event, pick);
    }
    path.finished(pick)
}

/// An S over the middle of the picture.
fn s_curve(count: u32) -> Vec<DVec2> {
    (0..count)
        .map(|index| {
            let t = f64::from(index) / f64::from(count - 1);
            DVec2::new(240.0 + 160.0 * t, 180.0 + 24.0 * (t * std::f64::consts::TAU).sin())
        })
        .collect()
}

fn own_view() -> ObjectView {
    ObjectView::new(&front().camera, DAffine3::IDENTITY)
}

#[test]
fn the_same_drag_gives_the_same_guide_at_any_event_rate() {
    for steady in [0.0, 0.2] {
        let settings = PathSettings { steady, ..SETTINGS };
        let drags = [7, 60, 1000]
            .map(|count| drag(&s_curve(count), &settings, &mut |at_px| on_ball(&front(), at_px)));
        let finest = &drags[2];
        for path in &drags[..2] {
            assert_eq!(path.pieces().len(), 1);
            let (mut worst_px, mut worst_stamp) = (0.0f64, 0.0f64);
            for point in &path.pieces()[0] {
                let off = finest.pieces()[0].iter().map(|other| other.at_px.distance(point.at_px));
                worst_px = worst_px.max(off.fold(f64::INFINITY, f64::min));
            }
            let (stamps, finest) = (path.stamps(), finest.stamps());
            assert!(stamps.len().abs_diff(finest.len()) <= 1, "{} {}", stamps.len(), finest.len());
            for (stamp, other) in stamps.iter().zip(&finest) {
                worst_stamp = worst_stamp.max(stamp.position.distance(other.position) * path.px_per_unit);
            }
            println!("steady {steady}: {worst_px:.3} px off the path, stamps {worst_stamp:.3} px apart");
            // Seven pointer events cannot define an S that is 160 px wide more exactly.
            assert!(worst_px < 1.5 && worst_stamp < 1.5, "{worst_px} {worst_stamp}");
        }
        let (some, many) = (&drags[1], &drags[2]);
        let of = |path: &SurfacePath| path.guides(&style(), &own_view(), &own_view());
        let (some, many) = (of(some), of(many));
        assert_eq!((some.len(), many.len()), (1, 1));
        for [one, other] in [[&some[0], &many[0]], [&many[0], &some[0]]] {
            for point in &one.points {
                let at = DVec3::from(point.at);
                let off = other.points.windows(2).map(|pair| {
                    let [a, b] = [DVec3::from(pair[0].at), DVec3::from(pair[1].at)];
                    let t = ((at - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
                    a.lerp(b, t).distance(at)
                });
                let off_px = off.fold(f64::INFINITY, f64::min) * drags[0].px_per_unit;
                assert!(off_px < 0.75, "{off_px}");
            }
        }
    }
}

#[test]
fn a_fast_drag_leaves_no_gap() {
    let path = drag(&[DVec2::new(230.0, 180.0), DVec2::new(410.0, 180.0)], &SETTINGS, &mut |at_px| {
        on_ball(&front(), at_px)
    });
    let stamps = path.stamps();
    for pair in stamps.windows(2) {
        let apart = pair[0].position.distance(pair[1].position);
        assert!((apart - path.radius() * 0.25).abs() < path.radius() * 0.01, "{apart}");
    }
    assert!(stamps.len() > 15);
    assert_eq!(path.pieces()[0].last().unwrap().at_px, DVec2::new(410.0, 180.0));
    let guide = &path.guides(&style(), &own_view(), &own_view())[0];
    assert!((5..40).contains(&guide.points.len()), "{} points", guide.points.len());
    assert!((guide.radius * path.px_per_unit - 40.0).abs() < 1e-9 && guide.view.is_none());
    for pair in guide.points.windows(2) {
        let middle = (DVec3::from(pair[0].at) + DVec3::from(pair[1].at)) * 0.5;
        assert!((1.0 - middle.length()) * path.px_per_unit < 0.51, "the polyline leaves the ball");
    }
    let against = GuideStyle { sense: PathSense::Against, ..style() };
    let back = &path.guides(&against, &own_view(), &own_view())[0];
    assert!(back.points.iter().eq(guide.points.iter().rev()));
}

#[test]
fn leaving_ends_a_piece_and_coming_back_begins_another() {
    let events = [[300.0, 180.0], [640.0, 180.0], [640.0, 200.0], [300.0, 200.0]].map(DVec2::from);
    let path = drag(&events, &SETTINGS, &mut |at_px| on_ball(&front(), at_px));
    assert_eq!(path.pieces().len(), 2);
    assert!(!path.is_lifted());
    let guides = path.guides(&style(), &own_view(), &own_view());
    assert_eq!(guides.len(), 2);
    let left = path.pieces()[0].last().unwrap().at_px;
    assert!(on_ball(&front(), left + DVec2::X * 1.1).is_none(), "the piece ends at {left}, not at the edge");
    let gone = drag(&events[..2], &SETTINGS, &mut |at_px| on_ball(&front(), at_px));
    assert!(gone.is_lifted());
}

#[test]
fn another_object_another_region_and_the_back_end_a_piece() {
    let across = [DVec2::new(200.0, 180.0), DVec2::new(440.0, 180.0)];
    let strip = |at_px: DVec2| (300.0..340.0).contains(&at_px.x);
    type Change = fn(&mut Hit);
    let changes: [(Change, usize); 2] = [(|hit| hit.object = 1, 2), (|hit| hit.front = false, 2)];
    for (change, pieces) in changes {
        let path = drag(&across, &SETTINGS, &mut |at_px| {
            let mut hit = on_plane(&front(), at_px)?;
            if strip(at_px) {
                change(&mut hit);
            }
            Some(hit)
        });
        assert_eq!(path.pieces().len(), pieces);
    }
    let elsewhere = |at_px: DVec2| if strip(at_px) { None } else { on_plane(&front(), at_px) };
    assert_eq!(drag(&across, &SETTINGS, &mut elsewhere.clone()).pieces().len(), 2);
    let all = PathSettings { faces: Faces::All, ..SETTINGS };
    let path = drag(&across, &all, &mut |at_px| {
        on_plane(&front(), at_px).map(|hit| Hit { front: !strip(at_px), ..hit })
    });
    assert_eq!(path.pieces().len(), 1);
}

#[test]
fn a_fold_in_front_of_the_same_object_is_not_drawn_across() {
    let across = [DVec2::new(200.0, 180.0), DVec2::new(440.0, 180.0)];
    let folded = drag(&across, &SETTINGS, &mut |at_px| {
        let hit = on_plane(&front(), at_px)?;
        let nearer = DVec3::Z * if at_px.x > 320.0 { 0.5 } else { 0.0 };
        Some(Hit { position_in_model: hit.position_in_model * (1.0 - nearer.z / 4.0) + nearer, ..hit })
    });
    assert_eq!(folded.pieces().len(), 2);
    // A steep step does not cut the path if the surface is connected there.
    let steep = drag(&across, &SETTINGS, &mut |at_px| {
        let hit = on_plane(&front(), at_px)?;
        let nearer = ((at_px.x - 318.0) / 4.0).clamp(0.0, 1.0) * 0.5;
        Some(Hit {
            position_in_model: hit.position_in_model * (1.0 - nearer / 4.0) + DVec3::Z * nearer,
            ..hit
        })
    });
    assert_eq!(steep.pieces().len(), 1);
}

#[test]
fn a_string_steadies_a_trembling_hand() {
    let trembling: Vec<DVec2> = (0..200u32)
        .map(|index| DVec2::new(200.0 + f64::from(index), 180.0 + [0.0, 3.0, 0.0, -3.0][index as usize % 4]))
        .collect();
    let spread = |steady: f64| {
        let path =
            drag(&trembling, &PathSettings { steady, ..SETTINGS }, &mut |at_px| on_plane(&front(), at_px));
        // The path ends where the button was released: on release it goes on by the length of the string.
        let points = &path.pieces()[0];
        assert!(points.last().unwrap().at_px.distance(*trembling.last().unwrap()) <= STEP_PX);
        let inner = &points[20..points.len() - (steady * LONGEST_STRING_PX) as usize - 4];
        inner.iter().map(|point| (point.at_px.y - 180.0).abs()).fold(0.0, f64::max)
    };
    let (free, steadied) = (spread(0.0), spread(0.5));
    assert!(free > 2.5 && steadied < 0.5, "{free} {steadied}");
    let still = drag(
        &[DVec2::new(300.0, 180.0), DVec2::new(310.0, 180.0)],
        &PathSettings { steady: 0.5, ..SETTINGS },
        &mut |at_px| on_plane(&front(), at_px),
    );
    assert_eq!(
        still.guides(&style(), &own_view(), &own_view()),
        [],
        "a drag shorter than the string draws nothing"
    );
}

#[test]
fn a_press_alone_is_no_guide() {
    let pick = &mut |at_px| on_plane(&front(), at_px);
    let path = drag(&[DVec2::new(300.0, 180.0)], &SETTINGS, pick);
    assert_eq!(path.guides(&style(), &own_view(), &own_view()), []);
    assert_eq!(path.stamps().len(), 1);
    let mut path = drag(&[DVec2::new(300.0, 180.0), DVec2::new(301.0, 180.0)], &SETTINGS, pick);
    path.move_to(DVec2::NAN, pick);
    assert_eq!(path.guides(&style(), &own_view(), &own_view()), []);
}

#[test]
fn the_view_is_stated_unless_it_is_the_reference() {
    let turned = DAffine3::from_scale_rotation_translation(
        DVec3::splat(2.0),
        DQuat::from_rotation_y(0.4),
        DVec3::new(1.0, 2.0, 3.0),
    );
    let reference = ObjectView::new(&camera([0.0, 1.0, 4.0], [0.0, 0.5, 0.0]), turned);
    let at = DVec3::new(0.1, 0.2, 0.3);
    // The same view stated differently: another roll, lens and target distance.
    let mut same = camera([0.0, 1.0, 4.0], [0.0, 0.75, 2.0]);
    (same.roll_rad, same.lens) = (1.0, Lens::Perspective { fov_y_deg: 60.0, near: 0.1, far: 9.0 });
    assert_eq!(ObjectView::new(&same, turned).guide_view(&reference, at), None);
    // The object and the camera moved together.
    let moved = DAffine3::from_rotation_translation(DQuat::from_rotation_x(0.7), DVec3::new(-3.0, 0.0, 1.0));
    let mut carried = camera([0.0, 1.0, 4.0], [0.0, 0.5, 0.0]);
    (carried.eye, carried.target) =
        (moved.transform_point3(carried.eye), moved.transform_point3(carried.target));
    assert_eq!(ObjectView::new(&carried, moved * turned).guide_view(&reference, at), None);
    let other = ObjectView::new(&camera([1.0, 1.0, 4.0], [0.0, 0.5, 0.0]), turned).guide_view(&reference, at);
    let GuideView { eye, .. } = other.expect("it is another view");
    let world = turned.transform_point3(DVec3::from(eye));
    assert!((world - DVec3::new(1.0, 1.0, 4.0)).length() < 1e-9);
}

#[test]
fn a_parallel_view_of_a_central_scene_is_seen_from_afar() {
    let mut parallel = camera([1.0, 1.0, 4.0], [0.0, 0.5, 0.0]);
    parallel.lens = Lens::Orthographic { height: 3.0, near: 0.1, far: 50.0 };
    let reference = own_view();
    let seen = ObjectView::new(&parallel, DAffine3::IDENTITY);
    let middle = DVec3::new(0.4, 0.3, 0.2);
    let GuideView { eye, target, .. } = seen.guide_view(&reference, middle).unwrap();
    let [eye, target] = [eye, target].map(DVec3::from);
    let gaze = (target - eye).normalize();
    assert!((gaze - seen.gaze()).length() < 1e-9 && (middle - eye).normalize().dot(gaze) > 1.0 - 1e-9);
    assert!(eye.length() > 1e4);
}

#[test]
fn mirror_images_lie_on_the_surface_and_are_seen_from_the_other_side() {
    assert_eq!(MirrorAxes { x: true, ..Default::default() }.flips(), [DVec3::new(-1.0, 1.0, 1.0)]);
    assert_eq!(MirrorAxes { x: true, y: true, z: false }.flips().len(), 3);
    assert_eq!(MirrorAxes { x: true, y: true, z: true }.flips().len(), 7);
    assert!(MirrorAxes::default().flips().is_empty());
    let path = drag(&[DVec2::new(330.0, 150.0), DVec2::new(400.0, 190.0)], &SETTINGS, &mut |at_px| {
        on_ball(&front(), at_px)
    });
    let side = ObjectView::new(&camera([1.0, 0.0, 4.0], [0.0; 3]), DAffine3::IDENTITY);
    let guide = &path.guides(&style(), &side, &own_view())[0];
    let flip = DVec3::new(-1.0, 1.0, 1.0);
    let mut ball = |at: DVec3, facing: DVec3, farthest: f64| {
        let position = at.normalize();
        let found = (at.distance(position) <= farthest && position.dot(facing) > 0.0 && position.x < -0.1)
            .then_some(position)?;
        Some(SurfacePoint {
            triangle: 0,
            barycentric: [1.0, 0.0, 0.0],
            position: found,
            position_now: found,
            normal: found,
            face_normal: found,
            flipped: false,
        })
    };
    let [image] = mirrored(guide, flip, &side, &own_view(), &mut ball).try_into().expect("one piece");
    for (point, own) in image.points.iter().rev().zip(guide.points.iter().rev()) {
        assert!((DVec3::from(point.at) - DVec3::from(own.at) * flip).length() < 1e-9);
    }
    assert!(image.points.len() < guide.points.len(), "what has no surface near by is left out");
    assert_eq!(image.view, Some(GuideView { eye: [-1.0, 0.0, 4.0], target: [0.0; 3], frame: None }));
    // The reference looks straight on, so its mirror image is the reference again.
    assert_eq!(mirrored(guide, flip, &own_view(), &own_view(), &mut ball)[0].view, None);
    assert!(mirrored(guide, flip, &side, &own_view(), &mut |_, _, _| None).is_empty());
}
