//! Guides that smooth: how far they loosen the samples of the field, and how far strokes follow what it relaxes to.

use glam::DVec2;
use impasto_core::direction::field::Constraint;
use impasto_core::direction::{Symmetry, tangent_axes};
use impasto_scene::document::GuideMode;
use rayon::prelude::*;

use crate::field::{FIRM, FieldInputs, SamplePoint};

/// Firmness of a sample that nothing has loosened, and of one that is let go wholly.
const HELD: f64 = 1e4;
const LET_GO: f64 = 1e-6;

/// The share of the relaxed field in a stroke that a smoothing guide reaches by this weight. It rises steeply: the field
/// itself knows how far it is loose, and at the rim of the guide it is what it was.
pub(crate) fn share(weight: f64) -> f64 {
    1.0 - (1.0 - weight).powi(4)
}

impl FieldInputs {
    /// Whether any guide smooths.
    pub(crate) fn smooths(&self) -> bool {
        self.guides.iter().any(|guide| guide.mode == GuideMode::Smooth)
    }

    /// What holds the samples that a guide loosens: by geometric steps less of what was solved; where a later guide combs,
    /// that. `None` for all others.
    pub(crate) fn holds(
        &self,
        points: &[SamplePoint],
        solved: &[DVec2],
        symmetry: Symmetry,
    ) -> Vec<Option<Constraint>> {
        let hold = |(sample, solved): (&SamplePoint, &DVec2)| {
            let point = sample.point;
            let mut hold: Option<Constraint> = None;
            for guide in self.guides_of(point.rule) {
                let Some(found) = guide.guide.influence(point.position, point.normal, 0.0) else { continue };
                match (guide.mode, &mut hold) {
                    (GuideMode::Smooth, _) => {
                        let held = hold.get_or_insert(Constraint { target: *solved, weight: HELD });
                        held.weight *= (LET_GO / HELD).powf(found.weight);
                    }
                    (GuideMode::Comb, Some(held)) => {
                        let views =
                            self.references.views((point.position, point.normal), point.rule, |_| None);
                        let tangent = self.combed(guide, found, point, &views);
                        let there = symmetry.encode(tangent, tangent_axes(point.normal));
                        let pull = FIRM * found.weight;
                        let target = (held.target * held.weight + there * pull).try_normalize();
                        held.target = target.unwrap_or(there);
                        held.weight = held.weight.max(pull);
                    }
                    // It is in what was solved.
                    (GuideMode::Comb, None) => {}
                }
            }
            hold.map(|held| Constraint { weight: held.weight.max(LET_GO), ..held })
        };
        points.par_iter().zip(solved).with_min_len(256).map(hold).collect()
    }
}
