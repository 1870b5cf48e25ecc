//! Tests picking and dragging a lamp in the editor's real window.

use glam::{DVec2, DVec3};
use impasto_editor_model::picking::View;
use impasto_scene::document::{Light, Scene};
use impasto_scene::motion;
use impasto_tests::screen::{ControlRect, EditorWindow, Screen};

use crate::editor_window::{folder, read};

/// Where a point of the world shows in the window. The scene's picture is as wide as the viewport and lies in the
/// viewport's middle.
fn shown_at(scene: &Scene, viewport: &ControlRect, position: DVec3) -> DVec2 {
    let size = DVec2::new(f64::from(scene.size.0), f64::from(scene.size.1));
    let view = View {
        camera: motion::camera_at(scene, 0.0),
        size_px: size * (f64::from(viewport.size[0]) / size.x),
    };
    let [corner, sides] = [viewport.corner, viewport.size].map(|pair| DVec2::from(pair.map(f64::from)));
    corner + 0.5 * sides + view.project(position).unwrap() - view.size_px * 0.5
}

fn lamp(scene: &Scene) -> &Light {
    scene.lights.iter().find(|light| light.name == "lamp").unwrap()
}

fn place(scene: &Scene) -> DVec3 {
    DVec3::from(lamp(scene).position.unwrap())
}

#[test]
fn a_lamp_is_dragged_by_its_icon_and_is_saved_where_it_was_let_go() {
    let Some(screen) = Screen::open() else { return };
    let folder = folder();
    let file = folder.path().join("apple.ron");
    let text = std::fs::read_to_string(&file).unwrap();
    let lamp_line =
        "(name: \"lamp\", kind: Point, position: (-0.9, 0.9, 0.5), color: \"#ffb060\", intensity: 0.5),";
    let text = text.replacen("    lights: [\n", &format!("    lights: [\n        {lamp_line}\n"), 1);
    std::fs::write(&file, text).unwrap();
    let before = read(folder.path(), "apple.ron");
    let mut editor = EditorWindow::open(&screen, "lamp", folder.path(), "apple.ron");
    let mut shown = editor.rest().0;
    let viewport = editor.control("Viewport");
    let from = shown_at(&before, &viewport, place(&before));
    editor.keep_picture("opened");

    let whole = |at: DVec2| [at.x.round() as i32, at.y.round() as i32];
    let to = from + DVec2::new(70.0, -60.0);
    screen.drag(whole(from), whole(to));
    editor.wait_for_title("apple.ron (edited) - Impasto");
    shown = editor.rest_after(shown);
    editor.keep_picture("dragged");
    editor.keys(&["ctrl+s"]);
    editor.wait_for_title("apple.ron - Impasto");
    let after = read(folder.path(), "apple.ron");
    let let_go = shown_at(&after, &viewport, place(&after));
    assert!(let_go.distance(to) < 2.0, "the lamp shows at {let_go}, but was let go at {to}");
    let mut back = after.clone();
    back.lights[0].position = lamp(&before).position;
    assert_eq!(back, before, "nothing else moved");

    editor.keys(&["ctrl+z"]);
    editor.wait_for_title("apple.ron (edited) - Impasto");
    editor.rest_after(shown);
    editor.keys(&["ctrl+s"]);
    editor.wait_for_title("apple.ron - Impasto");
    assert_eq!(read(folder.path(), "apple.ron"), before);
    assert_eq!(editor.quit(), Some(0));
}
