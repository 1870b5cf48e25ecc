//! The points round one cell, copied next to each other, and the nearest of them to a place.

use glam::Vec3;

use super::cells::SortedPoints;
use std::ops::Range;

/// So many candidates are looked at together.
pub(super) const LANES: usize = 16;

/// Distances are sorted into so many classes before they are compared; fewer of them count than fit into a byte.
const CLASSES: usize = 256;

/// More than this are cut down to the nearest before they are sorted.
const MANY: usize = 255;

/// Of what is sorted, and of a block of what stands behind it.
const SLOTS: usize = CLASSES + 64;

/// What one task works in.
pub(super) struct Crowd {
    /// Positions, then normals: x, y, z.
    axes: [Vec<f32>; 6],
    numbers: Vec<u32>,
    /// Bits of the squared distance, then the number: those that count, and the same by class.
    found: Vec<u64>,
    sorted: [u64; SLOTS],
}

impl Default for Crowd {
    fn default() -> Self {
        Self { axes: Default::default(), numbers: Vec::new(), found: Vec::new(), sorted: [0; SLOTS] }
    }
}

/// How those of a block are kept that are near enough.
pub(super) trait Keep {
    /// Writes the bits of each squared distance that is not above `radius_sq`, then its number, one after the other; gives how
    /// many. What stands behind them is of no meaning.
    fn keep(
        distances_sq: &[f32; LANES],
        numbers: &[u32; LANES],
        radius_sq: f32,
        found: &mut [u64; LANES],
    ) -> usize;
}

/// Without a branch that nobody can foresee: each is written, and counted if it is near.
pub(super) struct OneByOne;

impl Keep for OneByOne {
    #[inline(always)]
    fn keep(
        distances_sq: &[f32; LANES],
        numbers: &[u32; LANES],
        radius_sq: f32,
        found: &mut [u64; LANES],
    ) -> usize {
        let mut count = 0;
        for i in 0..LANES {
            found[count % LANES] = u64::from(distances_sq[i].to_bits()) << 32 | u64::from(numbers[i]);
            count += usize::from(distances_sq[i] <= radius_sq);
        }
        count
    }
}

/// Where neighbours are looked for, and which.
#[derive(Clone, Copy)]
pub(super) struct Query {
    pub(super) position: Vec3,
    pub(super) normal: Vec3,
    /// The number of a point that does not count.
    pub(super) own: u32,
    pub(super) radius: f32,
    /// The longest list.
    pub(super) most: usize,
}

impl Crowd {
    /// Takes in some runs of points.
    pub(super) fn gather(&mut self, points: &SortedPoints, runs: &[Range<usize>; 9]) {
        let count: usize = runs.iter().map(Range::len).sum();
        let padded = count.next_multiple_of(LANES);
        for (to, from) in self.axes.iter_mut().zip(&points.axes) {
            to.clear();
            runs.iter().for_each(|run| to.extend_from_slice(&from[run.clone()]));
            to.resize(padded, f32::NAN);
        }
        self.numbers.clear();
        runs.iter().for_each(|run| self.numbers.extend_from_slice(&points.numbers[run.clone()]));
        self.numbers.resize(padded, 0);
        self.found.resize(padded + LANES, 0);
    }

    /// Writes the nearest points, nearest first, equal distances by number; gives how many.
    #[inline(always)]
    pub(super) fn nearest<K: Keep>(&mut self, query: &Query, list: &mut [u32]) -> usize {
        let count = self.collect::<K>(query);
        let mut found = &mut self.found[..count];
        if count > MANY {
            let most = query.most.min(count);
            found.select_nth_unstable(most - 1);
            found = &mut found[..most];
            found.sort_unstable();
        } else {
            sort_by_class(found, &mut self.sorted, query);
            found = &mut self.sorted[..count];
        }
        let most = query.most.min(found.len());
        for (to, from) in list[..most].iter_mut().zip(&found[..most]) {
            *to = *from as u32;
        }
        most
    }

    /// Those within the radius on the same side, in any order; gives how many.
    #[inline(always)]
    fn collect<K: Keep>(&mut self, query: &Query) -> usize {
        let [(xs, _), (ys, _), (zs, _), (us, _), (vs, _), (ws, _)] =
            self.axes.each_ref().map(|axis| axis.as_chunks::<LANES>());
        let (numbers, _) = self.numbers.as_chunks::<LANES>();
        let blocks = xs.iter().zip(ys).zip(zs).zip(us.iter().zip(vs).zip(ws)).zip(numbers);
        let ([qx, qy, qz], [qu, qv, qw]) = (query.position.to_array(), query.normal.to_array());
        let mut end = 0;
        for ((((x, y), z), ((u, v), w)), numbers) in blocks {
            let mut distances_sq = [0.0; LANES];
            for i in 0..LANES {
                let (dx, dy, dz) = (qx - x[i], qy - y[i], qz - z[i]);
                let distance_sq = dx * dx + dy * dy + dz * dz;
                let counts = (qu * u[i] + qv * v[i] + qw * w[i] > 0.0) & (numbers[i] != query.own);
                distances_sq[i] = if counts { distance_sq } else { f32::NAN };
            }
            let Some(found) = self.found[end..].first_chunk_mut() else { break };
            end += K::keep(&distances_sq, numbers, query.radius * query.radius, found);
        }
        end
    }
}

/// Sorts by classes of distances, of which a surface has about equally many in each, and then what little is left; at least as
/// far as the longest list goes.
#[inline(always)]
fn sort_by_class(found: &[u64], sorted: &mut [u64; SLOTS], query: &Query) {
    let classes_per_sq = (CLASSES - 1) as f32 / (query.radius * query.radius);
    let class = |key: u64| {
        let distance_sq = f32::from_bits((key >> 32) as u32);
        // Added to 2^23, a number stands rounded in the lowest bits.
        (distance_sq * classes_per_sq + 8_388_608.0).to_bits() as usize % CLASSES
    };
    let mut ends = [0u8; CLASSES];
    for &key in found {
        ends[class(key)] += 1;
    }
    let mut sum = 0u64;
    for ends in ends.as_chunks_mut::<8>().0 {
        // Sums of eight bytes at once; all of them stay below 256.
        let mut word = u64::from_le_bytes(*ends);
        word += word << 8;
        word += word << 16;
        word += word << 32;
        *ends = (word + sum * 0x0101_0101_0101_0101).to_le_bytes();
        sum += word >> 56;
    }
    for &key in found {
        let end = &mut ends[class(key)];
        *end -= 1;
        sorted[usize::from(*end)] = key;
    }
    let count = found.len();
    let last = if count < query.most { CLASSES } else { class(sorted[query.most - 1]) };
    let end = (query.most..count).find(|&i| class(sorted[i]) > last).unwrap_or(count);
    sort_what_is_left(sorted, end);
}

/// Sorts what is nearly sorted.
#[inline(always)]
fn sort_what_is_left(sorted: &mut [u64; SLOTS], count: usize) {
    for first in (0..count.saturating_sub(1)).step_by(64) {
        // Which are more than the next, found without a branch that nobody can foresee.
        let Some(block) = sorted[first..].first_chunk::<65>() else { break };
        let mut falls = 0u64;
        for bit in 0..64 {
            falls |= u64::from(block[bit] > block[bit + 1]) << bit;
        }
        falls &= u64::MAX >> (64 - (count - first - 1).min(64));
        while falls != 0 {
            let mut i = first + falls.trailing_zeros() as usize + 1;
            falls &= falls - 1;
            // What comes next may be less than what then stands here.
            while i < count && sorted[i - 1] > sorted[i] {
                let (key, mut at) = (sorted[i], i);
                while at > 0 && sorted[at - 1] > key {
                    sorted[at] = sorted[at - 1];
                    at -= 1;
                }
                sorted[at] = key;
                i += 1;
            }
        }
    }
}
