//! Fuzzes `PATH=VALUE` lines as `--set` and `impasto set` take them, lists of frames, and file patterns. A value is
//! either refused or written into the text of a scene. That text can then be read, and still holds a comment (unless
//! the value is in `objects` or `regions`).

#![no_main]

use std::path::Path;

use impasto_frame_files::{FrameList, Pattern};
use impasto_scene::load;
use libfuzzer_sys::fuzz_target;

const SCENE: &str = include_str!("../scenes/values.ron");

fuzz_target!(|bytes: &[u8]| {
    let text = String::from_utf8_lossy(bytes);
    let path = Path::new("scene.ron");
    let mut scene = SCENE.to_owned();
    for line in text.lines().take(8) {
        if let Ok(list) = FrameList::parse(line) {
            assert!(list.count() > 0);
            assert!(list.iter().take(1000).count() as u64 <= list.count());
        }
        let pattern = Pattern::parse(line, 5);
        assert!(!pattern.has_place() || pattern.path(3) != pattern.path(4));
        let Some((field, value)) = line.split_once('=') else { continue };
        let values = [(field.to_owned(), value.to_owned())];
        if let Ok(edited) = load::edited_text(path, &scene, &values) {
            load::parse(path, &edited).unwrap_or_else(|report| panic!("{line}\n{report}\n{edited}"));
            assert!(
                edited.contains("// kept") || field.starts_with("objects") || field.starts_with("regions")
            );
            scene = edited;
        }
    }
});
