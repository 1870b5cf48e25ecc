//! The sections of the inspector for the stroke settings of a region or of the scene: *Strokes* and *Advanced*.

use egui::{Ui, vec2};
use impasto_core::brush;
use impasto_editor_model::command::{Command, Regions, SceneEdit, StrokeChange};
use impasto_editor_model::stroke_fields::{FieldValue, field_values};
use impasto_scene::document::{BrushMix, Edges, InspectorPlace};
use impasto_scene::limits::{MAX_LAYER, MAX_STROKE_PX};
use impasto_scene::presets;

use super::edited_strokes::EditedStrokes;
use super::number::Number;
use super::parts::{note, pick, reset, row, section};
use super::{Asker, paint_layers, pigments};
use crate::panels::brush_thumbnails::thumbnail;
use crate::panels::column_state::ColumnState;
use crate::panels::status_line::grouped;
use crate::widgets::{self, Button, Tip};

pub(super) fn of_region(ui: &mut Ui, asker: &mut Asker<'_, '_>, region: &str) {
    let strokes = asker.shown.numbers.strokes_of.iter().find(|(name, _)| name == region);
    let note = strokes.map_or_else(String::new, |(_, count)| format!("{} shown", grouped(*count)));
    section(ui, "Strokes", &note, true, |ui| contents(ui, asker, Some(region)));
}

/// Shows brush, numbers, pigments and layer of a region. With `region: None`, shows those of the scene and its preset.
pub(super) fn contents(ui: &mut Ui, asker: &mut Asker<'_, '_>, region: Option<&str>) {
    let Some(place) = EditedStrokes::new(asker, region) else { return };
    if region.is_none() {
        preset(ui, asker, &place);
    }
    brushes(ui, asker, &place);
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

/// One radio button for each brush; with Shift or Ctrl, a click adds a brush to the mix or takes it out.
fn brushes(ui: &mut Ui, asker: &mut Asker<'_, '_>, place: &EditedStrokes<'_>) {
    let loaded = asker.shown.document.shown();
    let mix = &place.resolved[0].body().brushes;
    let names = brush::NAMES.iter().copied().chain(loaded.brushes.keys().map(String::as_str));
    ui.add_space(4.0);
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(3.0, 0.0);
        for name in names {
            let Some(picture) = thumbnail(ui.ctx(), name, loaded) else { continue };
            let on = mix.iter().any(|other| other == name);
            let label = format!("Brush {name}");
            let response = widgets::brush_thumbnail(ui, &label, picture.id(), on);
            let tip = Tip { name, effect: effect_of(name), range: "Ctrl-click mixes brushes.", key: "" };
            let response = tip.on(response);
            if !response.clicked() {
                continue;
            }
            let mixes = ui.input(|input| input.modifiers.shift || input.modifiers.command);
            let mut wanted = if mixes { mix.clone() } else { vec![name.to_owned()] };
            if mixes && on && mix.iter().any(|other| other != name) {
                wanted.retain(|other| other != name);
            } else if mixes && !on {
                wanted.push(name.to_owned());
            }
            if wanted != *mix {
                asker.ask(place.set(StrokeChange::Brush(Some(BrushMix(wanted)))));
            }
        }
        if place.own[0].brush.is_some() && reset(ui, "Brush") {
            asker.ask(place.set(StrokeChange::Brush(None)));
        }
    });
    ui.add_space(2.0);
    if mix.len() > 1 {
        note(ui, &mixed(mix));
    }
}

/// How often each brush of a mix is taken, as *Mixed: filbert 2, round 1*.
fn mixed(mix: &[String]) -> String {
    let mut words: Vec<String> = Vec::new();
    for (index, name) in mix.iter().enumerate() {
        if !mix[..index].contains(name) {
            let times = mix.iter().filter(|other| *other == name).count();
            words.push(format!("{name} {times}"));
        }
    }
    format!("Mixed: {}", words.join(", "))
}

fn effect_of(brush: &str) -> &'static str {
    match brush {
        "flat" => "Square ends and even edges.",
        "filbert" => "Rounded ends, soft sides.",
        "round" => "Pointed, full in the middle.",
        "fan" => "Many thin lines side by side.",
        "dry" => "Broken paint that lets the ground through.",
        "knife" => "A flat slab of thick paint.",
        "rigger" => "One long thin line.",
        _ => "A picture of this scene's own.",
    }
}

fn preset(ui: &mut Ui, asker: &mut Asker<'_, '_>, place: &EditedStrokes<'_>) {
    let is_region = place.index.is_some();
    // The source paper's rule holds only for a whole scene.
    let mut names: Vec<&str> =
        presets::names().filter(|name| !is_region || *name != presets::PAPER_PRESET).collect();
    if is_region {
        names.insert(0, "As the scene");
    }
    let own = place.own[0].preset.as_deref();
    let shown = own.unwrap_or(if is_region { names[0] } else { presets::DEFAULT_PRESET });
    row(ui, "Preset", |ui| {
        let tip = Tip {
            name: "Preset",
            effect: "The set of values that everything begins with.",
            ..Tip::default()
        };
        let chosen = names.iter().position(|name| *name == shown).unwrap_or(0);
        if let Some(picked) = pick(ui, tip, &names, chosen) {
            let wanted = (!is_region || picked > 0).then(|| names[picked].to_owned());
            asker.ask(place.set(StrokeChange::Preset(wanted)));
        }
        if !is_region && own.is_some_and(|own| own != presets::DEFAULT_PRESET) && reset(ui, "Preset") {
            asker.ask(place.set(StrokeChange::Preset(None)));
        }
    });
}

/// Shows what is seldom set: more numbers, edges, layers of paint, a region's preset, the seed, and buttons to copy and
/// paste strokes.
pub(super) fn advanced(ui: &mut Ui, asker: &mut Asker<'_, '_>, region: Option<&str>) {
    let Some(place) = EditedStrokes::new(asker, region) else { return };
    section(ui, "Advanced", "edges, layers, seed", false, |ui| {
        if region.is_some() {
            preset(ui, asker, &place);
        }
        numbers(ui, asker, &place, true);
        edges(ui, asker, &place);
        paint_layers::show(ui, asker, &place);
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
