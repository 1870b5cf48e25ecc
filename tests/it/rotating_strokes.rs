//! Tests of strokes as drawn: orientation, size, order, colour, coverage and occlusion, from pixels and from strokes
//! read back.

use std::sync::Arc;

use impasto_gl_render::context::Driver;
use impasto_gl_render::{Picture, RenderError, Renderer};
use impasto_painting::frame::{Brushes, Finish, LayerKind, LayerRun, Stroke, StrokeSource};
use impasto_painting::{Frame, FrameOptions, prepare};
use impasto_scene::document::Canvas;
use impasto_scene::document::{Color, MaterialOverride, ObjectKey, RotatingStrokes, Scale, Scene, Style};
use impasto_tests::pictures::{Grey, renderer, wrap_half};
use impasto_tests::shapes;

fn options(size_px: [u32; 2]) -> FrameOptions {
    FrameOptions::new(size_px)
}

fn unlit(color: [f32; 3]) -> Option<MaterialOverride> {
    Some(MaterialOverride { color: Some(Color(color)), unlit: true, ..Default::default() })
}

/// A frame with these strokes and nothing else, on a black background. The strokes belong to two flat, unlit bodies of
/// these `colors` far behind them: body 1 left of the middle, body 2 right of it.
fn lone_strokes(size_px: [u32; 2], strokes: Vec<Stroke>, colors: [[f32; 3]; 2]) -> Frame {
    let halves = [("left", -50.0, colors[0]), ("right", 50.0, colors[1])].map(|(name, x, color)| {
        let mut half = shapes::object(name, 1);
        half.scale = Scale([50.0; 3]);
        half.material = unlit(color);
        half.keys =
            vec![ObjectKey { translation: [x, 0.0, -95.0], rotation_deg: [0.0; 3], ..ObjectKey::at(0.0) }];
        half
    });
    let mut scene = shapes::scene(halves.into());
    // The scene's own strokes are replaced below.
    scene.strokes.layers = shapes::body_layer_alone();
    let painting = prepare(shapes::loaded(scene, [shapes::sheet(1), shapes::sheet(1)])).unwrap();
    let mut frame = painting.at(0.0, &options(size_px));
    let source = StrokeSource { place: 0, particle: 0, region: 0, kappa: 1.0, facing: 1.0, rank: 0.5 };
    frame.background = Some([0.0; 3]);
    frame.sources = vec![source; strokes.len()];
    frame.layers = vec![LayerRun { order: 0, kind: LayerKind::Body, first: 0, count: strokes.len() as u32 }];
    frame.strokes = strokes;
    frame.brushes = Arc::new(Brushes::of_names(&["filbert"]));
    frame.finish = Finish::default();
    frame
}

const WHITE: [[f32; 3]; 2] = [[1.0; 3]; 2];

fn stroke(center_px: [f32; 2], angle_deg: f32) -> Stroke {
    Stroke {
        center_px,
        depth: 4.0,
        angle_rad: angle_deg.to_radians(),
        length_px: 120.0,
        width_px: 32.0,
        body_id: 1,
        albedo_srgb8: 0x00ff_ffff,
        normal_in_world: [0.0, 0.0, 1.0],
        // Paint may run past its body without limit.
        overrun_px: Stroke::FREE,
        ..Stroke::default()
    }
}

#[test]
fn a_lone_stroke_lies_at_its_angle() {
    let mut renderer = renderer(Driver::Egl);
    for angle_deg in [7.0f32, 30.0, 137.0] {
        // All marks, plain and flipped, so that no single mark's shape decides.
        let mut sum = (0.0, 0.0);
        for mark in 0..24u32 {
            let mut one = stroke([158.0, 90.0], angle_deg);
            one.mark = (mark % 12) | ((mark / 12) << 16);
            let picture = renderer.render(&lone_strokes([320, 180], vec![one], WHITE)).unwrap();
            let angle = Grey::of(&picture).streak_angle_rad();
            sum = (sum.0 + (2.0 * angle).cos(), sum.1 + (2.0 * angle).sin());
        }
        let measured = 0.5 * f64::atan2(sum.1, sum.0);
        let error = wrap_half(measured - f64::from(angle_deg).to_radians()).to_degrees();
        println!("{angle_deg} degrees: off by {error:.3}");
        assert!(error.abs() <= 0.5, "{angle_deg} degrees: the drawn stroke is off by {error}");
    }
}

#[test]
fn a_stroke_has_its_size_at_any_depth() {
    let mut renderer = renderer(Driver::Egl);
    let mut lone = stroke([190.5, 100.5], 0.0);
    let first = renderer.render(&lone_strokes([401, 201], vec![lone], WHITE)).unwrap();
    assert!(Grey::of(&first).values.iter().any(|&value| value > 200.0));
    for depth in [1.0, 10.0, 50.0, 99.0] {
        lone.depth = depth;
        let picture = renderer.render(&lone_strokes([401, 201], vec![lone], WHITE)).unwrap();
        assert!(picture == first, "depth {depth} changes the drawn stroke");
    }
    let grey = Grey::of(&first);
    let rows_inked = (0..201).filter(|&y| (0..401).any(|x| grey.at(x, y) > 30.0)).count();
    assert!((26..=34).contains(&rows_inked), "a stroke 32 px wide covers {rows_inked} rows");
}

#[test]
fn later_strokes_lie_over_earlier_ones() {
    let mut renderer = renderer(Driver::Egl);
    let red = stroke([70.0, 100.0], 0.0);
    let blue = Stroke { body_id: 2, ..stroke([130.0, 100.0], 0.0) };
    let mut middle = |strokes: Vec<Stroke>| {
        let picture =
            renderer.render(&lone_strokes([200, 200], strokes, [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])).unwrap();
        let at = (100 * 200 + 100) * 4;
        [picture.rgba8[at], picture.rgba8[at + 2]]
    };
    let [r, b] = middle(vec![red, blue]);
    assert!(b > 200 && r < 90, "red then blue gives {r}, {b}");
    let [r, b] = middle(vec![blue, red]);
    assert!(r > 200 && b < 90, "blue then red gives {r}, {b}");
}

#[test]
fn a_stroke_goes_out_from_its_ends_and_below_a_quarter_as_a_whole() {
    let mut renderer = renderer(Driver::Egl);
    // The paint of a level stroke by column, and its brightest pixel.
    let mut columns = |presence: f32| {
        let mut one = stroke([100.0, 50.0], 0.0);
        one.facing_fade = presence;
        let picture = renderer.render(&lone_strokes([200, 100], vec![one], WHITE)).unwrap();
        let values = Grey::of(&picture).values;
        let column = |x: usize| values.iter().skip(x).step_by(200).sum::<f64>();
        let brightest = values.iter().fold(0.0f64, |a, &b| a.max(b));
        ((0..200).map(column).collect::<Vec<f64>>(), brightest)
    };
    let total = |columns: &[f64]| columns.iter().sum::<f64>();
    let (empty, _) = columns(0.0);
    let (whole, _) = columns(1.0);
    let all = total(&whole) - total(&empty);
    let mut before = total(&empty);
    for step in 1..=50 {
        let presence = step as f32 / 50.0;
        let (now, brightest) = columns(presence);
        let paint = total(&now);
        assert!(paint >= before - 0.004 * all, "presence {presence}: paint falls from {before} to {paint}");
        assert!(
            paint - before <= 0.1 * all,
            "presence {presence}: paint jumps from {before} to {paint} of {all}"
        );
        if presence > 0.5 {
            assert!(brightest > 200.0, "presence {presence}: the paint itself has gone thin ({brightest})");
        }
        before = paint;
    }
    // A stroke of presence 0.4 is shorter, and in one piece.
    let painted =
        |columns: &[f64]| -> Vec<usize> { (0..200).filter(|&x| columns[x] - empty[x] > 300.0).collect() };
    let half = painted(&columns(0.4).0);
    let share = half.len() as f64 / painted(&whole).len() as f64;
    assert!((0.3..0.85).contains(&share), "{share} of its length");
    assert!(half.windows(2).all(|pair| pair[1] == pair[0] + 1), "islands at {half:?}");
}

/// Two bodies of one flat colour each, side by side, the right one partly in front of the left one.
fn two_bodies() -> Scene {
    let mut left = shapes::object("left", 8000);
    left.material = unlit([1.0, 0.0, 0.0]);
    left.keys =
        vec![ObjectKey { translation: [-0.6, 0.0, 0.0], rotation_deg: [0.0; 3], ..ObjectKey::at(0.0) }];
    let mut right = shapes::object("right", 8000);
    right.material = unlit([0.0, 0.0, 1.0]);
    right.scale = Scale([0.7; 3]);
    right.keys =
        vec![ObjectKey { translation: [0.6, 0.1, 0.5], rotation_deg: [0.0; 3], ..ObjectKey::at(0.0) }];
    let mut scene = shapes::scene(vec![left, right]);
    flat(&mut scene);
    scene
}

#[test]
fn a_stroke_takes_its_colour_from_its_own_body_only() {
    let mut renderer = renderer(Driver::Egl);
    let painting = prepare(shapes::loaded(two_bodies(), [shapes::sphere(32, 16), shapes::cube()])).unwrap();
    let frame = painting.at(0.0, &options([640, 360]));
    renderer.render(&frame).unwrap();
    let resolved = renderer.resolved_strokes();
    assert_eq!(resolved.len(), frame.strokes.len());
    let shown = frame.strokes.iter().zip(&resolved).filter(|(_, resolved)| resolved.alpha > 0.0);
    assert!(shown.clone().count() > 1000);
    for (stroke, resolved) in shown {
        let own = if stroke.body_id == 1 { [1.0, 0.0, 0.0] } else { [0.0, 0.0, 1.0] };
        for (channel, expected) in resolved.color_linear.iter().zip(own) {
            assert!(
                (channel - expected).abs() <= 1.0 / 255.0,
                "{:?} for body {}",
                resolved.color_linear,
                stroke.body_id
            );
        }
    }
}

#[test]
fn paint_stays_near_its_own_body_and_behind_what_hides_it() {
    let mut renderer = renderer(Driver::Egl);
    let painting = prepare(shapes::loaded(two_bodies(), [shapes::sphere(32, 16), shapes::cube()])).unwrap();
    let picture = renderer.render(&painting.at(0.0, &options([640, 360]))).unwrap();
    let ids = renderer.read_reference().body_id;
    let (width, height) = (640i32, 360i32);
    let id = |x: i32, y: i32| {
        if (0..width).contains(&x) && (0..height).contains(&y) { ids[(y * width + x) as usize] } else { 0 }
    };
    let mut red_on_blue = 0;
    for y in 0..height {
        for x in 0..width {
            let pixel = &picture.rgba8[((y * width + x) * 4) as usize..][..3];
            let reach = 9;
            let near = |wanted: u32| {
                (-reach..=reach).any(|dy| (-reach..=reach).any(|dx| id(x + dx, y + dy) == wanted))
            };
            if id(x, y) == 0 && !near(1) && !near(2) {
                assert!(pixel[0] > 200 && pixel[1] > 200, "paint far from every body at {x}, {y}");
            }
            // The blue cube stands in front, so red paint ends at its edge.
            let inside = (-2..=2).all(|dy| (-2..=2).all(|dx| id(x + dx, y + dy) == 2));
            red_on_blue += u32::from(inside && pixel[0] > 200 && pixel[2] < 60);
        }
    }
    assert_eq!(red_on_blue, 0, "red paint lies over the body in front of it");
}

#[test]
fn hidden_strokes_are_absent_and_open_ones_whole() {
    let mut renderer = renderer(Driver::Egl);
    let painting = prepare(shapes::loaded(two_bodies(), [shapes::sphere(32, 16), shapes::cube()])).unwrap();
    let frame = painting.at(0.0, &options([640, 360]));
    renderer.render(&frame).unwrap();
    let reference = renderer.read_reference();
    let resolved = renderer.resolved_strokes();
    let (mut hidden, mut open, mut open_count) = (0, 0.0, 0);
    let body = frame.layers.iter().filter(|run| run.kind == LayerKind::Body);
    let of_body = body.flat_map(|run| run.first as usize..(run.first + run.count) as usize);
    for (stroke, resolved) in of_body.map(|index| (&frame.strokes[index], &resolved[index])) {
        let [x, y] = stroke.center_px;
        if !(14.0..626.0).contains(&x) || !(14.0..346.0).contains(&y) {
            continue;
        }
        // The bodies that show in the pixels within reach of the occlusion taps.
        let around: Vec<u32> = (-14..=14)
            .flat_map(|dy| (-14..=14).map(move |dx| (dx, dy)))
            .map(|(dx, dy)| {
                reference.body_id[(359 - (y as i32 + dy)) as usize * 640 + (x as i32 + dx) as usize]
            })
            .collect();
        if stroke.body_id == 1 && around.iter().all(|&id| id == 2) {
            assert!(resolved.alpha <= 0.01, "a stroke behind the cube has alpha {}", resolved.alpha);
            hidden += 1;
        }
        if stroke.body_id == 1 && around.iter().all(|&id| id == 1) && stroke.presence() > 0.0 {
            open += f64::from(resolved.alpha / stroke.presence());
            open_count += 1;
        }
    }
    assert!(hidden >= 20 && open_count >= 500, "{hidden} hidden, {open_count} open");
    let mean = open / f64::from(open_count);
    assert!(mean > 0.99, "strokes in the open are seen to {mean}");
}

fn sphere_scene(size: (u32, u32)) -> Scene {
    // Without a stated number, there are as many particles as the picture needs.
    let mut scene = shapes::scene(vec![impasto_scene::document::Object {
        particles: None,
        ..shapes::object("sphere", 0)
    }]);
    scene.size = size;
    flat(&mut scene);
    scene
}

/// Flat paint on a smooth board, since light on the relief and the canvas would not turn with the picture.
fn flat(scene: &mut Scene) {
    scene.style = Style::RotatingStrokes(RotatingStrokes {
        canvas: Canvas::Board,
        relief: 0.0,
        varnish: 0.0,
        ..Default::default()
    });
}

/// The share of the surface's pixels with paint of alpha below 0.5, and the number of the surface's pixels.
fn holes(renderer: &mut Renderer, frame: &Frame) -> (f64, usize) {
    renderer.render(frame).unwrap();
    let paint = renderer.read_paint();
    let ids = renderer.read_reference().body_id;
    let inside: Vec<f32> =
        paint.iter().zip(&ids).filter(|(_, id)| **id > 0).map(|(paint, _)| paint[3]).collect();
    (inside.iter().filter(|&&alpha| alpha < 0.5).count() as f64 / inside.len() as f64, inside.len())
}

#[test]
fn the_surface_is_covered() {
    let mut renderer = renderer(Driver::Egl);
    for (size, brush) in [((640, 360), (20.0, 7.0)), ((960, 540), (34.0, 11.0)), ((270, 630), (16.0, 5.0))] {
        let mut scene = sphere_scene(size);
        scene.strokes.length_px = Some(brush.0);
        scene.strokes.width_px = Some(brush.1);
        let painting = prepare(shapes::loaded(scene, [shapes::sphere(48, 24)])).unwrap();
        let mut frame = painting.at(0.0, &options(size.into()));
        let (all, pixels) = holes(&mut renderer, &frame);
        frame.layers.retain(|layer| layer.kind == LayerKind::Body);
        let (body, _) = holes(&mut renderer, &frame);
        println!(
            "{size:?}: {pixels} px, holes with all layers {:.3} %, body alone {:.2} %",
            all * 100.0,
            body * 100.0
        );
        assert!(pixels > 10_000);
        assert!(all <= 0.005, "{size:?}: {all} of the surface is bare");
        assert!(body <= 0.08, "{size:?}: the body layer leaves {body} bare");
        frame.layers.clear();
        assert!(holes(&mut renderer, &frame).0 > 0.9, "without strokes the measure must see holes");
    }
}

/// Side of the pictures with a rolled camera, in pixels.
const SIDE: usize = 512;
/// The middle of such a picture, in pixels.
const HALF: f64 = (SIDE as f64 - 1.0) * 0.5;

/// A ball, seen by a camera that has rolled by `roll_deg` at frame 1. The light is fixed in the world, so the picture
/// should turn as a whole.
fn rolled(roll_deg: f64) -> Scene {
    let mut scene = sphere_scene((SIDE as u32, SIDE as u32));
    (scene.strokes.length_px, scene.strokes.width_px) = (Some(34.0), Some(11.0));
    scene.timeline.last = 1;
    let key = scene.camera.keys[0].clone();
    let mut turned = key.clone();
    (turned.frame, turned.roll_deg) = (1.0, roll_deg);
    scene.camera.keys = vec![key, turned];
    scene
}

fn roll_pictures(renderer: &mut Renderer, roll_deg: f64, fixed: bool) -> (Picture, Picture, Vec<u32>) {
    // Speckled, so that streaks show: strokes of one colour hardly differ.
    let loaded = shapes::speckled(&shapes::loaded(rolled(roll_deg), [shapes::sphere(48, 24)]));
    let painting = prepare(loaded).unwrap();
    let before = painting.at(0.0, &options([SIDE as u32; 2]));
    let mut after = painting.at(1.0, &options([SIDE as u32; 2]));
    let first = renderer.render(&before).unwrap();
    let ids = renderer.read_reference().body_id;
    if fixed {
        for stroke in &mut after.strokes {
            stroke.angle_rad = 20f32.to_radians();
        }
    }
    (first, renderer.render(&after).unwrap(), ids)
}

#[test]
fn a_quarter_turn_of_the_camera_turns_the_picture() {
    let mut renderer = renderer(Driver::Egl);
    for roll_deg in [90.0, 180.0, 270.0] {
        let compare = |first: &Picture, after: &Picture, ids: &[u32]| {
            let (mut sum, mut over, mut count) = (0.0, 0, 0);
            for y in 0..SIDE {
                for x in 0..SIDE {
                    if ids[y * SIDE + x] == 0 {
                        continue;
                    }
                    // A camera rolled by +a shows the picture turned by −a (clockwise, Y up).
                    let (tx, ty) = match roll_deg as u32 {
                        90 => (SIDE - 1 - y, x),
                        180 => (SIDE - 1 - x, SIDE - 1 - y),
                        _ => (y, SIDE - 1 - x),
                    };
                    for channel in 0..3 {
                        let a = first.rgba8[(y * SIDE + x) * 4 + channel];
                        let b = after.rgba8[(ty * SIDE + tx) * 4 + channel];
                        sum += f64::from(a.abs_diff(b));
                        over += u32::from(a.abs_diff(b) > 16);
                        count += 1;
                    }
                }
            }
            (sum / f64::from(count), f64::from(over) / f64::from(count))
        };
        let (first, after, ids) = roll_pictures(&mut renderer, roll_deg, false);
        let (mean, over) = compare(&first, &after, &ids);
        println!("roll {roll_deg}: mean difference {mean:.3}/255, over 16: {:.3} %", over * 100.0);
        assert!(mean <= 2.0 && over <= 0.01, "roll {roll_deg}: mean {mean}, over 16: {over}");
        if roll_deg != 180.0 {
            // The planted fault: strokes that do not turn.
            let (first, after, ids) = roll_pictures(&mut renderer, roll_deg, true);
            let (_, over) = compare(&first, &after, &ids);
            assert!(over > 0.01, "strokes that do not turn must show: {over}");
        }
    }
}

#[test]
fn an_odd_turn_of_the_camera_turns_the_streaks() {
    let mut renderer = renderer(Driver::Egl);
    for roll_deg in [7.0f64, 30.0, 137.0] {
        let mut error = |fixed: bool| {
            let (first, after, ids) = roll_pictures(&mut renderer, roll_deg, fixed);
            let (first, after) = (Grey::of(&first), Grey::of(&after));
            // The first picture turned by −roll, sampled where the second has its pixels.
            let (sin, cos) = roll_deg.to_radians().sin_cos();
            let mut turned = after.clone();
            let mut known = vec![false; SIDE * SIDE];
            for y in 0..SIDE {
                for x in 0..SIDE {
                    let (px, py) = (x as f64 - HALF, HALF - y as f64);
                    // Where this pixel was before the picture turned clockwise by the roll.
                    let (qx, qy) = (px * cos - py * sin, px * sin + py * cos);
                    let (sx, sy) = (qx + HALF, HALF - qy);
                    let inside = |x: f64, y: f64| ids[(y.round() as usize) * SIDE + x.round() as usize] > 0;
                    if let Some(value) = first.sample(sx, sy) {
                        turned.values[y * SIDE + x] = value;
                        known[y * SIDE + x] = inside(sx, sy);
                    }
                }
            }
            // Both are blurred a little, so that the pixel grid does not matter.
            let (turned, after) = (turned.blurred(1.5), after.blurred(1.5));
            // Only pixels well inside the ball count, so that its outline does not matter either.
            let inside = |x: usize, y: usize| {
                let at = |dx: i32, dy: i32| known[(y as i32 + dy) as usize * SIDE + (x as i32 + dx) as usize];
                (-4..=4).all(|dy| (-4..=4).all(|dx| at(dx, dy)))
            };
            let mask: Vec<bool> = (0..SIDE * SIDE)
                .map(|index| (index % SIDE, index / SIDE))
                .map(|(x, y)| (5..SIDE - 5).contains(&x) && (5..SIDE - 5).contains(&y) && inside(x, y))
                .collect();
            let (first, second) = (turned.tensor_field(&mask, 8.0), after.tensor_field(&mask, 8.0));
            let (mut real, mut imaginary, mut pixels) = (0.0, 0.0, 0);
            for index in (0..SIDE * SIDE).filter(|&index| mask[index]) {
                let (a, b) = (first[index], second[index]);
                real += a.0 * b.0 + a.1 * b.1;
                imaginary += a.0 * b.1 - a.1 * b.0;
                pixels += 1;
            }
            assert!(pixels > 5000);
            (0.5 * f64::atan2(imaginary, real)).to_degrees()
        };
        let (own, fault) = (error(false), error(true));
        println!(
            "roll {roll_deg}: streaks off by {own:.3} degrees; hanging still they would be off by {fault:.1}"
        );
        assert!(own.abs() <= 0.5, "roll {roll_deg}: streaks off by {own} degrees");
        assert!(fault.abs() > 2.0, "strokes that do not turn must show: {fault}");
    }
}

#[test]
fn egl_and_osmesa_draw_the_same_bytes() {
    let painting = prepare(shapes::loaded(two_bodies(), [shapes::sphere(32, 16), shapes::cube()])).unwrap();
    let frame = painting.at(0.0, &options([333, 187]));
    let (mut egl, mut osmesa) = (renderer(Driver::Egl), renderer(Driver::Osmesa));
    let (a, b) = (egl.render(&frame).unwrap(), osmesa.render(&frame).unwrap());
    assert!(a.rgba8.chunks(4).any(|pixel| pixel[0] > 200 && pixel[2] < 60), "there is paint to compare");
    assert!(a == b, "EGL and OSMesa differ");
    // The same frame again, after a frame of another size.
    egl.render(&painting.at(0.0, &options([64, 400]))).unwrap();
    assert!(egl.render(&frame).unwrap() == a, "what was drawn before must not matter");
    let mut other = frame.clone();
    other.strokes[0].angle_rad += 1.0;
    other.strokes.truncate(other.strokes.len() / 2);
    other.layers =
        vec![LayerRun { order: 0, kind: LayerKind::Body, first: 0, count: other.strokes.len() as u32 }];
    assert!(osmesa.render(&other).unwrap() != a, "the comparison must see a change");
}

#[test]
fn odd_sizes_and_empty_frames_are_drawn() {
    let mut renderer = renderer(Driver::Egl);
    let painting = prepare(shapes::loaded(two_bodies(), [shapes::sphere(16, 8), shapes::cube()])).unwrap();
    for size in [[1, 1], [1, 77], [501, 3], [211, 91], [90, 210]] {
        let picture = renderer.render(&painting.at(0.0, &options(size))).unwrap();
        assert_eq!(picture.rgba8.len(), (size[0] * size[1] * 4) as usize);
    }
    let empty = lone_strokes([32, 16], Vec::new(), WHITE);
    assert!(renderer.render(&empty).unwrap().rgba8.chunks(4).all(|pixel| pixel == [0, 0, 0, 255]));
    let mut clear = empty.clone();
    clear.background = None;
    assert!(renderer.render(&clear).unwrap().rgba8.iter().all(|&byte| byte == 0));
    let mut huge = empty.clone();
    huge.size_px = [1_000_000, 2];
    assert!(matches!(renderer.render(&huge), Err(RenderError::TooLarge { .. })));
    let mut plain = painting.at(0.0, &options([64, 36]));
    plain.style = Style::Reference;
    assert!(renderer.render(&plain).unwrap().rgba8.chunks(4).any(|pixel| pixel[0] == 255 && pixel[1] == 0));
}
