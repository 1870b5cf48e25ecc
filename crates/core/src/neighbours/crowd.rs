//! Finds the points nearest to a point of a cell. First the points round the cell are copied next to each other in
//! memory, so that many can be tested together.

use glam::Vec3;

use super::cells::SortedPoints;
use std::ops::Range;

/// How many candidates are tested together.
pub(super) const LANES: usize = 16;

/// Buckets of the counting sort by distance. It sorts at most [`MANY`] candidates, so that its counts fit into bytes.
const BUCKETS: usize = 256;

/// More candidates than this are first reduced to the nearest by selection.
const MANY: usize = 255;

/// Room for all sorted candidates and for a block read past their end.
const SLOTS: usize = BUCKETS + 64;

/// Working memory of one task.
pub(super) struct Crowd {
    /// Positions, then normals: x, y, z.
    axes: [Vec<f32>; 6],
    numbers: Vec<u32>,
    /// Near points as keys: the bits of the squared distance, then the number.
    found: Vec<u64>,
    /// The keys of `found`, sorted.
    sorted: [u64; SLOTS],
}

impl Default for Crowd {
    fn default() -> Self {
        Self { axes: Default::default(), numbers: Vec::new(), found: Vec::new(), sorted: [0; SLOTS] }
    }
}

/// A way to pick the near points of a block and write them without gaps.
pub(super) trait PackNear {
    /// Writes a key (the bits of the squared distance, then the number) for each squared distance up to `radius_sq` and
    /// returns how many. What `found` holds after them has no meaning.
    fn pack(
        distances_sq: &[f32; LANES],
        numbers: &[u32; LANES],
        radius_sq: f32,
        found: &mut [u64; LANES],
    ) -> usize;
}

/// Portable code. To avoid a branch that would often be mispredicted, it writes every key, and writes the next key
/// over one that is not near.
pub(super) struct OneByOne;

impl PackNear for OneByOne {
    #[inline(always)]
    fn pack(
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

#[derive(Clone, Copy)]
pub(super) struct Query {
    pub(super) position: Vec3,
    pub(super) normal: Vec3,
    /// The number of the query point, which does not count; `u32::MAX` if it is not among the points searched.
    pub(super) own: u32,
    pub(super) radius: f32,
    pub(super) most: usize,
}

impl Crowd {
    /// Copies some runs of points, padded to whole blocks.
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

    /// Writes the numbers of the nearest points, nearest first, equal distances by number; returns how many.
    #[inline(always)]
    pub(super) fn nearest<P: PackNear>(&mut self, query: &Query, list: &mut [u32]) -> usize {
        let count = self.collect::<P>(query);
        let mut found = &mut self.found[..count];
        if count > MANY {
            let most = query.most.min(count);
            found.select_nth_unstable(most - 1);
            found = &mut found[..most];
            found.sort_unstable();
        } else {
            sort_by_bucket(found, &mut self.sorted, query);
            found = &mut self.sorted[..count];
        }
        let most = query.most.min(found.len());
        for (to, from) in list[..most].iter_mut().zip(&found[..most]) {
            *to = *from as u32;
        }
        most
    }

    /// Collects the points within the radius on the same side of the surface, in any order; returns how many.
    #[inline(always)]
    fn collect<P: PackNear>(&mut self, query: &Query) -> usize {
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
            end += P::pack(&distances_sq, numbers, query.radius * query.radius, found);
        }
        end
    }
}

/// Sorts at least the nearest `query.most` keys: a counting sort into equal ranges of squared distance (on a surface,
/// each holds about equally many points), then an insertion sort.
#[inline(always)]
fn sort_by_bucket(found: &[u64], sorted: &mut [u64; SLOTS], query: &Query) {
    let buckets_per_sq = (BUCKETS - 1) as f32 / (query.radius * query.radius);
    let bucket = |key: u64| {
        let distance_sq = f32::from_bits((key >> 32) as u32);
        // Rounds: adding 2^23 leaves the nearest whole number in the lowest bits.
        (distance_sq * buckets_per_sq + 8_388_608.0).to_bits() as usize % BUCKETS
    };
    let mut ends = [0u8; BUCKETS];
    for &key in found {
        ends[bucket(key)] += 1;
    }
    let mut sum = 0u64;
    for ends in ends.as_chunks_mut::<8>().0 {
        // Running sums of eight bytes at once; no sum exceeds 255.
        let mut word = u64::from_le_bytes(*ends);
        word += word << 8;
        word += word << 16;
        word += word << 32;
        *ends = (word + sum * 0x0101_0101_0101_0101).to_le_bytes();
        sum += word >> 56;
    }
    for &key in found {
        let end = &mut ends[bucket(key)];
        *end -= 1;
        sorted[usize::from(*end)] = key;
    }
    let count = found.len();
    let last = if count < query.most { BUCKETS } else { bucket(sorted[query.most - 1]) };
    let end = (query.most..count).find(|&i| bucket(sorted[i]) > last).unwrap_or(count);
    sort_nearly_sorted(sorted, end);
}

/// Insertion sort of nearly sorted keys.
#[inline(always)]
fn sort_nearly_sorted(sorted: &mut [u64; SLOTS], count: usize) {
    for first in (0..count.saturating_sub(1)).step_by(64) {
        // A bit for each key that is greater than the next, found without branches.
        let Some(block) = sorted[first..].first_chunk::<65>() else { break };
        let mut falls = 0u64;
        for bit in 0..64 {
            falls |= u64::from(block[bit] > block[bit + 1]) << bit;
        }
        falls &= u64::MAX >> (64 - (count - first - 1).min(64));
        while falls != 0 {
            let mut i = first + falls.trailing_zeros() as usize + 1;
            falls &= falls - 1;
            // After a key has moved down, the next one may be out of order too.
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
