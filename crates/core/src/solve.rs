//! The arrays that hold particles, and how particles are projected and their strokes turned: all at once for tests and
//! benchmarks, or one by one for pictures.

mod cull;

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::ScreenMap;
use crate::angle::atan2;
use crate::lift::Lift;
use crate::wide::{Wide, widest};

pub(crate) use cull::WORD;
pub use cull::{Bounds, ParticleView, SeenParticle, SolvedParticle};

/// How many particles one task handles.
const CHUNK: usize = 8192;

/// Where particles are, one array per component.
#[derive(Clone, Debug, Default)]
pub struct PlacedParticles {
    /// Position in model space: x, y, z.
    pub position: [Vec<f32>; 3],
    /// Unit normal in model space: x, y, z. For particles that a bent surface has carried, it is not unit: its length
    /// is the area of the surface now over its area at rest.
    pub normal: [Vec<f32>; 3],
}

/// What is baked per particle, one array per component.
#[derive(Clone, Debug, Default)]
pub struct BakedParticles {
    /// Where they are.
    pub placed: PlacedParticles,
    /// First column of N' (see [`Lift`]): x, y, z.
    pub along: [Vec<f32>; 3],
    /// Second column of N': x, y, z.
    pub across: [Vec<f32>; 3],
    /// 1: the stroke turns as the picture round it turns. 0: it points as a line drawn on the surface would,
    /// foreshortening included. Between them it is a blend: see [`solve`]. Empty when all are 1.
    pub flatness: Vec<f32>,
}

/// A run of consecutive particles to be written, one array per component.
#[derive(Debug)]
pub struct ParticleChunk<'a, const ARRAYS: usize> {
    arrays: [&'a mut [f32]; ARRAYS],
}

impl<'a, const ARRAYS: usize> ParticleChunk<'a, ARRAYS> {
    /// Cuts arrays of equal lengths into chunks of `size` particles.
    fn cut(arrays: [&'a mut [f32]; ARRAYS], size: usize) -> Vec<Self> {
        let count = arrays.first().map_or(0, |array| array.len());
        let empty = |_| Self { arrays: std::array::from_fn(|_| Default::default()) };
        let mut chunks: Vec<Self> = (0..count).step_by(size).map(empty).collect();
        for (component, array) in arrays.into_iter().enumerate() {
            for (chunk, slice) in chunks.iter_mut().zip(array.chunks_mut(size)) {
                chunk.arrays[component] = slice;
            }
        }
        chunks
    }

    #[inline(always)]
    fn set_all(&mut self, index: usize, numbers: &[f32]) {
        for (array, number) in self.arrays.iter_mut().zip(numbers) {
            array[index] = *number;
        }
    }
}

impl ParticleChunk<'_, 6> {
    /// Sets a particle of the chunk: position and unit normal in model space.
    #[inline]
    pub fn set(&mut self, index: usize, position: DVec3, normal: DVec3) {
        self.set_all(index, [position, normal].map(|vector| vector.as_vec3().to_array()).as_flattened());
    }
}

impl ParticleChunk<'_, 12> {
    /// Sets a particle of the chunk: position, normal, and both columns of its lift.
    #[inline(always)]
    pub(crate) fn set(&mut self, index: usize, vectors: [Vec3; 4]) {
        self.set_all(index, vectors.map(|vector| vector.to_array()).as_flattened());
    }
}

/// The particles of [`BakedParticles`] in one view, one array per component, in the same order.
#[derive(Clone, Debug, Default)]
pub struct SolvedParticles {
    /// Pixels from the picture's centre to the right.
    pub x_px: Vec<f32>,
    /// Pixels from the picture's centre upwards.
    pub y_px: Vec<f32>,
    /// Distance along the gaze, world units.
    pub depth: Vec<f32>,
    /// Angle of the stroke, counter-clockwise from +X, radians in (−π, π].
    pub angle_rad: Vec<f32>,
    /// Projected area in px² per unit of surface at rest; positive where it faces the eye.
    pub area_px: Vec<f32>,
}

impl PlacedParticles {
    /// Makes room for exactly `count` particles: those beyond are cut off, new ones are zero.
    pub fn resize(&mut self, count: usize) {
        self.arrays_mut().into_iter().for_each(|array| resize(array, count));
    }

    /// The particles from `first` on in chunks of `size`, to be written one by one.
    pub fn chunks_mut(&mut self, first: usize, size: usize) -> Vec<ParticleChunk<'_, 6>> {
        ParticleChunk::cut(self.arrays_mut().map(|array| &mut array[first..]), size)
    }

    fn arrays_mut(&mut self) -> [&mut Vec<f32>; 6] {
        let ([x, y, z], [nx, ny, nz]) = (&mut self.position, &mut self.normal);
        [x, y, z, nx, ny, nz]
    }

    /// How many particles.
    pub fn len(&self) -> usize {
        self.position[0].len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Memory that they need, in bytes.
    pub fn bytes(&self) -> usize {
        6 * self.len() * size_of::<f32>()
    }

    /// A particle's position in model space.
    #[inline]
    pub fn position_of(&self, particle: usize) -> DVec3 {
        vector(&self.position, particle)
    }

    /// A particle's normal in model space. For its length, see [`PlacedParticles::normal`].
    #[inline]
    pub fn normal_of(&self, particle: usize) -> DVec3 {
        vector(&self.normal, particle)
    }

    /// A particle's position and normal, as they are stored.
    #[inline]
    pub fn vectors_of(&self, particle: usize) -> [[f32; 3]; 2] {
        [&self.position, &self.normal].map(|arrays| components(arrays, particle))
    }
}

impl BakedParticles {
    /// Appends one particle.
    pub fn push(&mut self, position: DVec3, normal: DVec3, lift: Lift) {
        for (arrays, value) in [
            (&mut self.placed.position, position),
            (&mut self.placed.normal, normal),
            (&mut self.along, lift.along),
            (&mut self.across, lift.across),
        ] {
            for (array, number) in arrays.iter_mut().zip(value.to_array()) {
                array.push(number as f32);
            }
        }
    }

    /// Makes room for exactly `count` particles: those beyond are cut off, new ones are zero. Flatness is cleared.
    pub fn resize(&mut self, count: usize) {
        self.flatness.clear();
        self.arrays_mut().into_iter().for_each(|array| resize(array, count));
    }

    pub(crate) fn chunks_mut(&mut self, size: usize) -> Vec<ParticleChunk<'_, 12>> {
        ParticleChunk::cut(self.arrays_mut().map(|array| &mut array[..]), size)
    }

    fn arrays_mut(&mut self) -> [&mut Vec<f32>; 12] {
        let [x, y, z, nx, ny, nz] = self.placed.arrays_mut();
        let ([ax, ay, az], [bx, by, bz]) = (&mut self.along, &mut self.across);
        [x, y, z, nx, ny, nz, ax, ay, az, bx, by, bz]
    }

    /// How many particles.
    pub fn len(&self) -> usize {
        self.placed.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.placed.is_empty()
    }

    /// A particle's lift N'.
    #[inline]
    pub fn lift_of(&self, particle: usize) -> Lift {
        Lift { along: vector(&self.along, particle), across: vector(&self.across, particle) }
    }
}

/// Makes an array exactly `count` long; new numbers are zero.
fn resize(array: &mut Vec<f32>, count: usize) {
    if array.is_empty() {
        // The system gives zeroed memory without writing to it, so the threads that fill it are the first to touch its
        // pages, in parallel. `resize` would write all the zeros here.
        *array = vec![0.0; count];
    } else {
        array.truncate(count);
        array.reserve_exact(count - array.len());
        array.resize(count, 0.0);
    }
}

#[inline]
fn components(arrays: &[Vec<f32>; 3], particle: usize) -> [f32; 3] {
    [0, 1, 2].map(|axis| arrays[axis][particle])
}

#[inline]
fn vector(arrays: &[Vec<f32>; 3], particle: usize) -> DVec3 {
    DVec3::from_array(components(arrays, particle).map(f64::from))
}

/// Projects every particle of a body and finds its stroke's angle. Serves tests and benchmarks: a picture solves only
/// the particles that show, one by one ([`ParticleView`]).
///
/// J is the Jacobian of the screen map, N' the particle's lift. With flatness 1 the angle is φ, that of the rotation
/// nearest to A = J N'. With flatness 0 it is the direction of A e₁, the first column of A. With a flatness F between,
/// the two unit vectors are blended: `arg(F·e^{iφ} + (1 − F)·A e₁/|A e₁|)`. The number of threads changes no bit of the
/// result.
pub fn solve(particles: &BakedParticles, map: &ScreenMap, solved: &mut SolvedParticles) {
    let count = particles.len();
    for array in
        [&mut solved.x_px, &mut solved.y_px, &mut solved.depth, &mut solved.angle_rad, &mut solved.area_px]
    {
        array.resize(count, 0.0);
    }
    let rows = Rows::new(map);
    let outputs = (
        solved.x_px.par_chunks_mut(CHUNK),
        solved.y_px.par_chunks_mut(CHUNK),
        solved.depth.par_chunks_mut(CHUNK),
        solved.angle_rad.par_chunks_mut(CHUNK),
        solved.area_px.par_chunks_mut(CHUNK),
    );
    outputs.into_par_iter().enumerate().for_each(|(chunk, (x_px, y_px, depth, angle_rad, area_px))| {
        let first = chunk * CHUNK;
        let output = Output { x_px, y_px, depth, angle_rad, area_px };
        if particles.flatness.is_empty() {
            widest(Chunk::<false> { particles, first, rows: &rows, output });
        } else {
            widest(Chunk::<true> { particles, first, rows: &rows, output });
        }
    });
}

/// The screen map in single precision.
#[derive(Clone, Copy)]
struct Rows {
    x: [f32; 4],
    y: [f32; 4],
    w: [f32; 4],
    depth: [f32; 4],
}

impl Rows {
    fn new(map: &ScreenMap) -> Self {
        let row = |row: glam::DVec4| row.as_vec4().to_array();
        Self { x: row(map.row_x), y: row(map.row_y), w: row(map.row_w), depth: row(map.row_depth) }
    }
}

struct Output<'a> {
    x_px: &'a mut [f32],
    y_px: &'a mut [f32],
    depth: &'a mut [f32],
    angle_rad: &'a mut [f32],
    area_px: &'a mut [f32],
}

/// One task: the particles from `first` on, as many as the output holds. `WRAPPED` says that some strokes follow the
/// surface, so that flatness has to be read; otherwise it is 1 for all.
struct Chunk<'a, const WRAPPED: bool> {
    particles: &'a BakedParticles,
    first: usize,
    rows: &'a Rows,
    output: Output<'a>,
}

impl<const WRAPPED: bool> Wide for Chunk<'_, WRAPPED> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        solve_chunk(self);
    }
}

#[inline(always)]
fn solve_chunk<const WRAPPED: bool>(chunk: Chunk<'_, WRAPPED>) {
    let Chunk { particles, first, rows, output } = chunk;
    let count = output.x_px.len();
    // Slices of one known length, so that the compiler drops the bounds checks and vectorises.
    let [px, py, pz] = slices(&particles.placed.position, first, count);
    let [nx, ny, nz] = slices(&particles.placed.normal, first, count);
    let [ax, ay, az] = slices(&particles.along, first, count);
    let [bx, by, bz] = slices(&particles.across, first, count);
    // Where flatness is not read, any slice of this length will do.
    let flatness = if WRAPPED { &particles.flatness[first..first + count] } else { px };
    let Output { x_px, y_px, depth, angle_rad, area_px } = output;
    let (x_px, y_px, depth) = (&mut x_px[..count], &mut y_px[..count], &mut depth[..count]);
    let (angle_rad, area_px) = (&mut angle_rad[..count], &mut area_px[..count]);
    for i in 0..count {
        let seen = project(rows, [px[i], py[i], pz[i]], [nx[i], ny[i], nz[i]]);
        (x_px[i], y_px[i], depth[i], area_px[i]) = (seen.x_px, seen.y_px, seen.depth, seen.area_px);
        let lift = [[ax[i], ay[i], az[i]], [bx[i], by[i], bz[i]]];
        angle_rad[i] = seen.angle_rad::<WRAPPED>(lift, if WRAPPED { flatness[i] } else { 1.0 });
    }
}

/// One particle in a view; `jacobian` is J by rows.
struct Projected {
    x_px: f32,
    y_px: f32,
    depth: f32,
    area_px: f32,
    jacobian: [[f32; 3]; 2],
}

#[inline(always)]
fn project(rows: &Rows, [x, y, z]: [f32; 3], [nx, ny, nz]: [f32; 3]) -> Projected {
    let Rows { x: rx, y: ry, w: rw, depth: rd } = *rows;
    let over_w = 1.0 / (rw[0] * x + rw[1] * y + rw[2] * z + rw[3]);
    let u = (rx[0] * x + rx[1] * y + rx[2] * z + rx[3]) * over_w;
    let v = (ry[0] * x + ry[1] * y + ry[2] * z + ry[3]) * over_w;
    let (jx0, jx1, jx2) =
        ((rx[0] - rw[0] * u) * over_w, (rx[1] - rw[1] * u) * over_w, (rx[2] - rw[2] * u) * over_w);
    let (jy0, jy1, jy2) =
        ((ry[0] - rw[0] * v) * over_w, (ry[1] - rw[1] * v) * over_w, (ry[2] - rw[2] * v) * over_w);
    Projected {
        x_px: u,
        y_px: v,
        depth: rd[0] * x + rd[1] * y + rd[2] * z + rd[3],
        area_px: nx * (jx1 * jy2 - jx2 * jy1) + ny * (jx2 * jy0 - jx0 * jy2) + nz * (jx0 * jy1 - jx1 * jy0),
        jacobian: [[jx0, jx1, jx2], [jy0, jy1, jy2]],
    }
}

impl Projected {
    #[inline(always)]
    fn angle_rad<const WRAPPED: bool>(
        &self,
        [[ax, ay, az], [bx, by, bz]]: [[f32; 3]; 2],
        flatness: f32,
    ) -> f32 {
        let [[jx0, jx1, jx2], [jy0, jy1, jy2]] = self.jacobian;
        // A = J N'.
        let a11 = jx0 * ax + jx1 * ay + jx2 * az;
        let a21 = jy0 * ax + jy1 * ay + jy2 * az;
        let a12 = jx0 * bx + jx1 * by + jx2 * bz;
        let a22 = jy0 * bx + jy1 * by + jy2 * bz;
        let (mut turn_x, mut turn_y) = (a11 + a22, a21 - a12);
        if WRAPPED {
            let flat = flatness / (turn_x * turn_x + turn_y * turn_y).sqrt().max(f32::MIN_POSITIVE);
            let wrapped = (1.0 - flatness) / (a11 * a11 + a21 * a21).sqrt().max(f32::MIN_POSITIVE);
            turn_x = turn_x * flat + a11 * wrapped;
            turn_y = turn_y * flat + a21 * wrapped;
        }
        atan2(turn_y, turn_x)
    }
}

#[inline(always)]
fn slices(arrays: &[Vec<f32>; 3], first: usize, count: usize) -> [&[f32]; 3] {
    [&arrays[0][first..first + count], &arrays[1][first..first + count], &arrays[2][first..first + count]]
}
