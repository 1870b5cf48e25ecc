//! Carries particles along with a bent surface.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DMat3, DVec3, Mat3, Vec3};
use rayon::prelude::*;

use crate::TriangleMesh;
use crate::cofactors::{cofactors, cofactors_f32};
use crate::sampling::PackedParticle;
use crate::solve::{BakedParticles, Bounds, ParticleView, PlacedParticles, WORD};
use crate::wide::{Wide, widest};

/// How many particles one task carries.
const CHUNK: usize = 4096;

/// How many particles are looked up at a time, before any of them is computed: their vertices lie far apart in memory,
/// and reading many of them at once lets the processor fetch them in parallel.
const BATCH: usize = 32;

/// A vertex of the bent surface: its position, and the columns of F, the matrix that takes steps on the surface at rest
/// to steps now. It fills a line of the processor's cache.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct Vertex([f32; 16]);

/// A vertex without its padding.
type Record = [f32; 12];

/// A bent surface, ready to carry what lies on it.
#[derive(Clone, Debug)]
pub struct Carrier {
    vertices: Vec<Vertex>,
}

/// What culling needs of particles, sorted by triangle, so that particles in sequence read vertices that are near in
/// memory.
#[derive(Clone, Debug, Default)]
pub struct SortedParticles(Vec<SortedParticle>);

#[derive(Clone, Copy, Debug)]
struct SortedParticle {
    place: PackedParticle,
    /// Its index before sorting, and its bit in what [`Carrier::within`] returns.
    number: u32,
    /// Its place in the progressive order. Where the surface looks small, the last particles of the order are hidden.
    ordinal: f32,
    /// At rest.
    normal: Vec3,
    height: f32,
}

impl SortedParticles {
    /// Sorts particles; `ordinals` is as in [`ParticleView::within`], `height` is how far each stands off the surface.
    pub fn new(
        places: &[PackedParticle],
        placed: &PlacedParticles,
        ordinals: &[f32],
        height: impl Fn(usize) -> f32 + Sync,
    ) -> Self {
        let entry = |(index, &place): (usize, &PackedParticle)| SortedParticle {
            place,
            number: index as u32,
            ordinal: ordinals.get(index).copied().unwrap_or(index as f32),
            normal: placed.normal_of(index).as_vec3(),
            height: height(index),
        };
        let mut entries: Vec<SortedParticle> =
            places[..placed.len()].par_iter().enumerate().map(entry).collect();
        entries.par_sort_unstable_by_key(|entry| (entry.place.triangle(), entry.number));
        Self(entries)
    }
}

/// A place on a surface at rest, carried to where it is now.
#[derive(Clone, Copy, Debug)]
pub struct CarriedPlace {
    /// Where it is now, model space.
    pub position: DVec3,
    /// F: takes steps on the surface at rest to steps now.
    pub gradient: DMat3,
}

impl CarriedPlace {
    /// The unit normal now, on the side of the surface whose unit normal at rest is `at_rest`. Where the surface has
    /// collapsed, it is `at_rest` itself.
    pub fn normal(&self, at_rest: DVec3) -> DVec3 {
        self.area_normal(at_rest).normalize_or(at_rest)
    }

    /// As [`Self::normal`], but its length is the area now over the area at rest. Zero where the surface has collapsed.
    pub fn area_normal(&self, at_rest: DVec3) -> DVec3 {
        cofactors(self.gradient) * at_rest
    }

    /// The rows of a Jacobian here, pulled back to the surface at rest: `J F`.
    pub fn pulled_back(&self, jacobian: [DVec3; 2]) -> [DVec3; 2] {
        jacobian.map(|row| self.gradient.transpose() * row)
    }
}

impl Carrier {
    /// From the positions of all vertices, and F at each.
    pub fn new(positions: &[Vec3], gradients: &[Mat3]) -> Self {
        let record = |(position, gradient): (&Vec3, &Mat3)| {
            let [x, y, z] = position.to_array();
            let [a, b, c, d, e, f, g, h, i] = gradient.to_cols_array();
            Vertex([x, y, z, a, b, c, d, e, f, g, h, i, 0.0, 0.0, 0.0, 0.0])
        };
        Self { vertices: positions.par_iter().zip(gradients).with_min_len(CHUNK).map(record).collect() }
    }

    #[inline(always)]
    fn record(&self, vertex: u32) -> Record {
        let Vertex([record @ .., _, _, _, _]) = self.vertices[vertex as usize];
        record
    }

    /// Where a place is now.
    pub fn place(&self, mesh: &TriangleMesh, place: PackedParticle) -> CarriedPlace {
        let corners = mesh.triangles[place.triangle()].map(|vertex| self.record(vertex));
        let [x, y, z, gradient @ ..] = blended(&corners, place.weights()).map(f64::from);
        CarriedPlace { position: DVec3::new(x, y, z), gradient: DMat3::from_cols_array(&gradient) }
    }

    /// Carries one particle as [`Carrier::carry`] does. Returns its position, its normal and the two columns of its
    /// lift matrix N' (see [`crate::lift`]) now. `at_rest` has the normal and these columns at rest; `height` is how
    /// far it stands off the surface.
    pub fn particle(
        &self,
        mesh: &TriangleMesh,
        place: PackedParticle,
        at_rest: [Vec3; 3],
        height: f32,
    ) -> [Vec3; 4] {
        let corners = mesh.triangles[place.triangle()].map(|vertex| self.record(vertex));
        moved(at_rest, &blended(&corners, place.weights()), height)
    }

    /// Culls particles. Returns one bit for each, in the order that they had before sorting, set where the particle
    /// faces the eye and is within the bounds; 64 to a word, the first in the lowest bit.
    pub fn within(
        &self,
        mesh: &TriangleMesh,
        sorted: &SortedParticles,
        view: &ParticleView,
        bounds: &Bounds,
    ) -> Vec<u64> {
        let words: Vec<AtomicU64> = (0..sorted.0.len().div_ceil(WORD)).map(|_| AtomicU64::new(0)).collect();
        sorted.0.par_chunks(CHUNK).for_each(|entries| {
            widest(Culling { carrier: self, mesh, entries, view, bounds, words: &words });
        });
        words.into_iter().map(AtomicU64::into_inner).collect()
    }

    /// Carries particles that were baked at rest to where they are now. Their lift matrices N' (see [`crate::lift`])
    /// become F N'. `height` is how far a particle stands off the surface.
    ///
    /// **The length of a carried normal is the area of the surface now over its area at rest.** So the projected area
    /// that a view finds from it is that of a unit of surface at rest, however much the surface is stretched.
    pub fn carry(
        &self,
        mesh: &TriangleMesh,
        places: &[PackedParticle],
        baked: &BakedParticles,
        height: impl Fn(usize) -> f32 + Sync,
    ) -> BakedParticles {
        let mut carried = BakedParticles::default();
        carried.resize(baked.len());
        carried.chunks_mut(CHUNK).into_par_iter().enumerate().for_each(|(chunk, mut chunk_out)| {
            let first = chunk * CHUNK;
            let mut corners = [[0u32; 3]; BATCH];
            let mut records = [[[0.0f32; 12]; 3]; BATCH];
            for (batch, places) in places[first..baked.len().min(first + CHUNK)].chunks(BATCH).enumerate() {
                for (corners, place) in corners.iter_mut().zip(places) {
                    *corners = mesh.triangles[place.triangle()];
                }
                for (records, corners) in records.iter_mut().zip(&corners[..places.len()]) {
                    *records = corners.map(|vertex| self.record(vertex));
                }
                for (offset, (records, place)) in records.iter().zip(places).enumerate() {
                    let offset = batch * BATCH + offset;
                    let index = first + offset;
                    let at_rest =
                        [&baked.placed.normal, &baked.along, &baked.across].map(|arrays| of(arrays, index));
                    chunk_out.set(offset, moved(at_rest, &blended(records, place.weights()), height(index)));
                }
            }
        });
        carried.flatness.clone_from(&baked.flatness);
        carried
    }
}

/// Vectors such that the carried normal at any place of a triangle is a weighted mean of them. `gradients` are F at its
/// corners. The normal at rest must be a weighted mean of `normals`.
pub fn normals_around(gradients: [Mat3; 3], normals: [Vec3; 3]) -> impl Iterator<Item = Vec3> {
    cofactors_around(gradients)
        .into_iter()
        .flat_map(move |cofactors| normals.map(|normal| cofactors * normal))
}

/// An upper bound on the factor by which the area grows anywhere on a triangle, whatever its normal is. `gradients` are
/// F at its corners.
pub fn most_growth(gradients: [Mat3; 3]) -> f32 {
    // A matrix takes a unit vector to a vector at most as long as the matrix's Frobenius norm.
    let length =
        |cofactors: Mat3| cofactors.to_cols_array().iter().map(|entry| entry * entry).sum::<f32>().sqrt();
    let lengths = cofactors_around(gradients).map(length);
    if lengths.iter().all(|length| length.is_finite()) {
        lengths.into_iter().fold(0.0, f32::max)
    } else {
        f32::INFINITY
    }
}

/// Matrices such that the cofactors of F at any place of a triangle are a weighted mean of them. `gradients` are F at
/// its corners.
fn cofactors_around(gradients: [Mat3; 3]) -> [Mat3; 6] {
    let [a, b, c] = gradients;
    // Cofactors are quadratic: cof(u F + v G) = u² cof F + v² cof G + 2 u v (cof(F + G) − cof F − cof G)/2.
    let corners = gradients.map(cofactors_f32);
    let mixed =
        |(f, cof_f): (Mat3, Mat3), (g, cof_g): (Mat3, Mat3)| (cofactors_f32(f + g) - cof_f - cof_g) * 0.5;
    let [of_a, of_b, of_c] = [(a, corners[0]), (b, corners[1]), (c, corners[2])];
    [corners[0], corners[1], corners[2], mixed(of_a, of_b), mixed(of_b, of_c), mixed(of_c, of_a)]
}

#[inline(always)]
fn blended([a, b, c]: &[Record; 3], [u, v, w]: [f32; 3]) -> Record {
    std::array::from_fn(|index| a[index] * u + b[index] * v + c[index] * w)
}

#[inline(always)]
fn of(arrays: &[Vec<f32>; 3], index: usize) -> Vec3 {
    Vec3::new(arrays[0][index], arrays[1][index], arrays[2][index])
}

/// Moves a particle. Takes its normal and the two columns of its lift at rest; returns its position, its normal and
/// these columns now. `record` is the surface's position and F at the particle.
#[inline(always)]
fn moved([normal, along, across]: [Vec3; 3], record: &Record, height: f32) -> [Vec3; 4] {
    let [x, y, z, columns @ ..] = *record;
    let gradient = Mat3::from_cols_array(&columns);
    let normal = cofactors_f32(gradient) * normal;
    let position = lifted(Vec3::new(x, y, z), normal, height);
    [position, normal, gradient * along, gradient * across]
}

/// Culls a run of sorted particles, and sets the bits of those that show.
struct Culling<'a> {
    carrier: &'a Carrier,
    mesh: &'a TriangleMesh,
    entries: &'a [SortedParticle],
    view: &'a ParticleView,
    bounds: &'a Bounds,
    words: &'a [AtomicU64],
}

impl Wide for Culling<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let mut records = [[0.0f32; WORD]; 12];
        let mut normals = [[0.0f32; WORD]; 3];
        let mut heights = [0.0f32; WORD];
        let mut numbers = [0u32; WORD];
        let mut ordinals = [0.0f32; WORD];
        let mut shows = [0u8; WORD];
        for entries in self.entries.chunks(WORD) {
            // First each particle is looked up. Then all are computed, in arrays, so that the compiler vectorises the
            // loop.
            for (lane, entry) in entries.iter().enumerate() {
                let corners =
                    self.mesh.triangles[entry.place.triangle()].map(|vertex| self.carrier.record(vertex));
                let record = blended(&corners, entry.place.weights());
                for (array, value) in records.iter_mut().zip(record) {
                    array[lane] = value;
                }
                for (array, value) in normals.iter_mut().zip(entry.normal.to_array()) {
                    array[lane] = value;
                }
                heights[lane] = entry.height;
                numbers[lane] = entry.number;
                ordinals[lane] = entry.ordinal;
            }
            let is_lifted = heights[..entries.len()].iter().any(|height| *height != 0.0);
            for lane in 0..WORD {
                let at = |index: usize| records[index][lane];
                let columns = [3, 6, 9].map(|first| Vec3::new(at(first), at(first + 1), at(first + 2)));
                let gradient = Mat3::from_cols(columns[0], columns[1], columns[2]);
                let normal =
                    cofactors_f32(gradient) * Vec3::new(normals[0][lane], normals[1][lane], normals[2][lane]);
                let mut position = Vec3::new(at(0), at(1), at(2));
                if is_lifted {
                    position = lifted(position, normal, heights[lane]);
                }
                let vectors = [position.to_array(), normal.to_array()];
                shows[lane] = u8::from(self.view.shows(vectors, ordinals[lane], self.bounds));
            }
            for (shows, number) in shows.iter().zip(&numbers[..entries.len()]) {
                if *shows != 0 {
                    let number = *number as usize;
                    self.words[number / WORD].fetch_or(1 << (number % WORD), Ordering::Relaxed);
                }
            }
        }
    }
}

/// A place that stands off the surface, along its normal.
#[inline(always)]
fn lifted(position: Vec3, normal: Vec3, height: f32) -> Vec3 {
    if height == 0.0 { position } else { position + normal.normalize_or_zero() * height }
}
