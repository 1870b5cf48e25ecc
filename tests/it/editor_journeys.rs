//! Tests of whole tasks in the editor's real window, from start to end, with a picture of each step.

use std::path::Path;
use std::process::Command;

use impasto_scene::document::{Amount, Scene};
use impasto_tests::command::{impasto, root};
use impasto_tests::screen::{EditorWindow, Screen, wait_for};

use crate::editor_window::{folder, read};

/// Orbits by a drag with the middle button that begins in the upper part of the viewport.
fn orbit(editor: &mut EditorWindow<'_>, by_px: [i32; 2]) {
    let from = editor.control("Viewport").at([0.5, 0.18]);
    let to = [from[0] + by_px[0], from[1] + by_px[1]];
    let [from, to] = [from, to].map(|at| at.map(|at| at.to_string()));
    editor.screen.xdotool(&["mousemove", &from[0], &from[1], "mousedown", "2"]);
    editor.screen.xdotool(&["mousemove", &to[0], &to[1], "mouseup", "2"]);
}

/// Drags with the left button between two places, given in pixels from the viewport's middle.
fn comb(editor: &mut EditorWindow<'_>, from_px: [i32; 2], to_px: [i32; 2]) {
    let middle = editor.control("Viewport").middle();
    let place = |px: [i32; 2]| [middle[0] + px[0], middle[1] + px[1]];
    editor.screen.drag(place(from_px), place(to_px));
}

/// Replaces the number in a field by typing.
fn type_number(editor: &mut EditorWindow<'_>, name: &str, number: &str) {
    editor.click(name);
    editor.keys(&["ctrl+a"]);
    editor.screen.type_text(number);
    editor.keys(&["Return"]);
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
    editor.control("Open a mesh");
    assert_eq!(editor.title(), "Untitled - Impasto");
    editor.keep_picture("1_first_run");
    editor.click("Open a mesh");
    editor.control("File name");
    screen.type_text(&folder.path().join("apple.obj").to_string_lossy());
    editor.keys(&["Return"]);
    let mut shown = editor.rest_after(0);
    editor.keep_picture("2_opened");

    editor.keys(&["Tab"]);
    editor.wait_for_value("Paint, comb, shot camera, frame 0, reference");
    let strokes = [([-54, 14], [66, -46]), ([-64, 64], [66, 74]), ([-24, -66], [-19, 74])];
    for (from_px, to_px) in strokes {
        comb(&mut editor, from_px, to_px);
        shown = editor.rest_after(shown);
    }
    editor.keep_picture("3_combed");
    editor.click("Brush fan");
    shown = editor.rest_after(shown);
    type_number(&mut editor, "Length", "34");
    shown = editor.rest_after(shown);
    editor.keep_picture("4_brushed");
    orbit(&mut editor, [160, 0]);
    editor.wait_for_value("Paint, comb, free view, frame 0, reference");
    editor.keep_picture("5_looked_behind");
    editor.keys(&["KP_0"]);
    editor.wait_for_value("Paint, comb, shot camera, frame 0, reference");

    editor.keys(&["3"]);
    editor.wait_for_value("Animate, select, shot camera, frame 0, reference");
    type_number(&mut editor, "Current frame", "60");
    editor.wait_for_value("Animate, select, shot camera, frame 60");
    // The click meets the apple, which is in the middle of the viewport, and selects it.
    editor.click("Viewport");
    editor.keys(&["g", "x", "period", "3", "Return"]);
    shown = editor.rest_after(shown);
    editor.keys(&["r", "z", "minus", "1", "4", "0", "Return"]);
    editor.rest_after(shown);
    editor.keep_picture("6_posed");
    editor.keys(&["space"]);
    wait_for("some of the film", || (editor.printed("playing: ").len() > 8).then_some(()));
    editor.keep_picture("7_playing");
    editor.keys(&["space"]);

    editor.keys(&["ctrl+s"]);
    editor.control("File name");
    editor.keys(&["ctrl+a"]);
    screen.type_text("my film");
    editor.keep_picture("8_save");
    editor.keys(&["Return"]);
    editor.wait_for_title("my film.ron - Impasto");
    editor.keep_picture("9_saved");

    editor.keys(&["F12"]);
    editor.click("This frame");
    editor.click("Size 50 %");
    editor.keep_picture("10_render");
    editor.click("Start rendering");
    let picture = wait_for("a picture in out/", || {
        let mut files =
            std::fs::read_dir(folder.path().join("out")).ok()?.flatten().map(|entry| entry.path());
        files.find(|path| path.extension().is_some_and(|extension| extension == "png"))
    });
    // The button is back once rendering is finished.
    editor.control("Start rendering");
    editor.keep_picture("11_rendered");
    editor.keys(&["Escape"]);
    editor.wait_until_gone("Start rendering");
    assert_eq!(editor.quit(), Some(0));
    let frame = picture.file_stem().unwrap().to_string_lossy().rsplit('_').next().unwrap().to_owned();
    let mut command = Command::new(impasto());
    command.args(["render", "my film.ron", "--frames", &frame, "--size", "640x360", "-o", "again.png"]);
    assert!(command.current_dir(folder.path()).status().unwrap().success());
    let [window, again] = [picture, folder.path().join("again.png")].map(|path| std::fs::read(path).unwrap());
    assert!(window == again, "the window and the command line render different files");

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
    let [x, y] = editor.control("Viewport").middle().map(|at| at.to_string());
    screen.xdotool(&["mousemove", &x, &y]);
    editor.keys(&["Tab"]);
    editor.wait_for_value("Paint, comb, shot camera, frame 0, reference");
    editor.keys(&["shift+o"]);
    orbit(&mut editor, [220, 0]);
    editor.wait_for_value("Paint, comb, free view, frame 0, reference");
    editor.keep_picture("1_trust");
    for (from_px, to_px) in [([-64, -6], [56, -26]), ([-54, 54], [56, 44])] {
        comb(&mut editor, from_px, to_px);
        shown = editor.rest_after(shown);
    }
    editor.keep_picture("2_combed_behind");
    editor.keys(&["k"]);
    editor.wait_for_value("Paint, comb, free view, frame 0, reference, compared");
    editor.keep_picture("3_compared");
    editor.keys(&["k"]);
    editor.wait_for_value("Paint, comb, free view, frame 0, reference");
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
    editor.control("Show the problem");
    editor.keep_picture("2_save_refused");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), broken, "the broken file was saved over");
    editor.keys(&["Escape"]);
    editor.wait_until_gone("Show the problem");

    // Before it closes, the window asks about text that was typed into the panel of problems. Ctrl+Enter parses the
    // text into the document.
    let text_place = editor.control("Problems").at([0.8, 0.5]);
    screen.click(text_place);
    editor.keys(&["ctrl+End"]);
    screen.type_text(" // mine");
    editor.control("Read this text");
    editor.keys(&["ctrl+q"]);
    editor.control("Drop them");
    editor.keep_picture("3_text_not_read");
    editor.keys(&["Escape"]);
    editor.wait_until_gone("Drop them");
    screen.click(text_place);
    editor.keys(&["ctrl+Return"]);
    editor.wait_until_gone("Read this text");

    let shown = editor.rest().0;
    editor.click("Fix all that are certain");
    editor.rest_after(shown);
    editor.keep_picture("4_mended");
    editor.keys(&["ctrl+s"]);
    editor.wait_for_title("apple.ron - Impasto");
    assert_eq!(editor.quit(), Some(0));
    assert_eq!(read(folder.path(), "apple.ron"), whole);
}

#[test]
fn amounts_are_painted() {
    let Some(screen) = Screen::open() else { return };
    let folder = folder();
    let before = read(folder.path(), "apple.ron");
    let mut editor = EditorWindow::open(&screen, "amounts", folder.path(), "apple.ron");
    let [x, y] = editor.control("Viewport").middle().map(|at| at.to_string());
    screen.xdotool(&["mousemove", &x, &y]);
    editor.keys(&["Tab"]);
    editor.wait_for_value("Paint, comb, shot camera, frame 0, reference");
    let mut shown = editor.rest().0;
    editor.keys(&["p"]);
    editor.wait_for_value("Paint, amount, shot camera, frame 0, reference");
    for (from_px, to_px) in [([-90, -40], [-70, 60]), ([-60, -60], [-40, 70])] {
        comb(&mut editor, from_px, to_px);
        shown = editor.rest_after(shown);
    }
    editor.keep_picture("1_wide");
    screen.xdotool(&["keydown", "ctrl"]);
    comb(&mut editor, [40, -30], [60, 60]);
    screen.xdotool(&["keyup", "ctrl"]);
    shown = editor.rest_after(shown);
    editor.keep_picture("2_narrow");
    editor.click("Paint density");
    editor.click("Lower");
    comb(&mut editor, [-10, 40], [10, 90]);
    shown = editor.rest_after(shown);
    editor.keep_picture("3_thin");
    editor.keys(&["ctrl+s"]);
    editor.wait_for_title("apple.ron - Impasto");
    let painted = read(folder.path(), "apple.ron");
    std::fs::copy(folder.path().join("apple.ron"), folder.path().join("painted.ron")).unwrap();
    // With Shift the brush erases what is under its ring. One undo brings it back.
    screen.xdotool(&["keydown", "shift"]);
    comb(&mut editor, [-10, 40], [10, 90]);
    screen.xdotool(&["keyup", "shift"]);
    editor.wait_for_title("apple.ron (edited) - Impasto");
    shown = editor.rest_after(shown);
    editor.keep_picture("4_erased");
    editor.keys(&["ctrl+s"]);
    editor.wait_for_title("apple.ron - Impasto");
    let erased = read(folder.path(), "apple.ron");
    editor.keys(&["ctrl+z"]);
    editor.wait_for_title("apple.ron (edited) - Impasto");
    shown = editor.rest_after(shown);
    editor.keys(&["ctrl+s"]);
    editor.wait_for_title("apple.ron - Impasto");
    assert_eq!(read(folder.path(), "apple.ron"), painted);
    // The list of amounts is below the window's edge while the section of strokes above it is open.
    editor.click("Strokes");
    editor.wait_until_gone("Brush flat");
    editor.click("Clear width");
    editor.rest_after(shown);
    editor.keep_picture("5_cleared");
    editor.keys(&["ctrl+s"]);
    editor.wait_for_title("apple.ron - Impasto");
    let cleared = read(folder.path(), "apple.ron");
    assert_eq!(editor.quit(), Some(0));
    checked(folder.path(), "painted.ron");

    let of = |scene: &Scene| -> Vec<(Amount, usize)> {
        let amounts = scene.regions.iter().flat_map(|region| &region.amounts);
        amounts.map(|amount| (amount.of, amount.dabs.len())).collect()
    };
    let [(Amount::Width, width), (Amount::Density, density)] = of(&painted)[..] else {
        panic!("{:?}", of(&painted))
    };
    assert!(width >= 10 && density >= 2, "{width} {density}");
    let apple = |scene: &Scene| scene.regions.iter().position(|region| region.name == "apple").unwrap();
    let dabs = &painted.regions[apple(&painted)].amounts[0].dabs;
    assert!(dabs[0].by > 1.0 && dabs.last().unwrap().by < 1.0);
    assert_eq!(of(&erased), [(Amount::Width, width)]);
    assert_eq!(of(&cleared), [(Amount::Density, density)]);
    let bare = |mut scene: Scene| {
        scene.regions.iter_mut().for_each(|region| region.amounts.clear());
        scene
    };
    assert_eq!(bare(painted), before, "something else changed too");
}

#[test]
fn touches_are_laid_by_hand() {
    let Some(screen) = Screen::open() else { return };
    let folder = folder();
    let before = read(folder.path(), "apple.ron");
    let mut editor = EditorWindow::open(&screen, "touches", folder.path(), "apple.ron");
    let [x, y] = editor.control("Viewport").middle().map(|at| at.to_string());
    screen.xdotool(&["mousemove", &x, &y]);
    editor.keys(&["Tab"]);
    editor.wait_for_value("Paint, comb, shot camera, frame 0, reference");
    let mut shown = editor.rest().0;
    editor.keys(&["u"]);
    editor.wait_for_value("Paint, touch, shot camera, frame 0, reference");
    comb(&mut editor, [-60, -60], [-30, 70]);
    shown = editor.rest_after(shown);
    let middle = editor.control("Viewport").middle();
    screen.click([middle[0] + 40, middle[1] + 20]);
    shown = editor.rest_after(shown);
    editor.keep_picture("1_laid");
    editor.keys(&["ctrl+s"]);
    editor.wait_for_title("apple.ron - Impasto");
    let laid = read(folder.path(), "apple.ron");
    std::fs::copy(folder.path().join("apple.ron"), folder.path().join("laid.ron")).unwrap();
    // A drag with Shift across the long touch erases it. One undo brings it back.
    screen.xdotool(&["keydown", "shift"]);
    comb(&mut editor, [-70, 0], [-20, 10]);
    screen.xdotool(&["keyup", "shift"]);
    editor.wait_for_title("apple.ron (edited) - Impasto");
    shown = editor.rest_after(shown);
    editor.keys(&["ctrl+s"]);
    editor.wait_for_title("apple.ron - Impasto");
    let erased = read(folder.path(), "apple.ron");
    editor.keys(&["ctrl+z"]);
    editor.wait_for_title("apple.ron (edited) - Impasto");
    editor.rest_after(shown);
    editor.keep_picture("2_back");
    editor.keys(&["ctrl+s"]);
    editor.wait_for_title("apple.ron - Impasto");
    assert_eq!(read(folder.path(), "apple.ron"), laid);
    assert_eq!(editor.quit(), Some(0));
    checked(folder.path(), "laid.ron");

    let [long, one] = &laid.touches[..] else { panic!("{:?}", laid.touches) };
    assert!(long.points.len() > 1 && one.points.len() == 1);
    assert!(laid.touches.iter().all(|touch| touch.on == "apple"));
    assert_eq!(erased.touches, std::slice::from_ref(one));
    let bare = |scene: Scene| Scene { touches: Vec::new(), ..scene };
    assert_eq!(bare(laid), before, "something else changed too");
}
