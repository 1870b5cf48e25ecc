//! Tests the reach of openness, which is the ambient occlusion of the plain render. Its radius is 5.5 % of the
//! picture's height, and its outermost taps lie up to 0.83 radii to either side: a wall at 0.65 radii must darken the
//! floor, one at 1 must not.

use impasto_gl_render::Renderer;
use impasto_gl_render::context::Driver;
use impasto_painting::{FrameOptions, prepare};
use impasto_scene::document::{Color, Lens, Light, LightKind, ObjectKey, Scale, Style};
use impasto_tests::pictures::{Grey, faulty_renderer, renderer};
use impasto_tests::shapes;

const SIDE_PX: u32 = 360;
/// The height of the picture in world units.
const HEIGHT: f64 = 2.0;
const RADIUS: f64 = 0.055 * HEIGHT;

/// The light, 0..255, on the middle line of a canyon's floor when light comes from all around. The canyon's walls are
/// `half_width` radii away from that line and 0.45 radii high.
fn light_in_a_canyon(renderer: &mut Renderer, half_width: f64) -> f64 {
    let names = ["floor", "left", "right"];
    let mut scene = shapes::scene(names.map(|name| shapes::object(name, 100)).into());
    scene.style = Style::Reference;
    scene.strokes.layers = shapes::body_layer_alone();
    scene.camera.lens = Lens::Orthographic { height: HEIGHT, near: 0.1, far: 20.0 };
    scene.lights =
        vec![Light { ground: Some(Color::white()), intensity: 1.0, ..Light::new("sky", LightKind::Ambient) }];
    const BLOCK: f64 = 0.4;
    let beside = half_width * RADIUS + BLOCK;
    scene.objects[0].keys = vec![ObjectKey { scale: Scale::even(1.5), ..ObjectKey::at(0.0) }];
    for (object, x) in scene.objects[1..].iter_mut().zip([-beside, beside]) {
        let translation = [x, 0.0, 0.45 * RADIUS - BLOCK];
        object.keys = vec![ObjectKey { translation, scale: Scale::even(BLOCK), ..ObjectKey::at(0.0) }];
    }
    let meshes = [shapes::sheet(1), shapes::cube(), shapes::cube()];
    let painting = prepare(shapes::loaded(scene, meshes)).unwrap();
    let picture = renderer.render(&painting.at(0.0, &FrameOptions::new([SIDE_PX; 2]))).unwrap();
    let middle = SIDE_PX as usize / 2;
    assert_eq!(renderer.read_reference().body_id[middle * SIDE_PX as usize + middle], 1, "no floor shows");
    let grey = Grey::of(&picture);
    (middle - 20..middle + 20).map(|y| grey.at(middle, y)).sum::<f64>() / 40.0
}

/// How much light, of 255, walls at 0.25, 0.65 and 1 radii take from the floor between them.
fn darkening(renderer: &mut Renderer) -> [f64; 3] {
    let open = light_in_a_canyon(renderer, 3.0);
    [0.25, 0.65, 1.0].map(|half_width| open - light_in_a_canyon(renderer, half_width))
}

#[test]
fn surroundings_darken_as_far_as_the_radius_and_no_farther() {
    let [near, middle, beyond] = darkening(&mut renderer(Driver::Egl));
    assert!(near > 20.0, "walls at a quarter of the radius hardly darken the floor: {near}");
    assert!(middle > 4.0, "openness does not look as far as its radius: {middle}");
    assert!(beyond.abs() < 0.5, "openness looks farther than its radius: {beyond}");
    // Planted faults: a radius a quarter as large, and one that is too large.
    let planted =
        |radius: &str| darkening(&mut faulty_renderer("reference/openness.frag", "RADIUS = 0.055", radius));
    let [_, middle, _] = planted("RADIUS = 0.055 / 4.0");
    assert!(middle < 1.0, "the test does not notice openness that looks a quarter as far: {middle}");
    let [_, _, beyond] = planted("RADIUS = 0.055 * 1.5");
    assert!(beyond > 2.0, "the test does not notice openness that looks too far: {beyond}");
}
