//! Tests of the list of layers of paint, and of the chooser of presets.

use egui::{Modifiers, Role};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use impasto_editor::files::own_presets::OwnPreset;
use impasto_scene::document::{BrushMix, LayerSettings};
use impasto_scene::presets::{self, LayerKind};

use super::inspector::turn_the_wheel;
use super::{Column, click, harness, pick, region, type_in};

/// What the lemon states for a layer.
fn of_lemon(harness: &Harness<'_, Column>, name: &str) -> LayerSettings {
    let strokes = &harness.state().region("lemon").strokes;
    strokes.layers.iter().find(|layer| layer.name == name).cloned().unwrap_or_default()
}

fn value(harness: &Harness<'_, Column>, name: &str) -> Option<String> {
    harness.get_by_role_and_label(Role::SpinButton, name).accesskit_node().value()
}

fn open() -> Harness<'static, Column> {
    let mut harness = harness("still_life.ron", region("lemon"));
    click(&mut harness, "Paint layers");
    harness
}

#[test]
fn the_lights_are_on_top_and_a_region_has_no_ground() {
    let harness = open();
    let top = |kind: LayerKind| harness.get_by_label(&format!("Layer {}", kind.name())).rect().top();
    assert!(LayerKind::ALL.windows(2).all(|pair| top(pair[0]) > top(pair[1])));
    assert!(harness.query_by_label("Layer ground").is_none());
    let scene = super::harness("still_life.ron", None);
    let top = |name: &str| scene.get_by_label(name).rect().top();
    assert!(top("Layer ground") > top("Layer underpainting"));
}

#[test]
fn the_eye_hides_a_layer_and_its_numbers_stay() {
    let mut harness = open();
    type_in(&mut harness, "Opacity of lights", "0.4");
    let coverage = presets::resolve(harness.state().document.scene(), None).layers[6].coverage;
    click(&mut harness, "Hide layer lights");
    let state =
        |harness: &Harness<'_, Column>| harness.get_by_label("Hide layer lights").accesskit_node().toggled();
    assert_eq!(state(&harness), Some(egui::accesskit::Toggled::True));
    let layer = of_lemon(&harness, "lights");
    assert_eq!((layer.hidden, layer.opacity), (Some(true), Some(0.4)));
    assert_eq!(value(&harness, "Opacity of lights").as_deref(), Some("0.40"));
    // The row is selected, so that its numbers are shown.
    assert_eq!(value(&harness, "Layer coverage"), Some(format!("{coverage:.2}\u{d7}")));
    assert_eq!(harness.state().document.undo_text(), Some("Hide layer lights"));
    click(&mut harness, "Hide layer lights");
    assert_eq!(of_lemon(&harness, "lights").hidden, None);
    click(&mut harness, "Reset Opacity of lights");
    assert_eq!(of_lemon(&harness, "lights"), LayerSettings::default(), "the reset left something");
}

#[test]
fn a_region_opens_the_eye_that_the_scene_has_shut() {
    let mut harness = harness("still_life.ron", None);
    click(&mut harness, "Hide layer form");
    assert_eq!(harness.state().document.scene().strokes.layers[0].hidden, Some(true));
    click(&mut harness, "lemon, region");
    click(&mut harness, "Paint layers");
    click(&mut harness, "Hide layer form");
    assert_eq!(of_lemon(&harness, "form").hidden, Some(false));
    let scene = harness.state().document.scene();
    let lemon = scene.regions.iter().position(|region| region.name == "lemon");
    assert!(presets::resolve(scene, lemon).layer_of(LayerKind::Form).coverage > 0.0);
    assert!(presets::resolve(scene, None).layer_of(LayerKind::Form).coverage == 0.0);
}

#[test]
fn numbers_and_brushes_of_the_selected_layer_are_set_and_reset() {
    let mut harness = open();
    click(&mut harness, "Layer form");
    let before = value(&harness, "Thickness");
    type_in(&mut harness, "Thickness", "0.2");
    assert_eq!(of_lemon(&harness, "form").thickness, Some(0.2));
    click(&mut harness, "Reset Thickness");
    assert_eq!(value(&harness, "Thickness"), before);
    type_in(&mut harness, "Layer length", "50");
    assert_eq!(of_lemon(&harness, "form").length_px, Some(50.0));
    click(&mut harness, "Brush knife of form");
    let mix = |names: &[&str]| Some(BrushMix(names.iter().map(|name| (*name).to_owned()).collect()));
    assert_eq!(of_lemon(&harness, "form").brush, mix(&["knife"]));
    harness.event(egui::Event::ModifiersChanged(Modifiers::COMMAND));
    harness.get_by_label("Brush round of form").click_modifiers(Modifiers::COMMAND);
    harness.run();
    assert_eq!(of_lemon(&harness, "form").brush, mix(&["knife", "round"]));
    harness.event(egui::Event::ModifiersChanged(Modifiers::NONE));
    click(&mut harness, "Reset Brush of form");
    assert_eq!(of_lemon(&harness, "form").brush, None);
    // The layer `body` has the brush and the size of the region's strokes, so it has no rows for them.
    click(&mut harness, "Layer body");
    assert!(harness.query_by_label("Layer length").is_none());
    assert!(harness.query_by_label("Brush round of body").is_none());
}

#[test]
fn steps_of_two_layers_are_two_entries() {
    let mut harness = open();
    let count = harness.state().document.undo_count();
    for (layer, entries) in [("form", 1), ("form", 1), ("scumble", 2)] {
        click(&mut harness, &format!("Layer {layer}"));
        turn_the_wheel(&mut harness, "Thickness", -1.0, Modifiers::COMMAND);
        assert!(of_lemon(&harness, layer).thickness.is_some(), "{layer}");
        assert_eq!(harness.state().document.undo_count(), count + entries, "{layer}");
    }
}

#[test]
fn ink_has_no_order_of_layers() {
    let mut harness = harness("still_life.ron", None);
    click(&mut harness, "Layer form");
    assert!(harness.query_by_label("Move layer up").is_some());
    click(&mut harness, "Style ink");
    let from = harness.get_by_label("Layer form").rect().center();
    assert!(harness.query_by_label("Move layer up").is_none());
    harness.drag_at(from);
    harness.run();
    harness.hover_at(from + egui::vec2(0.0, 70.0));
    harness.run();
    harness.drop_at(from + egui::vec2(0.0, 70.0));
    harness.run();
    assert_eq!(presets::laying_order(harness.state().document.scene()), LayerKind::ALL);
}

#[test]
fn many_presets_leave_the_commands_within_reach() {
    let mut harness = harness("still_life.ron", region("lemon"));
    click(&mut harness, "Advanced");
    let named =
        |index| OwnPreset { name: format!("my {index}"), path: format!("/p/{index}.strokes.ron").into() };
    harness.state_mut().own_presets = (0..200).map(named).collect();
    click(&mut harness, "Preset");
    let top = |name: &str| harness.get_by_label(name).rect().top();
    assert!(top("Save as preset\u{2026}") < top("impressionist") && top("impressionist") < top("my 0"));
    click(&mut harness, "Load preset\u{2026}");
    assert_eq!(harness.state().asked_presets, ["load for lemon"]);
}

#[test]
fn a_row_is_dragged_to_another_place_and_buttons_move_it() {
    let mut harness = harness("still_life.ron", None);
    let order = |harness: &Harness<'_, Column>| presets::laying_order(harness.state().document.scene());
    let place = |harness: &Harness<'_, Column>, name: &str| harness.get_by_label(name).rect();
    let from = place(&harness, "Layer contour").center();
    let to = place(&harness, "Layer body");
    harness.drag_at(from);
    harness.run();
    for y in [from.y + 20.0, to.bottom() - 6.0] {
        harness.hover_at(egui::pos2(from.x, y));
        harness.run();
    }
    harness.drop_at(egui::pos2(from.x, to.bottom() - 6.0));
    harness.run();
    use LayerKind::{Accents, Body, Contour, Form, Lights, Scumble, Underpainting};
    assert_eq!(order(&harness), [Underpainting, Contour, Body, Form, Scumble, Accents, Lights]);
    assert!(place(&harness, "Layer contour").top() > place(&harness, "Layer body").top());
    assert_eq!(harness.state().document.undo_text(), Some("Order of layers"));
    click(&mut harness, "Layer contour");
    click(&mut harness, "Move layer down");
    assert_eq!(order(&harness)[..2], [Contour, Underpainting]);
    click(&mut harness, "Move layer up");
    assert_eq!(order(&harness)[..2], [Underpainting, Contour]);
    click(&mut harness, "Reset Order of layers");
    assert_eq!(order(&harness), LayerKind::ALL);
}

#[test]
fn the_ground_has_a_tone_and_an_opacity() {
    let mut harness = harness("still_life.ron", None);
    type_in(&mut harness, "Opacity of ground", "0.7");
    click(&mut harness, "Layer ground");
    assert!(harness.query_by_label("Tone of the ground").is_some());
    assert!(harness.query_by_label("Layer coverage").is_none());
    click(&mut harness, "Hide layer ground");
    let scene = harness.state().document.scene();
    assert_eq!(presets::ground(scene).opacity, 0.0);
    assert_eq!(presets::stated_ground(&scene.strokes).opacity, 0.7);
    assert_eq!(value(&harness, "Opacity of ground").as_deref(), Some("0.70"));
}

#[test]
fn presets_are_chosen_by_their_cards() {
    let mut harness = harness("still_life.ron", region("lemon"));
    click(&mut harness, "Advanced");
    pick(&mut harness, "Preset", "impressionist");
    assert_eq!(harness.state().region("lemon").strokes.preset.as_deref(), Some("impressionist"));
    pick(&mut harness, "Preset", "As the scene");
    assert_eq!(harness.state().region("lemon").strokes.preset, None);
    click(&mut harness, "Preset");
    assert!(harness.query_by_label("paper").is_none(), "`paper` is offered, though only a scene takes it");
    click(&mut harness, "Save as preset\u{2026}");
    assert_eq!(harness.state().asked_presets, ["save for lemon"]);
    click(&mut harness, "Preset");
    click(&mut harness, "mine");
    assert_eq!(harness.state().asked_presets[1], "use /presets/mine.strokes.ron for lemon");
}
