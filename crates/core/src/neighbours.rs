//! Finds, for points of a surface, the nearest others within a radius on the same side of the surface. The solvers
//! `Horn` and `HornExact` need these lists, and so does the direction field.

mod cells;
mod crowd;
mod wide;

use cells::{CellSpace, RowCursor, SortedPoints};
use crowd::{Crowd, PackNear, Query};
use glam::Vec3;
use rayon::prelude::*;

/// How many neighbours a list holds at most, as in the source paper.
pub const MAX_NEIGHBOURS: usize = 50;

/// Points of a surface with their unit normals, in model space.
#[derive(Clone, Copy, Debug)]
pub struct Points<'a> {
    /// Positions.
    pub positions: &'a [Vec3],
    /// The unit normal at each position.
    pub normals: &'a [Vec3],
}

/// For each particle the indices of its neighbours, nearest first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Neighbours {
    /// For each particle the slot of its list. Lists are stored in the order of the particles' grid cells.
    slots: Vec<u32>,
    /// Length of each list, by slot.
    lengths: Vec<u8>,
    /// How many indices are reserved for each list: those of slot `s` begin at `s * most`.
    most: usize,
    indices: Vec<u32>,
}

/// Lists of neighbours as plain arrays, in which form they are stored.
#[derive(Clone, Copy, Debug)]
pub struct NeighbourArrays<'a> {
    /// For each particle the slot of its list.
    pub slots: &'a [u32],
    /// Length of each list, by slot.
    pub lengths: &'a [u8],
    /// `most` indices for each slot. Those beyond the length of the slot's list mean nothing.
    pub indices: &'a [u32],
    /// How many indices are reserved for each list.
    pub most: usize,
}

/// How many lists one task finds.
const CHUNK: usize = 1024;

impl Neighbours {
    /// How many particles have a list.
    pub fn len(&self) -> usize {
        self.slots.len()
    }

    /// Whether there are no lists.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The neighbours of one particle, nearest first; those at equal distances by index. The particle itself is never
    /// among them.
    #[inline]
    pub fn of(&self, particle: usize) -> &[u32] {
        let slot = self.slots[particle] as usize;
        &self.indices[slot * self.most..][..usize::from(self.lengths[slot])]
    }

    /// As plain arrays.
    pub fn arrays(&self) -> NeighbourArrays<'_> {
        let Self { slots, lengths, most, indices } = self;
        NeighbourArrays { slots, lengths, indices, most: *most }
    }

    /// The lists that [`Neighbours::find`] found, from their [`Neighbours::arrays`]; `None` where lengths do not match
    /// or a number is out of range.
    pub fn from_arrays(slots: Vec<u32>, lengths: Vec<u8>, indices: Vec<u32>, most: usize) -> Option<Self> {
        let count = slots.len();
        let is_inside = |number: &u32| (*number as usize) < count;
        let fits = lengths.len() == count
            && most <= MAX_NEIGHBOURS
            && indices.len() == count * most
            && lengths.iter().all(|&length| usize::from(length) <= most)
            && slots.iter().chain(&indices).all(is_inside);
        fits.then_some(Self { slots, lengths, most, indices })
    }

    /// Finds, for each particle, the [`MAX_NEIGHBOURS`] nearest others of the same body within `radius` (model units,
    /// inclusive) whose normals lie in the same half space (n·n' > 0). The lists are exact, and the same on every
    /// machine.
    pub fn find(positions: &[Vec3], normals: &[Vec3], radius: f32) -> Self {
        Self::found_among_themselves(Points { positions, normals }, radius, wide::run)
    }

    /// As [`Neighbours::find`], with one of the builds of the search (portable or vector code).
    fn found_among_themselves(
        points: Points<'_>,
        radius: f32,
        run: impl Fn(&Search<'_>, Part<'_>) + Sync,
    ) -> Self {
        let PointIndex { space, points, radius } = PointIndex::new(points, radius);
        let search = Search { queries: &points, others: None, space: &space, radius, most: MAX_NEIGHBOURS };
        Self::found(&search, run)
    }

    fn found(search: &Search<'_>, run: impl Fn(&Search<'_>, Part<'_>) + Sync) -> Self {
        let Search { queries, most, .. } = *search;
        let count = queries.numbers.len();
        let mut lengths = vec![0; count];
        // Zeroed pages that no list fills are never touched, so they take no memory.
        let mut indices = vec![0; count * most];
        let parts =
            lengths.par_chunks_mut(CHUNK).zip(indices.par_chunks_mut((CHUNK * most).max(1))).enumerate();
        parts.for_each(|(chunk, (lengths, indices))| {
            run(search, Part { first: chunk * CHUNK, lengths, indices })
        });
        let mut slots = vec![0; count];
        for (&number, slot) in queries.numbers.iter().zip(0..) {
            slots[number as usize] = slot;
        }
        Self { slots, lengths, most, indices }
    }
}

/// Points of a surface, ready for searches among them.
#[derive(Clone, Debug)]
pub struct PointIndex {
    points: SortedPoints,
    space: CellSpace,
    radius: f32,
}

impl PointIndex {
    /// Sorts the points for searches within `radius`, model units.
    pub fn new(points: Points<'_>, radius: f32) -> Self {
        // A negative radius becomes NaN, so that no distance is within it.
        let radius = if radius >= 0.0 { radius } else { f32::NAN };
        let space = CellSpace::new(points.positions, radius);
        Self { points: SortedPoints::new(points, &space), space, radius }
    }

    /// Finds, for each of `queries`, the `most` (at most [`MAX_NEIGHBOURS`]) nearest of the points within the radius on
    /// the same side of the surface.
    pub fn nearest(&self, queries: Points<'_>, most: usize) -> Neighbours {
        let Self { points, space, radius } = self;
        let queries = SortedPoints::new(queries, space);
        let most = most.min(MAX_NEIGHBOURS);
        let search = Search { queries: &queries, others: Some(points), space, radius: *radius, most };
        Neighbours::found(&search, wide::run)
    }
}

struct Search<'a> {
    queries: &'a SortedPoints,
    /// The points among which neighbours are searched; `None` for the queries themselves.
    others: Option<&'a SortedPoints>,
    space: &'a CellSpace,
    radius: f32,
    most: usize,
}

/// Some of the lists, in the order of the queries' cells.
struct Part<'a> {
    first: usize,
    lengths: &'a mut [u8],
    indices: &'a mut [u32],
}

impl Search<'_> {
    #[inline(always)]
    fn run<P: PackNear>(&self, part: Part<'_>) {
        if self.most == 0 {
            return;
        }
        let Part { first, lengths, indices } = part;
        let points = self.others.unwrap_or(self.queries);
        let (mut crowd, mut cursor) = (Crowd::default(), RowCursor::new(points, self.space));
        for (cell, run) in self.queries.by_cell(first..first + lengths.len()) {
            crowd.gather(points, &cursor.runs_round(cell));
            for query in run {
                let [x, y, z, nx, ny, nz] = self.queries.axes.each_ref().map(|axis| axis[query]);
                let asked = Query {
                    position: Vec3::new(x, y, z),
                    normal: Vec3::new(nx, ny, nz),
                    own: if self.others.is_none() { self.queries.numbers[query] } else { u32::MAX },
                    radius: self.radius,
                    most: self.most,
                };
                let list = &mut indices[(query - first) * self.most..][..self.most];
                lengths[query - first] = crowd.nearest::<P>(&asked, list) as u8;
            }
        }
    }
}

/// The radius in which a particle has about [`MAX_NEIGHBOURS`] neighbours on a flat surface: √(50 A / (π N)).
pub fn full_list_radius(area: f64, count: usize) -> f64 {
    (MAX_NEIGHBOURS as f64 * area / (std::f64::consts::PI * count.max(1) as f64)).sqrt()
}

#[cfg(test)]
mod tests;
