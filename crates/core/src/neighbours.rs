//! The nearest particles within a radius, on the same side of the surface: for `horn`, `horn-exact` and the direction field.

use glam::Vec3;
use rayon::prelude::*;

/// The source paper's longest list.
pub const MAX_NEIGHBOURS: usize = 50;

/// Points of a surface with their unit normals, in model space.
#[derive(Clone, Copy, Debug)]
pub struct Points<'a> {
    /// Positions.
    pub positions: &'a [Vec3],
    /// As many unit normals.
    pub normals: &'a [Vec3],
}

/// For each particle the indices of its neighbours, nearest first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Neighbours {
    starts: Vec<u32>,
    indices: Vec<u32>,
}

impl Neighbours {
    /// How many particles have a list.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Whether none has.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The neighbours of one particle, nearest first; equal distances by index. Never itself.
    pub fn of(&self, particle: usize) -> &[u32] {
        &self.indices[self.starts[particle] as usize..self.starts[particle + 1] as usize]
    }

    /// Finds, for each particle, the [`MAX_NEIGHBOURS`] nearest others of the same body within `radius` (model units,
    /// inclusive) whose normals lie in the same half space (n·n' > 0).
    pub fn find(positions: &[Vec3], normals: &[Vec3], radius: f32) -> Self {
        let points = Points { positions, normals };
        Self::search(points, points, (radius, MAX_NEIGHBOURS), |particle, other| particle != other)
    }

    /// Finds, for each of `queries`, the `most` nearest of `points` within `radius` on the same side of the surface.
    pub fn find_among(queries: Points<'_>, points: Points<'_>, radius: f32, most: usize) -> Self {
        Self::search(queries, points, (radius, most), |_, _| true)
    }

    fn search(
        queries: Points<'_>,
        points: Points<'_>,
        (radius, most): (f32, usize),
        counts: impl Fn(usize, usize) -> bool + Sync,
    ) -> Self {
        let grid = CellGrid::new(points.positions, radius);
        let lists: Vec<Vec<u32>> = (0..queries.positions.len())
            .into_par_iter()
            .with_min_len(256)
            .map_init(Vec::new, |found, query| {
                found.clear();
                let (position, normal) = (queries.positions[query], queries.normals[query]);
                grid.for_each_near(position, |other| {
                    let distance_sq = position.distance_squared(points.positions[other as usize]);
                    let same_side = normal.dot(points.normals[other as usize]) > 0.0;
                    if distance_sq <= radius * radius && same_side && counts(query, other as usize) {
                        found.push((distance_sq, other));
                    }
                });
                let nearer = |a: &(f32, u32), b: &(f32, u32)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
                if found.len() > most {
                    found.select_nth_unstable_by(most, nearer);
                    found.truncate(most);
                }
                found.sort_unstable_by(nearer);
                found.iter().map(|&(_, index)| index).collect()
            })
            .collect();
        let mut starts = Vec::with_capacity(lists.len() + 1);
        let mut indices = Vec::with_capacity(lists.iter().map(Vec::len).sum());
        starts.push(0);
        for list in lists {
            indices.extend(list);
            starts.push(indices.len() as u32);
        }
        Self { starts, indices }
    }
}

/// The radius in which a particle has about [`MAX_NEIGHBOURS`] neighbours on a flat surface: √(50 A / (π N)).
pub fn full_list_radius(area: f64, count: usize) -> f64 {
    (MAX_NEIGHBOURS as f64 * area / (std::f64::consts::PI * count.max(1) as f64)).sqrt()
}

/// Particles sorted by grid cell; a cell is as wide as the search radius.
struct CellGrid {
    cell: f32,
    /// Sorted by cell.
    keys: Vec<([i32; 3], u32)>,
}

impl CellGrid {
    fn new(positions: &[Vec3], radius: f32) -> Self {
        let cell = radius.max(f32::MIN_POSITIVE);
        let mut keys: Vec<([i32; 3], u32)> = positions
            .par_iter()
            .enumerate()
            .map(|(index, position)| (Self::cell_of(*position, cell), index as u32))
            .collect();
        keys.par_sort_unstable();
        Self { cell, keys }
    }

    fn cell_of(position: Vec3, cell: f32) -> [i32; 3] {
        (position / cell).floor().as_ivec3().to_array()
    }

    fn for_each_near(&self, position: Vec3, mut visit: impl FnMut(u32)) {
        let [x, y, z] = Self::cell_of(position, self.cell);
        for x in x.saturating_sub(1)..=x.saturating_add(1) {
            for y in y.saturating_sub(1)..=y.saturating_add(1) {
                // Cells that differ in z alone are neighbours in the sorted list.
                let (low, high) = ([x, y, z.saturating_sub(1)], [x, y, z.saturating_add(1)]);
                let from = self.keys.partition_point(|&(key, _)| key < low);
                for &(key, index) in &self.keys[from..] {
                    if key > high {
                        break;
                    }
                    visit(index);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hash;

    #[test]
    fn lists_equal_brute_force() {
        let scatter = |index: u32, axis: u32| hash::unit(hash::combine(index, axis)) * 2.0 - 1.0;
        let positions: Vec<Vec3> = (0..1500)
            .map(|index| Vec3::new(scatter(index, 0), scatter(index, 1), 0.1 * scatter(index, 2)))
            .collect();
        let normals: Vec<Vec3> =
            positions.iter().map(|p| Vec3::new(0.2, 0.1, p.z.signum()).normalize()).collect();
        for radius in [0.02, 0.15, 0.7, 9.0] {
            let found = Neighbours::find(&positions, &normals, radius);
            for particle in 0..positions.len() {
                let mut expected: Vec<(f32, u32)> = Vec::new();
                for other in 0..positions.len() {
                    let distance = positions[particle].distance_squared(positions[other]);
                    if other != particle
                        && distance <= radius * radius
                        && normals[particle].dot(normals[other]) > 0.0
                    {
                        expected.push((distance, other as u32));
                    }
                }
                expected.sort_by(|a, b| a.partial_cmp(b).unwrap());
                expected.truncate(50);
                let expected: Vec<u32> = expected.into_iter().map(|(_, index)| index).collect();
                assert_eq!(found.of(particle), expected, "particle {particle}, radius {radius}");
            }
        }
    }
}
