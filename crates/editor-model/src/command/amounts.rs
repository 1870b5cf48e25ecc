//! Commands on painted amounts.

use impasto_scene::document::{Amount, AmountDab, PaintedAmount, Scene};

use super::direction::target;
use super::{Done, RegionTarget, unlocked_region};
use crate::refusal::Refusal;
use crate::selection::{Item, Selection};

/// Painted amounts: how wide, long, dense and flat strokes are where a brush touched them.
#[derive(Clone, Debug, PartialEq)]
pub enum Amounts {
    /// Adds the dabs of one drag.
    Paint {
        /// The region that the dabs are painted on.
        region: RegionTarget,
        /// What the dabs multiply: width, length, density or flatness.
        of: Amount,
        /// The object, where the region covers more than one.
        object: Option<String>,
        /// The dabs.
        dabs: Vec<AmountDab>,
    },
    /// Replaces the amounts of a region, as an eraser does.
    Erase {
        /// The region.
        region: String,
        /// Which amount was erased.
        of: Amount,
        /// All amounts of the region, without what was erased.
        left: Vec<PaintedAmount>,
    },
    /// Removes one amount with all its dabs. Holds the region, and the amount's index in the region.
    Clear(String, usize),
    /// Removes all amounts of a region.
    ClearAll(String),
}

impl Amounts {
    pub(super) fn edit(&self, scene: &mut Scene) -> Result<Done, Refusal> {
        match self {
            Self::Paint { region, of, object, dabs } => {
                let name = target(scene, region)?;
                if dabs.is_empty() {
                    return Err(Refusal::new("Nothing to paint here: the ring must lie on an object"));
                }
                let amounts = &mut unlocked_region(scene, &name)?.amounts;
                match amounts.iter_mut().find(|amount| amount.of == *of && amount.object == *object) {
                    Some(amount) => amount.dabs.extend_from_slice(dabs),
                    None => {
                        amounts.push(PaintedAmount { of: *of, object: object.clone(), dabs: dabs.clone() });
                    }
                }
                Ok(done(format!("Paint {} on {name}", of.word()), &name))
            }
            Self::Erase { region, of, left } => {
                unlocked_region(scene, region)?.amounts.clone_from(left);
                Ok(done(format!("Erase {} on {region}", of.word()), region))
            }
            Self::Clear(region, index) => {
                let amounts = &mut unlocked_region(scene, region)?.amounts;
                if *index >= amounts.len() {
                    return Err(Refusal::new(format!("{region} has no such amount")));
                }
                let of = amounts.remove(*index).of;
                Ok(Done::new(format!("Clear {} of {region}", of.word())))
            }
            Self::ClearAll(region) => {
                let amounts = &mut unlocked_region(scene, region)?.amounts;
                if amounts.is_empty() {
                    return Err(Refusal::new(format!("Nothing is painted on {region}")));
                }
                amounts.clear();
                Ok(Done::new(format!("Clear all amounts of {region}")))
            }
        }
    }
}

fn done(text: String, region: &str) -> Done {
    Done::new(text).selecting(Selection::only(Item::Region(region.to_owned())))
}
