//! The strokes of a frame by key (body, layer, particle), so that two frames can be compared stroke by stroke.

use std::collections::BTreeMap;

use impasto_gl_render::ResolvedStroke;
use impasto_painting::Frame;
use impasto_painting::frame::LayerKind;

/// Identifies a stroke in every frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct StrokeKey {
    /// Index of the object plus 1.
    pub body_id: u32,
    /// Layer of paint.
    pub kind: LayerKind,
    /// Index of its particle in the progressive order of the object's layer; of a touch, its index in the scene.
    pub particle: u32,
}

/// A stroke as it is measured. Pixels from the lower left, Y up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredStroke {
    /// Centre as drawn, or as computed if the stroke was not drawn.
    pub center_px: [f64; 2],
    /// Where its particle projects.
    pub particle_px: [f64; 2],
    /// Counter-clockwise from +X, as computed. Contour strokes are drawn turned onto the outline; that turn is not
    /// included.
    pub angle_rad: f64,
    /// Length.
    pub length_px: f64,
    /// Width.
    pub width_px: f64,
    /// Alpha as drawn, or the presence if the stroke was not drawn.
    pub alpha: f64,
    /// Luma of its colour as encoded, 0..=1, weights of Rec. 709; 0 where it was not drawn.
    pub luma: f64,
    /// Distance from the eye along the gaze.
    pub depth: f64,
    /// Its presence: the alpha that it would have if nothing hid it and its layer were painted everywhere (small
    /// strokes, for example, are painted only near detail).
    pub presence: f64,
    /// Cosine between its surface's normal and the direction to the eye.
    pub facing: f64,
    /// Index of its region; `regions.len()` outside all regions.
    pub region: u32,
}

impl MeasuredStroke {
    /// Length times width.
    pub fn area_px(&self) -> f64 {
        self.length_px * self.width_px
    }
}

/// All strokes of a frame.
pub type StrokesByKey = BTreeMap<StrokeKey, MeasuredStroke>;

/// The strokes of a frame. `resolved` says how each was drawn, in the frame's order; it is empty if nothing was drawn.
pub fn strokes_by_key(frame: &Frame, resolved: &[ResolvedStroke]) -> StrokesByKey {
    let mut strokes = StrokesByKey::new();
    for run in &frame.layers {
        for index in run.first as usize..(run.first + run.count) as usize {
            let (stroke, source) = (&frame.strokes[index], &frame.sources[index]);
            let key = StrokeKey { body_id: stroke.body_id, kind: run.kind, particle: source.particle };
            let drawn = resolved.get(index);
            let center_px = drawn.map_or(stroke.center_px, |drawn| drawn.center_px);
            let measured = MeasuredStroke {
                center_px: center_px.map(f64::from),
                particle_px: stroke.center_px.map(f64::from),
                angle_rad: f64::from(stroke.angle_rad),
                length_px: f64::from(stroke.length_px),
                width_px: f64::from(stroke.width_px),
                alpha: f64::from(drawn.map_or_else(|| stroke.presence(), |drawn| drawn.alpha)),
                luma: drawn.map_or(0.0, |drawn| luma(drawn.color_linear)),
                depth: f64::from(stroke.depth),
                presence: f64::from(stroke.presence()),
                facing: f64::from(source.facing),
                region: source.region,
            };
            strokes.insert(key, measured);
        }
    }
    strokes
}

/// Luma of a display-linear colour as it is encoded, 0..=1.
fn luma(color_linear: [f32; 3]) -> f64 {
    let encoded =
        color_linear.map(|value| f64::from(impasto_core::color::srgb_from_linear(value.clamp(0.0, 1.0))));
    0.2126 * encoded[0] + 0.7152 * encoded[1] + 0.0722 * encoded[2]
}

/// The strokes of one layer.
pub fn of_layer(
    strokes: &StrokesByKey,
    kind: LayerKind,
) -> impl Iterator<Item = (&StrokeKey, &MeasuredStroke)> {
    strokes.iter().filter(move |(key, _)| key.kind == kind)
}

/// The difference of two angles, degrees in 0..=180.
pub fn degrees_apart(first_rad: f64, second_rad: f64) -> f64 {
    impasto_core::angle::wrap_pi(first_rad - second_rad).abs().to_degrees()
}

#[cfg(test)]
pub(crate) fn a_stroke(center_px: [f64; 2], alpha: f64, luma: f64) -> MeasuredStroke {
    MeasuredStroke {
        center_px,
        particle_px: center_px,
        angle_rad: 0.0,
        length_px: 10.0,
        width_px: 4.0,
        alpha,
        luma,
        depth: 1.0,
        presence: alpha,
        facing: 1.0,
        region: 0,
    }
}
