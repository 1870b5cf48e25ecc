//! Tests of the editor's real window. It opens on an Xvfb, xdotool moves the mouse and presses keys, and the files that
//! the editor saves are read and painted to check them.

use std::path::Path;
use std::process::Command;

use glam::DVec2;
use impasto_scene::document::{Guide, GuideMode, Scene};
use impasto_scene::load::{LoadOptions, load};
use impasto_tests::command::{impasto, root};
use impasto_tests::screen::{ControlRect, EditorWindow, Screen};

/// A folder with a scene of the apple alone. It has few particles, so that it is painted quickly, and its strokes lie
/// exactly along their directions.
pub(crate) fn folder() -> tempfile::TempDir {
    let (folder, alone) = apple_alone(12_000);
    let strokes = "    strokes: (angle_jitter_deg: 0, swing_deg: 0, contour: 0),\n";
    let exact = alone.replacen("    regions: [\n", &format!("{strokes}    regions: [\n"), 1);
    std::fs::write(folder.path().join("apple.ron"), exact).unwrap();
    let scene = read(folder.path(), "apple.ron");
    assert_eq!((scene.objects.len(), scene.objects[0].particles), (1, Some(12_000)));
    assert_eq!(scene.strokes.contour, Some(0.0));
    folder
}

/// A folder with the shipped apple's mesh, and the text of its scene without the wall and with `particles` particles.
pub(crate) fn apple_alone(particles: usize) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let scenes = root().join("scenes");
    std::fs::create_dir(folder.path().join("meshes")).unwrap();
    for name in ["apple.obj", "apple.mtl"] {
        let name = Path::new("meshes").join(name);
        std::fs::copy(scenes.join(&name), folder.path().join(&name)).unwrap();
    }
    let shipped = std::fs::read_to_string(scenes.join("apple.ron")).unwrap();
    assert!(shipped.contains("particles: 45658"));
    let alone: String = shipped.split_inclusive('\n').filter(|line| !line.contains("\"wall\"")).collect();
    (folder, alone.replacen("particles: 45658", &format!("particles: {particles}"), 1))
}

pub(crate) fn read(folder: &Path, file: &str) -> Scene {
    load(&folder.join(file), &LoadOptions::default()).unwrap_or_else(|report| panic!("{report}")).scene
}

fn guides(folder: &Path) -> Vec<Guide> {
    let mut scene = read(folder, "apple.ron");
    let region = scene.regions.iter_mut().find(|region| region.name == "apple").unwrap();
    std::mem::take(&mut region.guides)
}

/// A place in the window as a place in the rendered picture: pixels from the picture's lower left corner, Y up. The
/// window shows this picture as wide as the viewport, and in the viewport's middle.
fn in_picture(at: [i32; 2], viewport: &ControlRect, size: (u32, u32)) -> DVec2 {
    let plain = |[x, y]: [i32; 2]| DVec2::new(f64::from(x), f64::from(y));
    let size = DVec2::new(f64::from(size.0), f64::from(size.1));
    let from_middle = plain(at) - plain(viewport.corner) - plain(viewport.size) * 0.5;
    let px_per_point = size.x / f64::from(viewport.size[0]);
    size * 0.5 + from_middle * DVec2::new(1.0, -1.0) * px_per_point
}

/// Place in pixels and angle in degrees of the apple's strokes in three layers, as `impasto strokes` prints them.
fn strokes(folder: &Path, file: &str) -> Vec<(DVec2, f64)> {
    let mut command = Command::new(impasto());
    command.args(["strokes", file, "--frame", "0", "--format", "csv"]).current_dir(folder);
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let header = lines.next().unwrap();
    let column = |name: &str| header.iter().position(|other| *other == name).unwrap();
    let [region, layer, x, y, angle] = ["region", "layer", "x_px", "y_px", "angle_deg"].map(column);
    let number = |text: &str| text.parse::<f64>().unwrap();
    lines
        .filter(|line| line[region] == "apple" && ["underpainting", "body", "scumble"].contains(&line[layer]))
        .map(|line| (DVec2::new(number(line[x]), number(line[y])), number(line[angle])))
        .collect()
}

fn lines_apart_deg(a: f64, b: f64) -> f64 {
    let off = (a - b).rem_euclid(180.0);
    off.min(180.0 - off)
}

#[test]
fn a_drag_over_the_apple_is_in_the_saved_file_as_it_was_drawn() {
    let Some(screen) = Screen::open() else { return };
    let folder = folder();
    let mut editor = EditorWindow::open(&screen, "comb", folder.path(), "apple.ron");
    assert_eq!(editor.title(), "apple.ron - Impasto");
    editor.keep_picture("opened");

    let viewport = editor.control("Viewport");
    let [x, y] = viewport.middle();
    let hover = |x: i32| screen.xdotool(&["mousemove", &x.to_string(), &y.to_string()]);
    hover(x);
    editor.keys(&["Tab"]);
    editor.wait_for_value("Paint, comb, shot camera, frame 0, reference");
    // Raises the strength from 80 % to 100 %, so that strokes follow the drag exactly.
    editor.keys(&["shift+f"]);
    hover(x + 56);
    hover(x + 96);
    editor.keys(&["Return"]);

    let (from, to) = ([x - 70, y + 14], [x + 70, y - 46]);
    let mut shown = editor.rest().0;
    screen.drag(from, to);
    editor.wait_for_title("apple.ron (edited) - Impasto");
    shown = editor.rest_after(shown);
    editor.keep_picture("combed");
    editor.keys(&["ctrl+s"]);
    editor.wait_for_title("apple.ron - Impasto");
    let [combed] = &guides(folder.path())[..] else { panic!("one guide") };
    assert_eq!(combed.mode, GuideMode::Comb);
    std::fs::copy(folder.path().join("apple.ron"), folder.path().join("combed.ron")).unwrap();

    screen.xdotool(&["keydown", "shift"]);
    screen.drag([x - 54, y + 74], [x + 46, y + 84]);
    screen.xdotool(&["keyup", "shift"]);
    editor.wait_for_title("apple.ron (edited) - Impasto");
    shown = editor.rest_after(shown);
    editor.keep_picture("smoothed");
    editor.keys(&["ctrl+z"]);
    editor.wait_for_title("apple.ron - Impasto");
    shown = editor.rest_after(shown);
    editor.keys(&["ctrl+shift+z"]);
    editor.wait_for_title("apple.ron (edited) - Impasto");
    editor.rest_after(shown);
    editor.keys(&["ctrl+s"]);
    editor.wait_for_title("apple.ron - Impasto");
    let saved = guides(folder.path());
    assert_eq!(
        saved.iter().map(|guide| guide.mode).collect::<Vec<_>>(),
        [GuideMode::Comb, GuideMode::Smooth]
    );
    assert_eq!(saved[0], *combed);
    assert_eq!(editor.quit(), Some(0));

    let size = read(folder.path(), "combed.ron").size;
    let [from, to] = [from, to].map(|at| in_picture(at, &viewport, size));
    let way = to - from;
    let dragged_deg = way.to_angle().to_degrees();
    // For each stroke: its place along the drag (0 to 1), its distance from the drag in pixels, and its angle to the
    // drag in degrees.
    let seen: Vec<(f64, f64, f64)> = strokes(folder.path(), "combed.ron")
        .into_iter()
        .map(|(at, angle_deg)| {
            let along = (at - from).dot(way) / way.length_squared();
            let aside_px = (at - from).perp_dot(way.normalize()).abs();
            (along, aside_px, lines_apart_deg(angle_deg, dragged_deg))
        })
        .collect();
    let mean = |of: Vec<f64>| (of.iter().sum::<f64>() / of.len() as f64, of.len());
    let core = seen.iter().filter(|(along, aside_px, _)| (0.15..0.85).contains(along) && *aside_px < 8.0);
    let (core_deg, core_count) = mean(core.map(|seen| seen.2).collect());
    let far = seen.iter().filter(|(along, aside_px, _)| (0.15..0.85).contains(along) && *aside_px > 75.0);
    let (far_deg, far_count) = mean(far.map(|seen| seen.2).collect());
    println!(
        "along the drag {core_deg:.3} degrees off ({core_count}), far from it {far_deg:.1} ({far_count})"
    );
    assert!(core_count >= 10 && core_deg <= 1.0, "{core_deg} degrees off the drag, {core_count} strokes");
    assert!(far_count >= 100 && far_deg > 30.0, "{far_deg} degrees far from the drag, {far_count} strokes");
}

#[test]
fn a_name_typed_into_the_path_sheet_is_the_files() {
    let Some(screen) = Screen::open() else { return };
    let folder = folder();
    let mut editor = EditorWindow::open(&screen, "save_as", folder.path(), "apple.ron");
    let old = std::fs::read(folder.path().join("apple.ron")).unwrap();
    let value = editor.rest().1;
    editor.keys(&["ctrl+shift+s"]);
    editor.wait_for_value(&format!("{value}, under a sheet"));
    editor.keys(&["ctrl+a"]);
    screen.type_text("my apple");
    editor.keep_picture("sheet");
    editor.keys(&["Return"]);
    editor.wait_for_title("my apple.ron - Impasto");
    assert_eq!(std::fs::read(folder.path().join("apple.ron")).unwrap(), old);
    assert_eq!(read(folder.path(), "my apple.ron"), read(folder.path(), "apple.ron"));
    assert_eq!(editor.quit(), Some(0));
}

#[test]
fn a_typed_move_moves_just_so_far_and_undo_brings_it_back() {
    let Some(screen) = Screen::open() else { return };
    let folder = folder();
    let mut editor = EditorWindow::open(&screen, "move", folder.path(), "apple.ron");
    let before = read(folder.path(), "apple.ron");
    editor.click("Viewport");
    let shown = editor.rest().0;
    editor.keys(&["g", "x", "period", "5", "Return"]);
    editor.wait_for_title("apple.ron (edited) - Impasto");
    let shown = editor.rest_after(shown);
    editor.keep_picture("moved");
    editor.keys(&["ctrl+s"]);
    editor.wait_for_title("apple.ron - Impasto");
    let mut moved = read(folder.path(), "apple.ron");
    assert_eq!(moved.objects[0].keys[0].translation, [0.5, 0.0, 0.0]);
    moved.objects[0].keys[0].translation = [0.0; 3];
    assert_eq!(moved, before, "more than the translation of the apple has changed");
    editor.keys(&["ctrl+z"]);
    editor.wait_for_title("apple.ron (edited) - Impasto");
    editor.rest_after(shown);
    editor.keys(&["ctrl+s"]);
    editor.wait_for_title("apple.ron - Impasto");
    assert_eq!(read(folder.path(), "apple.ron"), before);
    assert_eq!(editor.quit(), Some(0));
}
