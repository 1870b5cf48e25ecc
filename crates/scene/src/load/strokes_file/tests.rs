//! Tests of reading presets from files.

use super::*;
use crate::save::{preset_to_ron, write_preset};

const GOOD: &str = r#"(version: 1, height_px: 720, strokes: (preset: "impressionist", length_px: 40,
    layers: [(name: "form", hidden: true)]))"#;

fn problems(text: &str) -> Vec<String> {
    let Err(Report(problems)) = parse(Path::new("a.strokes.ron"), text) else { return Vec::new() };
    problems.iter().map(ToString::to_string).collect()
}

#[test]
fn a_preset_is_read_as_it_was_written() {
    let preset = parse(Path::new("a.strokes.ron"), GOOD).unwrap();
    assert_eq!(preset.strokes.layers[0].hidden, Some(true));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.strokes.ron");
    write_preset(&path, &preset).unwrap();
    assert_eq!(load(&path).unwrap(), preset);
    assert_eq!(parse(&path, &preset_to_ron(&preset)).unwrap(), preset);
    assert_eq!(name_of(&path), "a");
    assert!(is_preset(&path) && !is_preset(Path::new("a.ron")));
    assert_eq!(name_of(Path::new("x/Thick oil.STROKES.RON")), "Thick oil");
    assert_eq!(name_of(Path::new("\u{f6}.ron")), "\u{f6}.ron");
}

#[test]
fn every_fault_has_its_place_and_its_mend() {
    for (text, place, words) in [
        (GOOD.replace("length_px", "lenght_px"), "1:", "did you mean `length_px`?"),
        (GOOD.replace("length_px: 40", "length_px: 1e9"), "1:", "out of range"),
        (GOOD.replace("\"form\"", "\"from\""), "2:", "form"),
        (GOOD.replace("impressionist", "impresionist"), "1:", "impressionist"),
        (GOOD.replace("version: 1, ", ""), "1:", "the preset does not say its version"),
        (GOOD.replace("version: 1", "version: 9"), "1:", "this preset has version 9"),
        (GOOD.replace("height_px: 720, ", ""), "1:", "the preset has no `height_px`"),
        (GOOD.replace("720", "0"), "1:", "out of range"),
        (GOOD.replace("length_px: 40", "layer: 3"), "1:", "a preset has no `layer`"),
        (format!("{GOOD} x"), "2:", "end of the preset"),
        ("(version: 1, ".to_owned(), "1:", ""),
        (String::new(), "1:", ""),
    ] {
        let found = problems(&text);
        assert!(!found.is_empty(), "{text}");
        let known = found.iter().any(|found| found.contains(&format!("a.strokes.ron:{place}")));
        assert!(known && found.iter().any(|found| found.contains(words)), "{text}: {found:?}");
        let is_of_scene = |found: &String| found.contains("the scene") || found.contains("this scene");
        assert!(!found.iter().any(is_of_scene), "{found:?}");
    }
}

#[test]
fn pictures_of_brushes_lie_in_its_folder_and_nowhere_else() {
    let outer = tempfile::tempdir().unwrap();
    let folder = outer.path().join("presets");
    std::fs::create_dir(&folder).unwrap();
    std::fs::write(outer.path().join("secret.png"), "no picture").unwrap();
    let path = folder.join("a.strokes.ron");
    for name in ["../secret.png", "/etc/hostname.png", "missing.png"] {
        let brush = format!("brush: {name:?}, length_px");
        std::fs::write(&path, GOOD.replace("length_px", &brush)).unwrap();
        let Report(problems) = load(&path).unwrap_err();
        assert!(problems.iter().all(|problem| problem.severity.is_fatal()), "{problems:?}");
    }
    let nested = format!("(version: 1, height_px: 720, strokes: {})", "(".repeat(100_000));
    std::fs::write(&path, nested).unwrap();
    assert!(load(&path).is_err());
    assert!(load(&folder).is_err(), "a folder was read as a preset");
}
