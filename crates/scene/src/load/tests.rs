//! Tests of loading scenes: errors, their positions and suggestions.

use super::*;
use crate::document::{BrushMix, Lens, RotatingStrokes, Solver, Style};

const GOOD: &str = r#"(
    version: 1,
    camera: (keys: [(frame: 0, eye: (0, 1, 4), target: (0, 0, 0))]),
    objects: [
        (name: "body", mesh: "cube.obj"),
        (name: "wheel", mesh: "cube.obj", parent: "body", particles: 10),
    ],
    regions: [(name: "r", on: Object("body"), strokes: (flatness: 0.5))],
)"#;

fn complaint(text: &str) -> String {
    parse(Path::new("s.ron"), text).expect_err("no complaint").to_string()
}

/// The error report for [`GOOD`] after one edit.
#[track_caller]
fn after_edit(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "{from} is not in the text");
    complaint(&GOOD.replacen(from, to, 1))
}

#[test]
fn every_kind_of_error_has_its_position_and_a_mend() {
    let cases = [
        ("parent:", "parnt:", "s.ron:6:43: error: unknown field `parnt`; did you mean `parent`?"),
        ("10)", "10.5)", "s.ron:6:70: error: `10.5` does not fit `objects[1].particles`"),
        ("10)", "-3)", "s.ron:6:70: error: `-3` does not fit `objects[1].particles`"),
        ("10)", "18446744073709551616)", "s.ron:6:70: error: `18446744073709551616` does not fit"),
        ("(0, 1, 4)", "(0, 1)", "s.ron:3:37: error: `(0, 1)` does not fit `camera.keys[0].eye`"),
        ("(0, 1, 4)", "(0, 1, 4, 5)", "s.ron:3:37: error: `(0, 1, 4, 5)` does not fit `camera.keys[0].eye`"),
        ("(0, 1, 4)", "(0, \"x\", 4)", "s.ron:3:41: error: `\"x\"` does not fit `camera.keys[0].eye[1]`"),
        ("\"body\", mesh", "body, mesh", "s.ron:5:16: error: `body` does not fit `objects[0].name`"),
        ("version: 1", "version: 999", "s.ron:2:14: error: this scene has version 999"),
        ("version: 1", "version: 0", "s.ron:2:14: error: there is no version 0"),
        ("version: 1,", "", "s.ron:1:1: error: the scene does not say its version; write `version: 1,`"),
        ("Object(", "Objct(", "s.ron:8:31: error: `regions[0].on` cannot be `Objct`; did you mean `Object`?"),
        ("\"wheel\", mesh: ", "\"wheel\" mesh: ", "s.ron:6:24: error: a comma is missing before this"),
        ("name: \"wheel\", ", "", "s.ron:6:9: error: `objects[1]` has no `name`; add `name: …`"),
        ("frame: 0,", "frame: 0, frame: 1,", "s.ron:3:37: error: the field `frame` is given twice"),
        ("1, 4)", "1, 4), ease: Smoth", "s.ron:3:54: error: `camera.keys[0].ease` cannot be `Smoth`"),
        ("\"r\",", "\"\\u{d800}\",", "s.ron:8:22: error: `\"\\u{d800}\"` does not fit `regions[0].name`"),
        ("version: 1,", "version: 1, timeline: (last: inf),", "s.ron:2:34: error: `inf` does not fit"),
        (
            "version: 1,",
            "version: 1, background: (NaN, 0, 0),",
            "s.ron:2:29: error: `(NaN, 0, 0)` does not fit",
        ),
        (
            "flatness: 0.5)",
            "flatness: 0.5), turn_dg: 3",
            "s.ron:8:73: error: unknown field `turn_dg`; did you mean `turn_deg`?",
        ),
        (
            "flatness: 0.5)",
            "flatness: 0.5), hiden: true",
            "s.ron:8:73: error: unknown field `hiden`; did you mean `hidden`?",
        ),
        (
            "flatness: 0.5)",
            "flatness: 0.5), color: 3",
            "s.ron:8:80: error: `3` does not fit `regions[0].color`",
        ),
        ("10)", "10, loked: true)", "s.ron:6:74: error: unknown field `loked`; did you mean `locked`?"),
        ("version: 1,", "version: 1, style: RotatingStrokes(canva: 1),", "s.ron:2:40: error: unknown field"),
        ("regions: [", "regions: [[", "s.ron:9:1: error: `)` closes what `[` opened; write `]`"),
    ];
    for (from, to, expected) in cases {
        let said = after_edit(from, to);
        assert!(said.starts_with(expected), "{from} -> {to}:\n{said}\nexpected\n{expected}");
        assert!(said.contains("; "), "no mend: {said}");
    }
}

#[test]
fn all_unknown_fields_are_reported_at_once() {
    let said = after_edit("particles: 10", "guides: [],\n  unlit: true, keys: [(frme: 1), (frame: 2)]");
    let places: Vec<&str> = said.lines().map(|line| line.split(": ").next().unwrap()).collect();
    // The missing `frame` is not reported beside the misspelt `frme`.
    assert_eq!(places, ["s.ron:6:59", "s.ron:7:3", "s.ron:7:24"], "{said}");
}

#[test]
fn unknown_fields_that_are_not_ascii_do_not_shift_the_next_one() {
    let said = after_edit("particles: 10", "größe: \"äöü\", parents: 1");
    assert!(said.contains("s.ron:6:59: error: unknown field `größe`"), "{said}");
    assert!(said.contains("s.ron:6:73: error: unknown field `parents`; did you mean `parent`?"), "{said}");
}

#[test]
fn an_unknown_field_is_found_again_where_a_known_one_of_its_name_stands_elsewhere() {
    // `particles` is known in objects; `fps` is known in the timeline.
    let said = after_edit("strokes: (flatness: 0.5)", "strokes: (particles: 3, fps: 2)");
    assert!(said.contains("s.ron:8:57: error: unknown field `particles`"), "{said}");
    assert!(said.contains("s.ron:8:71: error: unknown field `fps`"), "{said}");
}

#[test]
fn text_that_is_not_a_scene_is_identified() {
    let deep = format!("(version: 1, a: {}", "[".repeat(100_000));
    let deep_comment = "/*".repeat(100_000);
    let long_number = format!("(version: 1, seed: {})", "7".repeat(1_000_000));
    let cases = [
        ("", "s.ron:1:1: error: the file holds no scene"),
        ("// only\n/* a comment */", "s.ron:1:1: error: the file holds no scene"),
        ("{\"version\": 1}", "s.ron:1:1: error: this looks like JSON"),
        ("(version: 1, a\0b: 2)", "s.ron:1:15: error: there is a NUL character"),
        ("(version: 1,\n  /* /* */ ", "s.ron:2:3: error: this comment is never closed"),
        ("(version: 1,\n  name: \"abc)", "s.ron:2:9: error: this text is never closed"),
        ("(version: 1,\n  name: r##\"abc\"#)", "s.ron:2:9: error: this text is never closed"),
        ("(version: 1,\n  keys: [1, 2", "s.ron:2:9: error: this `[` is never closed"),
        ("(version: 1))", "s.ron:1:13: error: there is more text behind the end"),
        (&deep, "s.ron:1:80: error: brackets lie more than 64 deep"),
        (&deep_comment, "s.ron:1:1: error: comments lie more than 64 deep"),
        (&long_number, "s.ron:1:20: error: this number has 1000000 characters"),
    ];
    for (text, expected) in cases {
        let said = complaint(text);
        assert!(said.starts_with(expected), "{said}\nexpected\n{expected}");
        assert!(said.len() < 500, "a message of {} bytes", said.len());
    }
}

#[test]
fn byte_order_mark_line_ends_comments_and_raw_text_are_no_fault() {
    let plain = parse(Path::new("s.ron"), GOOD).unwrap();
    let dressed = GOOD
        .replace("objects: [", "/* ( /* [ */ \" */ objects: [ // )\n")
        .replace("\"wheel\"", "r#\"wheel\"#")
        .replace('\n', "\r\n");
    let text = format!("\u{feff}#![enable(implicit_some)]\r\n{dressed}");
    assert_eq!(parse(Path::new("s.ron"), &text).unwrap(), plain);
    let broken = text.replace("parent:", "parnt:");
    assert!(
        complaint(&broken).starts_with("s.ron:8:46: error: unknown field `parnt`"),
        "{}",
        complaint(&broken)
    );
}

#[test]
fn bytes_that_are_not_utf8_are_reported_with_their_position() {
    let path = Path::new("s.ron");
    let place = |bytes: &[u8]| source::decode(path, bytes).expect_err("taken").to_string();
    assert!(place(b"(\n a: \"\xe4\")").starts_with("s.ron:2:6: error: this file is not UTF-8"));
    assert!(place(b"\xff\xfe(\0").starts_with("s.ron:1:1: error: this file is UTF-16"));
    assert!(place(b"\xfe\xff\0(").starts_with("s.ron:1:1: error: this file is UTF-16"));
}

fn overridden(sets: &[(&str, &str)]) -> Result<Scene, Report> {
    let parsed = parse::parse(Path::new("s.ron"), GOOD).unwrap();
    let sets: Vec<_> = sets.iter().map(|(path, value)| (path.to_string(), value.to_string())).collect();
    overrides::apply(parsed, &sets).map(|(parsed, _)| parsed.scene)
}

#[test]
fn values_of_the_command_line_replace_and_add_fields() {
    let scene = overridden(&[
        ("strokes.width_px", "12"),
        ("objects[0].particles", "9"),
        ("objects.wheel.particles", "11"),
        ("objects.wheel.name", "left wheel"),
        ("style.RotatingStrokes.solver", "Horn"),
        ("camera.lens.fov_y_deg", "50"),
        ("camera.keys[0].eye[1]", "2.5"),
        ("regions.r.direction", "Around((0, 0, 1))"),
        ("strokes.brush", "filbert"),
        ("size", "(64, 32)"),
    ])
    .unwrap();
    assert_eq!(scene.strokes.width_px, Some(12.0));
    assert_eq!(scene.strokes.brush, Some(BrushMix(vec!["filbert".to_owned()])));
    assert_eq!(scene.objects.iter().map(|o| o.particles).collect::<Vec<_>>(), [Some(9), Some(11)]);
    assert_eq!(scene.objects[1].name, "left wheel");
    let style = RotatingStrokes { solver: Solver::Horn, ..Default::default() };
    assert_eq!(scene.style, Style::RotatingStrokes(style));
    assert_eq!(scene.camera.lens, Lens::Perspective { fov_y_deg: 50.0, near: 0.05, far: 100.0 });
    assert_eq!(scene.camera.keys[0].eye, [0.0, 2.5, 4.0]);
    assert_eq!(scene.regions[0].direction, crate::document::Direction::Around([0.0, 0.0, 1.0]));
    assert_eq!(scene.size, (64, 32));
}

#[test]
fn errors_in_set_options_are_reported_for_the_command_line() {
    let cases = [
        ("objects.whel.particles", "9", "`objects` has no item `whel`; did you mean `wheel`?"),
        ("objects[7].scale", "2", "`objects` has no item `7`; it has 2, counted from 0"),
        ("strokes.wdth_px", "2", "unknown field `wdth_px`; did you mean `width_px`?"),
        ("objects.wheel.particles", "many", "`many` does not fit `objects[1].particles`"),
        // A value cannot close brackets that were opened before it.
        ("timeline.last", "9), seed: (7", "`\"9), seed: (7\"` does not fit `timeline.last`"),
        ("", "1", "no field is named"),
        ("version.x", "1", "`version` has no field `x`"),
    ];
    for (path, value, expected) in cases {
        let said = overridden(&[(path, value)]).expect_err("taken").to_string();
        assert!(said.starts_with(&format!("--set {path}={value}: error: {expected}")), "{said}");
    }
}

#[test]
fn a_missing_file_a_folder_and_a_strange_extension_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let options = LoadOptions::default();
    let said = |path: &Path| load(path, &options).expect_err("taken").to_string();
    assert!(said(&folder.path().join("none.ron")).contains("none.ron: error: the file cannot be read"));
    assert!(said(&folder.path().join("none.obj")).contains("none.obj: error: the file cannot be read"));
    let subfolder = folder.path().join("folder.ron");
    std::fs::create_dir(&subfolder).unwrap();
    assert!(said(&subfolder).contains("this is no regular file"));
    assert!(said(&folder.path().join("x.fbx")).contains("neither a scene nor a mesh"));
    let long = folder.path().join("long.ron");
    std::fs::File::create(&long).unwrap().set_len(limits::MAX_SCENE_BYTES + 1).unwrap();
    assert!(said(&long).contains("limit: the scene file is longer than 16 MiB"));
}
