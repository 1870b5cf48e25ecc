//! M8, flatness: does a stroke keep its size and shape on the picture?

use std::collections::BTreeMap;

use crate::figures::coefficient_of_variation;
use crate::strokes::{StrokeKey, StrokesByKey};

/// How the sizes of strokes vary over the frames.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Flatness {
    /// Per stroke, the larger of the coefficients of variation of its length and its width.
    pub variation: Vec<f64>,
}

/// Flatness over frames of one picture size, for the strokes that are in at least two of them.
pub fn flatness<'a>(frames: impl Iterator<Item = &'a StrokesByKey>) -> Flatness {
    let mut sizes: BTreeMap<StrokeKey, [Vec<f64>; 2]> = BTreeMap::new();
    for strokes in frames {
        for (key, stroke) in strokes {
            let [lengths, widths] = sizes.entry(*key).or_default();
            lengths.push(stroke.length_px);
            widths.push(stroke.width_px);
        }
    }
    let of_stroke = |[lengths, widths]: &[Vec<f64>; 2]| {
        coefficient_of_variation(lengths).max(coefficient_of_variation(widths))
    };
    Flatness { variation: sizes.values().filter(|[lengths, _]| lengths.len() >= 2).map(of_stroke).collect() }
}
