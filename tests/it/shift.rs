//! Tests that strokes near the border of their body are shifted along their length, to lie on the body as far as they
//! can, and that strokes of thin parts lie along the middle of the part.

use std::collections::HashMap;

use glam::DVec3;
use impasto_gl_render::Renderer;
use impasto_gl_render::context::Driver;
use impasto_painting::frame::LayerKind;
use impasto_painting::{Frame, FrameOptions, prepare};
use impasto_scene::document::{Direction, Edges, Lens};
use impasto_tests::pictures::{faulty_renderer, renderer};
use impasto_tests::shapes;

const SIZE_PX: [u32; 2] = [640, 360];
/// Borders of the sheet in the picture: 120 pixels a unit.
const LEFT_PX: f32 = 200.0;
const RIGHT_PX: f32 = 440.0;
const BOTTOM_PX: f32 = 60.0;
const TOP_PX: f32 = 300.0;

/// The shift of a level stroke whose centre is `inside_px` inside an upright border. An end may lie past the border by
/// a fifth of the length; an end that lies farther out shifts the stroke by half the excess.
fn expected_px(inside_px: f32, length_px: f32) -> f32 {
    let half_px = 0.5 * length_px;
    let on_body = (inside_px / half_px).min(1.0);
    0.5 * half_px * (1.0 - (on_body + 0.4).min(1.0))
}

/// How far strokes are from where they should lie, in pixels.
#[derive(Debug, Default)]
struct Errors {
    at_border: Vec<f32>,
    inside: Vec<f32>,
    across: f32,
}

fn errors(frame: &Frame, renderer: &mut Renderer) -> Errors {
    renderer.render(frame).unwrap();
    let resolved = renderer.resolved_strokes();
    let body = frame.layers.iter().find(|run| run.kind == LayerKind::Body).unwrap();
    let mut errors = Errors::default();
    let of_body = frame.strokes.iter().zip(&resolved).skip(body.first as usize).take(body.count as usize);
    for (stroke, drawn) in of_body {
        let [x, y] = stroke.center_px;
        let from_end = (y - BOTTOM_PX).min(TOP_PX - y);
        // Only level, visible strokes away from the lower and upper borders are compared.
        if drawn.alpha <= 0.0 || stroke.angle_rad.abs() > 1e-3 || from_end < stroke.width_px {
            continue;
        }
        let [from_left, from_right] = [x - LEFT_PX, RIGHT_PX - x].map(|inside_px| inside_px.max(0.0));
        let expected = expected_px(from_left, stroke.length_px) - expected_px(from_right, stroke.length_px);
        let error = (drawn.center_px[0] - x - expected).abs();
        if expected.abs() > 3.0 {
            errors.at_border.push(error);
        } else if from_left.min(from_right) > 0.5 * stroke.length_px {
            errors.inside.push(error);
        }
        errors.across = errors.across.max((drawn.center_px[1] - y).abs());
    }
    let [at_border, inside] = [&errors.at_border, &errors.inside].map(Vec::len);
    assert!(at_border > 20 && inside > 100, "{at_border} strokes at the border, {inside} inside");
    errors
}

fn largest(errors: &[f32]) -> f32 {
    errors.iter().copied().fold(0.0, f32::max)
}

#[test]
fn strokes_at_the_border_are_shifted_onto_their_body() {
    let mut scene = shapes::scene(vec![shapes::object("sheet", 3000)]);
    scene.camera.lens = Lens::Orthographic { height: 3.0, near: 0.05, far: 100.0 };
    scene.strokes.contour = Some(0.0);
    scene.strokes.layers = shapes::body_layer_alone();
    scene.strokes.edges = Some(Edges::Clip);
    (scene.strokes.length_px, scene.strokes.width_px) = (Some(60.0), Some(10.0));
    scene.regions[0].direction = Direction::Angle(0.0);
    let painting = prepare(shapes::loaded(scene, [shapes::sheet(1)])).unwrap();
    let frame = painting.at(0.0, &FrameOptions::new(SIZE_PX));
    let found = errors(&frame, &mut renderer(Driver::Egl));
    // The shader's taps are 1/12 of half a stroke apart, so the shift is not exact.
    let off = largest(&found.at_border);
    assert!(off < 2.0, "strokes at the border are not shifted onto their body: off by {off} px");
    let off = largest(&found.inside);
    assert!(off < 0.01, "strokes that lie on their body are shifted by {off} px");
    assert!(found.across < 0.05, "level strokes are shifted across themselves by {} px", found.across);
    let (file, shift) = ("rotating_strokes/resolve.vert", "return 0.25 * size.x * (forward - back);");
    for (fault, least) in [("return 0.0;", 5.0), ("return 0.12 * size.x * (forward - back);", 2.5)] {
        let off = largest(&errors(&frame, &mut faulty_renderer(file, shift, fault)).at_border);
        assert!(off > least, "the test does not notice `{fault}`: off by {off} px");
    }
}

/// A wire 2.4 pixels wide, at 30 degrees, with strokes along it. They lie on its middle line, where paint reaches the
/// whole wire, and do not leap when the camera moves by a tenth of a pixel.
#[test]
fn strokes_of_a_wire_lie_on_its_middle_line() {
    const HALF_WIDTH_PX: f64 = 1.2;
    let along = DVec3::new(30f64.to_radians().cos(), 30f64.to_radians().sin(), 0.0);
    let across = DVec3::new(-along.y, along.x, 0.0);
    let wire = shapes::moved(&shapes::sheet(16), |at| along * at.x + across * (at.y * HALF_WIDTH_PX / 120.0));
    let mut scene = shapes::scene(vec![shapes::object("wire", 2000)]);
    scene.camera.lens = Lens::Orthographic { height: 3.0, near: 0.05, far: 100.0 };
    scene.timeline.last = 10;
    scene.camera.keys = [0.0, 10.0]
        .map(|frame| {
            let target = across * (0.1 / 120.0 * frame);
            shapes::camera_key(frame, (target + 4.0 * DVec3::Z).to_array(), target.to_array())
        })
        .into();
    scene.regions[0].direction = Direction::Angle(30.0);
    let painting = prepare(shapes::loaded(scene, [wire])).unwrap();
    let mut renderer = renderer(Driver::Egl);
    // How far the stroke of each particle is moved, and the distances of particles and of strokes from the middle line.
    let mut of_frame = |number: f64| {
        let frame = painting.at(number, &FrameOptions::new(SIZE_PX));
        renderer.render(&frame).unwrap();
        let off_px = |center_px: [f32; 2]| {
            let [x, y] = center_px.map(f64::from);
            ((x - 320.0) * across.x + (y - 180.0) * across.y).abs()
        };
        let (mut moves, mut distances) = (HashMap::new(), Vec::new());
        let sources = frame.sources.iter().map(|source| (source.place, source.particle));
        for ((source, stroke), drawn) in sources.zip(&frame.strokes).zip(renderer.resolved_strokes()) {
            let [x, y] = stroke.center_px;
            // The ends of the wire have no middle line.
            if drawn.alpha < 0.05 || drawn.turned_rad != 0.0 || (x - 320.0).hypot(y - 180.0) > 100.0 {
                continue;
            }
            distances.push([off_px(stroke.center_px), off_px(drawn.center_px)]);
            moves.insert(source, [drawn.center_px[0] - x, drawn.center_px[1] - y]);
        }
        (moves, distances)
    };
    let (mut before, distances) = of_frame(0.0);
    let mean = |which: usize| distances.iter().map(|pair| pair[which]).sum::<f64>() / distances.len() as f64;
    let [particles, strokes] = [mean(0), mean(1)];
    assert!(distances.len() > 50 && particles > 0.45, "{} particles, {particles} px off", distances.len());
    assert!(strokes < 0.3, "strokes are {strokes} px off the middle, their particles {particles}");
    for number in 1..=10 {
        let (moves, _) = of_frame(f64::from(number));
        let leap = |(source, now): (&_, &[f32; 2])| {
            before.get(source).map(|then: &[f32; 2]| (now[0] - then[0]).hypot(now[1] - then[1]))
        };
        let largest = moves.iter().filter_map(leap).fold(0.0, f32::max);
        // With taps on single pixels, strokes would leap by 0.86 to 1.4 px.
        assert!(largest < 0.7, "frame {number}: a stroke leaps by {largest} px");
        before = moves;
    }
}
