//! Smooth curves for outlines, and noise that makes surfaces uneven.

use glam::DVec2;

/// A smooth curve through points, as a dense chain of samples.
pub struct Profile {
    samples: Vec<DVec2>,
}

impl Profile {
    /// The Catmull-Rom curve through at least two points, ends included.
    pub fn through(points: &[[f64; 2]]) -> Self {
        const STEPS: usize = 64;
        let points: Vec<DVec2> = points.iter().copied().map(DVec2::from_array).collect();
        let last = points.len() - 1;
        let mut samples = vec![points[0]];
        for span in 0..last {
            let (start, end) = (points[span], points[span + 1]);
            // Past an end the curve is continued straight on.
            let before = if span > 0 { points[span - 1] } else { 2.0 * start - end };
            let after = if span + 1 < last { points[span + 2] } else { 2.0 * end - start };
            samples.extend(
                (1..=STEPS).map(|step| catmull_rom([before, start, end, after], step as f64 / STEPS as f64)),
            );
        }
        Self { samples }
    }

    /// `count + 1` points along the curve, both ends among them. A share of the steps, `bend_share` (0..=1), goes
    /// where the curve bends, so that no facet turns much more than another. The rest are spread evenly along its
    /// length.
    pub fn spread(&self, count: usize, bend_share: f64) -> Vec<DVec2> {
        let mut lengths = vec![0.0];
        let mut bends = vec![0.0];
        for index in 1..self.samples.len() {
            let step = self.samples[index] - self.samples[index - 1];
            let bend = match self.samples.get(index + 1) {
                Some(next) => step.angle_to(*next - self.samples[index]).abs(),
                None => 0.0,
            };
            lengths.push(lengths[index - 1] + step.length());
            bends.push(bends[index - 1] + bend);
        }
        let end = self.samples.len() - 1;
        let bend_share = if bends[end] > 0.0 { bend_share } else { 0.0 };
        let progress = |index: usize| {
            let bent = if bends[end] > 0.0 { bends[index] / bends[end] } else { 0.0 };
            (1.0 - bend_share) * lengths[index] / lengths[end] + bend_share * bent
        };
        let mut index = 1;
        (0..=count)
            .map(|step| {
                let wanted = step as f64 / count as f64;
                while index < end && progress(index) < wanted {
                    index += 1;
                }
                let (low, high) = (progress(index - 1), progress(index));
                let share = if high > low { ((wanted - low) / (high - low)).clamp(0.0, 1.0) } else { 0.0 };
                self.samples[index - 1].lerp(self.samples[index], share)
            })
            .collect()
    }

    /// The second coordinate where the first is `x`, for a curve whose first coordinate only grows.
    pub fn height_at(&self, x: f64) -> f64 {
        let index = self.samples.partition_point(|sample| sample.x < x).clamp(1, self.samples.len() - 1);
        let (low, high) = (self.samples[index - 1], self.samples[index]);
        let share = if high.x > low.x { ((x - low.x) / (high.x - low.x)).clamp(0.0, 1.0) } else { 0.0 };
        low.y + (high.y - low.y) * share
    }
}

fn catmull_rom([before, start, end, after]: [DVec2; 4], t: f64) -> DVec2 {
    let (t2, t3) = (t * t, t * t * t);
    0.5 * (2.0 * start
        + (end - before) * t
        + (2.0 * before - 5.0 * start + 4.0 * end - after) * t2
        + (3.0 * start - before - 3.0 * end + after) * t3)
}

/// 0 below `low`, 1 above `high`, smooth between. If `low` > `high`, it falls: 1 below `high`, 0 above `low`.
pub fn smoothstep(low: f64, high: f64, value: f64) -> f64 {
    let t = ((value - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// A smooth bump of height 1 and half-width `width` round `centre`, 0 beyond.
pub fn bump(centre: f64, width: f64, value: f64) -> f64 {
    1.0 - smoothstep(0.0, width, (value - centre).abs())
}

/// Value noise in −1..=1. `x` is in turns: `x` and `x + 1` agree. A turn is `cells` cells wide, and a cell is 1 high in
/// `y`.
pub fn noise(x: f64, y: f64, cells: u32, seed: u32) -> f64 {
    let across = x.rem_euclid(1.0) * f64::from(cells);
    let (column, row) = (across.floor(), y.floor());
    let (u, v) = (smoothstep(0.0, 1.0, across - column), smoothstep(0.0, 1.0, y - row));
    let knot = |dx: f64, dy: f64| hash([(column + dx) as u32 % cells, (row + dy) as i32 as u32, seed]);
    let low = knot(0.0, 0.0) * (1.0 - u) + knot(1.0, 0.0) * u;
    let high = knot(0.0, 1.0) * (1.0 - u) + knot(1.0, 1.0) * u;
    low * (1.0 - v) + high * v
}

/// A number in −1..=1 that depends on the three numbers alone.
pub fn hash(numbers: [u32; 3]) -> f64 {
    let mut state = 0x9e37_79b9_u32;
    for number in numbers {
        state = (state ^ number).wrapping_mul(0x85eb_ca6b);
        state = (state ^ state >> 13).wrapping_mul(0xc2b2_ae35);
        state ^= state >> 16;
    }
    f64::from(state) / f64::from(u32::MAX) * 2.0 - 1.0
}
