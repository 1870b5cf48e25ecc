//! Checks touches: strokes placed by hand.

use super::{Findings, regions, strokes};
use crate::document::{BrushMix, Scene, Touch};
use crate::limits;

pub(super) fn check(scene: &Scene, findings: &mut Findings) {
    findings.unique("touches", scene.touches.iter().map(|touch| touch.name.as_str()));
    let points = scene.touches.iter().map(|touch| touch.points.len()).sum();
    for (what, count, most) in [
        ("touches", scene.touches.len(), limits::MAX_TOUCHES),
        ("points of touches", points, limits::MAX_ALL_TOUCH_POINTS),
    ] {
        if count > most {
            let message = format!("the scene has {count} {what}, at most {most} are possible");
            findings.limit("touches", message, "remove some: touches are few, and single ones");
        }
    }
    let object_names = regions::names_of_objects(scene);
    for (index, touch) in scene.touches.iter().enumerate().take(limits::MAX_TOUCHES) {
        let path = format!("touches[{index}]");
        if !object_names.contains(touch.on.as_str()) {
            regions::unknown_object(&format!("{path}.on"), &touch.on, scene, findings);
        }
        check_touch(&path, touch, findings);
    }
    if !scene.touches.is_empty() && !scene.style.settings().preparation().lays_touches {
        let message = format!("touches are not painted in the style {}", scene.style.info().name);
        findings.warning("touches", message, "use the style RotatingStrokes, or remove them");
    }
}

fn check_touch(path: &str, touch: &Touch, findings: &mut Findings) {
    let field = |name: &str| format!("{path}.{name}");
    match touch.points.len() {
        0 => findings.error(
            field("points"),
            "a touch without a place lies nowhere",
            "give one place, or several that it runs through",
        ),
        count if count > limits::MAX_TOUCH_POINTS => {
            let message = format!("a touch through {count} places");
            let mend = format!("give at most {}", limits::MAX_TOUCH_POINTS);
            findings.error(field("points"), message, mend);
        }
        _ => {}
    }
    for (index, point) in touch.points.iter().enumerate().take(limits::MAX_TOUCH_POINTS) {
        findings.vector(&format!("{path}.points[{index}].at"), point.at);
        findings.direction(&format!("{path}.points[{index}].normal"), point.normal);
    }
    findings.number(&field("width_px"), touch.width_px, limits::TOUCH_WIDTH_PX);
    findings.number(&field("length_px"), touch.length_px, limits::TOUCH_LENGTH_PX);
    findings.number(&field("opacity"), touch.opacity, 0.0..=1.0);
    findings.number(&field("taper"), touch.taper, -1.0..=1.0);
    if let Some(brush) = &touch.brush {
        strokes::check_brush(path, Some(&BrushMix(vec![brush.clone()])), findings);
    }
}
