//! Value noise over a mark, from a table of random values that is filled once.

use crate::hash;
use crate::presence::smoothstep;

/// Value noise, 0..1, on a grid of random values over a mark. `u` runs along the mark and `across` over its width, both
/// from −[`MARGIN`] to 1 + [`MARGIN`].
pub(super) struct Lattice {
    columns: usize,
    cycles: [f32; 2],
    values: Vec<f32>,
}

/// A place along one axis: two neighbouring lattice lines and the smoothed weight of the second.
#[derive(Clone, Copy)]
pub(super) struct Between {
    first: usize,
    share: f32,
}

impl Between {
    fn of(at: f32, lines: usize) -> Self {
        let first = (at as usize).min(lines - 2);
        Self { first, share: smoothstep(at - first as f32) }
    }
}

/// Marks are evaluated a little beyond their edges, so the noise goes on at least this far outside 0..1. Farther out
/// it is constant.
const MARGIN: f32 = 0.25;

impl Lattice {
    /// `cycles`: how many grid cells the unit square has along u and across.
    pub(super) fn new(seed: u32, cycles: [f32; 2]) -> Self {
        let [columns, rows] = cycles.map(|cycles| (cycles * (1.0 + 2.0 * MARGIN)).ceil() as usize + 2);
        let values = (0..columns * rows).map(|index| hash::unit(hash::combine(seed, index as u32))).collect();
        Self { columns, cycles, values }
    }

    /// Noise of one dimension, to be read with [`Lattice::along`].
    pub(super) fn line(seed: u32, cycles: f32) -> Self {
        Self::new(seed, [cycles, 0.0])
    }

    pub(super) fn at(&self, u: f32, across: f32) -> f32 {
        self.between(self.column(u), self.row(across))
    }

    /// The two lattice columns on either side of `u`. Texels with the same `u` can share the result.
    pub(super) fn column(&self, u: f32) -> Between {
        Between::of((u + MARGIN).max(0.0) * self.cycles[0], self.columns)
    }

    pub(super) fn row(&self, across: f32) -> Between {
        Between::of((across + MARGIN).max(0.0) * self.cycles[1], self.values.len() / self.columns)
    }

    /// Noise where a column and a row cross.
    pub(super) fn between(&self, column: Between, row: Between) -> f32 {
        let first = row.first * self.columns + column.first;
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let low = mix(self.values[first], self.values[first + 1], column.share);
        let above = first + self.columns;
        let high = mix(self.values[above], self.values[above + 1], column.share);
        mix(low, high, row.share)
    }

    pub(super) fn along(&self, t: f32) -> f32 {
        self.at(t, 0.0)
    }
}
