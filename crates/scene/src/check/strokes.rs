//! Stroke settings, regions and the style.

use std::collections::HashSet;

use super::{Findings, did_you_mean, short, shown};
use crate::document::{Direction, Scene, Selector, Solver, StrokeSettings, Style};
use crate::limits;
use crate::presets::{self, BRUSHES, PAPER_PRESET};
use crate::problem::Severity;

pub(super) fn check(scene: &Scene, findings: &mut Findings) {
    check_settings("strokes", &scene.strokes, findings);
    check_flatness("strokes", scene, None, findings);
    findings.unique("regions", scene.regions.iter().map(|region| region.name.as_str()));
    let object_names: HashSet<&str> = scene.objects.iter().map(|object| object.name.as_str()).collect();
    for (index, region) in scene.regions.iter().enumerate() {
        let region_path = format!("regions[{index}]");
        let (Selector::Object(object) | Selector::Group(object, _) | Selector::Material(object, _)) =
            &region.on
        else {
            check_region(&region_path, scene, index, findings);
            continue;
        };
        if !object_names.contains(object.as_str()) {
            findings.add(Severity::Error, || {
                let known = scene.objects.iter().map(|object| object.name.as_str());
                let message = format!("there is no object \"{}\"", shown(object));
                (format!("{region_path}.on"), message, did_you_mean(object, known))
            });
        }
        check_region(&region_path, scene, index, findings);
    }
}

fn check_region(region_path: &str, scene: &Scene, index: usize, findings: &mut Findings) {
    let region = &scene.regions[index];
    let direction_path = format!("{region_path}.direction");
    match region.direction {
        Direction::Angle(angle_deg) => {
            let turn = limits::MAX_ANGLE_DEG;
            findings.number(&direction_path, angle_deg, -turn..=turn);
        }
        Direction::Around(axis) => findings.direction(&direction_path, axis),
        Direction::Up => {}
    }
    let strokes_path = format!("{region_path}.strokes");
    check_settings(&strokes_path, &region.strokes, findings);
    if region.strokes.preset.as_deref() == Some(PAPER_PRESET) {
        let message = format!("the preset \"{PAPER_PRESET}\" holds for a whole scene");
        findings.error(format!("{strokes_path}.preset"), message, "name it in the scene's own strokes");
    }
    check_flatness(&strokes_path, scene, Some(index), findings);
}

/// Strokes that follow the surface need the tangent plane; the neighbour solvers know none.
fn check_flatness(strokes_path: &str, scene: &Scene, region: Option<usize>, findings: &mut Findings) {
    let stated = region.map_or(&scene.strokes, |index| &scene.regions[index].strokes).flatness;
    let Some(flatness) = stated.filter(|flatness| (0.0..1.0).contains(flatness)) else { return };
    let needs = match &scene.style {
        _ if presets::is_paper(scene) => format!("the preset \"{PAPER_PRESET}\""),
        Style::RotatingStrokes { solver: solver @ (Solver::Horn | Solver::HornExact), .. } => {
            format!("the solver {solver:?}")
        }
        Style::RotatingStrokes { solver: Solver::Tangent, .. } | Style::Reference => return,
    };
    let message = format!("a flatness of {} does not go with {needs}", short(flatness));
    findings.error(format!("{strokes_path}.flatness"), message, "use the solver Tangent, or a flatness of 1");
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
    if let Some(brush) = settings.brush.as_deref().filter(|brush| !BRUSHES.contains(brush)) {
        let message = format!("there is no brush \"{}\"", shown(brush));
        findings.error(path("brush"), message, did_you_mean(brush, BRUSHES.iter().copied()));
    }
    for (field, value, most) in [
        ("length_px", settings.length_px, limits::MAX_STROKE_PX),
        ("width_px", settings.width_px, limits::MAX_STROKE_PX),
        ("coverage", settings.coverage, limits::MAX_COVERAGE),
    ] {
        // A thousandth of a pixel is below anything that can be seen, and still a number in 32 bits.
        if let Some(value) = value.filter(|value| !(1e-3..=most).contains(value)) {
            let mend = format!("give a number above 0 (from 0.001), at most {most}");
            findings.error(path(field), format!("{} is out of range", short(value)), mend);
        }
    }
    for (field, value, most) in [
        ("flatness", settings.flatness, 1.0),
        ("angle_jitter_deg", settings.angle_jitter_deg, 180.0),
        ("size_jitter", settings.size_jitter, 1.0),
    ] {
        if let Some(value) = value {
            findings.number(&path(field), value, 0.0..=most);
        }
    }
    if let Some(layer) = settings.layer {
        let most = f64::from(limits::MAX_LAYER);
        findings.number(&path("layer"), f64::from(layer), -most..=most);
    }
}
