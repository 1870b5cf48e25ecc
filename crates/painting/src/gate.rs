//! What can be said of a particle's stroke before anything is computed for it: most of them are absent.

use impasto_core::presence;

use crate::coat::Coat;
use crate::counts::most_wanted;
use crate::prepare::Painting;
use crate::stroke::LEAST_COUNTED_FADE;

/// What is asked here is rounded otherwise than what is asked later: a little is let through.
const LEEWAY: f64 = 1.001;

/// Of one rule on one coat, in one view.
pub(crate) struct Gate {
    /// How far from its centre a stroke reaches, pixels, as long as it does not follow the size of its surface.
    pub(crate) reach_px: f32,
    /// By part: the most particles of a lower order for each px² per unit of surface that a stroke may have before it, and be
    /// there. Infinite where that is no question of the order.
    pub(crate) most_per_area: Vec<f32>,
}

impl Painting {
    /// By rule; `None` for rules that paint nothing on this coat.
    pub(crate) fn gates(&self, coat: &Coat, px_scale: f32, by_polygon: bool) -> Vec<Option<Gate>> {
        let body = &self.bodies[coat.object];
        let regions = &self.scene().regions;
        let most =
            f64::from(most_wanted(coat.kind) / LEAST_COUNTED_FADE) / f64::from(presence::ABSENT_LN).exp();
        let gate = |(index, rule): (usize, &crate::regions::RegionRule)| {
            let layer = rule.strokes.layer_of(coat.kind);
            let is_hidden = body.hidden || regions.get(index).is_some_and(|region| region.hidden);
            if is_hidden || layer.coverage <= 0.0 {
                return None;
            }
            let of_part = |cap: &crate::parts::Cap| {
                let [length, width] = cap.apply(layer.length_px, layer.width_px);
                let wanted_per_px = f64::from(layer.coverage / (length * width));
                (wanted_per_px * coat.sampled.area * most * LEEWAY / f64::from(px_scale * px_scale)) as f32
            };
            let by_order = !by_polygon && rule.strokes.size_follow <= 0.0;
            Some(Gate {
                reach_px: (layer.length_px + layer.width_px * (1.0 + rule.strokes.taper.abs())) * px_scale,
                most_per_area: body
                    .caps
                    .iter()
                    .map(|cap| if by_order { of_part(cap) } else { f32::INFINITY })
                    .collect(),
            })
        };
        self.rules.iter().enumerate().map(gate).collect()
    }
}
