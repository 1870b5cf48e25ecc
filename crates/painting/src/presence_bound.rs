//! A cheap upper bound on a stroke's presence. Most strokes are absent, and the bound rules them out before they are
//! computed.

use std::borrow::Cow;

use impasto_core::presence;
use impasto_scene::presets::ResolvedStrokes;

use crate::boil;
use crate::coat::Coat;
use crate::counts::most_wanted;
use crate::painting::Painting;
use crate::parts::Cap;
use crate::stroke_size::{most_size, reach_px};

/// Strokes fade near a body's outline. To make up for that, the number wanted is divided by the fade, but by no less
/// than this.
pub(crate) const LEAST_COUNTED_FADE: f32 = 0.3;

/// A factor on the bound that lets a little more through, since the bound is rounded differently from the presence
/// itself.
const LEEWAY: f64 = 1.001;

/// The bound for one rule on one coat, in one view.
pub(crate) struct PresenceBound {
    /// How far from its particle a stroke can reach, pixels, with the largest size and shift that chance, boil and
    /// painted amounts give. A stroke that grows as its surface comes nearer (`size_follow`) can reach farther.
    pub(crate) reach_px: f32,
    /// One number for each part of the body. A stroke can be present only if its particle's ordinal (about how many
    /// particles come before it) is less than this, times the px² that a unit of surface covers there. Infinite where
    /// the ordinal rules out nothing: with the source paper's counts, and with `size_follow`.
    pub(crate) most_per_area: Vec<f32>,
}

impl Painting {
    /// One bound for each rule in `strokes_of_rule`, which holds the rules' strokes at the frame; `None` for a rule
    /// that paints nothing on this coat. With `by_polygon`, the source paper's counts per polygon decide what shows,
    /// whatever the ordinal, so `most_per_area` is infinite.
    pub(crate) fn presence_bounds(
        &self,
        coat: &Coat,
        strokes_of_rule: &[Cow<'_, ResolvedStrokes>],
        px_scale: f32,
        by_polygon: bool,
    ) -> Vec<Option<PresenceBound>> {
        let body = &self.bodies[coat.object];
        let regions = &self.scene().regions;
        let most =
            f64::from(most_wanted(coat.kind) / LEAST_COUNTED_FADE) / f64::from(presence::ABSENT_LN).exp();
        let bound = |(index, strokes): (usize, &Cow<'_, ResolvedStrokes>)| {
            let layer = strokes.layer_of(coat.kind);
            let is_hidden = body.hidden || regions.get(index).is_some_and(|region| region.hidden);
            if is_hidden || layer.hidden || layer.coverage <= 0.0 {
                return None;
            }
            let ([longer_painted, wider_painted], more_painted) = coat.amounts.most(index);
            let of_part = |cap: &Cap| {
                let size_px = [layer.length_px, layer.width_px];
                let [length, width] = cap.fitted(size_px, body.least_form, strokes.fit);
                let wanted_per_px = f64::from(layer.coverage / (length * width) * more_painted);
                (wanted_per_px * coat.sampled.area * most * LEEWAY / f64::from(px_scale * px_scale)) as f32
            };
            let by_ordinal = !by_polygon && strokes.size_follow <= 0.0;
            let [longer, wider] = most_size(strokes.size_jitter);
            let [longer_boiled, wider_boiled] = boil::most_size(strokes.boil);
            let [along, across] = boil::most_shift(strokes.boil);
            let length_px = layer.length_px * longer * longer_boiled * longer_painted * px_scale;
            let width_px = layer.width_px * wider * wider_boiled * wider_painted * px_scale;
            let shift_px = along * length_px + across * width_px;
            Some(PresenceBound {
                reach_px: reach_px([1.0; 2], [length_px, width_px * (1.0 + strokes.taper.abs())]) + shift_px,
                most_per_area: body
                    .caps
                    .iter()
                    .map(|cap| if by_ordinal { of_part(cap) } else { f32::INFINITY })
                    .collect(),
            })
        };
        strokes_of_rule.iter().enumerate().map(bound).collect()
    }
}
