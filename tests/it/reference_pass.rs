//! Tests of the reference pass, which finds and lights surfaces for every style: sheets seen from behind, holes, and
//! parallel rays.

use std::sync::Arc;

use impasto_gl_render::context::Driver;
use impasto_gl_render::{Picture, Renderer};
use impasto_painting::{FrameOptions, prepare};
use impasto_scene::document::{
    Color, Lens, Light, LightKind, MaterialOverride, Object, ObjectKey, Scale, Scene, Style,
};
use impasto_scene::loaded::LoadedScene;
use impasto_tests::pictures::{Grey, renderer};
use impasto_tests::shapes;

const SIZE_PX: [u32; 2] = [320, 180];
/// The height of the picture in world units.
const HEIGHT: f64 = 2.5;
const PARALLEL: Lens = Lens::Orthographic { height: HEIGHT, near: 0.1, far: 20.0 };

/// A scene of one object for a plain render, in the light of a sun that shines along `sunshine`.
fn plain(object: Object, sunshine: [f64; 3]) -> Scene {
    let mut scene = shapes::scene(vec![object]);
    scene.size = (SIZE_PX[0], SIZE_PX[1]);
    scene.style = Style::Reference;
    scene.background = Color([0.0; 3]);
    scene.camera.lens = PARALLEL;
    scene.strokes.layers = shapes::body_layer_alone();
    scene.lights = vec![Light { direction: Some(sunshine), ..Light::new("sun", LightKind::Sun) }];
    scene
}

fn drawn(renderer: &mut Renderer, loaded: Arc<LoadedScene>) -> Picture {
    renderer.render(&prepare(loaded).unwrap().at(0.0, &FrameOptions::new(SIZE_PX))).unwrap()
}

/// A sheet seen and lit from behind is as bright as one seen and lit from the front, at any slant of the light.
#[test]
fn the_back_of_a_sheet_is_lit_as_its_front() {
    let mut renderer = renderer(Driver::Egl);
    let mut middle = |side: f64, sunshine: [f64; 3]| {
        let mut scene = plain(shapes::object("sheet", 100), sunshine);
        scene.camera.keys = vec![shapes::camera_key(0.0, [0.0, 0.0, 4.0 * side], [0.0; 3])];
        let picture = drawn(&mut renderer, shapes::loaded(scene, [shapes::sheet(1)]));
        Grey::of(&picture).at(160, 90)
    };
    for across in [0.0, 0.7] {
        let front = middle(1.0, [across, 0.0, -1.0]);
        let back = middle(-1.0, [-across, 0.0, 1.0]);
        assert!(front > 80.0, "the front is not lit: {front}");
        assert!((front - back).abs() < 1.0, "the front is {front}, the back {back}");
        // Light on the far side does not shine through.
        for (side, sunshine) in [(1.0, [across, 0.0, 1.0]), (-1.0, [across, 0.0, -1.0])] {
            let from_beyond = middle(side, sunshine);
            assert!(from_beyond < 1.0, "light shines through: {from_beyond}");
        }
    }
}

/// The alpha of the sheet's texture rises from 0 at the left to 1 at the right. The sheet is there where alpha is at
/// least the material's cutoff.
#[test]
fn a_hole_ends_where_alpha_is_the_cutoff() {
    const TEXELS: u32 = 256;
    let mut renderer = renderer(Driver::Egl);
    for cutoff in [0.2, 0.5, 0.9] {
        let scene = plain(shapes::object("sheet", 100), [0.0, 0.0, -1.0]);
        let loaded = shapes::loaded(scene, [shapes::sheet(1)]);
        drawn(&mut renderer, shapes::with_holes(&loaded, cutoff as f32));
        let ids = renderer.read_reference().body_id;
        // A texel has its own alpha at its centre. Between two centres alpha is interpolated linearly.
        let share = (cutoff * f64::from(TEXELS - 1) + 0.5) / f64::from(TEXELS);
        let px_per_unit = f64::from(SIZE_PX[1]) / HEIGHT;
        let first = 160.0 + px_per_unit * (2.0 * share - 1.0);
        for y in [30, 90, 150] {
            for x in 0..SIZE_PX[0] as usize {
                let at = x as f64 + 0.5;
                let is_there = ids[y * SIZE_PX[0] as usize + x] != 0;
                if (at - first).abs() > 0.6 {
                    let wanted = at > first && at < 160.0 + px_per_unit;
                    assert_eq!(is_there, wanted, "cutoff {cutoff}: at {x}, {y}, {} px off", at - first);
                }
            }
        }
    }
}

/// How much light a ball's gloss adds to each pixel, 0..255.
fn highlight(renderer: &mut Renderer, lens: &Lens, distance: f64) -> Vec<f64> {
    let [glazed, matt] = [1.0, 0.0].map(|gloss| {
        let mut ball = shapes::object("ball", 100);
        ball.keys = vec![ObjectKey { scale: Scale::even(1.1), ..ObjectKey::at(0.0) }];
        // Dark, so that the soft shoulder for bright light does not compress the highlight.
        ball.material = Some(MaterialOverride {
            color: Some(Color([0.15; 3])),
            gloss: Some(gloss),
            ..MaterialOverride::default()
        });
        let mut scene = plain(ball, [-0.5, -0.3, -0.4]);
        scene.camera.lens = lens.clone();
        scene.camera.keys = vec![shapes::camera_key(0.0, [0.0, 0.0, distance], [0.0; 3])];
        Grey::of(&drawn(renderer, shapes::loaded(scene, [shapes::sphere(64, 32)]))).values
    });
    glazed.iter().zip(&matt).map(|(glazed, matt)| glazed - matt).collect()
}

/// A highlight depends on where the eye is. In parallel rays it is the same as for an eye far away.
#[test]
fn a_highlight_in_parallel_rays_is_that_for_a_far_eye() {
    const FAR: f64 = 400.0;
    let mut renderer = renderer(Driver::Egl);
    let fov_y_deg = 2.0 * (0.5 * HEIGHT / FAR).atan().to_degrees();
    let far =
        highlight(&mut renderer, &Lens::Perspective { fov_y_deg, near: FAR - 10.0, far: FAR + 10.0 }, FAR);
    let parallel = highlight(&mut renderer, &PARALLEL, 4.0);
    let brightest = far.iter().copied().fold(0.0, f64::max);
    assert!(brightest > 40.0, "there is no highlight to compare: {brightest}");
    let [of_far, of_parallel] = [&far, &parallel].map(|picture| picture.iter().sum::<f64>());
    assert!((of_parallel / of_far - 1.0).abs() < 0.02, "{of_parallel} in parallel rays, {of_far} from afar");
    let off: f64 = far.iter().zip(&parallel).map(|(far, parallel)| (far - parallel).abs()).sum();
    assert!(off < 0.05 * of_far, "the highlight lies elsewhere: {off} of {of_far}");
}
