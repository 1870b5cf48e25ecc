//! The numbers of a region's strokes, or of the scene's, as an inspector shows them.

use impasto_scene::document::{STROKE_NUMBERS, Scene, StrokeNumber, StrokeSettings};
use impasto_scene::presets;

/// What an inspector shows of one number.
#[derive(Clone, Copy, Debug)]
pub struct FieldValue {
    /// The number.
    pub field: &'static StrokeNumber,
    /// Its value, as shown.
    pub shown: f64,
    /// Whether it is stated here; else it comes from a preset or from the scene.
    pub is_own: bool,
    /// What it would be if it were not stated here, as shown.
    pub usual: f64,
}

/// The stroke numbers of a region, or of the scene, in the order of the inspector.
pub fn field_values(scene: &Scene, region: Option<usize>) -> Vec<FieldValue> {
    let own = region.map_or(&scene.strokes, |region| &scene.regions[region].strokes);
    let unstated = without_numbers(own);
    // Lengths are shown without `scale`, which is shown as a number of its own.
    let of_scene = StrokeSettings { scale: None, ..scene.strokes.clone() };
    // The value of a number that is not stated does not depend on the other numbers. So one call with no number stated
    // finds this value for all of them.
    let usual = match region {
        Some(_) => presets::resolve_with(scene, &of_scene, Some(&unstated)),
        None => presets::resolve_with(scene, &unstated, None),
    };
    let value_of = |field: &'static StrokeNumber| {
        let stated = (field.number.get)(own);
        let usual = (field.resolved)(&usual);
        let shown = |value: f64| value / field.shown.file_per_shown;
        FieldValue {
            field,
            shown: shown(stated.unwrap_or(usual)),
            is_own: stated.is_some(),
            usual: shown(usual),
        }
    };
    let mut values: Vec<FieldValue> = STROKE_NUMBERS.iter().map(value_of).collect();
    values.sort_by_key(|value| value.field.shown.place);
    values
}

/// The settings with no number stated; their preset stays.
fn without_numbers(settings: &StrokeSettings) -> StrokeSettings {
    let mut settings = settings.clone();
    for field in STROKE_NUMBERS {
        *(field.number.of)(&mut settings) = None;
    }
    settings
}

#[cfg(test)]
mod tests {
    use super::*;
    use impasto_scene::document::{Region, Selector};
    use impasto_scene::new_scene;

    #[test]
    fn what_is_set_is_what_is_shown_whatever_the_scene_scales() {
        let mut scene = new_scene::empty();
        scene.strokes.scale = Some(0.7);
        scene.regions.push(Region::new("skin", Selector::Everything));
        for field in STROKE_NUMBERS {
            let shown_before = |scene: &Scene| {
                let values = field_values(scene, Some(0));
                *values
                    .iter()
                    .find(|value| value.field.number.field == field.number.field)
                    .expect("it is in the table")
            };
            let before = shown_before(&scene);
            assert!(!before.is_own && before.shown == before.usual, "{before:?}");
            let wanted = (field.shown.drag.start() + field.shown.drag.end()) / 2.0;
            *(field.number.of)(&mut scene.regions[0].strokes) = Some(wanted * field.shown.file_per_shown);
            let after = shown_before(&scene);
            assert!(after.is_own && (after.shown - wanted).abs() < 1e-9, "{after:?}");
            assert!((after.usual - before.shown).abs() < 1e-9, "{before:?} {after:?}");
            *(field.number.of)(&mut scene.regions[0].strokes) = None;
        }
    }
}
