//! How far strokes reach in the picture, and how much their size varies by chance.

use impasto_core::hash;

/// Besides their common size, a stroke's length and width vary each on its own. These are the standard deviations of
/// the two logarithms, as shares of the size jitter.
pub(crate) const LENGTH_SHARE: f32 = 1.1;
pub(crate) const WIDTH_SHARE: f32 = 0.75;

/// Size of a stroke's quad over that of the stroke itself; the margin has room for ragged ends.
const QUAD: f32 = 1.0 / impasto_core::brush::FILL;

/// How far a stroke reaches from its centre along an axis of the picture, pixels. `along` and `across` are the axis's
/// components along and across the stroke. Includes the shift along the stroke that the resolve shader may make.
pub(crate) fn reach_px([along, across]: [f32; 2], [length_px, width_px]: [f32; 2]) -> f32 {
    0.5 * QUAD * (along.abs() * length_px + across.abs() * width_px) + 0.5 * length_px * along.abs()
}

/// The greatest factors that chance puts on length and width, with this size jitter.
pub(crate) fn most_size(jitter: f32) -> [f32; 2] {
    [LENGTH_SHARE, WIDTH_SHARE].map(|share| (jitter * (1.0 + share) * hash::MOST_NORMAL).exp())
}
