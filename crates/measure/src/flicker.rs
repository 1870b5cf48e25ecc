//! M17, flicker: how much the brightness of surface points goes up and down from frame to frame, while they are
//! followed along their motion.

use crate::chatter::Place;
use crate::plane::Plane;

/// A second difference of luma above this (levels of 255) counts as visible.
pub const SEEN: f32 = 6.0;

/// How many bins count the second differences, from 0 to 255; the last one also counts all larger ones.
const BINS: usize = 5100;

/// For each pixel of a frame, where its surface point is in the frame before and in the one after, in columns and rows;
/// `None` where no body is, or where the point is off the picture, hidden, or perhaps covered by another body's paint.
pub struct Along<'a> {
    /// In the frame before.
    pub before: &'a [Option<[f64; 2]>],
    /// In the frame after.
    pub after: &'a [Option<[f64; 2]>],
}

/// Flicker over a shot.
#[derive(Clone, Debug)]
pub struct Flicker {
    counts: Vec<usize>,
    /// Pixels whose points were seen in three frames.
    pub pixels: usize,
    /// Those of these pixels that flicker by more than [`SEEN`].
    pub flickering: usize,
    /// The pixel with the largest second difference.
    pub worst: Option<Place>,
}

impl Default for Flicker {
    fn default() -> Self {
        Self { counts: vec![0; BINS], pixels: 0, flickering: 0, worst: None }
    }
}

impl Flicker {
    /// Adds three neighbouring frames: |I₊(x + v₊) − 2 I(x) + I₋(x + v₋)| at every pixel x whose surface point is seen
    /// in all three. I is luma; v₋ and v₊ lead from x to where the point is in the frame before and in the one after.
    pub fn add(&mut self, frame: f64, [first, middle, last]: [&Plane; 3], along: &Along<'_>) {
        let width = middle.size_px[0];
        for (pixel, (before, after)) in along.before.iter().zip(along.after).enumerate() {
            let (Some(before), Some(after)) = (before, after) else { continue };
            let (Some(then), Some(next)) =
                (first.sample(before[0], before[1]), last.sample(after[0], after[1]))
            else {
                continue;
            };
            let difference = (then - 2.0 * middle.values[pixel] + next).abs();
            self.counts[((difference * (BINS as f32 / 255.0)) as usize).min(BINS - 1)] += 1;
            self.pixels += 1;
            self.flickering += usize::from(difference > SEEN);
            if self.worst.is_none_or(|worst| f64::from(difference) > worst.amount) {
                let at_px = [(pixel % width) as f64 + 0.5, (pixel / width) as f64 + 0.5];
                self.worst = Some(Place { frame, at_px, stroke: None, amount: f64::from(difference) });
            }
        }
    }

    /// The second difference that this `share` (0..=1) of the pixels does not exceed, divided by 255.
    pub fn percentile(&self, share: f64) -> f64 {
        let wanted = (share * self.pixels as f64).ceil() as usize;
        let mut sum = 0;
        let bin = self.counts.iter().position(|&count| {
            sum += count;
            sum >= wanted
        });
        (bin.unwrap_or(0) + 1) as f64 / BINS as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_moves_along_or_changes_evenly_does_not_flicker() {
        let size_px = [40, 30];
        let texture = |x: i64, y: i64| ((x * 37 + y * 91) % 101) as f32;
        // The surface moves by two columns a frame, and gets lighter by 10 a frame.
        let frames = [-1i64, 0, 1].map(|time| {
            Plane::of(size_px, |x, y| texture(x as i64 - 2 * time, y as i64) + 50.0 + 10.0 * time as f32)
        });
        let places = |by: f64| -> Vec<Option<[f64; 2]>> {
            (0..size_px[0] * size_px[1]).map(|at| Some([(at % 40) as f64 + by, (at / 40) as f64])).collect()
        };
        let (before, after) = (places(-2.0), places(2.0));
        let along = Along { before: &before, after: &after };
        let mut calm = Flicker::default();
        calm.add(5.0, frames.each_ref(), &along);
        assert_eq!((calm.pixels, calm.flickering), (36 * 30, 0));
        assert!(calm.percentile(0.999) < 1e-3);
        // One pixel of the middle frame flashes.
        let mut flashing = frames.clone();
        flashing[1].values[3 * 40 + 20] += 60.0;
        let mut found = Flicker::default();
        found.add(5.0, flashing.each_ref(), &along);
        assert_eq!(found.flickering, 1);
        let worst = found.worst.unwrap();
        assert_eq!((worst.frame, worst.at_px, worst.amount.round()), (5.0, [20.5, 3.5], 120.0));
        assert!((found.percentile(1.0) - 120.0 / 255.0).abs() < 1e-3);
    }
}
