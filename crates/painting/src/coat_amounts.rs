//! The painted amounts at each particle of a coat: factors on width, length, density and flatness of its strokes.

use std::sync::Arc;

use impasto_scene::document::Amount;
use impasto_scene::presets::LayerKind;
use rayon::prelude::*;

use crate::amounts::{BodyAmounts, Painted};
use crate::traits::Traits;

/// The painted amounts at each particle of a coat, in progressive order.
#[derive(Debug, Default)]
pub(crate) struct CoatAmounts {
    /// Empty if no size and no density is painted.
    painted: Vec<Painted>,
    /// Factors on the flatness; empty where none is painted.
    flatness: Vec<f32>,
    /// For each rule with painted amounts, the greatest factors. Here, `density` is [`Painted::wanted`]: the factor on
    /// how many strokes are wanted.
    most: Vec<(u16, Painted)>,
}

pub(crate) struct AmountInputs {
    pub(crate) kind: LayerKind,
    pub(crate) amounts: Arc<BodyAmounts>,
    pub(crate) traits: Arc<Traits>,
}

impl PartialEq for AmountInputs {
    fn eq(&self, other: &Self) -> bool {
        self.kind == other.kind && Arc::ptr_eq(&self.traits, &other.traits) && self.amounts == other.amounts
    }
}

impl AmountInputs {
    /// The amounts of all particles. The underpainting is there to cover, so the size and the number of its strokes do
    /// not change.
    pub(crate) fn find(&self) -> CoatAmounts {
        let Self { kind, amounts, traits } = self;
        let count = traits.particles.len();
        let at = |index: usize| {
            let (particle, rule) = (traits.particles.at(index), traits.region(index));
            (particle.position, particle.normal, rule)
        };
        let sized = *kind != LayerKind::Underpainting
            && amounts.has(&[Amount::Width, Amount::Length, Amount::Density]);
        let mut of_coat = CoatAmounts::default();
        if sized {
            let painted = (0..count).into_par_iter().map(|index| {
                let (position, normal, rule) = at(index);
                amounts.painted(rule, position, normal)
            });
            of_coat.painted = painted.collect();
            of_coat.most = amounts.rules().map(|rule| (rule, Painted::NOTHING)).collect();
            for (index, painted) in of_coat.painted.iter().enumerate() {
                let rule = traits.region(index);
                if let Some((_, most)) = of_coat.most.iter_mut().find(|(known, _)| *known == rule) {
                    *most = most.most(Painted { density: painted.wanted(), ..*painted });
                }
            }
        }
        if amounts.has(&[Amount::Flatness]) {
            let flatness = (0..count).into_par_iter().map(|index| {
                let (position, normal, rule) = at(index);
                amounts.at(Amount::Flatness, rule, position, normal)
            });
            of_coat.flatness = flatness.collect();
        }
        of_coat
    }
}

impl CoatAmounts {
    /// The painted factors on length, width and density at a particle; [`Painted::NOTHING`] where none are painted.
    #[inline]
    pub(crate) fn of(&self, particle: usize) -> Painted {
        self.painted.get(particle).copied().unwrap_or(Painted::NOTHING)
    }

    /// The greatest factors on the length and the width of a rule's strokes, and on how many are wanted.
    pub(crate) fn most(&self, rule: usize) -> ([f32; 2], f32) {
        let found = self.most.iter().find(|(known, _)| usize::from(*known) == rule);
        let Painted { length, width, density } = found.map_or(Painted::NOTHING, |(_, most)| *most);
        ([length, width], density)
    }

    pub(crate) fn flatness(&self) -> &[f32] {
        &self.flatness
    }
}
