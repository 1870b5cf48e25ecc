//! The numbers of a region's strokes as an inspector shows them: one table of names, units, ranges and effects.

use impasto_scene::document::{Region, Scene, Selector, StrokeSettings};
use impasto_scene::presets::{self, ResolvedStrokes};

/// One number of [`StrokeSettings`].
#[derive(Clone, Debug)]
pub struct StrokeField {
    /// What people call it: *Length*.
    pub label: &'static str,
    /// The field in a scene file: `length_px`.
    pub name: &'static str,
    /// Shown behind the value.
    pub unit: &'static str,
    /// The value shown, times this, is the value of the file.
    pub file_per_shown: f64,
    /// Range of a drag, as shown; typing may go beyond it as far as a scene file may.
    pub range: std::ops::RangeInclusive<f64>,
    /// One step of the wheel or of an arrow key, as shown.
    pub step: f64,
    /// Digits behind the point.
    pub decimals: usize,
    /// What it does, one sentence.
    pub effect: &'static str,
    /// Whether it stands under Advanced.
    pub is_advanced: bool,
    /// What the settings say, if they say it.
    pub get: fn(&StrokeSettings) -> Option<f64>,
    /// Says it, or leaves it to the scene and its preset.
    pub set: fn(&mut StrokeSettings, Option<f64>),
    /// What holds after preset, scene and region have spoken.
    pub resolved: fn(&ResolvedStrokes) -> f64,
}

macro_rules! field {
    ($field:ident, $resolved:expr, $label:literal, $unit:literal x $factor:literal, $range:expr, $step:literal . $decimals:literal, $advanced:literal, $effect:literal) => {
        StrokeField {
            label: $label,
            name: stringify!($field),
            unit: $unit,
            file_per_shown: $factor,
            range: $range,
            step: $step,
            decimals: $decimals,
            effect: $effect,
            is_advanced: $advanced,
            get: |settings| settings.$field,
            set: |settings, value| settings.$field = value,
            resolved: $resolved,
        }
    };
}

/// All numbers of a region's strokes, in the order of the inspector.
pub const STROKE_FIELDS: &[StrokeField] = &[
    field!(length_px, |s| f64::from(s.body().length_px), "Length", "px" x 1.0, 4.0..=160.0, 1.0 . 0, false,
        "How long strokes are in the picture; other layers keep their proportion."),
    field!(width_px, |s| f64::from(s.body().width_px), "Width", "px" x 1.0, 1.0..=60.0, 1.0 . 0, false,
        "How wide strokes are in the picture."),
    field!(coverage, |s| f64::from(s.body().coverage), "Coverage", "×" x 1.0, 0.0..=8.0, 0.1 . 1, false,
        "How many strokes lie over each other; under 1 the ground shows."),
    field!(flatness, |s| f64::from(s.flatness), "Flatness", "2D" x 1.0, 0.0..=1.0, 0.05 . 2, false,
        "1 keeps strokes flat on the picture, 0 lets them follow the surface."),
    field!(angle_jitter_deg, |s| f64::from(s.angle_jitter_rad).to_degrees(), "Angle jitter", "°" x 1.0, 0.0..=45.0, 1.0 . 0, false,
        "How far strokes stray from their direction, each on its own."),
    field!(color_jitter, |s| f64::from(s.color_jitter), "Colour jitter", "%" x 0.01, 0.0..=200.0, 5.0 . 0, false,
        "How much colours differ from stroke to stroke; 100 as oil paint is mixed."),
    field!(scale, |_| 1.0, "Scale", "×" x 1.0, 0.1..=4.0, 0.05 . 2, true,
        "Makes the strokes of all layers larger or smaller."),
    field!(swing_deg, |s| f64::from(s.swing_rad).to_degrees(), "Swing", "°" x 1.0, 0.0..=45.0, 1.0 . 0, true,
        "A slow swing of the direction over the surface."),
    field!(contour, |s| f64::from(s.contour), "Contour", "%" x 0.01, 0.0..=100.0, 5.0 . 0, true,
        "How far strokes near the limb lie along it; this part follows the view."),
    field!(size_jitter, |s| f64::from(s.size_jitter), "Size jitter", "%" x 0.01, 0.0..=100.0, 5.0 . 0, true,
        "How much sizes differ from stroke to stroke."),
    field!(taper, |s| f64::from(s.taper), "Taper", "%" x 0.01, -100.0..=100.0, 5.0 . 0, true,
        "How much narrower strokes end than they start; 100 ends in a point, -100 starts in one."),
    field!(bend_deg, |s| f64::from(s.bend_rad).to_degrees(), "Bend", "°" x 1.0, -180.0..=180.0, 5.0 . 0, true,
        "How far strokes turn to their left from start to end; below 0 to their right."),
    field!(size_follow, |s| f64::from(s.size_follow), "Size follows", "%" x 0.01, 0.0..=100.0, 5.0 . 0, true,
        "0 keeps strokes at their size in the picture, 100 at their size on the surface."),
    field!(offset, |s| f64::from(s.offset), "Offset", "u" x 1.0, 0.0..=1.0, 0.01 . 3, true,
        "How far strokes stand off the surface, in units of the object."),
    field!(temperature, |s| f64::from(s.temperature), "Temperature", "%" x 0.01, 0.0..=200.0, 5.0 . 0, true,
        "How much warmer lights and cooler shadows are than in the plain render."),
    field!(grading, |s| f64::from(s.grading), "Grading", "%" x 0.01, 0.0..=100.0, 5.0 . 0, true,
        "How far colours are pulled to a painter's values."),
];

/// A number of the table by its name in a scene file.
pub fn stroke_field(name: &str) -> Option<&'static StrokeField> {
    STROKE_FIELDS.iter().find(|field| field.name == name)
}

/// What an inspector shows of one field.
#[derive(Clone, Copy, Debug)]
pub struct FieldValue {
    /// The field.
    pub field: &'static StrokeField,
    /// Its value, as shown.
    pub shown: f64,
    /// Whether it is stated here; else it comes from the scene and its preset.
    pub is_own: bool,
    /// What it would be if it were not stated here, as shown.
    pub usual: f64,
}

/// The stroke numbers of a region, or of the scene, as an inspector shows them.
pub fn field_values(scene: &Scene, region: Option<usize>) -> Vec<FieldValue> {
    let own = region.map_or(&scene.strokes, |region| &scene.regions[region].strokes);
    // Lengths are shown before `scale`, which has a row of its own.
    let unscaled = |settings: &StrokeSettings| StrokeSettings { scale: None, ..settings.clone() };
    let resolve = |own: Option<StrokeSettings>| {
        let regions = own.map(|strokes| Region { strokes, ..Region::new("", Selector::Everything) });
        let scene = Scene {
            objects: Vec::new(),
            regions: regions.into_iter().collect(),
            strokes: unscaled(&scene.strokes),
            ..scene_head(scene)
        };
        presets::resolve(&scene, (!scene.regions.is_empty()).then_some(0))
    };
    let holds = resolve(region.map(|_| unscaled(own)));
    STROKE_FIELDS
        .iter()
        .map(|field| {
            let stated = (field.get)(own);
            let without = |settings: &StrokeSettings| {
                let mut settings = unscaled(settings);
                (field.set)(&mut settings, None);
                settings
            };
            let usual = if field.name == "scale" {
                1.0
            } else if region.is_some() {
                (field.resolved)(&resolve(Some(without(own))))
            } else {
                let scene = Scene { strokes: without(own), regions: Vec::new(), ..scene_head(scene) };
                (field.resolved)(&presets::resolve(&scene, None))
            };
            let value = match (field.name, stated) {
                ("scale", stated) => stated.unwrap_or(1.0),
                (_, Some(stated)) => stated,
                (_, None) => (field.resolved)(&holds),
            };
            let (shown, usual) = (value / field.file_per_shown, usual / field.file_per_shown);
            FieldValue { field, shown, is_own: stated.is_some(), usual }
        })
        .collect()
}

/// A scene without its lists.
fn scene_head(scene: &Scene) -> Scene {
    crate::change::head(scene)
}

#[cfg(test)]
mod tests {
    use super::*;
    use impasto_scene::new_scene;

    #[test]
    fn what_is_set_is_what_is_shown_whatever_the_scene_scales() {
        let mut scene = new_scene::empty();
        scene.strokes.scale = Some(0.7);
        scene.regions.push(Region::new("skin", Selector::Everything));
        for field in STROKE_FIELDS {
            let shown_before = |scene: &Scene| {
                let values = field_values(scene, Some(0));
                *values.iter().find(|value| value.field.name == field.name).expect("it is in the table")
            };
            let before = shown_before(&scene);
            assert!(!before.is_own && before.shown == before.usual, "{before:?}");
            let wanted = (field.range.start() + field.range.end()) / 2.0;
            (field.set)(&mut scene.regions[0].strokes, Some(wanted * field.file_per_shown));
            let after = shown_before(&scene);
            assert!(after.is_own && (after.shown - wanted).abs() < 1e-9, "{after:?}");
            assert!((after.usual - before.shown).abs() < 1e-9, "{before:?} {after:?}");
            (field.set)(&mut scene.regions[0].strokes, None);
        }
    }
}
