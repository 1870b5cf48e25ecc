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
    /// The dabs. Where several reach, their factors are multiplied; the product is held to the range of one.
    pub dabs: Vec<AmountDab>,
}

/// What a painted amount multiplies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize, Serialize)]
pub enum Amount {
    /// How wide strokes are; by 0.25 to 4. As many as keep the coverage.
    Width,
    /// How long strokes are; by 0.25 to 4. As many as keep the coverage.
    Length,
    /// How many strokes lie over each other; by 0, which leaves the underpainting alone, to 4.
    Density,
    /// How flat strokes lie on the picture; by 0 to 4, and never more than quite flat.
    Flatness,
}

/// One touch of a brush that paints an amount; all in the object's own space.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct AmountDab {
    /// Where.
    pub at: [f64; 3],
    /// Normal of the surface there; what is turned from it by 60° or more takes less, from 90° on nothing.
    pub normal: [f64; 3],
    /// How far it reaches, more than 0: its factor falls off to 1 there as (1 − (r/R)²)².
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
