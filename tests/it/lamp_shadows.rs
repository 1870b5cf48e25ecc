//! Tests of the shadow that the brightest lamp casts where there is no sun. Where a ball's shadow ends on a floor is
//! known from geometry.

use impasto_aovs::{Drawn, read};
use impasto_frame_files::exr_file::Samples;
use impasto_gl_render::Renderer;
use impasto_gl_render::context::Driver;
use impasto_painting::{FrameOptions, prepare};
use impasto_scene::aovs::AovSet;
use impasto_scene::document::{Lens, Light, LightKind, ObjectKey, Scale};
use impasto_tests::pictures::renderer;
use impasto_tests::shapes;

const SIDE_PX: u32 = 400;
/// The height of the picture in world units.
const HEIGHT: f64 = 4.0;

/// The share of the light that arrives at places (x, y) of a floor at z = 0. A ball of radius 0.3 hangs over it at
/// z = 0.6.
fn shadow_at(renderer: &mut Renderer, lights: Vec<Light>, places: &[[f64; 2]]) -> Vec<f32> {
    let mut scene = shapes::scene(["floor", "ball"].map(|name| shapes::object(name, 100)).into());
    scene.camera.lens = Lens::Orthographic { height: HEIGHT, near: 0.1, far: 20.0 };
    scene.strokes.layers = shapes::body_layer_alone();
    scene.lights = lights;
    scene.objects[0].keys = vec![ObjectKey { scale: Scale::even(3.0), ..ObjectKey::at(0.0) }];
    let ball = ObjectKey { translation: [0.0, 0.0, 0.6], scale: Scale::even(0.3), ..ObjectKey::at(0.0) };
    scene.objects[1].keys = vec![ball];
    let painting = prepare(shapes::loaded(scene, [shapes::sheet(4), shapes::sphere(64, 32)])).unwrap();
    let options = FrameOptions::new([SIDE_PX; 2]);
    let frame = painting.at(0.0, &options);
    renderer.render(&frame).unwrap();
    let wanted = AovSet::of_words(["shadow"]).unwrap();
    let found =
        read(renderer, &Drawn { painting: &painting, frame: &frame, number: 0.0, options: &options, wanted });
    let plane = found.unwrap().channels.into_iter().find(|channel| channel.name == "shadow.X").unwrap();
    let Samples::Half(values) = plane.samples else { panic!("shadow has another type") };
    let px = |along: f64| (f64::from(SIDE_PX) * (0.5 + along / HEIGHT)) as usize;
    places.iter().map(|&[x, y]| values[px(-y) * SIDE_PX as usize + px(x)].to_f32()).collect()
}

fn lamp(kind: LightKind, position: [f64; 3]) -> Light {
    Light { position: Some(position), intensity: 9.0, ..Light::new("lamp", kind) }
}

#[test]
fn a_ball_casts_the_shadow_that_geometry_says() {
    let mut renderer = renderer(Driver::Auto);
    // Seen from the lamp at (1.2, 0, 1.8), the ball's middle lies in front of the place (−0.6, 0), which is 2.546 away.
    // The ball's radius spans asin(0.3 / 1.697) = 10.18°, so the shadow ends 2.546 tan(10.18°) = 0.457 to either side.
    let near = [1.2, 0.0, 1.8];
    let spot = Light {
        direction: Some([-0.4, 0.0, -1.0]),
        cone_deg: Some([50.0, 60.0]),
        ..lamp(LightKind::Spot, near)
    };
    let places =
        [[-0.6, 0.0], [-0.6, 0.40], [-0.6, -0.40], [-0.6, 0.51], [-0.6, -0.51], [0.6, 0.0], [-0.6, 1.4]];
    for light in [lamp(LightKind::Point, near), spot] {
        let found = shadow_at(&mut renderer, vec![light.clone()], &places);
        let dark = found[..3].iter().all(|&arrives| arrives < 0.05);
        let lit = found[3..].iter().all(|&arrives| arrives > 0.95);
        assert!(dark && lit, "{:?}: {found:?}", light.kind);
    }
    // From far away the shadow is nearly that of a sun: it reaches 0.3 to either side of its middle at (−0.6, 0).
    let places = [[-0.6, 0.0], [-0.6, 0.26], [-0.6, 0.36], [-0.6, -0.36], [0.0, 1.0]];
    let far = shadow_at(&mut renderer, vec![lamp(LightKind::Point, [30.0, 0.0, 30.6])], &places);
    assert!(
        far[..2].iter().all(|&arrives| arrives < 0.05) && far[2..].iter().all(|&arrives| arrives > 0.95),
        "{far:?}"
    );
}

#[test]
fn a_sun_casts_the_only_shadow_and_the_brightest_lamp_where_there_is_none() {
    let mut renderer = renderer(Driver::Auto);
    let places = [[-0.6, 0.0], [0.6, 0.0]];
    let from_right = lamp(LightKind::Point, [1.2, 0.0, 1.8]);
    let from_left = Light {
        intensity: 30.0,
        ..Light { name: "left".into(), ..lamp(LightKind::Point, [-1.2, 0.0, 1.8]) }
    };
    let two = shadow_at(&mut renderer, vec![from_right.clone(), from_left], &places);
    assert!(two[0] > 0.95 && two[1] < 0.05, "{two:?}");
    // The sun stands straight above: its shadow is under the ball.
    let sun = Light { direction: Some([0.0, 0.0, -1.0]), ..Light::new("sun", LightKind::Sun) };
    let with_sun = shadow_at(&mut renderer, vec![from_right, sun], &places);
    assert!(with_sun.iter().all(|&arrives| arrives > 0.95), "{with_sun:?}");
}
