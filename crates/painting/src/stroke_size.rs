//! How far strokes reach, and how much chance makes of their size.

use impasto_core::hash;

/// Length and width also vary each on its own: standard deviations of their logarithms, as shares of the size jitter.
pub(crate) const LENGTH_SHARE: f32 = 1.1;
pub(crate) const WIDTH_SHARE: f32 = 0.75;

/// Size of a stroke's quad over that of the stroke itself; the margin has room for ragged ends.
const QUAD: f32 = 1.0 / impasto_core::brush::FILL;

/// How far a stroke reaches from its centre along an axis of the picture, which has these parts along and across the stroke,
/// pixels. The resolve shader may shift a stroke along itself: that is in it.
pub(crate) fn reach_px([along, across]: [f32; 2], [length_px, width_px]: [f32; 2]) -> f32 {
    0.5 * QUAD * (along.abs() * length_px + across.abs() * width_px) + 0.5 * length_px * along.abs()
}

/// The most that chance makes of a length and a width, as factors, where sizes vary by this much.
pub(crate) fn most_size(jitter: f32) -> [f32; 2] {
    [LENGTH_SHARE, WIDTH_SHARE].map(|share| (jitter * (1.0 + share) * hash::MOST_NORMAL).exp())
}
