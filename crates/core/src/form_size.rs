//! How large a surface's form is at each place: how far one can go from there before the surface turns away.

use glam::Vec3;
use rayon::prelude::*;

use crate::hash;
use crate::sampling::{self, Surface, hexagonal_spacing};
use crate::wide::{Wide, widest};

/// At most this many samples measure a surface, since all pairs of them are compared.
const MOST_SAMPLES: usize = 2048;

/// The cosine of 25 degrees: samples whose normals differ by more do not lie on the same form.
const LEAST_COSINE: f32 = 0.906;

/// A sample on the same form as a point is also near the point's tangent plane: it lies off the plane by at most this
/// share of its distance from the point. If two points of a ball have normals that differ by 25 degrees, each lies off
/// the other's tangent plane by about as much. So the form of an eye ends at its lids, although the cheek faces the
/// same way.
const MOST_RISE: f32 = 0.22;

/// The form ends at the radius at which it fills only this share of the disc with that radius; a right-angled corner of
/// a plane fills 0.25.
const LEAST_SHARE: f32 = 0.2;

/// The first radius that is tried, in spacings of the samples: within a smaller one there are too few samples.
const FIRST_RADIUS: f32 = 2.5;

/// How many radii are tried. Divided by the square of the first, their squares are 1, 1.5, 2, 3, 4, 6, 8 and so on: all
/// numbers from 1 on that a float holds in its exponent and the first bit of its mantissa.
const RADII: usize = 24;

/// The sizes are smoothed over samples within this radius, in spacings: 26 of them on a plane.
const SMOOTHING_RADIUS: f32 = 2.7;

/// If more samples than this would lie within the smoothing radius on average, as where many sheets lie close
/// together, the radius is made smaller. So a size is found as quickly in a heap of triangles as on a plane.
const MOST_NEIGHBOURS: usize = 128;

/// The radius with [`MOST_NEIGHBOURS`] is found from the neighbours of at most this many samples.
const ASKED: usize = 64;

/// The size of the form all over a surface, measured at samples of it.
///
/// The samples that lie within a radius R of a point, on the same form as the point, cover a share of the disc of that
/// radius. On a plane they cover all of it; once R passes the end of the form, the share falls. The size is the R at
/// which they cover a fifth of the disc: 3.2 widths of a flat strip, the radius of a sphere, 2.8 radii of a long
/// cylinder. The two sides of a plate are measured separately, so a thin plate is as large as it looks.
#[derive(Clone, Debug, Default)]
pub struct FormSize {
    /// The samples, in the order of their buckets.
    blocks: Vec<Block>,
    /// Where the blocks of each bucket begin; last, the number of all blocks. A bucket holds the samples in all those
    /// cells of a grid whose hash is the bucket's index.
    starts: Vec<u32>,
    smoothing_radius: f32,
    least: f32,
}

#[derive(Clone, Copy, Debug)]
struct Sample {
    position: Vec3,
    normal: Vec3,
    /// ln of the size, model units.
    size_ln: f32,
}

/// How many samples a block holds.
const LANES: usize = 16;

/// Samples of a bucket side by side, so that they are weighed in wide registers.
#[derive(Clone, Copy, Debug)]
struct Block {
    /// By axis and sample. Lanes without a sample, in the last block of a bucket, lie infinitely far away, so that they
    /// have no weight.
    positions: [[f32; LANES]; 3],
    normals: [[f32; LANES]; 3],
    sizes_ln: [f32; LANES],
}

/// The samples' positions and normals, an array for each axis, so that pairs are compared in wide registers.
struct Axes([Vec<f32>; 6]);

impl FormSize {
    /// Measures a surface. The same surface and seed give the same result.
    pub fn of(surface: &Surface<'_>, seed: u32) -> Self {
        let points = sampling::samples(surface, MOST_SAMPLES, seed);
        let spacing = hexagonal_spacing(surface.area(), points.len().max(1)) as f32;
        if points.is_empty() || !(spacing.is_finite() && spacing > 0.0) {
            return Self::default();
        }
        let density = (points.len() as f64 / surface.area()) as f32;
        let axes = Axes::new(&points);
        let mut samples: Vec<Sample> = points
            .par_iter()
            .map_init(
                || vec![0.0; points.len()],
                |beyond, point| {
                    let (position, normal) = (point.position, point.normal);
                    axes.distances_over_form(position, normal, FIRST_RADIUS * spacing, beyond);
                    Sample {
                        position,
                        normal,
                        size_ln: size_ln_from(beyond, FIRST_RADIUS * spacing, density),
                    }
                },
            )
            .collect();
        let smoothing_radius = (SMOOTHING_RADIUS * spacing).min(radius_of_neighbours(&samples));
        let rough = Self::of_samples(&samples, smoothing_radius);
        let smooth: Vec<f32> =
            samples.par_iter().map(|sample| rough.at(sample.position, sample.normal).ln()).collect();
        for (sample, smooth) in samples.iter_mut().zip(smooth) {
            sample.size_ln = smooth;
        }
        let least_ln = samples.iter().fold(f32::INFINITY, |least, sample| least.min(sample.size_ln));
        Self { least: least_ln.exp(), ..Self::of_samples(&samples, smoothing_radius) }
    }

    fn of_samples(samples: &[Sample], smoothing_radius: f32) -> Self {
        let buckets = samples.len().next_power_of_two();
        let mut in_bucket = vec![Vec::new(); buckets];
        for sample in samples {
            in_bucket[bucket_of(cell_of(sample.position, smoothing_radius), buckets)].push(*sample);
        }
        let mut field = Self { smoothing_radius, starts: vec![0], ..Self::default() };
        for samples in in_bucket {
            field.blocks.extend(samples.chunks(LANES).map(Block::of));
            field.starts.push(field.blocks.len() as u32);
        }
        field
    }

    /// The size of the form at a point of the surface with this unit normal, model units; infinite on a surface without
    /// area.
    pub fn at(&self, position: Vec3, normal: Vec3) -> f32 {
        if self.starts.is_empty() {
            return f32::INFINITY;
        }
        let [sum, weights] = widest(Weighing { form: self, position, normal });
        // A shell too small to have a sample gets the least size.
        if weights > 0.0 { (sum / weights).exp() } else { self.least }
    }

    /// The least size anywhere, model units.
    pub fn least(&self) -> f32 {
        if self.starts.is_empty() { f32::INFINITY } else { self.least }
    }

    /// The buckets of the 2 × 2 × 2 cells that hold all samples within the smoothing radius. No bucket comes twice.
    #[inline(always)]
    fn buckets_round(&self, position: Vec3) -> impl Iterator<Item = usize> {
        let buckets = self.starts.len() - 1;
        let corner = cell_of(position - 0.5 * CELL * self.smoothing_radius, self.smoothing_radius);
        let all: [usize; 8] = std::array::from_fn(|index| {
            let cell = std::array::from_fn(|axis| corner[axis].wrapping_add(index as i32 >> axis & 1));
            bucket_of(cell, buckets)
        });
        (0..all.len()).filter(move |&index| !all[..index].contains(&all[index])).map(move |index| all[index])
    }
}

impl Block {
    fn of(samples: &[Sample]) -> Self {
        let mut block = Self {
            positions: [[f32::INFINITY; LANES]; 3],
            normals: [[0.0; LANES]; 3],
            sizes_ln: [0.0; LANES],
        };
        for (lane, sample) in samples.iter().enumerate() {
            for axis in 0..3 {
                block.positions[axis][lane] = sample.position[axis];
                block.normals[axis][lane] = sample.normal[axis];
            }
            // The ln of a size of 0 is −∞, which times a weight of 0 would make the whole sum NaN.
            block.sizes_ln[lane] = sample.size_ln.max(f32::MIN_POSITIVE.ln());
        }
        block
    }
}

/// Weighs the samples round a point. Near ones that face the same way count most.
struct Weighing<'a> {
    form: &'a FormSize,
    position: Vec3,
    normal: Vec3,
}

impl Wide for Weighing<'_> {
    /// The weighted sum of the ln of the sizes, and the sum of the weights.
    type Output = [f32; 2];

    #[inline(always)]
    fn run(self) -> [f32; 2] {
        let Self { form: FormSize { blocks, starts, smoothing_radius, .. }, position, normal } = self;
        let per_radius_sq = 1.0 / (smoothing_radius * smoothing_radius);
        let (mut sums, mut weights) = ([0.0f32; LANES], [0.0f32; LANES]);
        for bucket in self.form.buckets_round(position) {
            for block in &blocks[starts[bucket] as usize..starts[bucket + 1] as usize] {
                let ([xs, ys, zs], [normal_xs, normal_ys, normal_zs]) = (&block.positions, &block.normals);
                for lane in 0..LANES {
                    let [x, y, z] = [xs[lane] - position.x, ys[lane] - position.y, zs[lane] - position.z];
                    let near = (1.0 - (x * x + y * y + z * z) * per_radius_sq).max(0.0);
                    let facing =
                        normal.x * normal_xs[lane] + normal.y * normal_ys[lane] + normal.z * normal_zs[lane];
                    // A sample that faces away hardly counts, unless there is no other.
                    let weight = near * near * near * facing.max(1e-4);
                    sums[lane] += weight * block.sizes_ln[lane];
                    weights[lane] += weight;
                }
            }
        }
        [sums.iter().sum(), weights.iter().sum()]
    }
}

/// The radius within which a sample has about [`MOST_NEIGHBOURS`] others on average; infinite where there are too few
/// samples for that.
fn radius_of_neighbours(samples: &[Sample]) -> f32 {
    let asked: Vec<Vec3> =
        samples.iter().step_by(samples.len().div_ceil(ASKED).max(1)).map(|sample| sample.position).collect();
    let distances_sq =
        |at: &Vec3| samples.iter().map(|sample| sample.position.distance_squared(*at)).collect::<Vec<_>>();
    let mut all: Vec<f32> = asked.iter().flat_map(distances_sq).collect();
    let at = asked.len() * MOST_NEIGHBOURS;
    if at >= all.len() {
        return f32::INFINITY;
    }
    let (_, distance_sq, _) = all.select_nth_unstable_by(at, f32::total_cmp);
    // The distance is 0 where samples lie at one place; then no radius is better than another.
    if *distance_sq > 0.0 { distance_sq.sqrt() } else { f32::INFINITY }
}

impl Axes {
    fn new(points: &[sampling::Particle]) -> Self {
        let axis = |axis: usize| {
            let of = |point: &sampling::Particle| {
                if axis < 3 { point.position.to_array()[axis] } else { point.normal.to_array()[axis - 3] }
            };
            points.iter().map(of).collect()
        };
        Self(std::array::from_fn(axis))
    }

    /// Fills `beyond` with the squared distance to each sample, in squares of `unit`. It is infinite for a sample on
    /// another form.
    fn distances_over_form(&self, at: Vec3, normal: Vec3, unit: f32, beyond: &mut [f32]) {
        let [x, y, z, normal_x, normal_y, normal_z] = self.0.each_ref().map(|axis| &axis[..beyond.len()]);
        let per_unit_sq = 1.0 / (unit * unit);
        for (other, beyond) in beyond.iter_mut().enumerate() {
            let away = Vec3::new(x[other], y[other], z[other]) - at;
            let distance_sq = away.length_squared();
            let rise = normal.dot(away);
            let agreement = normal.dot(Vec3::new(normal_x[other], normal_y[other], normal_z[other]));
            let same = agreement >= LEAST_COSINE && rise * rise <= MOST_RISE * MOST_RISE * distance_sq;
            *beyond = if same { distance_sq * per_unit_sq } else { f32::INFINITY };
        }
    }
}

/// A cell's side, in smoothing radii.
const CELL: f32 = 2.0;

#[inline(always)]
fn cell_of(at: Vec3, smoothing_radius: f32) -> [i32; 3] {
    // A cast saturates, so a far point has a cell too.
    (at / (CELL * smoothing_radius)).floor().to_array().map(|coordinate| coordinate as i32)
}

/// `buckets` is a power of two.
#[inline(always)]
fn bucket_of(cell: [i32; 3], buckets: usize) -> usize {
    let [x, y, z] = cell.map(|coordinate| coordinate as u32);
    hash::combine(hash::combine(x, y), z) as usize & (buckets - 1)
}

/// ln of the size of the form round a sample. `beyond` holds the squared distances to all samples, in squares of the
/// first radius, infinite for samples on other forms; `density` is the number of samples per unit of area.
fn size_ln_from(beyond: &[f32], first_radius: f32, density: f32) -> f32 {
    // How many samples of the form lie between one radius and the next.
    let mut counts = [0u32; RADII];
    let first = 1f32.to_bits() >> 22;
    for &beyond in beyond {
        // The index of the next larger radius: the bits of positive floats sort like their values.
        let step =
            (beyond.max(1.0).to_bits().wrapping_sub(1) >> 22).wrapping_add(1).saturating_sub(first) as usize;
        if step < RADII {
            counts[step] += 1;
        }
    }
    // The previous radius: its ln, and ln(covered area / a fifth of the area of the disc with that radius).
    let mut last: Option<[f32; 2]> = None;
    let mut covered = 0;
    for (step, count) in counts.iter().enumerate() {
        covered += count;
        let radius_sq = first_radius * first_radius * f32::from_bits((first + step as u32) << 22);
        let fill_ln = (covered as f32 / (density * LEAST_SHARE * std::f32::consts::PI * radius_sq)).ln();
        let radius_ln = 0.5 * radius_sq.ln();
        if fill_ln < 0.0 {
            // Interpolates between the previous radius and this one. If even the first radius is too large, the size is
            // the radius of a disc of which the samples found cover a fifth.
            let [last_radius_ln, last_fill_ln] = last.unwrap_or([radius_ln + 0.5 * fill_ln, 0.0]);
            let part = if last.is_some() { last_fill_ln / (last_fill_ln - fill_ln) } else { 0.0 };
            return last_radius_ln + part * (radius_ln - last_radius_ln);
        }
        last = Some([radius_ln, fill_ln]);
    }
    last.map_or(0.0, |[radius_ln, _]| radius_ln)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TriangleMesh;
    use glam::Vec2;

    /// A surface of revolution about y with this radius at each height.
    fn turned(profile: &[(f32, f32)], around: u32) -> TriangleMesh {
        let mut mesh = TriangleMesh::default();
        for &(height, radius) in profile {
            for step in 0..around {
                let turn = Vec2::from_angle(step as f32 / around as f32 * std::f32::consts::TAU);
                mesh.positions.push(Vec3::new(turn.x * radius, height, turn.y * radius));
                mesh.normals.push(Vec3::new(turn.x, 0.0, turn.y));
            }
        }
        for row in 0..profile.len() as u32 - 1 {
            for step in 0..around {
                let at = |row: u32, step: u32| row * around + step % around;
                let [a, b, c, d] =
                    [at(row, step), at(row, step + 1), at(row + 1, step + 1), at(row + 1, step)];
                mesh.triangles.extend([[a, c, b], [a, d, c]]);
            }
        }
        mesh
    }

    fn ball(radius: f32) -> TriangleMesh {
        let mut mesh = turned(&sphere(radius), 96);
        mesh.normals = mesh.positions.iter().map(|at| at.normalize()).collect();
        mesh
    }

    fn sphere(radius: f32) -> Vec<(f32, f32)> {
        (0..=64)
            .map(|step| (step as f32 / 64.0 * std::f32::consts::PI).sin_cos())
            .map(|(sin, cos)| (-cos * radius, sin * radius))
            .collect()
    }

    #[test]
    fn the_size_of_a_ball_and_of_a_rod_are_their_radius_times_a_constant() {
        let mesh = ball(2.0);
        let size = FormSize::of(&Surface::new(&mesh, |_| true), 7);
        for direction in [Vec3::X, Vec3::Y, Vec3::new(0.6, 0.5, -0.62).normalize()] {
            let found = size.at(direction * 2.0, direction);
            assert!((found / 2.0 - 0.97).abs() < 0.08, "{direction}: {found}");
        }
        let rod: Vec<(f32, f32)> = (0..=80).map(|step| (step as f32 * 0.25 - 10.0, 0.5)).collect();
        let mesh = turned(&rod, 48);
        let size = FormSize::of(&Surface::new(&mesh, |_| true), 7);
        let at = |step: i32| {
            let (sin, cos) = (step as f32).sin_cos();
            let outward = Vec3::new(cos, 0.0, sin);
            size.at(outward * 0.5 + Vec3::Y * 0.2 * (step % 40 - 20) as f32, outward)
        };
        let found = (0..200).map(at).sum::<f32>() / 200.0;
        // Normals agree within 25° to either side, on a strip 0.873 radii wide. So 2R·0.873 = 0.2·πR², with R in radii.
        assert!((found / 0.5 / 2.78 - 1.0).abs() < 0.05, "{found}");
    }

    #[test]
    fn a_thin_plate_is_as_large_as_it_looks_and_a_knob_on_it_is_small() {
        let mut mesh = TriangleMesh::default();
        let corner = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
        for z in [0.0, 0.02] {
            mesh.positions.extend([
                corner(-2.0, -2.0, z),
                corner(2.0, -2.0, z),
                corner(2.0, 2.0, z),
                corner(-2.0, 2.0, z),
            ]);
        }
        mesh.normals = (0..8).map(|vertex| if vertex < 4 { Vec3::NEG_Z } else { Vec3::Z }).collect();
        mesh.triangles = vec![[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7]];
        let plate_alone = FormSize::of(&Surface::new(&mesh, |_| true), 7).at(Vec3::Z * 0.02, Vec3::Z);
        assert!(plate_alone > 3.0, "{plate_alone}");
        let knob = ball(0.2);
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(knob.positions.iter().map(|&at| at + Vec3::new(1.0, 1.0, 0.3)));
        mesh.normals.extend(knob.normals);
        mesh.triangles.extend(knob.triangles.iter().map(|corners| corners.map(|vertex| vertex + first)));
        let size = FormSize::of(&Surface::new(&mesh, |_| true), 7);
        let side = Vec3::new(0.7, 0.7, 0.14).normalize();
        let on_knob = size.at(Vec3::new(1.0, 1.0, 0.3) + side * 0.2, side);
        let on_plate = size.at(Vec3::new(-1.0, -1.0, 0.02), Vec3::Z);
        assert!(on_knob < 0.5 && on_plate > 2.5, "knob {on_knob}, plate {on_plate}");
        assert!(size.least() <= on_knob);
    }

    /// A mesh scaled by a factor has sizes scaled by the same factor. A power of two avoids rounding.
    #[test]
    fn sizes_grow_with_the_surface() {
        let [mut large, small] = [ball(2.0), ball(0.25)];
        let first = large.positions.len() as u32;
        large.positions.extend(small.positions.iter().map(|&at| at + Vec3::X * 3.0));
        large.normals.extend(small.normals);
        large.triangles.extend(small.triangles.iter().map(|corners| corners.map(|vertex| vertex + first)));
        let sizes = |scale: f32| {
            let mut mesh = large.clone();
            mesh.positions.iter_mut().for_each(|at| *at *= scale);
            let size = FormSize::of(&Surface::new(&mesh, |_| true), 7);
            let places =
                [(Vec3::ZERO, 2.0, Vec3::Y), (Vec3::ZERO, 2.0, Vec3::NEG_Z), (Vec3::X * 3.0, 0.25, Vec3::Y)];
            places.map(|(middle, radius, out)| size.at((middle + out * radius) * scale, out) / scale)
        };
        let plain = sizes(1.0);
        assert!(plain[0] > 4.0 * plain[2] && plain[1] > 4.0 * plain[2], "{plain:?}");
        for scale in [1.0 / 1024.0, 1024.0] {
            for (found, plain) in sizes(scale).iter().zip(plain) {
                assert!((found / plain - 1.0).abs() < 1e-3, "times {scale}: {found} for {plain}");
            }
        }
    }

    /// In a heap of triangles without order, nearly all samples lie within a few spacings of each other.
    #[test]
    fn in_a_heap_of_triangles_few_samples_are_near() {
        let mut mesh = TriangleMesh::default();
        for triangle in 0..2000u32 {
            for corner in 0..3 {
                let at = |axis: u32| hash::unit(hash::combine(triangle, 3 * corner + axis));
                mesh.positions.push(Vec3::new(at(0), at(1), at(2)));
            }
            let [a, b, c] = [0, 1, 2].map(|corner| mesh.positions[3 * triangle as usize + corner]);
            mesh.normals.extend([(b - a).cross(c - a).normalize(); 3]);
            mesh.triangles.push([0, 1, 2].map(|corner| 3 * triangle + corner));
        }
        let size = FormSize::of(&Surface::new(&mesh, |_| true), 7);
        let radius_sq = size.smoothing_radius * size.smoothing_radius;
        let of_block = |Block { positions: [xs, ys, zs], .. }: &Block| -> [Vec3; LANES] {
            std::array::from_fn(|lane| Vec3::new(xs[lane], ys[lane], zs[lane]))
        };
        let mut places: Vec<Vec3> = size.blocks.iter().flat_map(of_block).collect();
        places.retain(|place| place.is_finite());
        let near = |at: &Vec3| places.iter().filter(|other| other.distance_squared(*at) < radius_sq).count();
        let mean = places.iter().map(near).sum::<usize>() / places.len();
        assert!(places.len() > 2000 && (100..=160).contains(&mean), "{mean} near");
        let found = size.at(mesh.positions[0], mesh.normals[0]);
        assert!((0.001..10.0).contains(&found), "{found}");
    }

    /// The blocks give what a plain sum over all samples gives.
    #[test]
    fn blocks_leave_no_sample_out_and_take_none_twice() {
        let mesh = ball(2.0);
        let size = FormSize::of(&Surface::new(&mesh, |_| true), 7);
        let samples: Vec<Sample> = size
            .blocks
            .iter()
            .flat_map(|block| {
                (0..LANES).map(|lane| Sample {
                    position: Vec3::from_array(block.positions.map(|axis| axis[lane])),
                    normal: Vec3::from_array(block.normals.map(|axis| axis[lane])),
                    size_ln: block.sizes_ln[lane],
                })
            })
            .filter(|sample| sample.position.is_finite())
            .collect();
        assert!(samples.len() > 2000);
        for out in [Vec3::Y, Vec3::new(0.6, 0.5, -0.62).normalize(), Vec3::new(-0.1, -0.9, 0.3).normalize()] {
            let at = out * 2.0;
            let [mut sum, mut weights] = [0.0f64; 2];
            for sample in &samples {
                let near = 1.0
                    - f64::from(at.distance_squared(sample.position))
                        / f64::from(size.smoothing_radius).powi(2);
                let weight = near.max(0.0).powi(3) * f64::from(out.dot(sample.normal)).max(1e-4);
                sum += weight * f64::from(sample.size_ln);
                weights += weight;
            }
            let (found, expected) = (f64::from(size.at(at, out)), (sum / weights).exp());
            assert!((found / expected - 1.0).abs() < 1e-4, "{out}: {found}, not {expected}");
        }
    }

    #[test]
    fn a_surface_without_area_bounds_nothing() {
        let mesh = TriangleMesh {
            positions: vec![Vec3::ZERO; 3],
            normals: vec![Vec3::Y; 3],
            triangles: vec![[0, 1, 2]],
            ..Default::default()
        };
        let size = FormSize::of(&Surface::new(&mesh, |_| true), 7);
        assert!(size.at(Vec3::ZERO, Vec3::Y).is_infinite() && size.least().is_infinite());
    }
}
