//! Fuzzes point caches of a mesh of four points: they are refused, or move its points to finite places.

#![no_main]

use std::path::PathBuf;
use std::sync::OnceLock;

use impasto_scene::load::{LoadOptions, load};
use libfuzzer_sys::fuzz_target;

const SCENE: &str = "#![enable(implicit_some)]\n(version: 1, camera: (keys: [(frame: 0, eye: (0, 0, 4), target: (0, 0, 0))]), \
    objects: [(name: \"a\", mesh: \"a.obj\", cache: \"a.pc2\")])";
const MESH: &str = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n";

fn folder() -> &'static PathBuf {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let folder = impasto_fuzz::folder("point_cache");
        std::fs::write(folder.join("scene.ron"), SCENE).expect("written");
        std::fs::write(folder.join("a.obj"), MESH).expect("written");
        folder
    })
}

fuzz_target!(|bytes: &[u8]| {
    std::fs::write(folder().join("a.pc2"), bytes).expect("written");
    let Ok(loaded) = load(&folder().join("scene.ron"), &LoadOptions::default()) else { return };
    for cache in loaded.caches.values() {
        assert_eq!(cache.count(), 4);
        let [first, last] = cache.frames();
        for frame in [f64::MIN, first, first + 0.37, (first + last) / 2.0, last, f64::MAX] {
            if let Ok(places) = cache.at(frame) {
                assert!(places.len() == 4 && places.iter().all(|place| place.is_finite()), "at {frame}");
            }
        }
    }
});
