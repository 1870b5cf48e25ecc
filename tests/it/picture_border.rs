//! Tests of strokes at the border of the picture.

use std::collections::BTreeSet;

use impasto_painting::FrameOptions;
use impasto_scene::motion;
use impasto_tests::scenes;

/// A stroke whose centre lies beside the picture is drawn if it reaches into the picture, even if only because jitter or
/// boil made it longer, or because it grew with its surface. A wider picture of the same view shows which strokes these
/// are.
#[test]
fn long_strokes_that_reach_into_the_picture_are_there() {
    let jitter = [("strokes.size_jitter", "0.6"), ("strokes.boil", "0.5")];
    let follow = [("strokes.size_follow", "1")];
    for (settings, nearer, least_count) in [(&jitter[..], 0.0, 100), (&follow, 0.5, 50)] {
        let painting = scenes::painting_with("still_life", settings);
        let mut camera = motion::camera_at(painting.scene(), 0.0);
        camera.eye = camera.eye.lerp(camera.target, nearer);
        let strokes = |size| painting.strokes(&camera, 0.0, &FrameOptions::new(size), None);
        let (narrow, wide) = (strokes([240, 180]), strokes([320, 180]));
        let there: BTreeSet<u32> = narrow.sources.iter().map(|source| source.place).collect();
        let mut count = 0;
        for (stroke, source) in wide.strokes.iter().zip(&wide.sources) {
            let from_middle_px = [stroke.center_px[0] - 160.0, stroke.center_px[1] - 90.0];
            let (sin, cos) = stroke.angle_rad.sin_cos();
            let reach = |along: f32, across: f32| {
                0.5 * (along.abs() * stroke.length_px + across.abs() * stroke.width_px)
            };
            let beside_px = from_middle_px[0].abs() - 120.0;
            let is_in = beside_px < reach(cos, sin) && from_middle_px[1].abs() - 90.0 < reach(sin, cos);
            if is_in && beside_px > 0.0 {
                count += 1;
                let of = format!("{} x {} px", stroke.length_px, stroke.width_px);
                assert!(
                    there.contains(&source.place),
                    "a stroke of {of}, {beside_px} px outside, is missing"
                );
            }
        }
        assert!(count > least_count, "{count}");
    }
}
