//! Tests of touches, the strokes placed by hand: they lie where they were put, move with the surface, are hidden by
//! what is in front of them, and a long one is one stroke.

use std::collections::BTreeSet;
use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use impasto_core::TriangleMesh;
use impasto_gl_render::Picture;
use impasto_gl_render::context::Driver;
use impasto_painting::frame::{Frame, LayerKind, LineVertex};
use impasto_painting::{FrameOptions, Painting, prepare};
use impasto_scene::document::{Color, Direction, ObjectKey, Region, Scene, Selector, Touch, TouchPoint};
use impasto_scene::load::{LoadOptions, load};
use impasto_scene::motion::{self, CameraPose};
use impasto_tests::command::root;
use impasto_tests::gestures::camera;
use impasto_tests::pictures::{faulty_renderer, renderer};
use impasto_tests::shapes;

use crate::directions::SIZE_PX;

const RED: Color = Color([1.0, 0.1, 0.05]);

fn point(at: [f64; 3], normal: [f64; 3]) -> TouchPoint {
    TouchPoint { at, normal }
}

/// A red touch on `thing` through these places of the plane z = 0, which faces +Z.
fn on_plane(places: &[[f64; 2]]) -> Touch {
    let points = places.iter().map(|[x, y]| point([*x, *y, 0.0], [0.0, 0.0, 1.0])).collect();
    Touch { color: Some(RED), ..Touch::new("touch", "thing", points) }
}

fn scene(touches: Vec<Touch>) -> Scene {
    let mut scene = shapes::scene(vec![shapes::object("thing", 4000)]);
    scene.strokes.layers = shapes::body_layer_alone();
    scene.touches = touches;
    scene
}

fn painted(scene: Scene, mesh: TriangleMesh) -> Painting {
    prepare(shapes::loaded(scene, [mesh])).unwrap()
}

fn seen(painting: &Painting, camera: &CameraPose) -> Frame {
    painting.seen_by(camera, 0.0, &FrameOptions::new(SIZE_PX))
}

/// The points midway between the left and right vertices of a frame's first line, without those of the tips past its
/// ends.
fn middle(frame: &Frame) -> Vec<DVec2> {
    let Some(strip) = frame.lines.strips.first() else { return Vec::new() };
    let vertices = &frame.lines.vertices[strip.first as usize..(strip.first + strip.count) as usize];
    let at = |vertex: &LineVertex| DVec2::from(vertex.at_px.map(f64::from));
    let pairs: Vec<DVec2> = vertices.chunks(2).map(|pair| (at(&pair[0]) + at(&pair[1])) * 0.5).collect();
    pairs[1..pairs.len() - 1].to_vec()
}

/// Where a camera shows a place, in pixels from the lower left, computed from the camera's axes alone.
fn shown(camera: &CameraPose, at: DVec3) -> DVec2 {
    let gaze = (camera.target - camera.eye).normalize();
    let right = gaze.cross(DVec3::Y).normalize();
    let up = right.cross(gaze);
    let (sin, cos) = camera.roll_rad.sin_cos();
    let off = at - camera.eye;
    let level = DVec2::new(off.dot(right), off.dot(up)) / off.dot(gaze);
    let rolled = DVec2::new(level.x * cos + level.y * sin, level.y * cos - level.x * sin);
    let [width, height] = SIZE_PX.map(f64::from);
    rolled * (0.5 * height / (17.5f64.to_radians()).tan()) + DVec2::new(width, height) * 0.5
}

#[test]
fn a_straight_touch_on_a_plane_lies_where_its_points_are_from_any_view() {
    let painting = painted(scene(vec![on_plane(&[[-0.6, -0.2], [0.5, 0.3]])]), shapes::sheet(9));
    let [from, to] = [DVec3::new(-0.6, -0.2, 0.0), DVec3::new(0.5, 0.3, 0.0)];
    for eye in [[0.0, 0.0, 4.0], [2.0, 0.7, 3.0], [-2.4, -1.0, 2.5]] {
        for roll_deg in [0.0f64, 7.0, 30.0, 137.0] {
            let view = CameraPose { roll_rad: roll_deg.to_radians(), ..camera(eye, [0.1, 0.0, 0.0]) };
            let frame = seen(&painting, &view);
            let found = middle(&frame);
            assert!(found.len() > 20);
            for (step, at) in found.iter().enumerate() {
                let wanted = shown(&view, from.lerp(to, step as f64 / (found.len() - 1) as f64));
                assert!(at.distance(wanted) < 0.01, "{eye:?} at {roll_deg}°, {step}: {at}, not {wanted}");
            }
            // In every view the width is 14 pixels, the default of a new touch.
            let stroke = frame.strokes.last().unwrap();
            assert_eq!(stroke.width_px, 14.0);
            let strip = frame.lines.strips[0];
            let middle = &frame.lines.vertices[(strip.first + strip.count / 2) as usize];
            let half = DVec2::from(middle.from_middle_px.map(f64::from)).length();
            assert!((half - 7.0 / 0.84).abs() < 1e-4, "{half}");
        }
    }
}

#[test]
fn a_touch_turns_with_its_object_and_is_gone_where_that_faces_away() {
    for turn_deg in [7.0, 30.0, 137.0] {
        let mut scene = scene(vec![on_plane(&[[-0.5, 0.3], [0.0, -0.1], [0.4, 0.35]])]);
        scene.objects[0].keys = vec![ObjectKey { rotation_deg: [0.0, turn_deg, 0.0], ..ObjectKey::at(0.0) }];
        let still = painted(self::scene(scene.touches.clone()), shapes::sheet(9));
        let painting = painted(scene, shapes::sheet(9));
        let view = camera([0.0, 0.0, 4.0], [0.0; 3]);
        let found = middle(&seen(&painting, &view));
        if turn_deg > 90.0 {
            assert!(found.is_empty(), "a touch on the far side of the sheet is shown");
            continue;
        }
        let before = middle(&seen(&still, &view));
        assert_eq!(found.len(), before.len());
        let focal = 180.0 / 17.5f64.to_radians().tan();
        let half = DVec2::new(320.0, 180.0);
        let turned = glam::DQuat::from_rotation_y(f64::to_radians(turn_deg));
        for (was, now) in before.iter().zip(&found) {
            // The place on the plane, found from where the line shows when nothing is turned.
            let on_plane = (*was - half) * (4.0 / focal);
            let wanted = shown(&view, turned * on_plane.extend(0.0));
            assert!(now.distance(wanted) < 0.02, "{turn_deg}: {now}, not {wanted}");
        }
    }
}

#[test]
fn a_touch_rides_on_a_body_that_bends() {
    let bowed = |at: DVec3| DVec3::new(at.x, at.y, 0.4 * (1.0 - at.x * at.x));
    let mesh = shapes::sheet(24);
    let mut scene = scene(vec![on_plane(&[[-0.7, 0.0], [0.0, 0.2], [0.7, 0.0]])]);
    scene.timeline.last = 10;
    scene.objects[0].morph = Some("target.obj".to_owned());
    scene.objects[0].keys = vec![ObjectKey::at(0.0), ObjectKey { morph: 1.0, ..ObjectKey::at(10.0) }];
    let target = shapes::moved(&mesh, bowed);
    let painting = prepare(shapes::morphing(scene, [mesh, target])).unwrap();
    let options = FrameOptions::new(SIZE_PX);
    let view = motion::camera_at(painting.scene(), 0.0);
    let [rest, bent] = [0.0, 10.0].map(|frame| middle(&painting.at(frame, &options)));
    assert_eq!(rest.len(), bent.len());
    let focal = 180.0 / 17.5f64.to_radians().tan();
    for (was, now) in rest.iter().zip(&bent) {
        let at = (*was - DVec2::new(320.0, 180.0)) * (4.0 / focal);
        let wanted = shown(&view, bowed(at.extend(0.0)));
        // The target is flat between its vertices, so it differs a little from `bowed`.
        assert!(now.distance(wanted) < 0.4, "{now}, not {wanted}");
    }
}

#[test]
fn a_touch_at_one_place_lies_along_the_strokes_round_it_and_keeps_its_length() {
    for angle_deg in [7.0, 30.0, 137.0] {
        let mut scene = scene(vec![Touch { length_px: 60.0, ..on_plane(&[[0.2, 0.1]]) }]);
        let direction = Direction::Angle(angle_deg);
        scene.regions = vec![Region { direction, ..Region::new("all", Selector::Everything) }];
        let painting = painted(scene, shapes::sheet(9));
        for z in [4.0, 2.5, 6.0] {
            let view = camera([0.0, 0.0, z], [0.0; 3]);
            let line = middle(&seen(&painting, &view));
            let along = line[line.len() - 1] - line[0];
            assert!((along.length() - 60.0).abs() < 1e-3, "from {z} it is {} long", along.length());
            let off = (along.to_angle() - f64::to_radians(angle_deg)).rem_euclid(PI);
            assert!(off.min(PI - off) < 1e-3, "{angle_deg} from {z}: off by {off}");
            let at = (line[0] + line[line.len() - 1]) * 0.5;
            assert!(at.distance(shown(&view, DVec3::new(0.2, 0.1, 0.0))) < 0.01);
        }
    }
}

#[test]
fn touches_hold_on_a_mesh_that_was_exported_again_and_change_no_other_stroke() {
    let touch = || on_plane(&[[-0.5, 0.3], [0.0, -0.1], [0.4, 0.35]]);
    let view = camera([0.3, 0.2, 4.0], [0.0; 3]);
    let [coarse, fine] =
        [4, 33].map(|cells| middle(&seen(&painted(scene(vec![touch()]), shapes::sheet(cells)), &view)));
    for (one, other) in coarse.iter().zip(&fine) {
        assert!(one.distance(*other) < 0.01);
    }
    let [with, without] =
        [vec![touch()], Vec::new()].map(|touches| seen(&painted(scene(touches), shapes::sheet(9)), &view));
    assert_eq!(with.strokes[..without.strokes.len()], without.strokes);
    assert_eq!(with.layers[..without.layers.len()], without.layers);
    let last = with.layers.last().unwrap();
    assert_eq!(
        (last.kind, last.count as usize),
        (LayerKind::Touches, with.strokes.len() - without.strokes.len())
    );
    // A touch stays the same if another one comes before it in the list.
    let more = vec![Touch { name: "other".to_owned(), ..on_plane(&[[0.0, 0.0]]) }, touch()];
    let two = seen(&painted(scene(more), shapes::sheet(9)), &view);
    assert_eq!(two.strokes.last(), with.strokes.last());
}

/// The red of a pixel minus its green.
fn redness(picture: &Picture, at: DVec2) -> i32 {
    let (x, y) = (at.x as usize, (f64::from(SIZE_PX[1]) - at.y) as usize);
    let first = 4 * (y * SIZE_PX[0] as usize + x);
    i32::from(picture.rgba8[first]) - i32::from(picture.rgba8[first + 1])
}

/// Makes all bodies grey, so that red shows on them.
fn grey(mut scene: Scene) -> Scene {
    for object in &mut scene.objects {
        object.material = Some(impasto_scene::document::MaterialOverride {
            color: Some(Color([0.5; 3])),
            ..Default::default()
        });
    }
    scene
}

fn curved() -> Touch {
    let places = [[-0.8, -0.3], [-0.4, 0.35], [0.1, 0.1], [0.35, -0.35], [0.8, 0.3]];
    Touch { width_px: 16.0, brush: Some("flat".to_owned()), ..on_plane(&places) }
}

#[test]
fn a_curved_touch_is_one_stroke_without_gaps_on_either_driver() {
    let painting = painted(grey(scene(vec![curved()])), shapes::sheet(9));
    let view = camera([0.0, 0.0, 4.0], [0.0; 3]);
    let frame = seen(&painting, &view);
    let line = middle(&frame);
    let mut pictures = Vec::new();
    for driver in [Driver::Egl, Driver::Osmesa] {
        let mut renderer = renderer(driver);
        let picture = renderer.render(&frame).unwrap();
        // Except at its ragged ends, the touch is there across most of its width.
        for pair in line[4..line.len() - 4].windows(2) {
            let across = (pair[1] - pair[0]).normalize().perp();
            for step in 0..8 {
                let at = pair[0].lerp(pair[1], f64::from(step) / 8.0);
                let red =
                    (-5..=5).filter(|&off| redness(&picture, at + across * f64::from(off)) > 60).count();
                assert!(red >= 6, "{driver:?} at {at}: {red} of 11 pixels across are red");
            }
        }
        let off = line[line.len() / 2] + DVec2::new(0.0, 40.0);
        assert!(redness(&picture, off) < 30, "red beside the touch");
        // The same frame again, after another one.
        renderer.render(&seen(&painting, &camera([1.0, 0.0, 3.0], [0.0; 3]))).unwrap();
        assert_eq!(renderer.render(&frame).unwrap().rgba8, picture.rgba8);
        pictures.push(picture);
    }
    let [egl, osmesa] = [&pictures[0], &pictures[1]];
    assert!(egl.rgba8 == osmesa.rgba8, "EGL and OSMesa differ");
}

/// In a picture twice as large, a touch is twice as wide and lies at the same part of the picture.
#[test]
fn a_touch_is_as_large_as_its_picture() {
    let painting = painted(scene(vec![curved()]), shapes::sheet(9));
    let view = camera([0.0, 0.0, 4.0], [0.0; 3]);
    let [small, large] = [1, 2].map(|times| {
        let frame = painting.seen_by(&view, 0.0, &FrameOptions::new(SIZE_PX.map(|side| side * times)));
        let at = |vertex: &LineVertex| DVec2::from(vertex.at_px.map(f64::from));
        let widths = frame.lines.vertices.chunks(2).map(|pair| at(&pair[0]).distance(at(&pair[1])));
        let widest = widths.fold(0.0, f64::max);
        let line = middle(&frame);
        (widest, line[line.len() / 2])
    });
    assert!((large.0 / small.0 - 2.0).abs() < 0.05, "{} and {} pixels wide", small.0, large.0);
    assert!(large.1.distance(small.1 * 2.0) < 6.0, "{} and {}", small.1, large.1);
}

#[test]
fn what_is_in_front_hides_a_touch_and_a_planted_fault_is_noticed() {
    let mut scene = shapes::scene(vec![shapes::object("thing", 4000), shapes::object("cover", 500)]);
    scene.strokes.layers = shapes::body_layer_alone();
    scene.touches = vec![on_plane(&[[-0.7, 0.0], [0.7, 0.0]])];
    // The cover hides the right half.
    scene.objects[1].keys = vec![ObjectKey { translation: [1.0, 0.0, 0.5], ..ObjectKey::at(0.0) }];
    let meshes = [shapes::sheet(9), shapes::sheet(3)];
    let painting = prepare(shapes::loaded(grey(scene), meshes)).unwrap();
    let view = camera([0.0, 0.0, 4.0], [0.0; 3]);
    let frame = seen(&painting, &view);
    let line = middle(&frame);
    let shares = |picture: &Picture| {
        let red = |part: &[DVec2]| {
            part.iter().filter(|at| redness(picture, **at) > 60).count() as f64 / part.len() as f64
        };
        [red(&line[2..line.len() / 2 - 2]), red(&line[line.len() / 2 + 2..])]
    };
    let [left, right] = shares(&renderer(Driver::Egl).render(&frame).unwrap());
    assert!(left > 0.9 && right < 0.01, "{left} {right}");
    let fault = ["if (body.z < FREE) alpha *= laid(tint);", ""];
    let mut faulty = faulty_renderer("rotating_strokes/paint.frag", fault[0], fault[1]);
    let [_, right] = shares(&faulty.render(&frame).unwrap());
    assert!(right > 0.1, "the fault would not be noticed: {right}");
}

#[test]
fn a_touch_goes_behind_its_own_body_and_its_paint_lies_on_top() {
    // Round a sphere, from the front to the back.
    let points = (0..9).map(|step| {
        let angle = (-60.0 + 30.0 * f64::from(step)).to_radians();
        let at = [angle.sin(), 0.2, angle.cos()];
        point(at, at)
    });
    let touch = Touch { color: Some(RED), width_px: 12.0, ..Touch::new("round", "thing", points.collect()) };
    let painting = painted(grey(scene(vec![touch])), shapes::sphere(40, 20));
    let view = camera([0.0, 0.0, 4.0], [0.0; 3]);
    let frame = seen(&painting, &view);
    let picture = renderer(Driver::Egl).render(&frame).unwrap();
    let strips = frame.lines.strips.len();
    assert!(strips >= 1 && frame.lines.vertices.iter().all(|v| v.at_px.iter().all(|at| at.is_finite())));
    let on_front = shown(&view, DVec3::new(-0.3, 0.2, (1.0f64 - 0.13).sqrt()));
    assert!(redness(&picture, on_front) > 60, "the touch is not seen on the front");
    // A place of the front that has no touch.
    let behind = shown(&view, DVec3::new(0.5, -0.3, 0.8));
    assert!(redness(&picture, behind) < 30);
    let from_behind = seen(&painting, &camera([0.0, 0.0, -4.0], [0.0; 3]));
    assert_eq!(from_behind.layers.last().unwrap().kind, LayerKind::Touches);
}

#[test]
fn without_a_colour_a_touch_has_that_of_the_picture_and_hidden_ones_are_not_there() {
    let plain = Touch { color: None, ..curved() };
    let painting = painted(grey(scene(vec![plain.clone()])), shapes::sheet(9));
    let frame = seen(&painting, &camera([0.0, 0.0, 4.0], [0.0; 3]));
    let mut renderer = renderer(Driver::Egl);
    renderer.render(&frame).unwrap();
    let found = renderer.resolved_strokes();
    let [touch, body] = [found.last().unwrap(), &found[0]].map(|stroke| stroke.color_linear);
    for channel in 0..3 {
        assert!((touch[channel] - body[channel]).abs() < 0.05, "{touch:?}, the body has {body:?}");
    }
    let hidden = Touch { hidden: true, ..plain };
    let frame = seen(&painted(scene(vec![hidden]), shapes::sheet(9)), &camera([0.0, 0.0, 4.0], [0.0; 3]));
    assert!(frame.lines.strips.is_empty() && frame.layers.iter().all(|run| run.kind != LayerKind::Touches));
}

/// In mattes, a touch belongs to the material under its middle.
#[test]
fn a_touch_is_of_the_material_that_it_lies_on() {
    let mut loaded = load(&root().join("scenes/apple.ron"), &LoadOptions::default()).unwrap();
    loaded.scene.objects.retain(|object| object.name == "apple");
    loaded.scene.objects[0].particles = Some(2000);
    let before = prepare(Arc::new(loaded.clone())).unwrap();
    let mut materials = BTreeSet::new();
    for index in (0..2000).step_by(190) {
        let at = before.particles(0).at(index);
        let place = point(at.position.as_dvec3().to_array(), at.normal.as_dvec3().to_array());
        loaded.scene.touches = vec![Touch::new("touch", "apple", vec![place])];
        let painting = prepare(Arc::new(loaded.clone())).unwrap();
        let under = before.material_of(0, LayerKind::Body, index);
        assert_eq!(painting.material_of(0, LayerKind::Touches, 0), under);
        materials.insert(under.to_owned());
    }
    assert!(materials.len() > 2 && !materials.contains("apple"), "{materials:?}");
}
