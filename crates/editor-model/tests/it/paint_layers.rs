//! Tests of commands on layers of paint and of the user's own presets: each is one entry of the history.

use std::path::Path;

use impasto_editor_model::Document;
use impasto_editor_model::command::{Command, Regions, StrokeChange, StrokesOf};
use impasto_scene::document::{LayerSettings, StrokeSettings, StrokesKey};
use impasto_scene::load::LoadOptions;
use impasto_scene::presets::{self, LayerKind};
use impasto_scene::strokes_file::StrokesFile;

fn still_life() -> Document {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/still_life.ron");
    Document::open(&path, &LoadOptions::default()).expect("it opens")
}

fn set(document: &mut Document, of: &StrokesOf, change: StrokeChange) -> String {
    let command = Command::Regions(Regions::SetStroke(of.clone(), change));
    document.apply(&command).expect("it fits").text
}

fn lemon() -> StrokesOf {
    StrokesOf::Region("lemon".to_owned())
}

fn strokes_of_lemon(document: &Document) -> &StrokeSettings {
    &document.scene().regions.iter().find(|region| region.name == "lemon").expect("it is there").strokes
}

#[test]
fn an_eye_that_is_shut_and_opened_again_leaves_nothing_in_the_file() {
    let mut document = still_life();
    let before = strokes_of_lemon(&document).clone();
    let layer = |hidden| {
        let name = "scumble".to_owned();
        StrokeChange::PaintLayer(Box::new(LayerSettings { name, hidden, ..LayerSettings::default() }))
    };
    assert_eq!(set(&mut document, &lemon(), layer(Some(true))), "Hide layer scumble");
    assert_eq!(strokes_of_lemon(&document).layers.len(), before.layers.len() + 1);
    assert_eq!(set(&mut document, &lemon(), layer(None)), "Show layer scumble");
    assert_eq!(*strokes_of_lemon(&document), before);
}

#[test]
fn the_usual_order_is_not_stated_and_a_region_has_none() {
    let mut document = still_life();
    let mut order = LayerKind::ALL;
    order.swap(0, 1);
    assert_eq!(
        set(&mut document, &StrokesOf::Scene, StrokeChange::LayerOrder(Some(order))),
        "Order of layers"
    );
    assert_eq!(presets::laying_order(document.scene()), order);
    set(&mut document, &StrokesOf::Scene, StrokeChange::LayerOrder(Some(LayerKind::ALL)));
    assert!(document.scene().strokes.order.is_empty());
    let of_region = Command::Regions(Regions::SetStroke(lemon(), StrokeChange::LayerOrder(Some(order))));
    assert!(document.apply(&of_region).is_err());
    // What only a scene has is not pasted to a region.
    set(&mut document, &StrokesOf::Scene, StrokeChange::LayerOrder(Some(order)));
    let copied = Box::new(document.scene().strokes.clone());
    document.apply(&Command::Regions(Regions::PasteStrokes(lemon(), copied))).expect("it is taken");
    assert!(strokes_of_lemon(&document).order.is_empty());
}

#[test]
fn a_preset_is_one_entry_and_keeps_what_it_does_not_state() {
    let mut document = still_life();
    set(&mut document, &lemon(), StrokeChange::Layer(Some(4)));
    let before = document.scene().clone();
    let mut other = before.clone();
    other.size = (other.size.0 * 2, other.size.1 * 2);
    other.strokes.length_px = Some(90.0);
    other.strokes.keys = vec![StrokesKey::at(5.0)];
    let preset = Box::new(StrokesFile::of(&other, None));
    let entries = document.undo_count();
    let name = "thick".to_owned();
    let command = Command::Regions(Regions::ApplyPreset { of: lemon(), preset, name });
    assert_eq!(document.apply(&command).expect("it fits").text, "Preset thick");
    assert_eq!(document.undo_count(), entries + 1);
    let strokes = strokes_of_lemon(&document);
    assert_eq!((strokes.length_px, strokes.layer, strokes.keys.len()), (Some(45.0), Some(4), 0));
    let region = document.scene().regions.iter().find(|region| region.name == "lemon").expect("it is there");
    let was = before.regions.iter().find(|region| region.name == "lemon").expect("it was there");
    assert_eq!((&region.direction, &region.guides), (&was.direction, &was.guides));
    document.undo();
    assert_eq!(*document.scene(), before);
}
