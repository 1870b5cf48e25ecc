//! Checks stroke settings, the style, and the names of AOVs.

use std::collections::HashSet;
use std::ops::RangeInclusive;

use super::{Findings, did_you_mean, short, shown};
use crate::aovs::{AOVS, AovSet};
use crate::document::{
    BrushMix, Edges, LayerNumber, LayerSettings, STROKE_NUMBERS, Scene, SettingRule, Solver, StrokeNumber,
    StrokeSettings, StrokesKey,
};
use crate::limits;
use crate::presets::{self, GROUND, LayerKind, PAPER_PRESET};

pub(super) fn check(scene: &Scene, findings: &mut Findings) {
    check_settings("strokes", &scene.strokes, findings);
    check_flatness("strokes", scene, None, findings);
    for rule in scene.style.settings().rules() {
        check_style(&rule, findings);
    }
    for (index, word) in scene.aovs.iter().enumerate() {
        if AovSet::named(word).is_err() {
            let message = format!("there is no AOV \"{}\"", shown(word));
            let known = AOVS.iter().map(|row| row.name);
            findings.error(format!("aovs[{index}]"), message, did_you_mean(word, known));
        }
    }
    if let Some((_, field_path)) = brush_pictures(scene).get(limits::MAX_BRUSH_PICTURES) {
        let message = "too many pictures that serve as brushes".to_owned();
        findings.error(field_path.clone(), message, format!("use at most {}", limits::MAX_BRUSH_PICTURES));
    }
}

fn check_style(rule: &SettingRule, findings: &mut Findings) {
    match *rule {
        SettingRule::Range { field, value, ref limits } => {
            findings.number(&format!("style.{field}"), value, limits.clone());
        }
        SettingRule::Direction { field, value } => findings.direction(&format!("style.{field}"), value),
        SettingRule::Broken { field, message, mend } => {
            findings.error(format!("style.{field}"), message, mend);
        }
    }
}

/// Each picture that serves as a brush, with the path of the first field that names it.
pub(crate) fn brush_pictures(scene: &Scene) -> Vec<(&str, String)> {
    let of_regions = scene
        .regions
        .iter()
        .enumerate()
        .map(|(index, region)| (format!("regions[{index}].strokes"), &region.strokes));
    let mut seen: HashSet<String> = HashSet::new();
    let mut found = Vec::new();
    for (path, settings) in [("strokes".to_owned(), &scene.strokes)].into_iter().chain(of_regions) {
        let of_layers = settings
            .layers
            .iter()
            .enumerate()
            .map(|(index, layer)| (format!("{path}.layers[{index}].brush"), layer.brush.as_ref()));
        let mixes = [(format!("{path}.brush"), settings.brush.as_ref())].into_iter().chain(of_layers);
        for (field_path, mix) in mixes {
            let names = mix.into_iter().flat_map(|mix| &mix.0).map(String::as_str);
            for name in names.filter(|name| presets::is_picture(name) && seen.insert((*name).to_owned())) {
                found.push((name, field_path.clone()));
            }
        }
    }
    for (index, touch) in scene.touches.iter().enumerate() {
        let name = touch.brush.as_deref().filter(|name| presets::is_picture(name));
        if let Some(name) = name.filter(|name| seen.insert((*name).to_owned())) {
            found.push((name, format!("touches[{index}].brush")));
        }
    }
    found
}

pub(super) fn check_of_region(strokes_path: &str, scene: &Scene, index: usize, findings: &mut Findings) {
    let settings = &scene.regions[index].strokes;
    check_settings(strokes_path, settings, findings);
    if settings.preset.as_deref() == Some(PAPER_PRESET) {
        let message = format!("the preset \"{PAPER_PRESET}\" holds for a whole scene");
        findings.error(format!("{strokes_path}.preset"), message, "name it in the scene's own strokes");
    }
    check_flatness(strokes_path, scene, Some(index), findings);
}

/// Checks a flatness below 1: strokes that follow the surface need the tangent plane, which the neighbour solvers lack.
fn check_flatness(strokes_path: &str, scene: &Scene, region: Option<usize>, findings: &mut Findings) {
    let stated = region.map_or(&scene.strokes, |index| &scene.regions[index].strokes).flatness;
    let Some(flatness) = stated.filter(|flatness| (0.0..1.0).contains(flatness)) else { return };
    let Some(needs) = needs_flat_strokes(scene) else { return };
    let message = format!("a flatness of {} does not go with {needs}", short(flatness));
    findings.error(format!("{strokes_path}.flatness"), message, "use the solver Tangent, or a flatness of 1");
}

/// Says what in the scene forbids a flatness below 1: the preset or the solver. `None` if any flatness is allowed.
pub(super) fn needs_flat_strokes(scene: &Scene) -> Option<String> {
    match scene.style.settings().preparation().solver {
        _ if presets::is_paper(scene) => Some(format!("the preset \"{PAPER_PRESET}\"")),
        solver @ (Solver::Horn | Solver::HornExact) => Some(format!("the solver {solver:?}")),
        Solver::Tangent => None,
    }
}

fn check_settings(strokes_path: &str, settings: &StrokeSettings, findings: &mut Findings) {
    let path = |field: &str| format!("{strokes_path}.{field}");
    if let Some(preset) =
        settings.preset.as_deref().filter(|preset| presets::names().all(|name| name != *preset))
    {
        let known: Vec<&str> = presets::names().collect();
        let message = format!("there is no preset \"{}\"", shown(preset));
        findings.error(path("preset"), message, did_you_mean(preset, known.iter().copied()));
    }
    check_brush(strokes_path, settings.brush.as_ref(), findings);
    for StrokeNumber { number, .. } in STROKE_NUMBERS {
        findings.number_of(strokes_path, settings, number);
    }
    if let Some(Edges::Overrun(overrun_px)) = settings.edges {
        findings.number(&path("edges"), overrun_px, 0.0..=limits::MAX_STROKE_PX);
    }
    if let Some(colors) = settings.palette.as_ref().filter(|colors| colors.len() > limits::MAX_PALETTE) {
        let message = format!("a palette of {} colours", colors.len());
        findings.error(path("palette"), message, format!("give at most {}", limits::MAX_PALETTE));
    }
    if let Some(layer) = settings.layer {
        let most = f64::from(limits::MAX_LAYER);
        findings.number(&path("layer"), f64::from(layer), -most..=most);
    }
    check_layers(strokes_path, &settings.layers, findings);
    check_order(strokes_path, &settings.order, findings);
    check_keys(&path("keys"), &settings.keys, findings);
}

fn check_keys(keys_path: &str, keys: &[StrokesKey], findings: &mut Findings) {
    findings.keys(keys_path, keys);
    for (index, key) in keys.iter().enumerate() {
        let mut number = |field: &str, value: f64, limits: RangeInclusive<f64>| {
            findings.number(&format!("{keys_path}[{index}].{field}"), value, limits);
        };
        number("size", key.size, limits::KEY_STROKE_SIZE);
        number("coverage", key.coverage, limits::KEY_COVERAGE);
        number("dryness", key.dryness, 0.0..=1.0);
        number("palette_mix", key.palette_mix, 0.0..=1.0);
    }
}

pub(super) fn check_brush(settings_path: &str, brush: Option<&BrushMix>, findings: &mut Findings) {
    let Some(BrushMix(names)) = brush else { return };
    let field_path = format!("{settings_path}.brush");
    if names.is_empty() || names.len() > limits::MAX_BRUSHES {
        let message = format!("a mix of {} brushes", names.len());
        let mend = format!("name from 1 to {} brushes", limits::MAX_BRUSHES);
        findings.error(&field_path, message, mend);
    }
    // A name with an ending is a picture; its problems are reported when it is read.
    for name in names.iter().filter(|name| !presets::is_picture(name)) {
        if !impasto_core::brush::NAMES.contains(&name.as_str()) {
            let message = format!("there is no brush \"{}\"", shown(name));
            let mend = did_you_mean(name, impasto_core::brush::NAMES.iter().copied());
            findings.error(&field_path, message, mend);
        }
    }
}

fn check_layers(strokes_path: &str, layers: &[LayerSettings], findings: &mut Findings) {
    let list_path = format!("{strokes_path}.layers");
    findings.unique(&list_path, layers.iter().map(|layer| layer.name.as_str()));
    let known = LayerKind::ALL.map(LayerKind::name).into_iter().chain([GROUND]);
    for (index, layer) in layers.iter().enumerate() {
        let layer_path = format!("{list_path}[{index}]");
        let path = |field: &str| format!("{layer_path}.{field}");
        if known.clone().all(|name| name != layer.name) {
            let message = format!("there is no layer \"{}\"", shown(&layer.name));
            findings.error(path("name"), message, did_you_mean(&layer.name, known.clone()));
        }
        check_brush(&layer_path, layer.brush.as_ref(), findings);
        for LayerNumber { number, .. } in LayerSettings::NUMBERS {
            findings.number_of(&layer_path, layer, number);
        }
        check_ground(&layer_path, layer, strokes_path == "strokes", findings);
    }
}

/// An order names each layer once, and only the scene has one.
fn check_order(strokes_path: &str, order: &[String], findings: &mut Findings) {
    if order.is_empty() {
        return;
    }
    let order_path = format!("{strokes_path}.order");
    if strokes_path != "strokes" {
        let mend = "state it in the scene's own strokes";
        return findings.error(order_path, "a region has no order of its own", mend);
    }
    let known = LayerKind::ALL.map(LayerKind::name);
    if order.len() > known.len() {
        let message = format!("the order names {} layers; there are {}", order.len(), known.len());
        return findings.error(order_path, message, "name each layer once, from the lowest to the highest");
    }
    let mut has_others = false;
    for (index, name) in order.iter().enumerate() {
        let item_path = format!("{order_path}[{index}]");
        if !known.contains(&name.as_str()) {
            let message = format!("there is no layer \"{}\"", shown(name));
            findings.error(item_path, message, did_you_mean(name, known.into_iter()));
            has_others = true;
        } else if order[..index].contains(name) {
            findings.error(item_path, format!("the layer \"{name}\" is named twice"), "name it once");
            has_others = true;
        }
    }
    let missing: Vec<&str> =
        known.into_iter().filter(|name| order.iter().all(|other| other != name)).collect();
    if !missing.is_empty() && !has_others {
        let message = format!("the order does not name {}", missing.join(", "));
        findings.error(order_path, message, "name each layer, from the lowest to the highest");
    }
}

/// The ground has a tone and no strokes. The scene may have a ground, a region may not.
fn check_ground(layer_path: &str, layer: &LayerSettings, of_scene: bool, findings: &mut Findings) {
    let is_ground = layer.name == GROUND;
    if is_ground && !of_scene {
        findings.error(
            format!("{layer_path}.name"),
            "a region has no ground of its own",
            "state it in the scene's own strokes",
        );
    }
    if !is_ground && layer.color.is_some() {
        let message = format!("the layer \"{}\" takes its colours from the scene", shown(&layer.name));
        findings.error(
            format!("{layer_path}.color"),
            message,
            "only the ground has a color; use a palette instead",
        );
    }
    let is_of_strokes = |of: &&LayerNumber| of.number.field != "opacity";
    let mut numbers = LayerSettings::NUMBERS.iter().filter(is_of_strokes);
    let has_marks = layer.brush.is_some() || numbers.any(|of| (of.number.get)(layer).is_some());
    if is_ground && has_marks {
        findings.error(layer_path, "the ground has no strokes", "give it only color and opacity");
    }
}
