//! Tests of strokes before they are drawn: none pops, none changes its size with distance, and more particles leave the
//! first ones as they were.

use std::collections::BTreeMap;

use impasto_measure::popping as measure;
use impasto_measure::strokes::strokes_by_key;
use impasto_painting::frame::LayerKind;
use impasto_painting::{Frame, FrameOptions, prepare};
use impasto_scene::document::{ObjectKey, Scene, StrokeSettings};
use impasto_tests::shapes;

const OPTIONS: FrameOptions = FrameOptions::new([640, 360]);

/// The area of strokes that pop as a share of the area shown, and the largest step of presence. Nothing is drawn, so
/// occlusion has no effect.
fn popping(before: &Frame, after: &Frame) -> (f64, f64) {
    let found = measure::popping(&strokes_by_key(before, &[]), &strokes_by_key(after, &[]), OPTIONS.size_px);
    (found.share, found.largest_step)
}

fn turntable() -> Scene {
    let mut scene = shapes::scene(vec![shapes::object("sphere", 20_000)]);
    scene.timeline.last = 360;
    let key = |frame: f64, y: f64| ObjectKey {
        translation: [0.0; 3],
        rotation_deg: [12.0, y, 0.0],
        ..ObjectKey::at(frame)
    };
    scene.objects[0].keys = vec![key(0.0, 0.0), key(360.0, 360.0)];
    scene
}

#[test]
fn nothing_pops_on_a_turntable() {
    let painting = prepare(shapes::loaded(turntable(), [shapes::sphere(32, 16)])).unwrap();
    let mut largest = 0.0f64;
    let mut before = painting.at(0.0, &OPTIONS);
    for frame in 1..=40 {
        let after = painting.at(f64::from(frame), &OPTIONS);
        assert!(after.strokes.len() > 500);
        let (popped, step) = popping(&before, &after);
        assert_eq!(popped, 0.0, "frame {frame}");
        largest = largest.max(step);
        before = after;
    }
    println!("largest step of presence in 40 degrees: {largest:.3}");
}

#[test]
fn the_papers_own_rule_pops() {
    let mut scene = turntable();
    scene.strokes = StrokeSettings { preset: Some("paper".to_owned()), ..Default::default() };
    scene.regions.clear();
    let painting = prepare(shapes::loaded(scene, [shapes::sphere(32, 16)])).unwrap();
    let (mut sum, frames) = (0.0, 20);
    for frame in 0..frames {
        sum +=
            popping(&painting.at(f64::from(frame), &OPTIONS), &painting.at(f64::from(frame + 1), &OPTIONS)).0;
    }
    let percent = 100.0 * sum / f64::from(frames);
    println!("the paper's rule pops {percent:.2} % of the shown strokes a degree");
    assert!(percent > 0.5, "{percent} % a degree: this test should see the paper's popping");
}

#[test]
fn nothing_pops_on_a_zoom() {
    let mut scene = shapes::scene(vec![shapes::object("sphere", 60_000)]);
    scene.timeline.last = 200;
    scene.camera.keys = vec![
        shapes::camera_key(0.0, [0.0, 0.0, 16.0], [0.0; 3]),
        shapes::camera_key(200.0, [0.0, 0.0, 16.0], [0.0; 3]),
    ];
    // The camera comes one percent closer per frame.
    for frame in 0..=200 {
        let distance = 16.0 * 0.99f64.powi(frame);
        let key = shapes::camera_key(f64::from(frame), [0.0, 0.0, distance], [0.0; 3]);
        if frame < 200 && frame > 0 {
            scene.camera.keys.insert(frame as usize, key);
        } else {
            scene.camera.keys[if frame == 0 { 0 } else { frame as usize }] = key;
        }
    }
    let painting = prepare(shapes::loaded(scene, [shapes::sphere(32, 16)])).unwrap();
    for frame in [0.0, 40.0, 90.0, 150.0] {
        let (popped, largest) = popping(&painting.at(frame, &OPTIONS), &painting.at(frame + 1.0, &OPTIONS));
        assert_eq!(popped, 0.0, "frame {frame}: largest step {largest}");
    }
}

#[test]
fn strokes_keep_their_size_from_1_to_100() {
    let mut scene = shapes::scene(vec![shapes::object("sphere", 3000)]);
    scene.strokes.size_jitter = Some(0.2);
    scene.timeline.last = 3;
    let distances = [2.5, 10.0, 40.0, 99.0];
    scene.camera.keys = distances
        .iter()
        .enumerate()
        .map(|(frame, &distance)| shapes::camera_key(frame as f64, [0.0, 0.0, distance], [0.0; 3]))
        .collect();
    let painting = prepare(shapes::loaded(scene, [shapes::sphere(32, 16)])).unwrap();
    let sizes = |frame: f64| -> BTreeMap<(LayerKind, u32), (f32, f32)> {
        let frame = painting.at(frame, &OPTIONS);
        let run_of =
            |index: usize| frame.layers.iter().find(|run| (run.first + run.count) as usize > index).unwrap();
        (0..frame.strokes.len())
            .map(|index| {
                let stroke = &frame.strokes[index];
                ((run_of(index).kind, frame.sources[index].particle), (stroke.length_px, stroke.width_px))
            })
            .collect()
    };
    let near = sizes(0.0);
    let mut compared = 0;
    for frame in [1.0, 2.0, 3.0] {
        for (key, size) in sizes(frame) {
            if let Some(near) = near.get(&key) {
                assert_eq!(size, *near, "a stroke's size in pixels must not depend on its distance");
                compared += 1;
            }
        }
    }
    assert!(compared >= 20, "{compared} strokes seen both near and far");
}

#[test]
fn twice_the_particles_keep_the_first_and_their_looks() {
    let frame = |particles: u64| {
        let mut scene = shapes::scene(vec![shapes::object("sphere", particles)]);
        scene.strokes.size_jitter = Some(0.2);
        scene.strokes.angle_jitter_deg = Some(10.0);
        prepare(shapes::loaded(scene, [shapes::sphere(32, 16)])).unwrap().at(0.0, &OPTIONS)
    };
    let (few, many) = (frame(4000), frame(8000));
    let versions = |frame: &Frame| -> BTreeMap<(LayerKind, u32), _> {
        let strokes = frame.layers.iter().flat_map(|run| {
            (run.first as usize..(run.first + run.count) as usize).map(move |index| (run.kind, index))
        });
        strokes.map(|(kind, index)| ((kind, frame.sources[index].particle), frame.strokes[index])).collect()
    };
    let (few, many) = (versions(&few), versions(&many));
    assert!(few.len() > 500);
    for (key, stroke) in few {
        assert_eq!(many.get(&key), Some(&stroke));
    }
}
