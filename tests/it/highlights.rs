//! Tests of the strokes of highlights, and of the strokes below them.

use impasto_gl_render::Renderer;
use impasto_gl_render::context::Driver;
use impasto_painting::frame::{LayerKind, Style};
use impasto_painting::{FrameOptions, prepare};
use impasto_scene::document::{Color, Light, LightKind, MaterialOverride};
use impasto_tests::pictures::renderer;
use impasto_tests::shapes;

const SIZE_PX: [u32; 2] = [640, 360];

/// A grey ball as it is seen in the light of one sun behind the eye. All values of green are linear.
struct Seen {
    /// The green of the brightest pixel of the plain render.
    plain: f32,
    /// The green of the brightest stroke of the layers of body, form and accents.
    below: f32,
    /// Of all strokes of highlights, the brightest green and the greatest alpha.
    highlight: [f32; 2],
}

fn ball(renderer: &mut Renderer, gloss: f64, distance: f64) -> Seen {
    let mut ball = shapes::object("ball", 20_000);
    ball.material =
        Some(MaterialOverride { color: Some(Color([0.35; 3])), gloss: Some(gloss), ..Default::default() });
    let mut scene = shapes::scene(vec![ball]);
    scene.background = Color([0.0; 3]);
    scene.camera.keys = vec![shapes::camera_key(0.0, [0.0, 0.0, distance], [0.0; 3])];
    scene.lights = vec![Light { direction: Some([0.2, -0.3, -1.0]), ..Light::new("sun", LightKind::Sun) }];
    (scene.strokes.color_jitter, scene.strokes.grading) = (Some(0.0), Some(0.0));
    let painting = prepare(shapes::loaded(scene, [shapes::sphere(64, 32)])).unwrap();
    let mut frame = painting.at(0.0, &FrameOptions::new(SIZE_PX));
    renderer.render(&frame).unwrap();
    let resolved = renderer.resolved_strokes();
    let of = |kinds: &[LayerKind]| {
        let runs = frame.layers.iter().filter(|run| kinds.contains(&run.kind));
        let strokes = runs.flat_map(|run| &resolved[run.first as usize..(run.first + run.count) as usize]);
        strokes.filter(|stroke| stroke.alpha > 0.1).fold([0.0, 0.0], |most: [f32; 2], stroke| {
            [most[0].max(stroke.color_linear[1]), most[1].max(stroke.alpha)]
        })
    };
    let below = of(&[LayerKind::Body, LayerKind::Form, LayerKind::Accents])[0];
    let highlight = of(&[LayerKind::Lights]);
    frame.style = Style::Reference;
    let picture = renderer.render(&frame).unwrap();
    let brightest = picture.rgba8.chunks_exact(4).map(|pixel| pixel[1]).max().unwrap();
    let plain = impasto_core::color::linear_from_srgb(f32::from(brightest) / 255.0);
    Seen { plain, below, highlight }
}

/// Strokes below a highlight show only a part of it, so they stay calm when it passes. Its own strokes show all of it.
#[test]
fn strokes_below_a_highlight_have_a_part_of_it_and_its_own_strokes_all() {
    let mut renderer = renderer(Driver::Egl);
    let matt = ball(&mut renderer, 0.0, 4.0);
    let glazed = ball(&mut renderer, 0.5, 4.0);
    let whole = glazed.plain - matt.plain;
    assert!(whole > 0.15, "the highlight is hardly seen: {whole}");
    let below = (glazed.below - matt.below) / whole;
    assert!((0.3..0.7).contains(&below), "strokes below have {below} of it");
    let own = (glazed.highlight[0] - matt.plain) / whole;
    assert!(own > 0.9, "its own strokes have {own} of it");
}

/// A highlight that grows as it passes over a bump must not flare up. So strokes of a small highlight are about as
/// strong as those of a large one.
#[test]
fn strokes_of_a_small_highlight_are_about_as_strong_as_those_of_a_large_one() {
    let mut renderer = renderer(Driver::Egl);
    let [large, small] = [4.0, 7.0].map(|distance| ball(&mut renderer, 0.5, distance).highlight[1]);
    assert!(small > 0.6 * large && large > 0.3, "{small} where it is small, {large} where it is large");
}

/// The faint sheen of plaster is not painted as a highlight. The strokes below keep nearly all of it.
#[test]
fn a_faint_sheen_has_no_strokes_of_its_own_and_stays_in_those_below() {
    let mut renderer = renderer(Driver::Egl);
    let matt = ball(&mut renderer, 0.0, 4.0);
    let plaster = ball(&mut renderer, 0.1, 4.0);
    let whole = plaster.plain - matt.plain;
    assert!(whole > 0.03, "the sheen is hardly seen: {whole}");
    let below = (plaster.below - matt.below) / whole;
    assert!(below > 0.8, "strokes below have {below} of it");
    assert!(plaster.highlight[1] == 0.0, "a stroke of highlights is there by {}", plaster.highlight[1]);
}
