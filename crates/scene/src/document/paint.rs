//! Strokes and paint as a scene file states them.

use serde::Deserialize;

use super::color::Color;

/// Stroke settings; what is left out comes from the preset, and a region's from the scene's.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct StrokeSettings {
    /// A named set of values to start from.
    pub preset: Option<String>,
    /// Brush of the body layer.
    pub brush: Option<BrushMix>,
    /// Length of the body layer's strokes in pixels at the scene's size; the other layers keep their proportion to it.
    pub length_px: Option<f64>,
    /// Width, likewise.
    pub width_px: Option<f64>,
    /// Makes the strokes of all layers larger or smaller; 1 leaves them.
    pub scale: Option<f64>,
    /// Strokes of the body layer per pixel × length × width.
    pub coverage: Option<f64>,
    /// 1 keeps strokes flat on the picture (the paper's similarity), 0 lets their direction follow the surface.
    pub flatness: Option<f64>,
    /// How far strokes stand off the surface along its normal, units of the object's own space.
    pub offset: Option<f64>,
    /// How far strokes grow and shrink with their surface: 0 keeps their size in pixels, 1 keeps it on the surface.
    pub size_follow: Option<f64>,
    /// How much narrower strokes are at their end than at their start, −1..=1: their width goes from 1 + taper times the mean
    /// one to 1 − taper times.
    pub taper: Option<f64>,
    /// How far strokes turn to their left from start to end, degrees, −180..=180; in the middle they keep their direction. Differs
    /// from stroke to stroke as sizes do.
    pub bend_deg: Option<f64>,
    /// Standard deviation of the angle from stroke to stroke, degrees.
    pub angle_jitter_deg: Option<f64>,
    /// Standard deviation of a slow swing of the angle over the surface, degrees.
    pub swing_deg: Option<f64>,
    /// How far strokes near a body's limb lie along its contour, 0..=1; this part of the direction follows the view.
    pub contour: Option<f64>,
    /// Standard deviation of the size, as a share of it.
    pub size_jitter: Option<f64>,
    /// How paint ends at the border of its body.
    pub edges: Option<Edges>,
    /// How much colours differ from stroke to stroke: 0 not at all, 1 as oil paint is mixed.
    pub color_jitter: Option<f64>,
    /// How much warmer lights and cooler shadows are than in the plain render, 0 and up.
    pub temperature: Option<f64>,
    /// How far colours are pulled to a painter's values: planes of one value, rich darks, an earthy underpainting; 0..=1.
    pub grading: Option<f64>,
    /// Pigments that all colours are mixed from, at most 16; empty means any colour.
    pub palette: Option<Vec<Color>>,
    /// Higher layers are painted over lower ones.
    pub layer: Option<i32>,
    /// What differs from the preset in single layers of paint, by name.
    pub layers: Vec<LayerSettings>,
}

/// One layer of paint: its own strokes, laid over those of the layers before it.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LayerSettings {
    /// `underpainting`, `body`, `form`, `scumble`, `accents` or `lights`; `ground` is the tone under all of them.
    pub name: String,
    /// Brush, or a mix of brushes.
    #[serde(default)]
    pub brush: Option<BrushMix>,
    /// Length in pixels at the scene's size.
    #[serde(default)]
    pub length_px: Option<f64>,
    /// Width in pixels at the scene's size.
    #[serde(default)]
    pub width_px: Option<f64>,
    /// Strokes per pixel × length × width where the layer is wanted; 0 leaves the layer out.
    #[serde(default)]
    pub coverage: Option<f64>,
    /// How much of what lies under a stroke it hides, 0..=1; of the ground: how far its tone hides the body's own wash.
    #[serde(default)]
    pub opacity: Option<f64>,
    /// Height of the paint, 0 none, 1 the lights' full brush.
    #[serde(default)]
    pub thickness: Option<f64>,
    /// Share of its mark that a brush leaves out, 0 wet .. 1 nothing left.
    #[serde(default)]
    pub dryness: Option<f64>,
    /// How much wet paint from the layers below a stroke picks up, 0..=1.
    #[serde(default)]
    pub pickup: Option<f64>,
    /// Tone of the ground; for `ground` alone.
    #[serde(default)]
    pub color: Option<Color>,
}

/// A brush by name, a PNG of one's own (grey is paint), or a list of them: one named twice is taken twice as often.
#[derive(Clone, Debug, PartialEq)]
pub struct BrushMix(pub Vec<String>);

/// How paint ends at the border of its body.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Edges {
    /// Cut off along the border.
    Clip,
    /// Ragged, up to about this many pixels (at the scene's size) past it; lost in some places and found in others.
    Overrun(f64),
    /// Strokes end where they end.
    Free,
}
