//! Tests of invalid and hostile scenes, each written into a folder of its own and loaded from there.

use std::fs;
use std::path::Path;

use impasto_editor_model::Document;
use impasto_scene::load::{self, LoadOptions};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::problem::{Report, Severity};
use impasto_tests::corpus;

/// A cube with outward faces.
const CUBE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
    f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outcome {
    /// Loads without a message.
    Ok,
    /// Loads with a warning.
    Warn,
    /// Refused with an error.
    Reject,
    /// Refused because it exceeds a limit.
    Limit,
}

use Outcome::{Limit, Ok as Good, Reject, Warn};

/// A scene and what should become of it.
struct Case {
    name: &'static str,
    /// The fields of the scene; version, camera and objects are added where they are left out.
    fields: &'static str,
    expected: Outcome,
    /// Text that the report must contain, in most cases with line and column; empty where there is no report.
    says: &'static str,
}

const fn case(name: &'static str, fields: &'static str, expected: Outcome, says: &'static str) -> Case {
    Case { name, fields, expected, says }
}

/// The fields of a case stand on line 2 of the file, from column 1.
const CASES: [Case; 35] = [
    case(
        "particles_u64max",
        r#"objects: [(name: "a", mesh: "cube.obj", particles: 18446744073709551615)]"#,
        Limit,
        "scene.ron:2:52: limit: 18446744073709551615 particles are more than 16000000",
    ),
    case(
        "particles_fraction",
        r#"objects: [(name: "a", mesh: "cube.obj", particles: 10.5)]"#,
        Reject,
        "scene.ron:2:52: error: `10.5` does not fit `objects[0].particles`",
    ),
    case(
        "particles_zero",
        r#"objects: [(name: "a", mesh: "cube.obj", particles: 0)]"#,
        Warn,
        "scene.ron:2:52: warning: no particles: the object is not painted",
    ),
    case(
        "parent_unknown",
        r#"objects: [(name: "body", mesh: "cube.obj"), (name: "wheel", mesh: "cube.obj", parent: "boby")]"#,
        Reject,
        "scene.ron:2:87: error: there is no object \"boby\"; did you mean \"body\"?",
    ),
    case(
        "parent_after_child",
        r#"objects: [(name: "b", mesh: "cube.obj", parent: "a"), (name: "a", mesh: "cube.obj")]"#,
        Good,
        "",
    ),
    // Keys belong to objects, so a scene cannot have a track for an unknown object.
    case(
        "track_unknown",
        r#"animation: [(target: "b")]"#,
        Reject,
        "scene.ron:2:1: error: unknown field `animation`",
    ),
    case(
        "field_typo",
        r#"objects: [(name: "a", mseh: "cube.obj")]"#,
        Reject,
        "scene.ron:2:23: error: unknown field `mseh`; did you mean `mesh`?",
    ),
    case("version_future", "version: 999", Reject, "scene.ron:2:10: error: this scene has version 999"),
    case(
        "mesh_missing",
        r#"objects: [(name: "a", mesh: "nothere.obj")]"#,
        Reject,
        "/nothere.obj); put the file there, or name its folder with --asset-dir",
    ),
    case("mesh_relative", r#"objects: [(name: "a", mesh: "sub/cube.obj")]"#, Good, ""),
    case(
        "mesh_devzero",
        r#"objects: [(name: "a", mesh: "/dev/zero")]"#,
        Reject,
        "scene.ron:2:29: error: \"/dev/zero\" is refused",
    ),
    case(
        "brush_missing",
        r#"strokes: (brush: "nothere.png")"#,
        Reject,
        "scene.ron:2:18: error: \"nothere.png\" was not found",
    ),
    case("brush_bomb", r#"strokes: (brush: "bomb.png")"#, Limit, "60000"),
    case(
        "texture_bomb",
        r#"objects: [(name: "a", mesh: "cube.obj", material: (texture: "bomb.png"))]"#,
        Limit,
        "60000",
    ),
    case(
        "keys_unsorted",
        r#"objects: [(name: "a", mesh: "cube.obj", keys: [(frame: 0), (frame: 2), (frame: 1)])]"#,
        Reject,
        "scene.ron:2:80: error: frame 1 stands behind frame 2; put the keys in the order",
    ),
    case(
        "keys_duplicate",
        r#"objects: [(name: "a", mesh: "cube.obj", keys: [(frame: 1), (frame: 1, translation: (5, 0, 0))])]"#,
        Reject,
        "scene.ron:2:68: error: two keys stand at frame 1",
    ),
    case("keys_one", r#"objects: [(name: "a", mesh: "cube.obj", keys: [(frame: 0)])]"#, Good, ""),
    // A rotation is three Euler angles, so four numbers (a quaternion) are an error, whether they are zero or not.
    case(
        "quat_zero",
        r#"objects: [(name: "a", mesh: "cube.obj", keys: [(frame: 0, rotation_deg: (0, 0, 0, 0))])]"#,
        Reject,
        "scene.ron:2:73: error: `(0, 0, 0, 0)` does not fit `objects[0].keys[0].rotation_deg`",
    ),
    case(
        "quat_180",
        r#"objects: [(name: "a", mesh: "cube.obj", keys: [(frame: 0), (frame: 9, rotation_deg: (0, 0, 180))])]"#,
        Good,
        "",
    ),
    case(
        "spin_720",
        r#"objects: [(name: "a", mesh: "cube.obj", keys: [(frame: 0), (frame: 9, rotation_deg: (0, 0, 720))])]"#,
        Good,
        "",
    ),
    case(
        "scale_zero",
        r#"objects: [(name: "a", mesh: "cube.obj", scale: (0, 0, 0))]"#,
        Warn,
        "scene.ron:2:48: warning: a scale of 0 leaves no surface",
    ),
    case("scale_nonuniform", r#"objects: [(name: "a", mesh: "cube.obj", scale: (10, 1, 0.1))]"#, Good, ""),
    case("fps_zero", "timeline: (fps: 0)", Reject, "scene.ron:2:17: error: 0 frames per second"),
    case(
        "duration_inf",
        "timeline: (last: inf)",
        Reject,
        "scene.ron:2:18: error: `inf` does not fit `timeline.last`",
    ),
    case(
        "frames_1e12",
        "timeline: (last: 1000000000000)",
        Limit,
        "scene.ron:2:18: limit: frame 1000000000000",
    ),
    case(
        "jump_cut",
        r#"objects: [(name: "a", mesh: "cube.obj", keys: [(frame: 0, ease: Step), (frame: 1, translation: (100, 0, 0))])]"#,
        Good,
        "",
    ),
    case(
        "camera_up_parallel",
        "camera: (keys: [(frame: 0, eye: (0, 5, 0), target: (0, 0, 0))])",
        Reject,
        "scene.ron:2:52: error: the camera looks straight up or down",
    ),
    case("camera_behind", "camera: (keys: [(frame: 0, eye: (0, 0, 5), target: (0, 0, 10))])", Good, ""),
    case(
        "camera_roll_360",
        "camera: (keys: [(frame: 0, eye: (0, 0, 5), target: (0, 0, 0)), (frame: 9, eye: (0, 0, 5), target: (0, 0, 0), roll_deg: 360)])",
        Good,
        "",
    ),
    case(
        "fov_180",
        "camera: (lens: Perspective(fov_y_deg: 180), keys: [(frame: 0, eye: (0, 0, 5), target: (0, 0, 0))])",
        Reject,
        "scene.ron:2:39: error: 180 is out of range; give a number from 1 to 170",
    ),
    case(
        "near_ge_far",
        "camera: (lens: Perspective(near: 10, far: 1), keys: [(frame: 0, eye: (0, 0, 5), target: (0, 0, 0))])",
        Reject,
        "scene.ron:2:43: error: near (10) is not less than far (1)",
    ),
    case("size_16385", "size: (16385, 16)", Limit, "scene.ron:2:7: limit: 16385 × 16 pixels"),
    case("brush_size_zero", "strokes: (width_px: 0)", Reject, "scene.ron:2:21: error: 0 is out of range"),
    case(
        "color_nan",
        "background: (NaN, 0, 0)",
        Reject,
        "scene.ron:2:13: error: `(NaN, 0, 0)` does not fit `background`",
    ),
    case("seed_same", "seed: 1", Good, ""),
];

/// Cases of the large corpus that are not in `CASES`: other tests cover them, or they are about output files, which are
/// not part of a scene.
const CASES_ELSEWHERE: [&str; 4] = ["particles_sum", "text_crlf", "output_is_input", "output_unwritable"];

pub(crate) fn scene_text(fields: &str) -> String {
    let mut text = format!("(\n{fields},\n");
    for (field, default) in [
        ("version:", "version: 1,\n"),
        ("camera:", "camera: (keys: [(frame: 0, eye: (0, 1, 4), target: (0, 0, 0))]),\n"),
        ("objects:", "objects: [(name: \"a\", mesh: \"cube.obj\")],\n"),
    ] {
        if !fields.contains(field) {
            text.push_str(default);
        }
    }
    text + ")\n"
}

/// Writes meshes, a picture whose header claims 3.6 billion pixels, and the scene into a folder; loads the scene.
pub(crate) fn load_in_folder(folder: &Path, scene: &[u8]) -> Result<LoadedScene, Report> {
    fs::create_dir_all(folder.join("sub")).expect("a temporary folder can be written to");
    fs::write(folder.join("cube.obj"), CUBE).expect("a temporary folder can be written to");
    fs::write(folder.join("sub/cube.obj"), CUBE).expect("a temporary folder can be written to");
    let picture = fs::File::create(folder.join("bomb.png")).expect("a temporary folder can be written to");
    png::Encoder::new(picture, 60_000, 60_000).write_header().expect("a temporary folder can be written to");
    let path = folder.join("scene.ron");
    fs::write(&path, scene).expect("a temporary folder can be written to");
    load::load(&path, &LoadOptions::default())
}

fn outcome(loaded: &Result<LoadedScene, Report>) -> (Outcome, String) {
    match loaded {
        Ok(scene) => {
            let said: Vec<String> = scene.warnings.iter().map(ToString::to_string).collect();
            (if said.is_empty() { Good } else { Warn }, said.join("\n"))
        }
        Err(report) => {
            let is_limit = report.0.iter().any(|problem| problem.severity == Severity::Limit);
            (if is_limit { Limit } else { Reject }, report.to_string())
        }
    }
}

#[test]
fn every_case_ends_as_it_should_and_says_why() {
    for case in CASES {
        let folder = tempfile::tempdir().unwrap();
        let (found, said) = outcome(&load_in_folder(folder.path(), scene_text(case.fields).as_bytes()));
        assert_eq!(found, case.expected, "{}: {said}", case.name);
        assert!(said.contains(case.says), "{}: {said}\nexpected: {}", case.name, case.says);
        // One fault gives one problem.
        assert!(said.lines().count() <= 1, "{}: {said}", case.name);
    }
}

#[test]
fn every_case_opens_in_the_editor_as_far_as_it_can_be_read_and_its_file_stays() {
    for case in CASES {
        let folder = tempfile::tempdir().unwrap();
        let text = scene_text(case.fields);
        let loads = load_in_folder(folder.path(), text.as_bytes()).is_ok();
        let path = folder.path().join("scene.ron");
        match Document::open_with_problems(&path, &LoadOptions::default()) {
            Ok(mut document) => {
                let has_losses = document.loss_count() > 0;
                assert_eq!(has_losses, !loads, "{}: it must have losses or load", case.name);
                let would_lose = document.saving_loses();
                let scene = document.scene().clone();
                assert_eq!(
                    document.save().is_err(),
                    would_lose,
                    "{}: only a text that was read whole may be saved over",
                    case.name
                );
                if would_lose {
                    let after = fs::read(&path).unwrap();
                    assert!(after == text.as_bytes(), "{}: the file was touched", case.name);
                } else {
                    // If only a mesh cannot be used, all of the text was read, so the scene can be saved. The mesh
                    // stays listed as a loss.
                    let again = Document::open_with_problems(&path, &LoadOptions::default()).unwrap();
                    assert!(*again.scene() == scene, "{}: the saved scene is another one", case.name);
                    assert_eq!(document.loss_count() > 0, has_losses, "{}", case.name);
                }
            }
            Err(report) => assert!(!report.0.is_empty() && !loads, "{}: {report}", case.name),
        }
    }
}

#[test]
fn a_thousand_objects_within_their_limits_may_still_be_too_much() {
    let objects: String =
        (0..1000).map(|i| format!("(name: \"a{i}\", mesh: \"cube.obj\", particles: 3000000),\n")).collect();
    let folder = tempfile::tempdir().unwrap();
    let loaded = load_in_folder(folder.path(), scene_text(&format!("objects: [\n{objects}]")).as_bytes());
    let (found, said) = outcome(&loaded);
    assert_eq!(found, Limit, "{said}");
    assert!(
        said.contains("scene.ron:13:44: limit: with this object the scene has more than 32000000"),
        "{said}"
    );
}

#[test]
fn windows_line_ends_change_nothing_but_bytes() {
    let text = scene_text("seed: 5");
    let (unix, windows) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let plain = load_in_folder(unix.path(), text.as_bytes()).unwrap();
    let converted = load_in_folder(windows.path(), text.replace('\n', "\r\n").as_bytes()).unwrap();
    assert_eq!(plain.scene, converted.scene);
    let broken = text.replace("target", "taget").replace('\n', "\r\n");
    let (_, said) = outcome(&load_in_folder(windows.path(), broken.as_bytes()));
    assert!(said.contains("scene.ron:4:44: error: unknown field `taget`"), "{said}");
}

#[test]
fn nothing_outside_the_scenes_folder_is_read() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("secret.obj"), CUBE).unwrap();
    let inside = folder.path().join("scenes");
    for mesh in
        ["../secret.obj", "sub/../../secret.obj", "..\\\\secret.obj", "file:///etc/passwd", "link.obj"]
    {
        fs::create_dir_all(&inside).unwrap();
        #[cfg(unix)]
        if mesh == "link.obj" {
            std::os::unix::fs::symlink("../secret.obj", inside.join(mesh)).unwrap();
        }
        let text = scene_text(&format!("objects: [(name: \"a\", mesh: \"{mesh}\")]"));
        let (found, said) = outcome(&load_in_folder(&inside, text.as_bytes()));
        assert_eq!(found, Reject, "{mesh}: {said}");
        assert!(said.contains("scene.ron:2:29: error: "), "{mesh}: {said}");
    }
    // The same mesh is read when its folder is named.
    let mut options = LoadOptions::default();
    options.folders.extra.push(folder.path().to_owned());
    let text = scene_text("objects: [(name: \"a\", mesh: \"secret.obj\")]");
    fs::write(inside.join("scene.ron"), text).unwrap();
    let loaded = load::load(&inside.join("scene.ron"), &options).unwrap();
    assert_eq!(loaded.meshes["secret.obj"].mesh.polygon_count(), 6);
}

#[test]
fn faults_of_the_scene_and_of_its_files_are_reported_together() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("bad.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 nan\nf 1 2 3\n").unwrap();
    let text = scene_text(
        "size: (0, 1), objects: [(name: \"a\", mesh: \"bad.obj\"), (name: \"b\", mesh: \"no.obj\"),\n\
         (name: \"c\", mesh: \"cube.obj\", group: \"stem\")]",
    );
    let (found, said) = outcome(&load_in_folder(folder.path(), text.as_bytes()));
    assert_eq!(found, Reject);
    for expected in
        ["scene.ron:2:7: error: a picture", "bad.obj:3:", "\"no.obj\" was not found", "no group \"stem\""]
    {
        assert!(said.contains(expected), "{expected} is not in\n{said}");
    }
}

#[test]
fn a_bare_mesh_is_a_scene() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cube.obj");
    fs::write(&path, CUBE).unwrap();
    let overrides = vec![("objects.cube.particles".to_owned(), "77".to_owned())];
    let loaded = load::load(&path, &LoadOptions { overrides, ..LoadOptions::default() }).unwrap();
    assert_eq!(loaded.scene.objects[0].particles, Some(77));
    assert_eq!(loaded.meshes["cube.obj"].mesh.triangles.len(), 12);
    let overrides = vec![("size".to_owned(), "(0, 0)".to_owned())];
    let report = load::load(&path, &LoadOptions { overrides, ..LoadOptions::default() }).unwrap_err();
    assert!(report.to_string().starts_with("--set size=(0, 0): error: "), "{report}");
}

/// Opens files as the window does. A file that cannot be read is refused with a reason. A file whose text was read only
/// in part is never saved over.
#[test]
fn the_small_corpus_opens_in_the_editor_or_is_refused_and_stays_what_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let (mut refused, mut losses) = (0, 0);
    for case in corpus::made(folder.path()) {
        let before = fs::read(&case.file).unwrap();
        match Document::open_with_problems(&case.file, &LoadOptions::default()) {
            Err(report) => {
                refused += 1;
                assert!(report.0.iter().any(|problem| problem.severity.is_fatal()), "{}", case.name);
            }
            Ok(mut document) => {
                let loaded = document.loaded();
                let again = loaded.with_scene(loaded.scene.clone(), &Default::default());
                assert!(again.is_ok(), "{}: {:?}", case.name, again.map(drop));
                losses += usize::from(document.loss_count() > 0);
                if document.saving_loses() {
                    assert!(document.save().is_err(), "{}: saved over what it could not read", case.name);
                }
            }
        }
        assert!(fs::read(&case.file).unwrap() == before, "{} was touched", case.name);
    }
    assert!(refused > 5 && losses > 3, "{refused} refused, {losses} opened with losses");
}

/// Runs with the large corpus (`IMPASTO_CORPUS`): every RON file in its `hostile/ron` is refused with a line and
/// column, and every case in its `hostile/scene` is in `CASES` or `CASES_ELSEWHERE`.
#[test]
fn the_corpus_of_hostile_scenes_is_covered() {
    let Some(corpus) = corpus::shared("the_corpus_of_hostile_scenes_is_covered") else { return };
    let hostile = corpus.join("hostile");
    let names_in = |folder: &str| -> Vec<String> {
        let entries = fs::read_dir(hostile.join(folder)).unwrap();
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    };
    let mut refused = 0;
    for name in names_in("ron") {
        let path = hostile.join("ron").join(&name).join(format!("{name}.ron"));
        let Report(problems) = load::load(&path, &LoadOptions::default()).expect_err(&name);
        for problem in &problems {
            assert!(problem.place.is_some() && !problem.mend.is_empty(), "{problem}");
        }
        refused += 1;
    }
    assert!(refused > 0, "no RON file in {}", hostile.display());
    for name in names_in("scene") {
        let is_known = CASES.iter().any(|case| case.name == name) || CASES_ELSEWHERE.contains(&name.as_str());
        assert!(is_known, "the case {name} is not in the table");
    }
}
