//! Fuzzes commands of the editor, in any order. Each is either refused and changes nothing, or applied, with exact undo
//! and redo. The scene after the last command stays equal when it is saved and read again.

#![no_main]

use std::path::Path;
use std::sync::OnceLock;

use impasto_editor_model::Document;
use impasto_scene::load::{self, LoadOptions};
use impasto_scene::save;
use libfuzzer_sys::fuzz_target;

#[path = "../../crates/editor-model/tests/it/any_command/mod.rs"]
mod any_command;

const SCENE: &str = include_str!("../scenes/values.ron");

const BYTES_PER_COMMAND: usize = 7;

fn document() -> Document {
    static DOCUMENT: OnceLock<Document> = OnceLock::new();
    let open = || {
        let folder = impasto_fuzz::folder("edits");
        std::fs::write(folder.join("a.obj"), impasto_fuzz::MESH).expect("written");
        let path = folder.join("scene.ron");
        std::fs::write(&path, SCENE).expect("written");
        Document::open(&path, &LoadOptions::default()).expect("the scene of this target")
    };
    DOCUMENT.get_or_init(open).clone()
}

fuzz_target!(|bytes: &[u8]| {
    let mut document = document();
    let first = document.scene().clone();
    for dice in bytes.chunks_exact(BYTES_PER_COMMAND).take(64) {
        // From -4 to 4.
        let number = |at: usize| f64::from(i16::from_le_bytes([dice[at], dice[at + 1]])) / 8192.0;
        let before = document.scene().clone();
        let command = any_command::command(&before, (dice[0], dice[1], dice[2], number(3), number(5)));
        let entries = document.undo_count();
        if document.apply(&command).is_err() {
            assert!(document.scene() == &before, "refused, and changed something: {command:?}");
            continue;
        }
        let after = document.scene().clone();
        assert_eq!(
            document.undo_count() > entries,
            after != before,
            "no entry, or an empty one: {command:?}"
        );
        if after != before {
            document.undo();
            assert!(document.scene() == &before, "undo is not exact: {command:?}");
            document.redo();
            assert!(document.scene() == &after, "redo is not exact: {command:?}");
        }
    }
    let text = save::to_ron(document.scene());
    let read =
        load::parse(Path::new("edited.ron"), &text).unwrap_or_else(|report| panic!("{report}\n{text}"));
    assert!(&read == document.scene(), "another scene after it was saved and read:\n{text}");
    let loaded = document.loaded();
    assert!(loaded.with_scene(read, &Default::default()).is_ok(), "what commands left is not valid\n{text}");
    while document.undo().is_some() {}
    assert!(document.scene() == &first, "undoing everything does not give the first scene");
});
