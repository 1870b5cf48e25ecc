//! The sections of the inspector for the stroke settings of a region or of the scene: *Strokes* and *Advanced*.

use egui::Ui;
use impasto_editor_model::command::{Command, Regions, SceneEdit, StrokeChange};
use impasto_editor_model::stroke_fields::{FieldValue, field_values};
use impasto_scene::document::{Edges, InspectorPlace};
use impasto_scene::limits::{MAX_LAYER, MAX_STROKE_PX};

use super::brushes::{self, BrushRow};
use super::edited_strokes::EditedStrokes;
use super::number::Number;
use super::parts::{pick, reset, row, section};
use super::{Asker, pigments, preset_chooser};
use crate::panels::column_state::ColumnState;
use crate::panels::status_line::grouped;
use crate::widgets::{Button, Tip};

pub(super) fn of_region(ui: &mut Ui, asker: &mut Asker<'_, '_>, region: &str) {
    let strokes = asker.shown.numbers.strokes_of.iter().find(|(name, _)| name == region);
    let note = strokes.map_or_else(String::new, |(_, count)| format!("{} shown", grouped(*count)));
    section(ui, "Strokes", &note, true, |ui| contents(ui, asker, Some(region)));
}

/// Shows brush, numbers, pigments and layer of a region. With `region: None`, shows those of the scene and its preset.
pub(super) fn contents(ui: &mut Ui, asker: &mut Asker<'_, '_>, region: Option<&str>) {
    let Some(place) = EditedStrokes::new(asker, region) else { return };
    if region.is_none() {
        preset_chooser::show(ui, asker, &place);
    }
    let own =
        BrushRow { of: "", mix: &place.resolved[0].body().brushes, is_own: place.own[0].brush.is_some() };
    brushes::show(ui, asker, &own, |mix| place.set(StrokeChange::Brush(mix)));
    numbers(ui, asker, &place, false);
    pigments::show(ui, asker, &place);
    let layers = place.resolved.each_ref().map(|resolved| f64::from(resolved.layer));
    let scene = asker.scene();
    let usual = if region.is_some() { scene.strokes.layer.unwrap_or(0) } else { 0 };
    let most = f64::from(MAX_LAYER);
    let layer = Number {
        range: 0.0..=8.0,
        limits: Some(-most..=most),
        scene_decides: false,
        default: place.own[0].layer.map(|_| f64::from(usual)),
        ..Number::new("Layer", "Higher layers are painted over lower ones.")
    };
    asker.number(ui, &layer, layers, |to| place.set(StrokeChange::Layer(to.map(|to| to.round() as i32))));
}

fn numbers(ui: &mut Ui, asker: &mut Asker<'_, '_>, place: &EditedStrokes<'_>, advanced: bool) {
    let shown = field_values(asker.scene(), place.index);
    let stored = field_values(asker.stored(), place.index);
    let is_here =
        |value: &FieldValue| matches!(value.field.shown.place, InspectorPlace::Advanced(_)) == advanced;
    for (shown, stored) in shown.iter().zip(&stored).filter(|(value, _)| is_here(value)) {
        number(ui, asker, place, [shown, stored]);
    }
}

fn number(
    ui: &mut Ui,
    asker: &mut Asker<'_, '_>,
    place: &EditedStrokes<'_>,
    [shown, stored]: [&FieldValue; 2],
) {
    let field = shown.field;
    let look = &field.shown;
    let number = Number {
        unit: look.unit,
        range: look.drag.clone(),
        limits: Some(field.limits_shown()),
        scene_decides: false,
        step: (look.step, look.decimals),
        default: stored.is_own.then_some(shown.usual),
        ..Number::new(look.label, field.number.effect)
    };
    asker.number(ui, &number, [shown.shown, stored.shown], |to| {
        place.set(StrokeChange::Number(field.number.field, to.map(|to| to * look.file_per_shown)))
    });
}

/// Shows the settings that are seldom changed: more numbers, edges, a region's preset, the seed, and buttons to copy
/// and paste strokes.
pub(super) fn advanced(ui: &mut Ui, asker: &mut Asker<'_, '_>, region: Option<&str>) {
    let Some(place) = EditedStrokes::new(asker, region) else { return };
    section(ui, "Advanced", "edges, seed", false, |ui| {
        if region.is_some() {
            preset_chooser::show(ui, asker, &place);
        }
        numbers(ui, asker, &place, true);
        edges(ui, asker, &place);
        seed(ui, asker);
        copy_and_paste(ui, asker, &place);
    });
}

fn edges(ui: &mut Ui, asker: &mut Asker<'_, '_>, place: &EditedStrokes<'_>) {
    let [shown, stored] = place.resolved.each_ref().map(|resolved| resolved.edges);
    let over = |edges| match edges {
        Edges::Overrun(px) => Some(px),
        _ => None,
    };
    row(ui, "Edges", |ui| {
        let chosen = match shown {
            Edges::Clip => 0,
            Edges::Overrun(_) => 1,
            Edges::Free => 2,
        };
        let tip =
            Tip { name: "Edges", effect: "How paint ends at the border of its body.", ..Tip::default() };
        if let Some(picked) = pick(ui, tip, &["Cut off", "Ragged", "Free"], chosen) {
            let wanted = [Edges::Clip, Edges::Overrun(4.0), Edges::Free][picked];
            asker.ask(place.set(StrokeChange::Edges(Some(wanted))));
        }
        if let Some(px) = over(shown) {
            let number = Number {
                unit: "px",
                range: 0.0..=20.0,
                limits: Some(0.0..=MAX_STROKE_PX),
                scene_decides: false,
                step: (0.5, 1),
                unlabelled: Some(58.0),
                ..Number::new("Overrun", "How far paint goes past the border, at most.")
            };
            asker.number(ui, &number, [px, over(stored).unwrap_or(px)], |px| {
                place.set(StrokeChange::Edges(px.map(Edges::Overrun)))
            });
        }
        if place.own[0].edges.is_some() && reset(ui, "Edges") {
            asker.ask(place.set(StrokeChange::Edges(None)));
        }
    });
}

pub(super) fn seed(ui: &mut Ui, asker: &mut Asker<'_, '_>) {
    let [shown, stored] = [asker.scene().seed, asker.stored().seed].map(f64::from);
    let number = Number {
        range: 0.0..=99.0,
        limits: Some(0.0..=f64::from(u32::MAX)),
        ..Number::new("Seed", "Changes every random choice of the whole scene at once.")
    };
    asker.number(ui, &number, [shown, stored], |to| {
        Command::Scene(SceneEdit::SetSeed(to.unwrap_or(0.0).round() as u32))
    });
}

fn copy_and_paste(ui: &mut Ui, asker: &mut Asker<'_, '_>, place: &EditedStrokes<'_>) {
    let copied = ColumnState::with(ui.ctx(), |state| state.copied_strokes.clone());
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        if Button::new("Copy strokes").show(ui).clicked() {
            let own = place.own[0].clone();
            ColumnState::with(ui.ctx(), |state| state.copied_strokes = Some(own));
        }
        let paste = ui.add_enabled_ui(copied.is_some(), |ui| Button::new("Paste strokes").show(ui)).inner;
        if let Some(copied) = copied.filter(|_| paste.clicked()) {
            asker.ask(Command::Regions(Regions::PasteStrokes(place.of.clone(), Box::new(copied))));
        }
    });
}
