//! Tests of what the window promises about the user's work, in the real window: nothing is lost by a kill or by a save
//! that fails, and what is wrong stays listed until it is mended.

use std::path::Path;

use impasto_tests::screen::{EditorWindow, Screen, wait_for};

use crate::editor_window::{folder, read};

/// Gives the apple's material a texture whose file, `skin.png`, does not exist.
fn with_a_missing_texture(folder: &Path) {
    let mtl = folder.join("meshes/apple.mtl");
    let text = std::fs::read_to_string(&mtl).unwrap();
    let named = text.replacen("newmtl red\n", "newmtl red\nmap_Kd skin.png\n", 1);
    assert_ne!(named, text);
    std::fs::write(&mtl, named).unwrap();
}

/// Writes the default settings, except that a copy is made after one second.
fn copied_after_a_second(folder: &Path) {
    std::fs::create_dir(folder.join("config")).unwrap();
    std::fs::write(folder.join("config/editor.ron"), "(copy_after_secs: 1)").unwrap();
}

/// The texts of the copies that are written whole.
fn copies(folder: &Path) -> Vec<String> {
    let Ok(copies) = std::fs::read_dir(folder.join("config/recovery")) else { return Vec::new() };
    // A copy that is still being written ends in `.part`.
    let whole = copies.flatten().map(|copy| copy.path());
    let whole = whole.filter(|path| path.extension().is_none_or(|end| end != "part"));
    whole.filter_map(|path| std::fs::read_to_string(path).ok()).collect()
}

fn move_the_apple(editor: &mut EditorWindow<'_>) {
    editor.click("Viewport");
    let shown = editor.rest().0;
    editor.keys(&["g", "x", "period", "5", "Return"]);
    editor.wait_for_title("apple.ron (edited) - Impasto");
    editor.rest_after(shown);
}

#[test]
fn work_outlives_a_kill_soon_after_an_edit() {
    let Some(screen) = Screen::open() else { return };
    let folder = folder();
    let before = read(folder.path(), "apple.ron");
    copied_after_a_second(folder.path());
    let mut editor = EditorWindow::open(&screen, "killed", folder.path(), "apple.ron");
    move_the_apple(&mut editor);
    wait_for("a copy of the work", || {
        let mut texts = copies(folder.path()).into_iter();
        texts.any(|text| text.contains("translation: (0.5")).then_some(())
    });
    // Dropping the window kills it.
    drop(editor);
    assert_eq!(read(folder.path(), "apple.ron"), before);
    let mut editor = EditorWindow::start(&screen, "killed_again", folder.path(), &["apple.ron"]);
    editor.click("Open what was being painted");
    editor.wait_for_title("apple.ron (edited) - Impasto");
    editor.keys(&["ctrl+s"]);
    editor.wait_for_title("apple.ron - Impasto");
    assert_eq!(read(folder.path(), "apple.ron").objects[0].keys[0].translation, [0.5, 0.0, 0.0]);
}

#[test]
fn an_edited_text_outlives_a_kill() {
    let Some(screen) = Screen::open() else { return };
    let folder = folder();
    let broken =
        std::fs::read_to_string(folder.path().join("apple.ron")).unwrap().replacen("seed:", "sead:", 1);
    assert!(broken.contains("sead:"));
    std::fs::write(folder.path().join("apple.ron"), &broken).unwrap();
    copied_after_a_second(folder.path());
    let mut editor = EditorWindow::open(&screen, "text", folder.path(), "apple.ron");
    // The text is wider than its panel, which scrolls, so the click goes to the upper left corner, which is seen.
    let text = editor.control("Source");
    screen.click(text.at([0.02, 0.12]));
    editor.keys(&["ctrl+Home"]);
    screen.type_text("// mine");
    wait_for("a copy of the text", || {
        let mut texts = copies(folder.path()).into_iter();
        texts.any(|text| text.contains("// edited| // mine") && text.contains("// source| ")).then_some(())
    });
    drop(editor);
    let mut editor = EditorWindow::start(&screen, "text_again", folder.path(), &["apple.ron"]);
    editor.click("Open what was being painted");
    editor.control("Read this text");
    editor.keep_picture("text");
    assert_eq!(editor.title(), "apple.ron - Impasto", "only the text was edited");
    assert_eq!(std::fs::read_to_string(folder.path().join("apple.ron")).unwrap(), broken);
}

#[test]
fn a_save_that_fails_stays_listed_until_the_work_is_saved_elsewhere() {
    let Some(screen) = Screen::open() else { return };
    let home = folder();
    let work = home.path().join("work");
    std::fs::create_dir(&work).unwrap();
    std::fs::copy(home.path().join("apple.ron"), work.join("apple.ron")).unwrap();
    std::fs::rename(home.path().join("meshes"), work.join("meshes")).unwrap();
    let mut editor = EditorWindow::open(&screen, "unsaved", home.path(), "work/apple.ron");
    move_the_apple(&mut editor);
    // The folder is gone, with the mesh.
    std::fs::rename(&work, home.path().join("moved")).unwrap();
    editor.keys(&["ctrl+s"]);
    editor.control("Show problems");
    editor.keep_picture("listed");
    editor.click("Save as");
    editor.control("File name");
    editor.keys(&["ctrl+a"]);
    screen.type_text(&home.path().join("elsewhere.ron").to_string_lossy());
    editor.keys(&["Return"]);
    // The scene is saved at once, without a question about files that are not there.
    editor.wait_for_title("elsewhere.ron - Impasto");
    editor.wait_until_gone("Save as");
    // The one problem left is that the mesh is gone.
    editor.control("Dismiss");
    editor.keep_picture("settled");
    let text = std::fs::read_to_string(home.path().join("elsewhere.ron")).unwrap();
    assert!(text.contains("translation: (0.5, 0") && text.contains("meshes/apple.obj"), "{text}");
}

#[test]
fn a_missing_texture_is_located_from_the_list_of_problems() {
    let Some(screen) = Screen::open() else { return };
    let folder = folder();
    with_a_missing_texture(folder.path());
    let elsewhere = tempfile::tempdir().unwrap();
    let picture = elsewhere.path().join("my skin.png");
    image_of_one_colour(&picture);
    let mut editor = EditorWindow::open(&screen, "texture", folder.path(), "apple.ron");
    editor.click("Show problems");
    editor.control("Retry skin.png");
    editor.keep_picture("listed");
    editor.click("Locate skin.png");
    editor.control("File name");
    screen.type_text(&picture.to_string_lossy());
    editor.keys(&["Return"]);
    editor.wait_until_gone("Show problems");
    editor.keep_picture("located");
    let brought = std::fs::read(folder.path().join("meshes/skin.png")).unwrap();
    assert_eq!(brought, std::fs::read(&picture).unwrap());
    assert_eq!(editor.title(), "apple.ron - Impasto", "the scene was not edited");
    assert_eq!(editor.quit(), Some(0));
}

/// `Retry` gives the mesh to the object whose mesh it was to replace, and adds no object.
#[test]
fn a_mesh_that_could_not_replace_another_is_retried_for_the_same_object() {
    let Some(screen) = Screen::open() else { return };
    let folder = folder();
    let mesh = folder.path().join("meshes/other.obj");
    std::fs::write(&mesh, "v 0 0 0\n").unwrap();
    let mut editor = EditorWindow::open(&screen, "replace", folder.path(), "apple.ron");
    let objects = read(folder.path(), "apple.ron").objects.len();
    editor.click("Arrange");
    editor.click("Viewport");
    editor.click("Mesh");
    editor.click("Replace mesh");
    editor.control("File name");
    screen.type_text(&mesh.to_string_lossy());
    editor.keys(&["Return"]);
    editor.control("Retry");
    editor.keep_picture("listed");
    std::fs::copy(folder.path().join("meshes/apple.obj"), &mesh).unwrap();
    editor.click("Retry");
    editor.wait_for_title("apple.ron (edited) - Impasto");
    editor.keys(&["ctrl+s"]);
    editor.wait_for_title("apple.ron - Impasto");
    let scene = read(folder.path(), "apple.ron");
    assert_eq!(scene.objects.len(), objects);
    assert_eq!(scene.objects[0].mesh, "meshes/other.obj");
}

/// Writes a PNG file of four red pixels.
fn image_of_one_colour(path: &Path) {
    let file = std::fs::File::create(path).unwrap();
    let mut encoder = png::Encoder::new(file, 2, 2);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&[200, 20, 20].repeat(4)).unwrap();
}

#[test]
fn the_window_opens_as_large_as_it_was() {
    let Some(screen) = Screen::open() else { return };
    let folder = folder();
    let editor = EditorWindow::open(&screen, "sized", folder.path(), "apple.ron");
    let [width, height] = [1000, 640].map(|side: i32| side.to_string());
    let window = ["search", "--onlyvisible", "--name", " - Impasto$"];
    screen.xdotool(&[&window[..], &["windowsize", "--sync", &width, &height]].concat());
    assert_eq!(editor.quit(), Some(0));
    let kept = std::fs::read_to_string(folder.path().join("config/editor.ron")).unwrap();
    assert!(kept.contains("window_size: (1000.0, 640.0)"), "{kept}");
    let mut editor = EditorWindow::open(&screen, "sized_again", folder.path(), "apple.ron");
    let status = editor.control("Status");
    assert!(status.corner[1] + status.size[1] <= 640 && status.corner[1] > 560, "{status:?}");
}
