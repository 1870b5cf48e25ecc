//! Tests of the scene tree, which is at the top of the column beside the viewport.

use std::path::Path;

use egui::{Key, Modifiers, Role, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use impasto_editor::panels;
use impasto_editor::theme::Theme;
use impasto_editor_model::keymap::Action;
use impasto_editor_model::{Document, Item, Selection};
use impasto_scene::document::LightKind;

use super::{Column, SIZE, assert_named, click, harness, harness_of, object, region};

#[test]
fn the_tree_names_every_row() {
    let harness = harness("still_life.ron", region("apple stem"));
    assert_named(
        &harness,
        &[
            "shot, camera",
            "window, light",
            "room, light",
            "apple, object",
            "apple, region, up",
            "apple stem, region, up",
            "apple leaf, region",
            "wall, region, crossing",
            "table, region, 3°",
            "jug rim, region, around",
            "canvas, background",
            "Expand apple",
            "Hide apple stem",
            "Search scene",
            "Add to scene",
        ],
    );
    let selected = harness.get_by_label("apple stem, region, up");
    assert_eq!(selected.accesskit_node().toggled(), Some(egui::accesskit::Toggled::True));
}

#[test]
fn a_row_is_hidden_locked_and_its_settings_dim() {
    let mut harness = harness("still_life.ron", region("lemon"));
    click(&mut harness, "Hide lemon");
    assert!(harness.state().region("lemon").hidden, "{:?}", harness.state().log);
    assert!(harness.query_by_label("lemon, region, hidden").is_some());
    click(&mut harness, "Region locked");
    assert!(harness.state().region("lemon").locked);
    assert!(harness.query_by_label("lemon is locked.").is_some());
    assert!(harness.get_by_label("Length").accesskit_node().is_disabled());
    click(&mut harness, "Region locked");
    assert!(!harness.get_by_label("Length").accesskit_node().is_disabled());
}

#[test]
fn things_are_renamed_in_the_tree_and_in_the_head() {
    let mut harness = harness("still_life.ron", region("lemon"));
    let ctx = harness.ctx.clone();
    assert!(panels::rename(&ctx, &harness.state().document));
    harness.run();
    harness.event(egui::Event::Text("peel".to_owned()));
    harness.run();
    harness.key_press(Key::Enter);
    harness.run();
    assert!(harness.query_by_label("peel, region").is_some(), "{:?}", harness.state().log);
    assert_eq!(harness.state().document.selection(), &Selection::only(Item::Region("peel".to_owned())));
    harness.get_by_label("Region name").focus();
    harness.run();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.event(egui::Event::Text("rind".to_owned()));
    harness.run();
    harness.key_press(Key::Enter);
    harness.run();
    assert_eq!(harness.state().document.undo_text(), Some("Rename to rind"));
    // Escape keeps the old name.
    assert!(panels::rename(&ctx, &harness.state().document));
    harness.run();
    harness.event(egui::Event::Text("pith".to_owned()));
    harness.run();
    harness.key_press(Key::Escape);
    harness.run();
    assert!(harness.query_by_label("rind, region").is_some());
}

#[test]
fn a_double_click_renames() {
    let mut harness = harness("apple.ron", None);
    let at = harness.get_by_label("wall, object").rect().center();
    harness.hover_at(at);
    harness.run();
    let button = |pressed| egui::Event::PointerButton {
        pos: at,
        button: egui::PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    harness.input_mut().events.extend([true, false, true, false].map(button));
    harness.run();
    assert!(harness.query_by_label("Rename wall").is_some(), "{:?}", harness.state().log);
}

#[test]
fn a_parent_is_set_by_its_combo_and_by_a_drag() {
    let mut harness = harness("still_life.ron", object("lemon"));
    harness.get_by_role_and_label(Role::DisclosureTriangle, "Parent").click();
    harness.run();
    let combo = harness.get_by_role_and_label(Role::ComboBox, "Parent");
    combo.click();
    harness.run();
    let row = harness.get_by_role_and_label(Role::MenuItemRadio, "apple");
    row.click();
    harness.run();
    let parent = |harness: &Harness<'_, Column>, name: &str| {
        let mut objects = harness.state().document.scene().objects.iter();
        objects.find(|object| object.name == name).and_then(|object| object.parent.clone())
    };
    assert_eq!(parent(&harness, "lemon").as_deref(), Some("apple"));
    let [from, to] = ["orange, object", "jug, object"].map(|name| harness.get_by_label(name).rect().center());
    harness.drag_at(from);
    harness.run();
    harness.hover_at(to);
    harness.run();
    harness.drop_at(to);
    harness.run();
    assert_eq!(parent(&harness, "orange").as_deref(), Some("jug"), "{:?}", harness.state().log);
}

#[test]
fn a_drag_between_rows_changes_their_order() {
    let mut harness = harness("still_life.ron", None);
    let from = harness.get_by_label("apple leaf, region").rect().center();
    let to = harness.get_by_label("apple, region, up").rect().center_top() + vec2(0.0, 3.0);
    harness.drag_at(from);
    harness.run();
    harness.hover_at(to);
    harness.run();
    harness.drop_at(to);
    harness.run();
    let names: Vec<_> =
        harness.state().document.scene().regions.iter().map(|region| region.name.as_str()).collect();
    assert_eq!(&names[names.len() - 3..], ["apple leaf", "apple", "apple stem"]);
    assert_eq!(harness.state().document.undo_text(), Some("Move apple leaf up"));
}

#[test]
fn shift_adds_to_the_selection_and_a_search_narrows_the_tree() {
    let mut harness = harness("still_life.ron", object("jug"));
    harness.get_by_label("lemon, object").click_modifiers(Modifiers::SHIFT);
    harness.run();
    let selected: Vec<_> = harness.state().document.selection().objects().map(str::to_owned).collect();
    assert_eq!(selected, ["jug", "lemon"]);
    click(&mut harness, "Search scene");
    harness.event(egui::Event::Text("RIM".to_owned()));
    harness.run();
    assert!(harness.query_by_label("jug rim, region, around").is_some());
    assert!(harness.query_by_label("jug, object").is_some(), "the object of the found region stays");
    assert!(harness.query_by_label("apple, object").is_none());
}

#[test]
fn lights_and_regions_are_added_from_the_menu() {
    let mut harness = harness("apple.ron", object("apple"));
    click(&mut harness, "Add to scene");
    assert!(harness.query_by_label("Region stem").is_none(), "a region is offered for a group that has one");
    click(&mut harness, "Lamp");
    let light = harness.state().document.scene().lights.last().cloned().expect("there is one");
    assert_eq!(light.kind, LightKind::Point);
    assert_eq!(harness.state().document.selection(), &Selection::only(Item::Light(light.name)));
    click(&mut harness, "Add to scene");
    click(&mut harness, "Import mesh\u{2026}");
    assert_eq!(harness.state().acts, [Action::ImportMesh]);
}

#[test]
fn an_empty_tree_says_so() {
    let column = Column::of(Document::empty(Path::new(".")));
    let harness = harness_of(column, Theme::Dark, SIZE);
    assert!(harness.query_by_label("No objects yet. Drop a mesh anywhere, or press +").is_some());
    assert!(harness.query_by_label("Select something to see its settings.").is_some());
}
