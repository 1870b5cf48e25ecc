//! Tests of steadiness from frame to frame: the measures of chatter, steps and flicker notice flashing and blinking;
//! strokes that turn are steadier than those at fixed angles; boil lets no stroke come or go, and keys let none pop;
//! light, background and palette follow their keys; and at an outline, paint covers as much of a pixel as the body that
//! it is on.

use std::collections::BTreeMap;
use std::sync::Arc;

use impasto_core::presence;
use impasto_gl_render::context::Driver;
use impasto_gl_render::{ReferencePixels, Renderer};
use impasto_measure::chatter::Chatter;
use impasto_measure::flicker::{Along, Flicker};
use impasto_measure::plane::Plane;
use impasto_measure::steps::{Shown, Steps};
use impasto_measure::strokes::{StrokeKey, StrokesByKey, strokes_by_key};
use impasto_measure::versions::SceneVersion;
use impasto_measure::warp::{correspondences, warp_error};
use impasto_painting::frame::LayerKind;
use impasto_painting::frame::{Frame, Stroke};
use impasto_painting::{FrameOptions, Painting, Rotation, prepare};
use impasto_scene::document::{
    BackgroundKey, Color, Ease, Edges, Light, LightKey, LightKind, ObjectKey, Scene, StrokesKey, Style,
};
use impasto_scene::loaded::LoadedScene;
use impasto_tests::pictures::renderer;
use impasto_tests::shapes;

const SIZE: [u32; 2] = [320, 180];

/// A ball that turns by a degree a frame.
fn ball(edit: impl FnOnce(&mut Scene)) -> Arc<LoadedScene> {
    let mut scene = shapes::scene(vec![shapes::object("sphere", 12_000)]);
    scene.timeline.last = 90;
    scene.camera.keys = vec![shapes::camera_key(0.0, [0.0, 0.9, 3.4], [0.0; 3])];
    let key = |frame: f64, y: f64| ObjectKey { rotation_deg: [12.0, y, 0.0], ..ObjectKey::at(frame) };
    scene.objects[0].keys = vec![key(0.0, 0.0), key(90.0, 90.0)];
    edit(&mut scene);
    shapes::loaded(scene, [shapes::sphere(32, 16)])
}

fn painted(loaded: &LoadedScene, version: SceneVersion) -> Painting {
    prepare(Arc::new(version.of(loaded, &[]))).unwrap()
}

struct Drawn {
    frame: Frame,
    luma: Plane,
    strokes: StrokesByKey,
    reference: ReferencePixels,
}

fn drawn(renderer: &mut Renderer, frame: Frame) -> Drawn {
    let luma = Plane::luma(&renderer.render(&frame).unwrap());
    let strokes = strokes_by_key(&frame, &renderer.resolved_strokes());
    Drawn { luma, strokes, reference: renderer.read_reference(), frame }
}

/// Over eight frames: chatter in percent, the number of steps, and flickering pixels in percent. `fault` may change the
/// frames with odd numbers.
fn found(painting: &Painting, fault: impl Fn(&mut Frame)) -> [f64; 3] {
    let mut renderer = renderer(Driver::Egl);
    let (mut chatter, mut steps, mut flicker) = (Chatter::default(), Steps::default(), Flicker::default());
    let frames: Vec<Drawn> = (20..28)
        .map(|number| {
            let mut frame = painting.at(f64::from(number), &FrameOptions::new(SIZE));
            if number % 2 == 1 {
                fault(&mut frame);
            }
            drawn(&mut renderer, frame)
        })
        .collect();
    for pair in frames.windows(2) {
        let [before, after] = [0, 1].map(|at| Shown {
            strokes: &pair[at].strokes,
            reference: &pair[at].reference,
            units_per_px_at_1: 0.003,
        });
        steps.add(0.0, before, after, SIZE);
    }
    for three in frames.windows(3) {
        chatter.add(0.0, [0, 1, 2].map(|at| &three[at].strokes), f64::from(SIZE[1]));
        let [before, after] = [0, 2].map(|at| {
            let motion = renderer.motion(&three[1].frame, &three[at].frame).unwrap();
            correspondences(&motion, &three[at].reference)
        });
        let lumas = [0, 1, 2].map(|at| three[at].luma.blurred_within(&three[at].reference.body_id, 1.0));
        flicker.add(0.0, lumas.each_ref(), &Along { before: &before, after: &after });
    }
    assert!(chatter.whole().of > 5000 && flicker.pixels > 50_000);
    let flickering = flicker.flickering as f64 / flicker.pixels as f64;
    [100.0 * chatter.whole().share(), steps.count(), 100.0 * flickering]
}

#[test]
fn chatter_steps_and_flicker_see_what_boils() {
    let painting = painted(&ball(|_| ()), SceneVersion::Board);
    let calm = found(&painting, |_| ());
    assert!(calm[0] < 1.0 && calm[1] == 0.0 && calm[2] < 1.0, "{calm:?}");
    // Flickering light changes all colours back and forth, but no stroke comes or goes.
    let flashing = found(&painting, |frame| {
        frame.lights.ambient_above *= 1.3;
        frame.lights.ambient_below *= 1.3;
        for sun in &mut frame.lights.suns {
            sun.radiance *= 1.3;
        }
    });
    assert!(flashing[0] > 20.0 && flashing[1] == 0.0 && flashing[2] > 20.0, "{flashing:?}");
    // Every tenth stroke blinks.
    let blinking = found(&painting, |frame| {
        for stroke in frame.strokes.iter_mut().step_by(10) {
            stroke.facing_fade = 0.0;
        }
    });
    assert!(blinking[1] > 100.0 && blinking[2] > calm[2], "{blinking:?}");
}

#[test]
fn fixed_angles_are_clearly_worse_over_several_frames() {
    // The ball turns nearly in the picture's plane, so its strokes do too.
    let loaded = ball(|scene| {
        let key = |frame: f64| ObjectKey { rotation_deg: [0.0, 0.0, frame], ..ObjectKey::at(frame) };
        scene.objects[0].keys = vec![key(0.0), key(90.0)];
        scene.strokes.color_jitter = Some(2.0);
    });
    let painting = painted(&loaded, SceneVersion::Unlit);
    let mut renderer = renderer(Driver::Egl);
    let mut error = |rotation: Rotation| {
        let options = FrameOptions { rotation, ..FrameOptions::new(SIZE) };
        let [now, then] = [20.0, 44.0].map(|at| drawn(&mut renderer, painting.at(at, &options)));
        let motion = renderer.motion(&now.frame, &then.frame).unwrap();
        let warp = warp_error(&now.luma, &then.luma, &correspondences(&motion, &then.reference));
        assert!(warp.pixels > 5000);
        warp.error
    };
    let (ours, fixed) = (error(Rotation::On), error(Rotation::Off));
    assert!(ours <= 0.8 * fixed, "{ours} {fixed}");
}

fn by_key(painting: &Painting, frame: f64) -> BTreeMap<StrokeKey, Stroke> {
    let frame = painting.at(frame, &FrameOptions::new(SIZE));
    let keys = frame.layers.iter().flat_map(|run| {
        (run.first as usize..(run.first + run.count) as usize).map(move |index| (run.kind, index))
    });
    keys.map(|(kind, index)| {
        let stroke = frame.strokes[index];
        (StrokeKey { body_id: stroke.body_id, kind, particle: frame.sources[index].particle }, stroke)
    })
    .collect()
}

#[test]
fn boil_lays_strokes_anew_on_twos_and_lets_none_come_or_go() {
    let still = |boil: Option<f64>| {
        let loaded = ball(|scene| {
            scene.objects[0].keys.clear();
            scene.strokes.boil = boil;
        });
        prepare(loaded).unwrap()
    };
    let (calm, boiling) = (still(None), still(Some(0.6)));
    let at = |frame: f64| by_key(&boiling, frame);
    assert_eq!(at(4.0), at(5.0), "a drawing holds for two frames");
    let (first, second, unmoved) = (at(5.0), at(6.0), by_key(&calm, 6.0));
    let (mut moved, mut recoloured, mut most_px, mut drifts) = (0, 0, 0.0f32, [0.0; 2]);
    for (key, stroke) in &unmoved {
        let (Some(before), Some(now)) = (first.get(key), second.get(key)) else { continue };
        assert_eq!((now.supply_ln, now.facing_fade), (stroke.supply_ln, stroke.facing_fade));
        let [dx, dy] = [0, 1].map(|axis| now.center_px[axis] - stroke.center_px[axis]);
        most_px = most_px.max(dx.hypot(dy) / stroke.length_px);
        moved += usize::from(before.center_px != now.center_px);
        // The lightness of a stroke changes a little, and its hue does not.
        assert_eq!(now.drift[1], stroke.drift[1]);
        recoloured += usize::from(before.drift[0] != now.drift[0]);
        drifts[0] += now.drift[0] * stroke.drift[0];
        drifts[1] += stroke.drift[0] * stroke.drift[0];
    }
    // Boil adds to the drift that a stroke has without boil.
    assert!(recoloured > 400 && (drifts[0] / drifts[1] - 1.0).abs() < 0.3, "{recoloured}, {drifts:?}");
    assert!(moved > 400 && first.len().abs_diff(unmoved.len()) < unmoved.len() / 20, "{moved}");
    assert!(most_px > 0.02 && most_px < 0.5, "{most_px}");
    // A scene that is prepared to be measured has no boil.
    let measured = painted(
        &ball(|scene| {
            scene.objects[0].keys.clear();
            scene.strokes.boil = Some(0.6);
        }),
        SceneVersion::Body,
    );
    assert_eq!(by_key(&measured, 5.0), by_key(&measured, 6.0));
}

#[test]
fn keys_of_strokes_let_them_come_and_go_by_rank_and_none_pops() {
    let loaded = ball(|scene| {
        scene.objects[0].keys.clear();
        scene.objects[0].particles = None;
        let small = StrokesKey { size: 0.5, ..StrokesKey::at(24.0) };
        scene.strokes.keys = vec![StrokesKey { ease: Ease::Smooth, ..StrokesKey::at(0.0) }, small];
    });
    let painting = prepare(loaded).unwrap();
    let frames: Vec<_> = (0..=24).map(|frame| by_key(&painting, f64::from(frame))).collect();
    let presence = |strokes: &BTreeMap<StrokeKey, Stroke>, key: &StrokeKey| {
        strokes.get(key).map_or(0.0, |stroke| stroke.presence())
    };
    let mut largest_step = 0.0f32;
    for pair in frames.windows(2) {
        for key in pair[0].keys().chain(pair[1].keys()) {
            largest_step = largest_step.max((presence(&pair[1], key) - presence(&pair[0], key)).abs());
        }
    }
    assert!(largest_step < 0.35, "{largest_step}");
    // Strokes half as long and half as wide are four times as many.
    let bodies = |strokes: &BTreeMap<StrokeKey, Stroke>| -> f32 {
        let of_body = strokes.iter().filter(|(key, _)| key.kind == LayerKind::Body);
        of_body.map(|(_, stroke)| presence::of_supply(stroke.supply_ln)).sum()
    };
    let times = bodies(&frames[24]) / bodies(&frames[0]);
    assert!((times - 4.0).abs() < 0.4, "{times}");
    let (key, before) = frames[0].iter().find(|(key, _)| frames[24].contains_key(key)).unwrap();
    assert_eq!(frames[24][key].angle_rad, before.angle_rad);
}

#[test]
fn light_background_and_palette_follow_their_keys() {
    let loaded = ball(|scene| {
        let hot = LightKey { intensity: Some(8.0), ..LightKey::at(10.0) };
        let sun = Light { direction: Some([0.0, -1.0, 0.0]), ..Light::new("sun", LightKind::Sun) };
        scene.lights =
            vec![Light { keys: vec![LightKey::at(0.0), hot], ..sun }, Light::new("sky", LightKind::Ambient)];
        let key = |frame, color| BackgroundKey { frame, color, ease: Ease::Linear };
        scene.background_keys = vec![key(0.0, Color([0.0; 3])), key(10.0, Color::white())];
        scene.strokes.palette = Some(vec![Color([1.0, 0.0, 0.0])]);
        scene.strokes.keys =
            vec![StrokesKey { palette_mix: 0.0, ..StrokesKey::at(0.0) }, StrokesKey::at(10.0)];
    });
    let painting = prepare(loaded).unwrap();
    let at = |frame: f64| painting.at(frame, &FrameOptions::new(SIZE));
    let [start, middle] = [at(0.0), at(5.0)];
    let sun = |frame: &Frame| frame.lights.suns[0].radiance.x;
    assert!((sun(&middle) / sun(&start) - 4.5).abs() < 1e-5);
    assert_eq!(start.background, Some([0.0; 3]));
    assert!((middle.background.unwrap()[1] - 0.5).abs() < 1e-5);
    assert_eq!((start.palettes[0].mix, middle.palettes[0].mix), (0.0, 0.5));
    // The picture follows: red paint comes with the palette.
    let redness = |frame: &Frame| {
        let picture = renderer(Driver::Egl).render(frame).unwrap();
        let [mut red, mut green] = [0.0, 0.0];
        for pixel in picture.rgba8.chunks_exact(4) {
            red += f64::from(pixel[0]);
            green += f64::from(pixel[1]);
        }
        red / green
    };
    let same = Frame { lights: start.lights.clone(), background: start.background, ..at(10.0) };
    let [bare, painted] = [&start, &same].map(redness);
    assert!(painted > 1.15 * bare, "{bare} {painted}");
}

#[test]
fn paint_covers_a_pixel_as_far_as_its_body_does() {
    let mut renderer = renderer(Driver::Egl);
    let mut partly_covered = |samples: u32| {
        let loaded = ball(|scene| {
            let Style::RotatingStrokes(style) = &mut scene.style else { panic!("strokes are the default") };
            style.samples = samples;
            scene.strokes.edges = Some(Edges::Clip);
        });
        let frame = prepare(loaded).unwrap().at(0.0, &FrameOptions::new(SIZE));
        renderer.render(&frame).unwrap();
        let (alpha, ids) = (renderer.read_paint(), renderer.read_reference().body_id);
        let inside = alpha.iter().zip(&ids).filter(|(_, id)| **id > 0);
        let (mut partly, mut whole) = (0, 0);
        for (paint, _) in inside {
            if paint[3] < 0.9 { partly += 1 } else { whole += 1 }
        }
        assert!(whole > 5000);
        partly
    };
    let [one, two, four] = [1, 2, 4].map(&mut partly_covered);
    assert!(two > one + 40 && four > one + 40, "{one} {two} {four}");
}

#[test]
fn a_picture_that_is_too_large_for_its_samples_has_one() {
    let loaded = ball(|_| ());
    let mut frame = prepare(loaded).unwrap().at(0.0, &FrameOptions::new(SIZE));
    frame.finish.samples = 2;
    assert_eq!(frame.samples(16_384), 2);
    assert_eq!(frame.samples(600), 1);
    frame.size_px = [8192, 8192];
    assert_eq!(frame.samples(16_384), 1);
}
