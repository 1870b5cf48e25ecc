//! Tests that the editor renders what `impasto render` renders, byte for byte, and that the command that the editor
//! offers renders the same.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command as Process;
use std::time::Duration;

use impasto_editor::rendering::Rendering;
use impasto_editor_model::command::{Command, SceneEdit};
use impasto_editor_model::document::Document;
use impasto_editor_model::render_settings::{
    AovChoice, FileKind, Outcome, RenderDriver, RenderPlan, RenderSettings, Which, shell_words,
};
use impasto_scene::aovs::AovSet;
use impasto_scene::load::LoadOptions;
use impasto_tests::command::{impasto, root};

/// A scene of two cubes, one of which turns, with enough frames for two painters. The name of its file has a space, so
/// a shell needs it quoted.
fn document(folder: &Path) -> Document {
    std::fs::create_dir(folder).unwrap();
    std::fs::copy(root().join("scenes/meshes/cube.obj"), folder.join("cube.obj")).unwrap();
    let text = r#"(
        version: 1, size: (160, 90), timeline: (first: -1, last: 6, fps: 12), seed: 5, aovs: ["depth", "crypto.object"],
        camera: (keys: [(frame: 0, eye: (0, 1, 5), target: (0, 0, 0))]),
        lights: [(name: "sun", kind: Sun, direction: (0.8, -0.8, -0.3))],
        objects: [
            (name: "a", mesh: "cube.obj", particles: 600, keys: [(frame: 0), (frame: 4, rotation_deg: (0, 0, 80))]),
            (name: "b", mesh: "cube.obj", particles: 300, keys: [(frame: 0, translation: (1.5, 0, 0))]),
        ],
    )"#;
    std::fs::write(folder.join("two cubes.ron"), text).unwrap();
    Document::open(&folder.join("two cubes.ron"), &LoadOptions::default())
        .unwrap_or_else(|report| panic!("{report}"))
}

fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let named = |path: std::path::PathBuf| {
        (path.file_name().unwrap().to_string_lossy().into_owned(), std::fs::read(&path).unwrap())
    };
    entries.map(named).collect()
}

/// The files that the editor writes; removes the folder afterwards.
fn rendered(plan: RenderPlan) -> BTreeMap<String, Vec<u8>> {
    let folder = plan.folder().to_owned();
    let rendering = Rendering::start(plan, Default::default(), || ()).unwrap();
    assert!(rendering.wait(Duration::from_secs(300)));
    assert_eq!(rendering.progress().outcome, Some(Outcome::Done));
    let files = files(&folder);
    std::fs::remove_dir_all(folder).unwrap();
    files
}

/// The files that the plan's command writes in a shell; removes the folder afterwards.
fn commanded(plan: &RenderPlan, document: &Document) -> BTreeMap<String, Vec<u8>> {
    let words = plan.command(document).unwrap();
    let program = impasto().to_str().unwrap();
    let mut shell = Process::new("sh");
    // In another folder: the command has to work in any.
    shell.arg("-c").arg(shell_words(program, &words)).current_dir(std::env::temp_dir());
    let output = shell.output().unwrap();
    assert!(output.status.success(), "{words:?}: {}", String::from_utf8_lossy(&output.stderr));
    let files = files(plan.folder());
    std::fs::remove_dir_all(plan.folder()).unwrap();
    files
}

#[test]
fn the_editors_frames_are_those_of_the_command_that_it_copies() {
    let place = tempfile::tempdir().unwrap();
    let document = document(&place.path().join("it's #1 of $HOME"));
    let all = RenderSettings { driver: RenderDriver::Osmesa, ..RenderSettings::of(document.scene()) };
    let listed = RenderSettings {
        which: Which::Listed,
        list: "-1-3x2, 4".to_owned(),
        size_px: [90, 120],
        output: "out/my 'best' %03d.png".to_owned(),
        transparent: true,
        ..all.clone()
    };
    let this = RenderSettings {
        which: Which::This,
        output: "one/picture.png".to_owned(),
        driver: RenderDriver::Automatic,
        ..all.clone()
    };
    for (settings, names) in [
        (
            all,
            vec![
                "frame_-0001.png",
                "frame_0000.png",
                "frame_0001.png",
                "frame_0002.png",
                "frame_0003.png",
                "frame_0004.png",
                "frame_0005.png",
                "frame_0006.png",
            ],
        ),
        (listed, vec!["my 'best' -001.png", "my 'best' 001.png", "my 'best' 003.png", "my 'best' 004.png"]),
        (this, vec!["picture.png"]),
    ] {
        let plan = settings.plan(&document, 2.0).unwrap();
        assert!(!plan.is_outside());
        let by_command = commanded(&plan, &document);
        assert_eq!(by_command.keys().collect::<Vec<_>>(), names);
        let by_editor = rendered(plan);
        assert!(by_editor == by_command, "{settings:?}: other bytes");
    }
}

/// Whether an EXR file's header names a channel.
fn has_channel(bytes: &[u8], name: &str) -> bool {
    // The list of channels comes before all pixels, and a zero ends each name.
    let name = format!("\0{name}\0");
    bytes[..bytes.len().min(8192)].windows(name.len()).any(|part| part == name.as_bytes())
}

#[test]
fn every_kind_of_file_is_that_of_the_command() {
    let place = tempfile::tempdir().unwrap();
    let document = document(&place.path().join("scene"));
    let png = RenderSettings {
        which: Which::Listed,
        list: "2".to_owned(),
        size_px: [48, 27],
        driver: RenderDriver::Osmesa,
        ..RenderSettings::of(document.scene())
    };
    let of_kind = |kind: FileKind, aovs: AovChoice| {
        let mut settings = RenderSettings { aovs, ..png.clone() };
        settings.choose_kind(kind);
        settings
    };
    let listed = AovSet::of_words(["normal", "stroke.id", "layers"]).unwrap();
    let (png_name, exr_name) = ("frame_0002.png", "frame_0002.exr");
    let none: &[&str] = &[];
    for (settings, names, channels) in [
        (of_kind(FileKind::Png16, AovChoice::OfScene), vec![png_name], none),
        (of_kind(FileKind::Exr, AovChoice::NONE), vec![exr_name], none),
        (of_kind(FileKind::Exr, AovChoice::All), vec![exr_name], &["shadow.X", "stroke.id.X", "Z"]),
        (of_kind(FileKind::Exr, AovChoice::These(listed)), vec![exr_name], &["stroke.id.X"]),
        (of_kind(FileKind::PngAndExr, AovChoice::OfScene), vec![exr_name, png_name], &["Z"]),
    ] {
        let plan = settings.plan(&document, 2.0).unwrap();
        let by_command = commanded(&plan, &document);
        assert_eq!(by_command.keys().collect::<Vec<_>>(), names);
        if let Some(bytes) = by_command.get(exr_name) {
            assert!(has_channel(bytes, "B") || has_channel(bytes, "R"), "the file has no colour");
            for name in ["shadow.X", "stroke.id.X", "Z"] {
                assert_eq!(has_channel(bytes, name), channels.contains(&name), "{settings:?}: {name}");
            }
        }
        assert!(rendered(plan) == by_command, "{settings:?}: other bytes");
    }
}

#[test]
fn what_is_rendered_is_the_document_as_it_was() {
    let place = tempfile::tempdir().unwrap();
    let mut document = document(&place.path().join("scene"));
    let settings = RenderSettings {
        which: Which::This,
        driver: RenderDriver::Osmesa,
        ..RenderSettings::of(document.scene())
    };
    let plan = settings.plan(&document, 2.0).unwrap();
    let before = commanded(&plan, &document);
    // The document is edited and even saved after the plan was made.
    document.apply(&Command::Scene(SceneEdit::SetSeed(6))).unwrap();
    document.save().unwrap();
    assert!(commanded(&plan, &document) != before, "another seed is another picture");
    assert!(rendered(plan) == before);
}

#[test]
fn frames_that_are_there_stay_by_the_command_as_well() {
    let place = tempfile::tempdir().unwrap();
    let document = document(&place.path().join("scene"));
    let settings = RenderSettings {
        which: Which::Listed,
        list: "0-1".to_owned(),
        driver: RenderDriver::Osmesa,
        ..RenderSettings::of(document.scene())
    };
    let plan = settings.plan(&document, 0.0).unwrap().keeping();
    std::fs::create_dir_all(plan.folder()).unwrap();
    // These bytes end as a PNG file does, so the file counts as whole.
    let mine = b"mine\0\0\0\0IEND\xae\x42\x60\x82";
    std::fs::write(plan.path(0), mine).unwrap();
    let files = commanded(&plan, &document);
    assert_eq!(files["frame_0000.png"], mine);
    assert!(files.len() == 2 && files["frame_0001.png"].starts_with(b"\x89PNG"));
}
