//! Painted amounts: how wide, long, dense and flat strokes are, dab by dab on the surface, as a scene file states it.

use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use crate::document::is_default;

/// Dabs of a brush that multiply one number of the strokes wherever they reach.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct PaintedAmount {
    /// What is multiplied.
    pub of: Amount,
    /// The object, where the region covers more than one.
    #[serde(default, skip_serializing_if = "is_default")]
    pub object: Option<String>,
    /// The dabs. Where several dabs overlap, their factors are multiplied, and the product is held to the range of a
    /// single factor.
    pub dabs: Vec<AmountDab>,
}

/// What a painted amount multiplies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize, Serialize)]
pub enum Amount {
    /// How wide strokes are: a factor from 0.25 to 4. The number of strokes changes so that the coverage stays.
    Width,
    /// How long strokes are: a factor from 0.25 to 4. The number of strokes changes so that the coverage stays.
    Length,
    /// How many strokes lie over each other: a factor from 0, which leaves only the underpainting, to 4.
    Density,
    /// How flat strokes lie on the picture: a factor from 0 to 4 on their `flatness`. Where the product is 1 or more,
    /// they lie wholly flat.
    Flatness,
}

/// One touch of a brush that paints an amount; all in the object's own space.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct AmountDab {
    /// The place, in the object's own space.
    pub at: [f64; 3],
    /// Normal of the surface there. A surface turned away from this normal by up to 60° takes the full factor; beyond
    /// 60° the effect fades, and from 90° on there is none.
    pub normal: [f64; 3],
    /// How far the dab reaches (R), more than 0, units of the object's own space. At a distance r from its middle, the
    /// factor has (1 − (r/R)²)² of its effect, so at R the factor is 1.
    pub radius: f64,
    /// The factor in its middle.
    pub by: f64,
}

impl Amount {
    /// All of them, in the order in which lists show them.
    pub const ALL: [Self; 4] = [Self::Width, Self::Length, Self::Density, Self::Flatness];

    /// The range of a dab's factor. The product of all dabs at a place is held to the same range.
    pub fn range(self) -> RangeInclusive<f64> {
        match self {
            Self::Width | Self::Length => 0.25..=4.0,
            Self::Density | Self::Flatness => 0.0..=4.0,
        }
    }

    /// What people call it, in the middle of a sentence.
    pub fn word(self) -> &'static str {
        match self {
            Self::Width => "width",
            Self::Length => "length",
            Self::Density => "density",
            Self::Flatness => "flatness",
        }
    }
}
