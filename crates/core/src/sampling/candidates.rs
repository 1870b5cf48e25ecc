//! An endless, even, random sequence of places on a surface: what dart throwing throws.

use rayon::prelude::*;

use super::dart_grid::Dart;
use super::{Particle, Surface, barycentric};
use crate::hash;

/// `count` particles by chance, spread evenly by area: what dart throwing picks from, without the picking. The first so many are
/// the same for every count. The result depends on the mesh, the count and the seed alone. An empty surface gives no particles.
pub fn scattered(surface: &Surface<'_>, count: usize, seed: u32) -> Vec<Particle> {
    if surface.faces.is_empty() {
        return Vec::new();
    }
    let candidates = Candidates::new(surface, seed);
    let numbers = (0..count).into_par_iter().with_min_len(1024);
    numbers.map(|number| candidates.particle(number as u32)).collect()
}

/// The sequence: its `i`th place depends on the surface, the seed and `i` alone.
pub(super) struct Candidates<'a> {
    surface: &'a Surface<'a>,
    /// For each of as many equal steps of area as there are faces, the face that the step begins in.
    guide: Vec<u32>,
    seed: u32,
}

impl<'a> Candidates<'a> {
    /// `surface` must have a face.
    pub(super) fn new(surface: &'a Surface<'a>, seed: u32) -> Self {
        Self { surface, guide: guide_table(&surface.area_up_to), seed }
    }

    /// Where a candidate lies: its face, and the weights of the face's second and third corner.
    #[inline]
    fn place(&self, index: u32) -> (usize, [f32; 2]) {
        let Self { surface, guide, seed } = self;
        let seed = hash::combine(*seed, index);
        // 53 random bits, so that a speck beside a huge face still has its share.
        let high = f64::from(hash::combine(seed, 0)) / 4_294_967_296.0;
        let low = f64::from(hash::combine(seed, 1) >> 11) / 9_007_199_254_740_992.0;
        let target = (high + low) * surface.area();
        let bucket = ((high * (guide.len() - 1) as f64) as usize).min(guide.len() - 2);
        let (from, to) = (guide[bucket] as usize, guide[bucket + 1] as usize + 1);
        let to = to.min(surface.faces.len());
        let mut face = from;
        if to - from <= 4 {
            while face < to && surface.area_up_to[face] <= target {
                face += 1;
            }
        } else {
            face += surface.area_up_to[from..to].partition_point(|&sum| sum <= target);
        }
        let place = barycentric(hash::unit(hash::combine(seed, 2)), hash::unit(hash::combine(seed, 3)));
        (face.min(surface.faces.len() - 1), place)
    }

    /// What of a candidate most are ever asked for.
    #[inline]
    pub(super) fn dart(&self, number: u32) -> Dart {
        let (face, place) = self.place(number);
        Dart { position: self.surface.position(face, place), face: face as u32, number }
    }

    /// The whole candidate.
    pub(super) fn particle(&self, number: u32) -> Particle {
        let (face, place) = self.place(number);
        self.surface.particle(face, place)
    }
}

fn guide_table(area_up_to: &[f64]) -> Vec<u32> {
    let steps = area_up_to.len();
    let total = area_up_to[steps - 1];
    let mut face = 0;
    (0..=steps)
        .map(|step| {
            let area = total * step as f64 / steps as f64;
            while face + 1 < steps && area_up_to[face] <= area {
                face += 1;
            }
            face as u32
        })
        .collect()
}
