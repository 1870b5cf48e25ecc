//! Sorts points by the cell of a grid, so that all points near a cell lie in nine runs of memory and are found quickly.

use std::ops::Range;

use glam::Vec3;
use rayon::prelude::*;

use super::Points;

/// The grid. Cells are at least as wide as the search radius. They are numbered with x fastest, then y, then z. Every
/// cell that holds a point has neighbours on all sides.
#[derive(Clone, Copy, Debug)]
pub(super) struct CellSpace {
    low: [f64; 3],
    cells_per_unit: f64,
    /// How many cells there are along x, y and z.
    cells: [u64; 3],
}

impl CellSpace {
    /// A grid round all finite positions. A position outside the grid is put into the nearest cell of the border. A
    /// search from there still finds every point within the radius.
    pub(super) fn new(positions: &[Vec3], radius: f32) -> Self {
        let none = (Vec3::splat(f32::MAX), Vec3::splat(f32::MIN));
        let joined = |a: (Vec3, Vec3), b: (Vec3, Vec3)| (a.0.min(b.0), a.1.max(b.1));
        let finite = positions.par_iter().filter(|position| position.is_finite());
        let (low, high) = finite.map(|&position| (position, position)).reduce(|| none, joined);
        let extent = (high.as_dvec3() - low.as_dvec3()).max(glam::DVec3::ZERO).to_array();
        // A little wider than needed, because of rounding, and so wide that cell numbers fit into 64 bits.
        let mut width = f64::from(radius.max(f32::MIN_POSITIVE)) * 1.00001;
        let cells = loop {
            let cells = extent.map(|extent| (extent / width).floor() + 3.0);
            if cells[0] * cells[1] * cells[2] < 9e18 {
                break cells.map(|cells| cells as u64);
            }
            width *= 2.0;
        };
        Self { low: low.as_dvec3().to_array(), cells_per_unit: 1.0 / width, cells }
    }

    #[inline]
    fn number(&self, position: Vec3) -> u64 {
        let position = position.as_dvec3().to_array();
        let [x, y, z] = [0, 1, 2].map(|axis| {
            // `as` and `min` keep any position in range, even NaN.
            let cell = ((position[axis] - self.low[axis]) * self.cells_per_unit) as u64;
            cell.min(self.cells[axis] - 3) + 1
        });
        (z * self.cells[1] + y) * self.cells[0] + x
    }

    /// The first cell of each of the nine rows of three cells round a cell.
    fn rows(&self, cell: u64) -> [u64; 9] {
        let [row, layer] = [self.cells[0], self.cells[0] * self.cells[1]];
        let corner = cell - layer - row - 1;
        std::array::from_fn(|at| corner + at as u64 / 3 * layer + at as u64 % 3 * row)
    }
}

/// Points in the order of their cells, one array per component.
#[derive(Clone, Debug)]
pub(super) struct SortedPoints {
    cells: Vec<u64>,
    /// Positions, then normals: x, y, z.
    pub(super) axes: [Vec<f32>; 6],
    /// The number of each point before sorting.
    pub(super) numbers: Vec<u32>,
}

impl SortedPoints {
    pub(super) fn new(points: Points<'_>, space: &CellSpace) -> Self {
        let positions = points.positions.par_iter().with_min_len(4096);
        let mut sorted: Vec<(u64, u32)> = positions
            .enumerate()
            .map(|(number, position)| (space.number(*position), number as u32))
            .collect();
        sorted.par_sort_unstable();
        // Positions and normals are gathered once, not once per axis, because every access to a point is a cache miss.
        let numbers = sorted.par_iter().with_min_len(4096);
        let gathered: Vec<[Vec3; 2]> = numbers
            .map(|&(_, number)| [points.positions[number as usize], points.normals[number as usize]])
            .collect();
        let axis = |vector: usize, axis: usize| {
            let gathered = gathered.par_iter().with_min_len(4096);
            gathered.map(|vectors| vectors[vector].to_array()[axis]).collect()
        };
        Self {
            axes: [axis(0, 0), axis(0, 1), axis(0, 2), axis(1, 0), axis(1, 1), axis(1, 2)],
            numbers: sorted.iter().map(|&(_, number)| number).collect(),
            cells: sorted.into_iter().map(|(cell, _)| cell).collect(),
        }
    }

    /// Splits a part of the points by cell: for each cell, its number and the range of its points.
    pub(super) fn by_cell(&self, part: Range<usize>) -> impl Iterator<Item = (u64, Range<usize>)> {
        let first = part.start;
        let mut from = first;
        self.cells[part].chunk_by(|a, b| a == b).map(move |cells| {
            let run = from..from + cells.len();
            from = run.end;
            (cells[0], run)
        })
    }
}

/// Finds the points round one cell after the other; cell numbers must not decrease.
pub(super) struct RowCursor<'a> {
    points: &'a SortedPoints,
    space: &'a CellSpace,
    /// In each of the nine rows, the first point that may still be needed; `None` before the first cell.
    at: Option<[usize; 9]>,
}

impl<'a> RowCursor<'a> {
    pub(super) fn new(points: &'a SortedPoints, space: &'a CellSpace) -> Self {
        Self { points, space, at: None }
    }

    /// The points of the three by three by three cells round a cell.
    pub(super) fn runs_round(&mut self, cell: u64) -> [Range<usize>; 9] {
        let cells = &self.points.cells;
        let rows = self.space.rows(cell);
        let at = self.at.get_or_insert_with(|| rows.map(|row| cells.partition_point(|&cell| cell < row)));
        std::array::from_fn(|index| {
            let row = rows[index];
            let steps =
                |from: usize, below: u64| cells[from..].iter().take_while(|&&cell| cell < below).count();
            at[index] += steps(at[index], row);
            at[index]..at[index] + steps(at[index], row + 3)
        })
    }
}
