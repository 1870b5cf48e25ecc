//! Tests of the settings of ink in the inspector.

use egui_kittest::kittest::Queryable as _;
use impasto_editor_model::command::{Command, Regions, SceneEdit, StrokeChange, StrokesOf};
use impasto_scene::document::{InkRule, Style, SumiE};

use super::{Column, assert_named, click, drag, harness, harness_of, type_in};

fn ink_of(column: &Column) -> SumiE {
    match &column.document.scene().style {
        Style::SumiE(ink) => ink.clone(),
        other => panic!("the style is {other:?}"),
    }
}

#[test]
fn ink_is_chosen_set_and_taken_back() {
    let mut harness = harness("apple.ron", None);
    click(&mut harness, "Style ink");
    assert_eq!(ink_of(harness.state()), SumiE::default());
    type_in(&mut harness, "Bleed", "0.9");
    type_in(&mut harness, "Tone 2", "0.5");
    let ink = ink_of(harness.state());
    assert_eq!((ink.bleed, ink.tones[1]), (0.9, 0.5));
    // A tone may not go below the one before it, and the rim must end after it begins.
    type_in(&mut harness, "Tone 1", "0.9");
    type_in(&mut harness, "Rim from", "0.95");
    let ink = ink_of(harness.state());
    assert!(ink.tones[0] <= ink.tones[1], "{:?}", ink.tones);
    assert!(ink.silhouette_from < ink.silhouette_to, "{ink:?}");
    let count = harness.state().document.undo_count();
    drag(&mut harness, "Density", 20.0);
    assert_eq!(harness.state().document.undo_count(), count + 1);
    assert!(ink_of(harness.state()).density > 1.0);
    click(&mut harness, "Rule source");
    assert_eq!(ink_of(harness.state()).rule, InkRule::Source);
    assert!(harness.query_by_label("Bleed").is_none(), "the source's rule knows no bleeding");
    click(&mut harness, "Style plain");
    assert_eq!(harness.state().document.scene().style, Style::Reference);
    while harness.state().document.undo_count() > 0 {
        harness.state_mut().document.undo();
    }
    assert!(matches!(harness.state().document.scene().style, Style::RotatingStrokes(_)));
}

#[test]
fn every_number_of_the_ink_has_its_place() {
    let mut column = Column::open("apple.ron");
    column.apply(Command::Scene(SceneEdit::SetStyle(Style::SumiE(SumiE::default()), String::new())));
    let harness = harness_of(column, impasto_editor::theme::Theme::Dark, egui::vec2(280.0, 1400.0));
    let names = [
        "Density",
        "Silhouette",
        "Rim from",
        "Rim to",
        "Softness",
        "Own tone",
        "Blur",
        "Bleed",
        "Bleed px",
        "Dryness",
        "Fibres",
        "Accent",
        "Tone 1",
        "Tone 4",
        "Paper colour",
        "Ink colour",
        "Seal colour",
        "Drawing wash",
        "Light eye",
        "Paper follows camera",
    ];
    assert_named(&harness, &names);
}

#[test]
fn layers_that_ink_does_not_draw_say_so() {
    let idle = |style: &str, layer: &str| {
        let mut harness = harness("apple.ron", None);
        click(&mut harness, style);
        // In this preset every layer has strokes.
        let preset = StrokeChange::Preset(Some("oil study".to_owned()));
        harness.state_mut().apply(Command::Regions(Regions::SetStroke(StrokesOf::Scene, preset)));
        harness.run();
        let at = harness.get_by_label(&format!("Layer {layer}")).rect().center();
        harness.hover_at(at);
        // A tooltip comes up once the pointer has rested for half a second.
        harness.run_steps(12);
        harness.query_by_label_contains("It paints nothing now.").is_some()
    };
    assert!(!idle("Style strokes", "contour") && !idle("Style ink", "form"));
    for layer in ["contour", "lights", "underpainting"] {
        assert!(idle("Style ink", layer), "{layer}");
    }
}
