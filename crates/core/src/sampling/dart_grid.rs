//! Finds the particles (darts) near a place while particles are sampled by dart throwing. A hash grid keeps them sorted
//! by cells, so that a search reads a few short runs of memory.

use std::ops::Range;

use glam::Vec3;

/// An accepted particle, or a candidate for one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dart {
    /// Model space.
    pub(super) position: Vec3,
    /// The face of the surface that it lies on.
    pub(super) face: u32,
    /// Number of the particle or candidate.
    pub(super) number: u32,
}

/// What a search does with the darts that it finds.
pub(super) trait Visitor {
    /// Takes the face and the number of a dart. Returns whether the search ends here.
    fn ends_at(&mut self, face: u32, number: u32) -> bool;
}

/// Where a search looks.
struct Near {
    position: Vec3,
    radius_sq: f32,
    /// Whether the position's own x lies in the first, not the second, of the two cells that are read in each row.
    is_first: bool,
}

/// How many darts are tested together.
const LANES: usize = 8;

/// A search reads two neighbouring cells as one run. A run with more darts than this is crowded, as happens where faces
/// lie on each other.
const CROWDED: usize = 256;

/// Size of a cell in search radii, a little over 2 and 4 because of rounding. A search reads two neighbouring cells
/// along x, in its own row of cells and in the next rows in y and z where they are within reach.
const CELL: Vec3 = Vec3::new(2.02, 4.04, 4.04);

/// Darts by grid cell. Cells are hashed into buckets so that neighbours along x have neighbouring buckets. Distant
/// cells may share a bucket, so a search reads some darts too many, never too few.
pub(super) struct DartGrid {
    /// Along each axis.
    cells_per_unit: Vec3,
    /// Buckets from one row to the next in y: about as many as a row has cells, so that rows are near each other in
    /// memory.
    row_stride: u32,
    /// One less than the number of buckets, a power of two.
    mask: u32,
    /// Index of the first dart of each bucket; last, the number of all darts.
    starts: Vec<u32>,
    /// Positions of the darts, then [`LANES`] that are infinitely far away.
    axes: [Vec<f32>; 3],
    faces: Vec<u32>,
    numbers: Vec<u32>,
}

impl DartGrid {
    /// A grid for searches within `radius`.
    pub(super) fn new(darts: &[Dart], radius: f32) -> Self {
        let buckets = darts.len().next_power_of_two().max(64);
        let cells_per_unit = (CELL * radius).recip();
        let ends = darts.iter().fold((f32::MAX, f32::MIN), |(low, high), dart| {
            (low.min(dart.position.x), high.max(dart.position.x))
        });
        let mut grid = Self {
            cells_per_unit,
            row_stride: ((ends.1 - ends.0) * cells_per_unit.x).clamp(0.0, 4096.0) as u32 | 1,
            mask: (buckets - 1) as u32,
            starts: vec![0; buckets + 1],
            axes: [0, 1, 2].map(|_| vec![f32::INFINITY; darts.len() + LANES]),
            faces: vec![0; darts.len()],
            numbers: vec![0; darts.len()],
        };
        for dart in darts {
            let bucket = grid.bucket(dart.position) as usize;
            grid.starts[bucket] += 1;
        }
        let mut end = 0;
        for start in &mut grid.starts {
            end += *start;
            *start = end;
        }
        // Each bucket is filled from its end, so that `starts` then holds where the buckets begin.
        for dart in darts.iter().rev() {
            let bucket = grid.bucket(dart.position) as usize;
            grid.starts[bucket] -= 1;
            grid.put(grid.starts[bucket] as usize, dart);
        }
        grid
    }

    #[inline]
    fn put(&mut self, at: usize, dart: &Dart) {
        for (axis, value) in self.axes.iter_mut().zip(dart.position.to_array()) {
            axis[at] = value;
        }
        self.faces[at] = dart.face;
        self.numbers[at] = dart.number;
    }

    #[inline(always)]
    fn dart(&self, at: usize) -> Dart {
        let [x, y, z] = &self.axes;
        Dart { position: Vec3::new(x[at], y[at], z[at]), face: self.faces[at], number: self.numbers[at] }
    }

    /// All darts, those of a bucket next to each other.
    pub(super) fn darts(&self) -> Vec<Dart> {
        (0..self.numbers.len()).map(|at| self.dart(at)).collect()
    }

    /// Builds the grid anew, with finer cells or more buckets, if `radius` has become much smaller or the darts many
    /// more.
    pub(super) fn fit(&mut self, radius: f32) {
        if radius * CELL.x * self.cells_per_unit.x < 0.8 || self.numbers.len() > 2 * self.starts.len() {
            *self = Self::new(&self.darts(), radius);
        }
    }

    /// Sorts darts roughly by bucket, so that each search finds in the cache what it reads.
    pub(super) fn in_order(&self, darts: Vec<Dart>) -> Vec<Dart> {
        let Some(&first) = darts.first() else { return darts };
        let buckets = self.mask as usize + 1;
        let groups = (darts.len() / 16).next_power_of_two().min(1 << 16).min(buckets);
        let shift = (buckets / groups).trailing_zeros();
        let keys: Vec<u16> = darts.iter().map(|dart| (self.bucket(dart.position) >> shift) as u16).collect();
        let mut ends = vec![0u32; groups];
        for &key in &keys {
            ends[usize::from(key)] += 1;
        }
        let mut sum = 0;
        for end in &mut ends {
            sum += *end;
            *end = sum;
        }
        let mut sorted = vec![first; darts.len()];
        for (dart, &key) in darts.iter().zip(&keys) {
            let end = &mut ends[usize::from(key)];
            *end -= 1;
            sorted[*end as usize] = *dart;
        }
        sorted
    }

    /// Adds some darts.
    pub(super) fn insert(&mut self, darts: &[Dart]) {
        let key = |(index, dart): (usize, &Dart)| u64::from(self.bucket(dart.position)) << 32 | index as u64;
        let mut order: Vec<u64> = darts.iter().enumerate().map(key).collect();
        order.sort_unstable();
        let mut end = self.numbers.len();
        let count = end + darts.len();
        self.faces.resize(count, 0);
        self.numbers.resize(count, 0);
        for axis in &mut self.axes {
            axis.resize(count + LANES, f32::INFINITY);
            axis[count..].fill(f32::INFINITY);
        }
        // From the last new dart down. Old darts between two new ones move up by the number of new ones before them.
        let mut bucket_end = self.starts.len();
        for (before, &key) in order.iter().enumerate().rev() {
            let (after, index) = ((key >> 32) as usize + 1, key as u32 as usize);
            let at = if after < bucket_end { self.starts[after] as usize } else { end };
            for axis in &mut self.axes {
                axis.copy_within(at..end, at + before + 1);
            }
            self.faces.copy_within(at..end, at + before + 1);
            self.numbers.copy_within(at..end, at + before + 1);
            self.put(at + before, &darts[index]);
            for start in &mut self.starts[after..bucket_end] {
                *start += before as u32 + 1;
            }
            (end, bucket_end) = (at, after);
        }
    }

    /// Visits the darts that are nearer than `radius` to a position, some of them more than once, until the visitor
    /// ends the search. Returns whether it did. `radius` must not exceed that of the grid.
    #[inline(always)]
    pub(super) fn visit_near(&self, position: Vec3, radius: f32, visitor: &mut impl Visitor) -> bool {
        let scaled = position * self.cells_per_unit;
        let [x, y, z] = [floor(scaled.x), floor(scaled.y), floor(scaled.z)];
        let first_x = x.wrapping_sub(i32::from(scaled.x - (x as f32) < 0.5));
        let near = Near { position, radius_sq: radius * radius, is_first: x == first_x };
        let dy = beside(scaled.y - y as f32);
        let dz = beside(scaled.z - z as f32);
        // The position's own row comes first, because most of the near darts are there.
        for row in 0..4 {
            let (has_dy, has_dz) = (row & 1 != 0, row & 2 != 0);
            if has_dy && dy == 0 || has_dz && dz == 0 {
                continue;
            }
            let [y, z] =
                [y.wrapping_add(if has_dy { dy } else { 0 }), z.wrapping_add(if has_dz { dz } else { 0 })];
            if self.visit_row(self.bucket_of([first_x, y, z]) as usize, &near, visitor) {
                return true;
            }
        }
        false
    }

    /// Searches two neighbouring buckets.
    #[inline(always)]
    fn visit_row(&self, bucket: usize, near: &Near, visitor: &mut impl Visitor) -> bool {
        let last = self.mask as usize;
        let run = self.starts[bucket] as usize..self.starts[(bucket + 2).min(last + 1)] as usize;
        if run.len() > CROWDED && !near.is_first {
            // The second bucket holds the position's own x, so it is searched before the whole run: where faces lie on
            // each other, the first bucket may hold half of all darts, none of them near.
            let middle = self.starts[bucket + 1] as usize;
            if self.visit_run(middle..run.end, near, visitor) {
                return true;
            }
        }
        self.visit_run(run, near, visitor)
            || bucket == last && self.visit_run(0..self.starts[1] as usize, near, visitor)
    }

    #[inline(always)]
    fn visit_run(&self, run: Range<usize>, near: &Near, visitor: &mut impl Visitor) -> bool {
        let [xs, ys, zs] = &self.axes;
        let mut from = run.start;
        loop {
            // Tests whole blocks. The last one may reach past the run's end: darts there are tested like all others.
            let (x, y, z) = (&xs[from..][..LANES], &ys[from..][..LANES], &zs[from..][..LANES]);
            let mut distances_sq = [0.0; LANES];
            let mut is_any_near = 0;
            for lane in 0..LANES {
                let off = [x[lane] - near.position.x, y[lane] - near.position.y, z[lane] - near.position.z];
                distances_sq[lane] = off[0] * off[0] + off[1] * off[1] + off[2] * off[2];
                is_any_near |= u32::from(distances_sq[lane] < near.radius_sq);
            }
            if is_any_near != 0 {
                for (distance_sq, at) in distances_sq.into_iter().zip(from..) {
                    if distance_sq < near.radius_sq && visitor.ends_at(self.faces[at], self.numbers[at]) {
                        return true;
                    }
                }
            }
            from += LANES;
            if from >= run.end {
                return false;
            }
        }
    }

    /// The bucket of the cell that holds a position.
    #[inline(always)]
    fn bucket(&self, position: Vec3) -> u32 {
        let scaled = position * self.cells_per_unit;
        self.bucket_of([floor(scaled.x), floor(scaled.y), floor(scaled.z)])
    }

    #[inline(always)]
    fn bucket_of(&self, [x, y, z]: [i32; 3]) -> u32 {
        let row = (y as u32).wrapping_mul(self.row_stride).wrapping_add((z as u32).wrapping_mul(0x9e37_79b1));
        (x as u32).wrapping_add(row) & self.mask
    }
}

/// The floor of a number; `f32::floor` is a function call on x86-64 without SSE4.1, which is the default target.
#[inline(always)]
fn floor(value: f32) -> i32 {
    let toward_zero = value as i32;
    toward_zero.wrapping_sub(i32::from(toward_zero as f32 > value))
}

/// Which row of cells beside a position's own row a search reaches: −1 or 1, or 0 for none. `inside` is how far inside
/// its own row the position is, 0..1.
#[inline(always)]
fn beside(inside: f32) -> i32 {
    if inside < 0.25 { -1 } else { i32::from(inside > 0.75) }
}
