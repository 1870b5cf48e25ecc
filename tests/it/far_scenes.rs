//! Tests that a scene far from the world's origin is painted like the same scene at the origin.

use glam::DVec3;
use impasto_gl_render::Renderer;
use impasto_gl_render::context::Driver;
use impasto_painting::{FrameOptions, prepare};
use impasto_scene::document::{Light, LightKind, ObjectKey, Scale};
use impasto_tests::pictures::renderer;
use impasto_tests::shapes;

/// The pictures (RGBA) of two frames of a ball before a tilted sheet under a lamp, all moved by `by`.
fn painted(renderer: &mut Renderer, by: DVec3) -> Vec<Vec<u8>> {
    let at = |place: [f64; 3]| (DVec3::from(place) + by).to_array();
    let mut scene = shapes::scene(["sheet", "ball"].map(|name| shapes::object(name, 3000)).into());
    scene.timeline.last = 7;
    scene.camera.keys = vec![
        shapes::camera_key(0.0, at([0.5, 1.0, 4.0]), at([0.0, 0.2, 0.0])),
        shapes::camera_key(7.0, at([-0.7, 0.8, 4.0]), at([0.0, 0.2, 0.0])),
    ];
    let position = Some(at([1.2, 1.5, 1.8]));
    scene.lights = vec![
        Light { position, intensity: 6.0, ..Light::new("lamp", LightKind::Point) },
        Light { intensity: 0.3, ..Light::new("sky", LightKind::Ambient) },
    ];
    let key = |place: [f64; 3], scale: f64| ObjectKey {
        translation: at(place),
        rotation_deg: [-37.0, 0.0, 0.0],
        scale: Scale::even(scale),
        ..ObjectKey::at(0.0)
    };
    scene.objects[0].keys = vec![key([0.0, 0.0, -0.5], 1.5)];
    scene.objects[1].keys = vec![key([0.2, 0.2, 0.4], 0.5)];
    let painting = prepare(shapes::loaded(scene, [shapes::sheet(4), shapes::sphere(32, 16)])).unwrap();
    [0.0, 7.0]
        .map(|frame| renderer.render(&painting.at(frame, &FrameOptions::new([320, 180]))).unwrap().rgba8)
        .into()
}

#[test]
fn a_scene_far_away_is_painted_as_one_at_the_origin() {
    let mut renderer = renderer(Driver::Auto);
    let near = painted(&mut renderer, DVec3::ZERO);
    assert!(near[0] != near[1], "the camera moves");
    for by in [DVec3::new(3e5, -2e5, 7e4), DVec3::new(-1e7, 3e6, 1e7)] {
        for (near, far) in near.iter().zip(painted(&mut renderer, by)) {
            let differs = |(near, far): (&u8, &u8)| near.abs_diff(*far) > 2;
            let count = near.iter().zip(&far).filter(|pair| differs(*pair)).count();
            // Vertices are rounded differently, which moves an edge of a stroke by a thousandth of a pixel.
            assert!(count * 2000 < near.len(), "{by}: {count} of {} differ", near.len());
        }
    }
}
