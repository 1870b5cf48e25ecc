//! Tests that the alpha of a stroke that nothing hides comes from supply, rank and facing alone, even at a grazing
//! angle.

use glam::DVec3;
use impasto_core::presence;
use impasto_gl_render::context::Driver;
use impasto_painting::{FrameOptions, prepare};
use impasto_scene::document::Lens;
use impasto_tests::pictures::renderer;
use impasto_tests::shapes;

/// The eye looks up by 5, 8 or 20 degrees over a level floor. Judged by its normal and the gaze alone, the floor would
/// face away, but the eye sees it. Nothing stands on it, so only supply, rank and facing decide how far each stroke is
/// present.
#[test]
fn strokes_of_a_bare_floor_are_whole_under_an_eye_that_looks_up() {
    let floor = || shapes::moved(&shapes::sheet(8), |at| DVec3::new(8.0 * at.x, 0.0, -8.0 * at.y));
    let mut renderer = renderer(Driver::Egl);
    for pitch_deg in [5.0f64, 8.0, 20.0] {
        let mut scene = shapes::scene(vec![shapes::object("floor", 20_000)]);
        scene.camera.lens = Lens::Perspective { fov_y_deg: 70.0, near: 0.05, far: 100.0 };
        let up = pitch_deg.to_radians().tan();
        scene.camera.keys = vec![shapes::camera_key(0.0, [0.0, 1.2, 4.0], [0.0, 1.2 + 4.0 * up, 0.0])];
        scene.strokes.layers = shapes::body_layer_alone();
        let painting = prepare(shapes::loaded(scene, [floor()])).unwrap();
        let frame = painting.at(0.0, &FrameOptions::new([640, 360]));
        renderer.render(&frame).unwrap();
        let mut count = 0;
        for (stroke, drawn) in frame.strokes.iter().zip(renderer.resolved_strokes()) {
            let [x, y] = stroke.center_px;
            let expected = presence::of_supply(stroke.supply_ln) * stroke.facing_fade;
            if expected < 0.3 || !(0.0..640.0).contains(&x) || y < 0.0 {
                continue;
            }
            count += 1;
            let there = drawn.alpha;
            assert!((there - expected).abs() < 0.01, "{pitch_deg}: {there}, not {expected}, at ({x}, {y})");
        }
        assert!(count > 300, "{pitch_deg}: only {count} strokes are seen");
    }
}
