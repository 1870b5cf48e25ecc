//! Value noise over a mark, from tables that are filled once.

use crate::hash;
use crate::presence::smoothstep;

/// Value noise, 0..1, over u and across in about −0.2..1.2, at fixed numbers of cycles.
pub(super) struct Lattice {
    columns: usize,
    cycles: [f32; 2],
    values: Vec<f32>,
}

/// Cells before the first one that a mark's own rectangle needs.
const MARGIN: f32 = 0.25;

impl Lattice {
    /// `cycles` along u and across, in the unit square.
    pub(super) fn new(seed: u32, cycles: [f32; 2]) -> Self {
        let [columns, rows] = cycles.map(|cycles| (cycles * (1.0 + 2.0 * MARGIN)).ceil() as usize + 2);
        let values = (0..columns * rows).map(|index| hash::unit(hash::combine(seed, index as u32))).collect();
        Self { columns, cycles, values }
    }

    /// Noise along a line.
    pub(super) fn line(seed: u32, cycles: f32) -> Self {
        Self::new(seed, [cycles, 0.0])
    }

    pub(super) fn at(&self, u: f32, across: f32) -> f32 {
        let x = (u + MARGIN).max(0.0) * self.cycles[0];
        let y = (across + MARGIN).max(0.0) * self.cycles[1];
        let rows = self.values.len() / self.columns;
        let column = (x as usize).min(self.columns - 2);
        let row = (y as usize).min(rows - 2);
        let (fx, fy) = (smoothstep(x - column as f32), smoothstep(y - row as f32));
        let first = row * self.columns + column;
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let low = mix(self.values[first], self.values[first + 1], fx);
        let high = mix(self.values[first + self.columns], self.values[first + self.columns + 1], fx);
        mix(low, high, fy)
    }

    /// Of a line.
    pub(super) fn along(&self, t: f32) -> f32 {
        self.at(t, 0.0)
    }
}
