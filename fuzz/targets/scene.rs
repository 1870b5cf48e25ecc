//! Fuzzes scene texts: they are refused, or read and checked; a scene that is saved and read again is equal.

#![no_main]

use std::path::Path;

use impasto_scene::{check, load, save};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let text = String::from_utf8_lossy(bytes);
    let path = Path::new("scene.ron");
    let Ok(scene) = load::parse(path, &text) else { return };
    let findings = check::check(&scene);
    let saved = save::to_ron(&scene);
    let again = load::parse(path, &saved).unwrap_or_else(|report| panic!("{report}\n{saved}"));
    // A scene with NaN differs from itself: then the saved texts are compared.
    if again != scene {
        let saved_again = save::to_ron(&again);
        assert!(saved == saved_again, "{saved}\n{saved_again}");
    }
    assert_eq!(check::check(&again).len(), findings.len());
});
