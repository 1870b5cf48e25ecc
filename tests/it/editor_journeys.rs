//! What people come to the editor for, from start to end in the real window, with a picture of each step.

use std::path::Path;
use std::process::Command;

use impasto_scene::document::Scene;
use impasto_tests::command::{impasto, root};
use impasto_tests::screen::{EditorWindow, Screen, wait_for};

use crate::editor_window::{folder, read};

/// The field of the frame in the lanes' bar, and the first-run sheet's first button.
const FRAME_FIELD: [&str; 2] = ["182", "573"];
const OPEN_A_MESH: [&str; 2] = ["378", "560"];

/// In the render sheet.
const THIS_FRAME: [&str; 2] = ["515", "330"];
const HALF: [&str; 2] = ["650", "364"];
const RENDER: [&str; 2] = ["862", "514"];

/// Middles of the brushes and of the length in the inspector of a region.
const SECOND_BRUSH: [&str; 2] = ["1089", "529"];
const LENGTH: [&str; 2] = ["1170", "607"];

fn click(screen: &Screen, [x, y]: [&str; 2]) {
    screen.hand(&[
        "mousemove",
        x,
        y,
        "sleep",
        "0.2",
        "mousedown",
        "1",
        "sleep",
        "0.1",
        "mouseup",
        "1",
        "sleep",
        "0.2",
    ]);
}

fn orbit(screen: &Screen, by: [i32; 2]) {
    let to = [524 + by[0], 200 + by[1]].map(|at| at.to_string());
    screen.hand(&["mousemove", "524", "200", "sleep", "0.2", "mousedown", "2", "sleep", "0.1"]);
    screen.hand(&["mousemove", &to[0], &to[1], "sleep", "0.2", "mouseup", "2"]);
}

fn guides(scene: &Scene) -> usize {
    scene.regions.iter().map(|region| region.guides.len()).sum()
}

fn checked(folder: &Path, file: &str) {
    let output = Command::new(impasto()).args(["check", file]).current_dir(folder).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn from_a_mesh_to_a_saved_film() {
    let Some(screen) = Screen::open() else { return };
    let folder = tempfile::tempdir().unwrap();
    for name in ["apple.obj", "apple.mtl"] {
        std::fs::copy(root().join("scenes/meshes").join(name), folder.path().join(name)).unwrap();
    }
    let mut editor = EditorWindow::start(&screen, "film", folder.path(), &[]);
    wait_for("the first picture of the window", || (editor.title() == "Untitled - Impasto").then_some(()));
    screen.hand(&["sleep", "1"]);
    editor.keep_picture("1_first_run");
    click(&screen, OPEN_A_MESH);
    screen.hand(&[
        "sleep",
        "0.5",
        "type",
        "--delay",
        "40",
        &folder.path().join("apple.obj").to_string_lossy(),
    ]);
    editor.keys(&["Return"]);
    let mut shown = editor.rest_after(0);
    editor.keep_picture("2_opened");

    editor.keys(&["Tab"]);
    editor.wait_for_value("Paint, comb, shot camera, frame 0, reference");
    for (from, to) in [([470, 420], [590, 360]), ([460, 470], [590, 480]), ([500, 340], [505, 480])] {
        screen.drag(from, to);
        shown = editor.rest_after(shown);
    }
    editor.keep_picture("3_combed");
    click(&screen, SECOND_BRUSH);
    shown = editor.rest_after(shown);
    click(&screen, LENGTH);
    editor.keys(&["ctrl+a"]);
    screen.hand(&["type", "--delay", "60", "34"]);
    editor.keys(&["Return"]);
    shown = editor.rest_after(shown);
    editor.keep_picture("4_brushed");
    orbit(&screen, [160, 0]);
    editor.wait_for_value("Paint, comb, free view, frame 0, reference");
    editor.keep_picture("5_looked_behind");
    editor.keys(&["KP_0"]);
    editor.wait_for_value("Paint, comb, shot camera, frame 0, reference");

    editor.keys(&["3"]);
    editor.wait_for_value("Animate, select, shot camera, frame 0, reference");
    click(&screen, FRAME_FIELD);
    editor.keys(&["ctrl+a"]);
    screen.hand(&["type", "--delay", "60", "60"]);
    editor.keys(&["Return"]);
    editor.wait_for_value("Animate, select, shot camera, frame 60");
    // The object is the thing in the middle of the picture.
    click(&screen, ["524", "320"]);
    editor.keys(&["g", "x", "period", "3", "Return"]);
    shown = editor.rest_after(shown);
    editor.keys(&["r", "z", "minus", "1", "4", "0", "Return"]);
    editor.rest_after(shown);
    editor.keep_picture("6_posed");
    editor.keys(&["space"]);
    wait_for("some of the film", || (editor.told("playing: ").len() > 8).then_some(()));
    editor.keep_picture("7_playing");
    editor.keys(&["space"]);

    editor.keys(&["ctrl+s"]);
    screen.hand(&["sleep", "1"]);
    editor.keys(&["ctrl+a"]);
    screen.hand(&["type", "--delay", "60", "my film"]);
    editor.keep_picture("8_save");
    editor.keys(&["Return"]);
    editor.wait_for_title("my film.ron - Impasto");
    editor.keep_picture("9_saved");

    editor.keys(&["F12"]);
    screen.hand(&["sleep", "1"]);
    click(&screen, THIS_FRAME);
    click(&screen, HALF);
    editor.keep_picture("10_render");
    click(&screen, RENDER);
    let picture = wait_for("a picture in out/", || {
        let mut files =
            std::fs::read_dir(folder.path().join("out")).ok()?.flatten().map(|entry| entry.path());
        files.find(|path| path.extension().is_some_and(|extension| extension == "png"))
    });
    screen.hand(&["sleep", "1"]);
    editor.keep_picture("11_rendered");
    editor.keys(&["Escape"]);
    screen.hand(&["sleep", "0.5"]);
    assert_eq!(editor.quit(), Some(0));
    let frame = picture.file_stem().unwrap().to_string_lossy().rsplit('_').next().unwrap().to_owned();
    let mut command = Command::new(impasto());
    command.args(["render", "my film.ron", "--frames", &frame, "--size", "640x360", "-o", "again.png"]);
    assert!(command.current_dir(folder.path()).status().unwrap().success());
    let [window, again] = [picture, folder.path().join("again.png")].map(|path| std::fs::read(path).unwrap());
    assert!(window == again, "the window renders what the command line does");

    let scene = read(folder.path(), "my film.ron");
    checked(folder.path(), "my film.ron");
    assert_eq!(guides(&scene), 3, "three gestures");
    let apple = &scene.objects[0];
    assert_eq!(apple.keys.iter().map(|key| key.frame).collect::<Vec<_>>(), [0.0, 60.0]);
    let [first, last] = &apple.keys[..] else { panic!("two keys") };
    assert!((last.translation[0] - first.translation[0] - 0.3).abs() < 1e-9, "{:?}", apple.keys);
    assert!((last.rotation_deg[2] + 140.0).abs() < 1e-6, "{:?}", last.rotation_deg);
    assert!(scene.regions.iter().any(|region| region.strokes.length_px == Some(34.0)));
}

#[test]
fn directions_are_refined() {
    let Some(screen) = Screen::open() else { return };
    let folder = folder();
    let before = guides(&read(folder.path(), "apple.ron"));
    let mut editor = EditorWindow::open(&screen, "refine", folder.path(), "apple.ron");
    let mut shown = editor.rest().0;
    screen.hand(&["mousemove", "524", "406"]);
    editor.keys(&["Tab"]);
    editor.wait_for_value("Paint, comb, shot camera, frame 0, reference");
    editor.keys(&["shift+o"]);
    orbit(&screen, [220, 0]);
    editor.wait_for_value("Paint, comb, free view, frame 0, reference");
    editor.keep_picture("1_trust");
    for (from, to) in [([460, 400], [580, 380]), ([470, 460], [580, 450])] {
        screen.drag(from, to);
        shown = editor.rest_after(shown);
    }
    editor.keep_picture("2_combed_behind");
    editor.keys(&["k"]);
    screen.hand(&["sleep", "2"]);
    editor.keep_picture("3_compared");
    editor.keys(&["k"]);
    screen.hand(&["sleep", "1"]);
    editor.keys(&["ctrl+z"]);
    editor.rest_after(shown);
    editor.keys(&["ctrl+s"]);
    editor.wait_for_title("apple.ron - Impasto");
    assert_eq!(editor.quit(), Some(0));
    assert_eq!(guides(&read(folder.path(), "apple.ron")), before + 1, "two gestures, one taken back");
    checked(folder.path(), "apple.ron");
}

#[test]
fn a_broken_scene_is_mended() {
    let Some(screen) = Screen::open() else { return };
    let folder = folder();
    let path = folder.path().join("apple.ron");
    let whole = read(folder.path(), "apple.ron");
    let text = std::fs::read_to_string(&path).unwrap();
    let broken = text.replacen("contour: 0", "contuor: 0", 1);
    assert_ne!(broken, text);
    std::fs::write(&path, &broken).unwrap();
    let mut editor = EditorWindow::open(&screen, "broken", folder.path(), "apple.ron");
    editor.keep_picture("1_opened");
    editor.keys(&["ctrl+s"]);
    screen.hand(&["sleep", "1"]);
    editor.keep_picture("2_save_refused");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), broken, "less is never saved over it");
    editor.keys(&["Escape"]);
    screen.hand(&["sleep", "0.5"]);
    let shown = editor.rest().0;
    click(&screen, FIX_ALL);
    editor.rest_after(shown);
    editor.keep_picture("3_mended");
    editor.keys(&["ctrl+s"]);
    editor.wait_for_title("apple.ron - Impasto");
    assert_eq!(editor.quit(), Some(0));
    assert_eq!(read(folder.path(), "apple.ron"), whole);
}

/// *Fix all that are certain* in the panel of problems.
const FIX_ALL: [&str; 2] = ["100", "710"];
