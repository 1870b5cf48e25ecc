//! Tests that ink leaves the holes of a texture bare.

use impasto_gl_render::context::Driver;
use impasto_painting::{FrameOptions, prepare};
use impasto_tests::pictures::renderer;
use impasto_tests::shapes;

use super::{SIZE_PX, red, scene_in, source, wash};

/// The sheet is a square of 160 px in the middle of the picture, darker than white. When cut, its left half is a hole.
#[test]
fn a_hole_of_the_texture_has_no_ink() {
    let mut renderer = renderer(Driver::Egl);
    for ink in [source(), wash()] {
        let mut scene = scene_in(ink.clone());
        scene.objects[0].name = "sheet".to_owned();
        let loaded = shapes::loaded(scene, [shapes::sheet(1)]);
        let [whole, cut] = [None, Some(0.5)].map(|cutoff| {
            let loaded = cutoff.map_or(loaded.clone(), |cutoff| shapes::with_holes(&loaded, cutoff));
            renderer.render(&prepare(loaded).unwrap().at(0.0, &FrameOptions::new(SIZE_PX))).unwrap()
        });
        for y in [60, 90, 120] {
            assert!(red(&whole, 115, y) < 250, "{ink:?}: nothing is drawn at {y}");
            assert_eq!(red(&cut, 115, y), 255, "{ink:?}: ink in the hole at {y}");
            assert_eq!(red(&cut, 205, y), red(&whole, 205, y), "{ink:?}: beside the hole at {y}");
        }
    }
}
