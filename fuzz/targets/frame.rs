//! Fuzzes scenes whose meshes are replaced by a small one: a scene that passes the checks has finite strokes at any
//! time.

#![no_main]

use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use impasto_scene::load::{self, LoadOptions};
use impasto_scene::save;
use libfuzzer_sys::fuzz_target;

fn folder() -> &'static PathBuf {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let folder = impasto_fuzz::folder("frame");
        std::fs::write(folder.join("m.obj"), impasto_fuzz::MESH).expect("written");
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
    impasto_fuzz::assert_finite_strokes(&painting);
});
