//! Tests of what colours a surface and its strokes: colour, texture and gloss of an object, pigments of a region.

use egui::{Key, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use impasto_editor::theme::Theme;
use impasto_editor_model::{Document, Selection};
use impasto_scene::document::{Color, MaterialOverride};
use impasto_scene::load::LoadOptions;

use super::{Column, click, harness_of, object, region, right_click, type_in};

const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n";

/// A folder with a mesh that has texture coordinates, one that has none, a picture, and a PNG file that is no picture.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("written");
    write("leaf.obj", OBJ);
    write("bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write("bad.png", "no picture");
    let scene = |mesh: &str| {
        format!(
            "(version: 1, size: (64, 36), camera: (keys: [(frame: 0, eye: (0, 0, 4), target: (0, 0, 0))]), \
             objects: [(name: \"leaf\", mesh: \"{mesh}\")])"
        )
    };
    write("leaf.ron", &scene("leaf.obj"));
    write("bare.ron", &scene("bare.obj"));
    let skin = image::RgbaImage::from_pixel(4, 4, image::Rgba([200, 60, 40, 255]));
    skin.save(folder.path().join("skin.png")).expect("written");
    folder
}

fn opened(folder: &tempfile::TempDir, scene: &str) -> Harness<'static, Column> {
    let mut document =
        Document::open(&folder.path().join(scene), &LoadOptions::default()).expect("a scene opens");
    document.select(Selection::from_iter(object("leaf")));
    let mut column = Column::of(document);
    column.tree_height = 300.0;
    harness_of(column, Theme::Dark, vec2(280.0, 1600.0))
}

fn material(harness: &Harness<'_, Column>) -> Option<MaterialOverride> {
    harness.state().document.scene().objects[0].material.clone()
}

fn log<'a>(harness: &'a Harness<'_, Column>) -> Option<&'a str> {
    harness.state().log.last().map(String::as_str)
}

/// Types the name of a file into a line of text.
fn name_file(harness: &mut Harness<'_, Column>, field: &str, file: &str) {
    harness.get_by_label(field).focus();
    harness.run();
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::A);
    harness.run();
    harness.event(egui::Event::Text(file.to_owned()));
    harness.run();
    harness.key_press(Key::Enter);
    harness.run();
}

/// Opens the picker of a square of colour by a click, drags over its field of colours, and closes it.
fn pick_colour(harness: &mut Harness<'_, Column>, square: &str) {
    // A button of egui's picker has a glyph that no font of the window has. This draws an empty box in its place.
    harness.ctx.set_missing_glyph_policy(egui::MissingGlyphPolicy::Tofu);
    let at = harness.get_by_label(square).rect();
    click(harness, square);
    let from = at.left_bottom() + vec2(30.0, 190.0);
    harness.drag_at(from);
    harness.run();
    for step in 1..=4 {
        harness.hover_at(from + vec2(20.0 * step as f32, 0.0));
        harness.run();
    }
    harness.drop_at(from + vec2(80.0, 0.0));
    harness.run();
    harness.key_press(Key::Escape);
    harness.run();
}

#[test]
fn a_colour_is_picked_as_one_entry_of_the_history_and_reset() {
    let folder = folder();
    let mut harness = opened(&folder, "leaf.ron");
    assert_eq!(material(&harness), None);
    pick_colour(&mut harness, "Material colour");
    let picked = material(&harness).and_then(|material| material.color);
    assert!(picked.is_some_and(|color| color != Color::white()), "{picked:?}");
    assert!(harness.state().log.iter().any(|words| words == "preview"), "it shows while it is picked");
    assert_eq!((log(&harness), harness.state().document.undo_count()), (Some("Colour of leaf"), 1));
    harness.state_mut().document.undo();
    harness.run();
    assert_eq!(material(&harness), None);
    harness.state_mut().document.redo();
    harness.run();
    click(&mut harness, "Reset Material colour");
    assert_eq!((material(&harness), log(&harness)), (None, Some("Reset colour of leaf")));
}

#[test]
fn colour_texture_and_gloss_are_saved_as_a_person_writes_them_and_read_again() {
    let folder = folder();
    let mut harness = opened(&folder, "leaf.ron");
    name_file(&mut harness, "Texture file", "skin.png");
    assert_eq!(log(&harness), Some("Texture of leaf"));
    assert!(harness.state().document.shown().textures.contains_key("skin.png"), "the texture is not loaded");
    type_in(&mut harness, "Gloss", "0.6");
    pick_colour(&mut harness, "Material colour");
    let stated = material(&harness).expect("an override");
    let color = stated.color.expect("a colour");

    let target = folder.path().join("leaf.ron");
    harness.state_mut().document.save_as(&target).expect("saved");
    let text = std::fs::read_to_string(&target).expect("there");
    let line = format!("material: (color: \"{}\", texture: \"skin.png\", gloss: 0.6)", color.to_hex());
    assert!(text.contains(&line), "{text}");
    let again = Document::open(&target, &LoadOptions::default()).expect("it opens again");
    assert_eq!(again.scene().objects[0].material, Some(stated));
    assert!(again.loaded().textures.contains_key("skin.png"));

    click(&mut harness, "Reset Texture file");
    assert_eq!(log(&harness), Some("Reset texture of leaf"));
    click(&mut harness, "Reset Gloss");
    click(&mut harness, "Reset Material colour");
    assert_eq!(material(&harness), None, "back to the model's own");
    harness.state_mut().document.save_as(&target).expect("saved");
    assert!(!std::fs::read_to_string(&target).expect("there").contains("material"));
}

#[test]
fn a_picture_that_cannot_be_used_changes_nothing() {
    let folder = folder();
    let mut harness = opened(&folder, "leaf.ron");
    for (file, why) in [("bad.png", "format of the picture is unknown"), ("nowhere.png", "was not found")] {
        name_file(&mut harness, "Texture file", file);
        let words = log(&harness).unwrap_or_default();
        assert!(words.starts_with("refused: ") && words.contains(why), "{words}");
        assert_eq!((material(&harness), harness.state().document.undo_count()), (None, 0));
    }
    click(&mut harness, "Browse for Texture file");
    assert_eq!(log(&harness), Some("choose the texture of leaf"));
}

#[test]
fn a_mesh_without_places_for_a_picture_says_so() {
    let folder = folder();
    let words = "The mesh has no UV coordinates, so nothing says where the picture lies.";
    for (scene, says) in [("leaf.ron", false), ("bare.ron", true)] {
        let mut harness = opened(&folder, scene);
        name_file(&mut harness, "Texture file", "skin.png");
        assert_eq!(harness.query_by_label(words).is_some(), says, "{scene}");
    }
}

#[test]
fn pigments_of_a_region_are_added_picked_taken_out_and_reset() {
    let mut column = Column::open("still_life.ron");
    column.document.select(Selection::from_iter(region("lemon")));
    // Wide enough for the picker below its square.
    let mut harness = harness_of(column, Theme::Dark, vec2(700.0, 1600.0));
    let palette = |harness: &Harness<'_, Column>| harness.state().region("lemon").strokes.palette.clone();
    assert_eq!(palette(&harness), None);
    click(&mut harness, "Add a pigment to the palette");
    click(&mut harness, "Add a pigment to the palette");
    assert_eq!(palette(&harness).map(|palette| palette.len()), Some(2));
    pick_colour(&mut harness, "Pigment 2");
    let picked = palette(&harness).expect("a palette");
    assert_ne!(picked[0], picked[1]);
    right_click(&mut harness, "Pigment 1");
    click(&mut harness, "Take out");
    assert_eq!(palette(&harness), Some(vec![picked[1]]));
    click(&mut harness, "Reset Palette");
    assert_eq!((palette(&harness), log(&harness)), (None, Some("Any colour")));
    assert_eq!(harness.state().document.undo_count(), 5, "each is an entry");
}

#[test]
fn a_region_leads_to_the_material_of_its_object() {
    let mut column = Column::open("still_life.ron");
    column.document.select(Selection::from_iter(region("lemon")));
    let mut harness = harness_of(column, Theme::Dark, vec2(280.0, 1600.0));
    click(&mut harness, "Material of lemon");
    harness.run();
    assert_eq!(harness.state().document.selection(), &Selection::from_iter(object("lemon")));
    let head = harness.get_by_role_and_label(egui::Role::DisclosureTriangle, "Material");
    assert!(head.accesskit_node().is_focused());
}
