//! Tests of the colours of strokes, from strokes read back: where another part of their own body covers them, along the
//! border between two colours, and over a thin strip of light.

use std::collections::HashMap;

use glam::DVec3;
use impasto_gl_render::context::Driver;
use impasto_painting::frame::Stroke;
use impasto_painting::{FrameOptions, Painting, prepare};
use impasto_scene::document::{Lens, Light, LightKind, MaterialOverride, Scene, Style};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::mesh_file::{Material, MeshFile};
use impasto_tests::pictures::renderer;
use impasto_tests::shapes;

/// A white sheet and, behind it, a black strip of the same body at 45 degrees to the gaze. The strip is 0.09 to 0.15
/// units farther away than the sheet, which would be 13 to 21 pixels along the sheet. No pixel shows the strip. The
/// left border of the picture cuts both.
fn strip_behind_a_sheet() -> LoadedScene {
    let mut mesh = shapes::sheet(8);
    let to_strip = |at: DVec3| DVec3::new(0.8 * at.x, 0.3 + 0.03 * at.y, -0.12 + 0.03 * at.y);
    let mut strip = shapes::moved(&shapes::sheet(8), to_strip);
    let vertices = mesh.positions.len() as u32;
    mesh.material_of_triangle = vec![0; mesh.triangles.len()];
    mesh.material_of_triangle.resize(mesh.triangles.len() + strip.triangles.len(), 1);
    let polygons = mesh.polygon_of_triangle.iter().max().map_or(0, |last| last + 1);
    mesh.polygon_of_triangle.extend(strip.polygon_of_triangle.iter().map(|polygon| polygon + polygons));
    mesh.group_of_triangle.append(&mut strip.group_of_triangle);
    mesh.triangles.extend(strip.triangles.iter().map(|corners| corners.map(|corner| corner + vertices)));
    mesh.positions.append(&mut strip.positions);
    mesh.normals.append(&mut strip.normals);
    mesh.uvs.append(&mut strip.uvs);

    let mut pot = shapes::object("pot", 20_000);
    pot.material = Some(MaterialOverride { unlit: true, ..Default::default() });
    let mut scene = shapes::scene(vec![pot]);
    scene.camera.keys = vec![shapes::camera_key(0.0, [2.74, 0.0, 4.0], [2.74, 0.0, 0.0])];
    let mut loaded = LoadedScene::clone(&shapes::loaded(scene, [mesh]));
    for file in loaded.meshes.values_mut() {
        let mut painted = MeshFile::clone(file);
        painted.materials = vec![
            Material::plain("sheet".to_owned(), [1.0; 3]),
            Material::plain("strip".to_owned(), [0.0; 3]),
        ];
        *file = painted.into();
    }
    loaded
}

#[test]
fn a_covered_stroke_has_the_colour_that_is_seen_also_where_its_middle_is_beyond_the_picture() {
    let mut renderer = renderer(Driver::Egl);
    let painting = prepare(strip_behind_a_sheet().into()).unwrap();
    let frame = painting.at(0.0, &FrameOptions::new([640, 360]));
    renderer.render(&frame).unwrap();
    let [mut inside, mut beyond] = [0, 0];
    for (stroke, resolved) in frame.strokes.iter().zip(renderer.resolved_strokes()) {
        if stroke.normal_in_world[2] > 0.9 || resolved.alpha < 0.05 {
            continue;
        }
        let green = resolved.color_linear[1];
        assert!(green > 0.8, "{green} at {:?}", stroke.center_px);
        // If a stroke's middle is left of -4 px, the circle round it whose radius is half the stroke's width also lies
        // wholly beyond the picture.
        *if stroke.center_px[0] < -4.0 { &mut beyond } else { &mut inside } += 1;
    }
    assert!(inside > 20 && beyond > 5, "{inside} strokes inside, {beyond} beyond");
}

/// The largest change of a stroke's green from one frame to the next, among the strokes on the first object for whose
/// centre `near` holds.
fn largest_step(painting: &Painting, near: impl Fn([f32; 2]) -> bool) -> f32 {
    let mut renderer = renderer(Driver::Egl);
    let mut before: HashMap<_, f32> = HashMap::new();
    let mut largest = 0.0f32;
    for number in 0..=16 {
        let frame = painting.at(f64::from(number), &FrameOptions::new([640, 360]));
        renderer.render(&frame).unwrap();
        let resolved = renderer.resolved_strokes();
        let counts = |stroke: &Stroke| stroke.body_id == 1 && near(stroke.center_px);
        let now: HashMap<_, f32> = frame
            .sources
            .iter()
            .zip(&frame.strokes)
            .zip(&resolved)
            .filter(|((_, stroke), drawn)| counts(stroke) && drawn.alpha > 0.05)
            .map(|((source, _), drawn)| ((source.place, source.particle), drawn.color_linear[1]))
            .collect();
        let steps = now.iter().filter_map(|(source, green)| Some((green - before.get(source)?).abs()));
        largest = steps.fold(largest, f32::max);
        before = now;
    }
    largest
}

fn with_samples(scene: &mut Scene, samples: u32) {
    let Style::RotatingStrokes(settings) = &mut scene.style else { panic!("strokes are the default") };
    settings.samples = samples;
    scene.strokes.layers = shapes::body_layer_alone();
}

/// The largest change of a stroke's green in one step, while the camera moves by two pixels in sixteen steps over a
/// sheet that is black on the left and white on the right. Pixels have `samples` samples a side.
fn largest_step_along_a_border(samples: u32) -> f32 {
    let mut board = shapes::object("board", 3000);
    board.material = Some(MaterialOverride { unlit: true, ..Default::default() });
    let mut scene = shapes::scene(vec![board]);
    scene.camera.lens = Lens::Orthographic { height: 3.0, near: 0.05, far: 100.0 };
    scene.timeline.last = 16;
    scene.camera.keys = [0.0, 16.0]
        .map(|frame| {
            let x = frame / 8.0 / 120.0;
            shapes::camera_key(frame, [x, 0.0, 4.0], [x, 0.0, 0.0])
        })
        .into();
    with_samples(&mut scene, samples);
    let mut loaded = LoadedScene::clone(&shapes::loaded(scene, [shapes::sheet(2)]));
    for file in loaded.meshes.values_mut() {
        let mut painted = MeshFile::clone(file);
        painted.materials =
            vec![Material::plain("left".to_owned(), [0.0; 3]), Material::plain("right".to_owned(), [1.0; 3])];
        for triangle in 0..painted.mesh.triangles.len() {
            let [a, b, c] = painted.mesh.corners(triangle);
            painted.mesh.material_of_triangle[triangle] = u32::from((a + b + c).x > 0.0);
        }
        *file = painted.into();
    }
    largest_step(&prepare(loaded.into()).unwrap(), |[x, _]| (x - 320.0).abs() < 20.0)
}

/// With one sample a pixel, the border moves by a whole pixel at once; with 2 × 2 samples, by half a pixel.
#[test]
fn a_border_between_two_colours_moves_within_pixels() {
    let [coarse, fine] = [1, 2].map(largest_step_along_a_border);
    assert!(coarse > 0.1, "the border is hardly seen: {coarse}");
    assert!(fine < 0.6 * coarse, "a stroke's colour leaps by {fine}, with one sample by {coarse}");
}

/// The largest change of a stroke's green in one step, while the camera rises over a floor seen at a grazing angle. Two
/// roofs shade the floor, except for a strip between them that is 0.8 pixels high in the picture.
fn largest_step_along_a_strip_of_light(samples: u32) -> f32 {
    let flat = |near: f64, far: f64, y: f64| {
        shapes::moved(&shapes::sheet(4), move |at| {
            DVec3::new(6.0 * at.x, y, 0.5 * (near + far) + 0.5 * (near - far) * -at.y)
        })
    };
    let mut scene = shapes::scene(vec![
        shapes::object("floor", 3000),
        shapes::object("near roof", 1),
        shapes::object("far roof", 1),
    ]);
    scene.lights = vec![Light {
        direction: Some([0.0, -1.0, 0.0]),
        intensity: 4.0,
        ..Light::new("sun", LightKind::Sun)
    }];
    scene.timeline.last = 16;
    scene.camera.keys = [0.0, 16.0]
        .map(|frame| {
            // The horizon stays, and the ground moves down by a few pixels.
            let y = 0.5 + frame / 16.0 * 0.05;
            shapes::camera_key(frame, [0.0, y, 4.0], [0.0, y, 0.0])
        })
        .into();
    with_samples(&mut scene, samples);
    let meshes = [flat(3.0, -6.0, 0.0), flat(3.0, -1.0, 2.0), flat(-1.07, -6.0, 2.0)];
    largest_step(&prepare(shapes::loaded(scene, meshes)).unwrap(), |[_, y]| (y - 120.0).abs() < 12.0)
}

/// A strip of light is thinner than a pixel. With 4 × 4 samples, the more of a pixel it covers, the lighter it makes
/// the pixel. With one sample it lights some pixels wholly, and others not at all.
#[test]
fn a_thin_strip_of_light_stays_even() {
    let [coarse, fine] = [1, 4].map(largest_step_along_a_strip_of_light);
    assert!(coarse > 0.03, "the strip is hardly seen: {coarse}");
    assert!(fine < 0.7 * coarse, "a stroke's colour leaps by {fine}, with one sample by {coarse}");
}
