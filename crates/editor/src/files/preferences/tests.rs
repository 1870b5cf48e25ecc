//! Tests of the preferences: they are read back as saved, broken files are kept, and values are brought into range.

use std::fs;
use std::path::{Path, PathBuf};

use impasto_editor_model::keymap::{CommandId, OwnKeys};

use super::*;

fn read(text: &str) -> (Loaded, tempfile::TempDir) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("editor.ron"), text).expect("written");
    (load(folder.path()), folder)
}

/// Own keys with one entry: the command `name` has `keys`.
fn own(name: &str, keys: &[&str]) -> OwnKeys {
    let mut own = OwnKeys::default();
    own.note(
        CommandId::named(name).expect("a command"),
        keys.iter().map(|key| key.parse().expect("a key")).collect(),
    );
    own
}

#[test]
fn what_is_saved_is_read_back() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let config = folder.path().join("deep/impasto");
    assert_eq!(load(&config), Loaded { preferences: Preferences::default(), note: None });
    let mut kept = Preferences {
        keys: Keys::Maya,
        theme: Theme::Light,
        scale: 1.5,
        show_welcome: false,
        driver: DriverChoice::Osmesa,
        copy_after_secs: 7,
        digits_as_numpad: true,
        foresee_strokes: false,
        pressure: Pressure::Radius,
        reduced_motion: true,
        window_size: (1920.0, 1080.0),
        ..Preferences::default()
    };
    kept.own_keys.set(&own("Comb", &["Ctrl K", "NumPad 1"]));
    kept.note_recent(Path::new("/scenes/a b.ron"));
    let view = LastView { eye: [0.1, 2.0, 3.0], target: [0.0; 3], roll_deg: 5.0, orthographic: true };
    kept.note_last_seen(Path::new("/scenes/a b.ron"), Mode::Paint, Some(view));
    save(&config, &kept).expect("saved");
    assert_eq!(load(&config), Loaded { preferences: kept.clone(), note: None });
    save(&config, &Preferences::default()).expect("saved over");
    assert_eq!(load(&config).preferences, Preferences::default());
    let files: Vec<_> =
        fs::read_dir(&config).expect("a folder").flatten().map(|entry| entry.file_name()).collect();
    assert_eq!(files, ["editor.ron"], "no temporary file stays");
}

#[test]
fn missing_and_unknown_fields_are_fine() {
    let (loaded, _folder) = read("(keys: Maya, perfume: Some((\"rose\", [1, 2])))");
    assert_eq!(loaded.note, None);
    assert_eq!(loaded.preferences, Preferences { keys: Keys::Maya, ..Preferences::default() });
}

#[test]
fn a_file_that_cannot_be_used_is_kept_beside() {
    for (text, word) in [
        ("(keys: Emacs)", "Emacs"),
        ("(scale: ", "1:9"),
        ("(version: 2, keys: Sculptor)", "newer"),
        ("", "cannot be used"),
    ] {
        let (loaded, folder) = read(text);
        assert_eq!(loaded.preferences, Preferences::default(), "{text}");
        let note = loaded.note.expect("a note");
        assert!(note.contains(word), "{note}");
        assert_eq!(fs::read_to_string(folder.path().join("editor.ron.bad")).expect("kept"), text);
        assert!(!folder.path().join("editor.ron").exists());
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("editor.ron"), b"(scale: \xff)").expect("written");
    assert!(load(folder.path()).note.expect("a note").contains("no text"));
}

#[test]
fn hand_written_numbers_come_into_range() {
    let seen = |file: &str, x: &str| {
        format!("(file: \"/{file}.ron\", view: Some((eye: ({x}, 0.0, 0.0), target: (0.0, 0.0, 0.0))))")
    };
    let seen = [seen("a", "NaN"), seen("b", "0.0"), seen("c", "1e12"), seen("d", "1e6")].join(", ");
    let text = format!("(scale: 90.0, window_size: (NaN, 3.0), copy_after_secs: 40000, last_seen: [{seen}])");
    let (loaded, _folder) = read(&text);
    assert_eq!(loaded.note, None);
    let Preferences { scale, window_size, copy_after_secs, last_seen, .. } = loaded.preferences;
    assert_eq!((scale, window_size, copy_after_secs), (3.0, (1280.0, 440.0), 7200));
    let kept: Vec<bool> = last_seen.iter().map(|seen| seen.view.is_some()).collect();
    assert_eq!(kept, [false, false, false, true]);
}

#[test]
fn lists_keep_the_newest_and_each_file_once() {
    let mut preferences = Preferences::default();
    for at in 0..70 {
        let file = PathBuf::from(format!("/scenes/{at}.ron"));
        preferences.note_recent(&file);
        preferences.note_last_seen(&file, Mode::Animate, None);
    }
    preferences.note_recent(Path::new("/scenes/65.ron"));
    assert_eq!(preferences.recent.len(), MAX_RECENT);
    assert_eq!(preferences.recent[..2], [Path::new("/scenes/65.ron"), Path::new("/scenes/69.ron")]);
    assert_eq!(preferences.last_seen.len(), MAX_LAST_SEEN);
    assert!(preferences.last_seen_in(Path::new("/scenes/19.ron")).is_none());
    assert!(preferences.last_seen_in(Path::new("/scenes/20.ron")).is_some());
    let folder = tempfile::tempdir().expect("a temporary folder");
    let there = folder.path().join("there.ron");
    fs::write(&there, "").expect("written");
    preferences.note_recent(&there);
    assert_eq!(preferences.recent_there(), [there.as_path()]);
}

#[test]
fn keys_that_cannot_be_read_lose_nothing_else() {
    for (text, faulty) in [
        ("{\"Comb\": [\"Ctrl Banana\"], \"Smooth\": [\"Ctrl K\"]}", Some("Comb: `Ctrl Banana` is no key")),
        ("{\"Fly\": [\"F\"], \"Smooth\": \"Ctrl K\"}", Some("no command is called “Fly”")),
        ("{\"Comb\": 7, \"Smooth\": [\"Ctrl K\"], 3: [\"K\"]}", Some("(and 1 more)")),
        ("{\"Smooth\": [\"Ctrl K\"], \"Cancel\": [\"Q\"]}", Some("Esc always cancels")),
        ("{\"Comb\": [\"Esc\"], \"Smooth\": [\"Ctrl K\"]}", Some("Comb: Esc cannot be given")),
        ("{\"Comb\": [7], \"Smooth\": [\"Ctrl K\"]}", Some("Comb: a key must be a text")),
        ("{\"Smooth\": [\"Ctrl K\"], \"Touch\": [\"Ctrl K\"]}", Some("“Touch” has the keys of “Smooth”")),
        ("{\"Along X\": [\"7\"], \"Smooth\": [\"Ctrl K\"]}", Some("numbers are typed")),
        ("{(): 7, \"Smooth\": [\"Ctrl K\"]}", Some("must be a text")),
        ("{\"Smooth\": [\"Ctrl K\"]}", None),
    ] {
        let (loaded, _folder) = read(&format!("(keys: Maya, own_keys: {text}, scale: 1.5)"));
        assert_eq!(loaded.note, None, "{text}");
        let Preferences { keys, own_keys, scale, .. } = loaded.preferences;
        assert_eq!((keys, scale), (Keys::Maya, 1.5));
        assert_eq!(own_keys.keys(), own("Smooth", &["Ctrl K"]), "{text}");
        match faulty {
            None => assert_eq!(own_keys.fault(), None),
            Some(words) => {
                assert!(own_keys.fault().expect("a fault").contains(words), "{:?}", own_keys.fault())
            }
        }
        // What cannot be read stays in the file, whatever is changed meanwhile.
        let mut changed = own_keys.clone();
        changed.set(&own("Fill direction", &["Ctrl L"]));
        assert_eq!(changed.keys(), own("Fill direction", &["Ctrl L"]));
        // But an entry that was refused only because another command had its keys is removed: it would take effect now.
        let stays = own_keys.fault().filter(|fault| !fault.contains("has the keys of"));
        assert_eq!(changed.fault(), stays, "{text}");
        let folder = tempfile::tempdir().expect("a temporary folder");
        let kept = Preferences { own_keys: changed, ..Preferences::default() };
        save(folder.path(), &kept).expect("saved");
        assert_eq!(load(folder.path()).preferences, kept, "{text}");
    }
    for text in ["5", "[]", "\"K\"", "None", "(1, 2)", "{}"] {
        let (loaded, folder) = read(&format!("(keys: Maya, own_keys: {text})"));
        assert_eq!(loaded.note, None, "{text}");
        let Preferences { keys, mut own_keys, .. } = loaded.preferences;
        assert_eq!((keys, own_keys.keys()), (Keys::Maya, OwnKeys::default()), "{text}");
        assert_eq!(own_keys.fault().is_some(), text != "{}", "{text}");
        own_keys.set(&own("Comb", &["Ctrl L"]));
        assert_eq!(own_keys.keys(), own("Comb", &["Ctrl L"]), "{text}");
        assert_eq!(own_keys.fault().is_some(), text != "{}", "the faulty value must stay: {text}");
        let kept = Preferences { own_keys, ..Preferences::default() };
        save(folder.path(), &kept).expect("saved");
        assert_eq!(load(folder.path()).preferences, kept, "{text}");
    }
}
