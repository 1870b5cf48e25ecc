//! Strokes and paint as a scene file states them.

use serde::{Deserialize, Serialize};

use super::color::Color;
use super::numbers::number;
use super::{Number, is_default};
use crate::limits::{MAX_COVERAGE, MAX_STROKE_PX, MAX_THICKNESS};

/// One layer of paint: its own strokes, laid over those of the layers before it.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct LayerSettings {
    /// `underpainting`, `body`, `form`, `scumble`, `accents` or `lights`; `ground` is the tone under all of them.
    pub name: String,
    /// Brush, or a mix of brushes.
    #[serde(default, skip_serializing_if = "is_default")]
    pub brush: Option<BrushMix>,
    /// Length in pixels at the scene's size.
    #[serde(default, skip_serializing_if = "is_default")]
    pub length_px: Option<f64>,
    /// Width in pixels at the scene's size.
    #[serde(default, skip_serializing_if = "is_default")]
    pub width_px: Option<f64>,
    /// Strokes per pixel × length × width where the layer is wanted; 0 leaves the layer out.
    #[serde(default, skip_serializing_if = "is_default")]
    pub coverage: Option<f64>,
    /// How much of what lies under a stroke it hides, 0..=1; of the ground: how far its tone hides the body's own wash.
    #[serde(default, skip_serializing_if = "is_default")]
    pub opacity: Option<f64>,
    /// Height of the paint, 0 none, 1 the lights' full brush.
    #[serde(default, skip_serializing_if = "is_default")]
    pub thickness: Option<f64>,
    /// Share of its mark that a brush leaves out, 0 wet .. 1 nothing left.
    #[serde(default, skip_serializing_if = "is_default")]
    pub dryness: Option<f64>,
    /// How much wet paint from the layers below a stroke picks up, 0..=1.
    #[serde(default, skip_serializing_if = "is_default")]
    pub pickup: Option<f64>,
    /// Tone of the ground; for `ground` alone.
    #[serde(default, skip_serializing_if = "is_default")]
    pub color: Option<Color>,
}

/// A number of [`LayerSettings`].
#[derive(Clone, Debug)]
pub struct LayerNumber {
    /// Its name, its range in a scene file, what it does, and where it is kept.
    pub number: Number<LayerSettings, Option<f64>>,
    /// Where it is kept once resolved.
    pub resolved: fn(&mut ResolvedLayer) -> &mut f32,
}

macro_rules! layer_number {
    ($field:ident, $limits:expr, $effect:expr) => {
        LayerNumber { number: number!($field, $limits, $effect), resolved: |layer| &mut layer.$field }
    };
}

impl LayerSettings {
    /// Every number of a layer.
    pub const NUMBERS: &'static [LayerNumber] = &[
        layer_number!(length_px, 0.001..=MAX_STROKE_PX, "How long strokes are, pixels at the scene's size."),
        layer_number!(width_px, 0.001..=MAX_STROKE_PX, "How wide strokes are, pixels at the scene's size."),
        layer_number!(
            coverage,
            0.0..=MAX_COVERAGE,
            "How many strokes lie over each other; 0 leaves the layer out."
        ),
        layer_number!(opacity, 0.0..=1.0, "How much a stroke hides of what lies under it."),
        layer_number!(
            thickness,
            0.0..=MAX_THICKNESS,
            "How high the paint stands; 1 is the lights' full brush."
        ),
        layer_number!(dryness, 0.0..=1.0, "How much of its mark the brush leaves out."),
        layer_number!(pickup, 0.0..=1.0, "How much wet paint a stroke takes up from below."),
    ];
}

/// One layer of paint with nothing left out.
#[derive(Clone, Debug, PartialEq)]
pub struct ResolvedLayer {
    /// Brushes by name; one named twice is taken twice as often. At least one.
    pub brushes: Vec<String>,
    /// Length in pixels at the scene's size.
    pub length_px: f32,
    /// Width in pixels at the scene's size.
    pub width_px: f32,
    /// Strokes per pixel × length × width where the layer is wanted.
    pub coverage: f32,
    /// How much of what lies under it a stroke hides, 0..=1.
    pub opacity: f32,
    /// Height of the paint; 1 is the lights' full brush.
    pub thickness: f32,
    /// Share of its mark that a brush leaves out.
    pub dryness: f32,
    /// How much wet paint it picks up, 0..=1.
    pub pickup: f32,
    /// How far past its body paint runs where the body layer runs one pixel.
    pub overrun: f32,
}

/// A brush by name, a PNG of one's own (grey is paint), or a list of them: one named twice is taken twice as often.
#[derive(Clone, Debug, PartialEq)]
pub struct BrushMix(pub Vec<String>);

/// How paint ends at the border of its body.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub enum Edges {
    /// Cut off along the border.
    Clip,
    /// Ragged, up to about this many pixels (at the scene's size) past it; lost in some places and found in others.
    Overrun(f64),
    /// Strokes end where they end.
    Free,
}
