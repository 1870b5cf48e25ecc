//! Scenes with every mesh replaced by a small one: what the checks let through gives finite strokes at any time.

#![no_main]

use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use impasto_painting::FrameOptions;
use impasto_scene::load::{self, LoadOptions};
use impasto_scene::save;
use libfuzzer_sys::fuzz_target;

const MESH: &str = "v -1 -1 0\nv 1 -1 0\nv 1 1 0.3\nv -1 1 0\nv 0 0 1\ng a\nf 1 2 3 4\ng b\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";

fn folder() -> &'static PathBuf {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let folder = impasto_fuzz::folder("frame");
        std::fs::write(folder.join("m.obj"), MESH).expect("written");
        folder
    })
}

fuzz_target!(|bytes: &[u8]| {
    let text = String::from_utf8_lossy(bytes);
    let path = folder().join("scene.ron");
    let Ok(mut scene) = load::parse(&path, &text) else { return };
    (scene.shot, scene.size) = (None, (64, 48));
    scene.objects.truncate(3);
    for object in &mut scene.objects {
        object.mesh = "m.obj".to_owned();
        (object.cache, object.morph) = (None, None);
        object.particles = Some(object.particles.unwrap_or(60).min(60));
        object.material = None;
    }
    save::write(&path, &scene).expect("written");
    let Ok(loaded) = load::load(&path, &LoadOptions::default()) else { return };
    let Ok(painting) = impasto_painting::prepare(Arc::new(loaded)) else { return };
    for frame in [-1e6, 0.0, 0.37, 7.0, 1e6] {
        let painted = painting.at(frame, &FrameOptions::new([64, 48]));
        for stroke in &painted.strokes {
            let [x, y] = stroke.center_px;
            let [length, width] = [stroke.length_px, stroke.width_px];
            let numbers = [x, y, stroke.angle_rad, length, width, stroke.facing_fade, stroke.bow, stroke.skew];
            assert!(numbers.iter().all(|number| number.is_finite()), "at {frame}: {stroke:?}");
        }
    }
});
