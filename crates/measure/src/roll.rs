//! M1 and M2, roll: do pictures and the angles of strokes turn as the camera rolls?

use impasto_gl_render::Picture;

use crate::strokes::{StrokesByKey, degrees_apart};
use crate::turning::quarters_of_bytes;

/// The difference between a picture and another one turned by quarters.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct QuarterDifference {
    /// Mean difference of a channel, levels of 255.
    pub mean: f64,
    /// Pixels of which a channel differs by more than 16 levels.
    pub over_16: usize,
    /// Pixels of the mask.
    pub pixels: usize,
}

/// M1 for quarter turns. `rolled` is the picture of a camera that is rolled by `quarters` quarter turns. It is compared
/// with `straight`, turned clockwise by as many, inside `mask`. The pictures are square.
pub fn quarter_difference(
    straight: &Picture,
    rolled: &Picture,
    quarters: i32,
    mask: &[bool],
) -> QuarterDifference {
    let expected = quarters_of_bytes(&straight.rgba8, straight.size_px[0] as usize, -quarters);
    let mut found = QuarterDifference::default();
    let mut sum = 0.0;
    for (index, _) in mask.iter().enumerate().filter(|(_, inside)| **inside) {
        let channels = index * 4..index * 4 + 3;
        let differences =
            rolled.rgba8[channels.clone()].iter().zip(&expected[channels]).map(|(a, b)| a.abs_diff(*b));
        let (total, largest) = differences.fold((0u32, 0), |(total, largest), difference| {
            (total + u32::from(difference), difference.max(largest))
        });
        sum += f64::from(total) / 3.0;
        found.over_16 += usize::from(largest > 16);
        found.pixels += 1;
    }
    found.mean = sum / found.pixels.max(1) as f64;
    found
}

/// M2: |wrap(θ(φ) − θ(0) + φ)| of the strokes that are in both frames, degrees, where θ(φ) is a stroke's angle under a
/// camera that is rolled by φ.
pub fn roll_errors_deg(straight: &StrokesByKey, rolled: &StrokesByKey, roll_deg: f64) -> Vec<f64> {
    let errors = straight.iter().filter_map(|(key, before)| {
        let now = rolled.get(key)?;
        Some(degrees_apart(now.angle_rad + roll_deg.to_radians(), before.angle_rad))
    });
    errors.collect()
}
