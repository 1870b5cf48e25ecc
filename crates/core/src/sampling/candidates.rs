//! A sequence of random places on a surface, spread evenly by area: the candidates from which dart throwing chooses
//! particles.

use std::ops::Range;

use rayon::prelude::*;

use super::block::{Block, LANES};
use super::dart_grid::Dart;
use super::throw::Throw;
use super::{Particle, Surface};

/// The first `count` candidates of dart throwing as particles, none refused: random, and spread evenly by area. A
/// greater count begins with the particles of a smaller one. The result depends on the surface, the count and the seed
/// alone. A surface without faces gives no particles.
pub fn scattered(surface: &Surface<'_>, count: usize, seed: u32) -> Vec<Particle> {
    if surface.faces.is_empty() {
        return Vec::new();
    }
    let candidates = Candidates::new(surface, seed);
    // Each task keeps the block that it computed last.
    let indices = (0..count).into_par_iter().with_min_len(16 * LANES);
    indices
        .map_init(
            || None::<(usize, [Particle; LANES])>,
            |known, index| {
                let (first, lane) = (index - index % LANES, index % LANES);
                match known {
                    Some((known, particles)) if *known == first => particles[lane],
                    _ => {
                        let particles = candidates.block_from(first as u32).particles(surface);
                        known.insert((first, particles)).1[lane]
                    }
                }
            },
        )
        .collect()
}

/// The sequence: its `i`th place depends on the surface, the seed and `i` alone.
pub(super) struct Candidates<'a> {
    surface: &'a Surface<'a>,
    /// The total area is cut into equal steps, as many as there are faces, but at most [`MOST_STEPS`]. For each
    /// step this holds the face in which it begins; one more entry, at the end, holds the last face.
    guide: Vec<u32>,
    seed: u32,
}

impl<'a> Candidates<'a> {
    /// `surface` must have a face.
    pub(super) fn new(surface: &'a Surface<'a>, seed: u32) -> Self {
        Self { surface, guide: guide_table(&surface.area_up_to), seed }
    }

    /// The [`LANES`] candidates from `first` on, one in each lane of a block.
    #[inline]
    fn block_from(&self, first: u32) -> Block {
        self.block(&std::array::from_fn(|lane| first.wrapping_add(lane as u32)))
    }

    /// The candidates with these numbers, one in each lane of a block.
    #[inline]
    fn block(&self, numbers: &[u32; LANES]) -> Block {
        let (steps, total) = (self.guide.len() - 1, self.surface.area());
        Block::new((self.seed, numbers), (steps, total), |area, step| self.face(area, step) as u32)
    }

    /// Where a candidate lies: its face, and the weights of the face's second and third corners.
    fn place(&self, number: u32) -> (usize, [f32; 2]) {
        let throw = Throw::new(self.seed, number);
        let face = self.face(throw.area(self.surface.area()), throw.step(self.guide.len() - 1));
        (face, throw.barycentric())
    }

    /// The face in which a candidate lies. `area` is the candidate's place when the areas of all faces are laid end to
    /// end. `step` narrows the search to the faces between two entries of `guide`: `area` lies in that step or, by
    /// rounding, just behind it.
    #[inline(always)]
    fn face(&self, area: f64, step: i32) -> usize {
        let Self { surface, guide, .. } = self;
        let step = step as usize;
        let (from, to) = (guide[step] as usize, guide[step + 1] as usize + 1);
        let to = to.min(surface.faces.len());
        let mut face = from;
        if to - from <= 4 {
            while face < to && surface.area_up_to[face] <= area {
                face += 1;
            }
        } else {
            face += surface.area_up_to[from..to].partition_point(|&sum| sum <= area);
        }
        face.min(surface.faces.len() - 1)
    }

    /// The face and position of a candidate: enough to refuse most candidates.
    pub(super) fn dart(&self, number: u32) -> Dart {
        let (face, place) = self.place(number);
        Dart { position: self.surface.position(face, place), face: face as u32, number }
    }

    /// The same as [`Candidates::dart`], for several candidates.
    pub(super) fn darts(&self, numbers: Range<u32>) -> Vec<Dart> {
        let mut darts = Vec::with_capacity(numbers.len());
        for first in numbers.clone().step_by(LANES) {
            let block = self.block_from(first);
            for (lane, number) in (first..numbers.end).take(LANES).enumerate() {
                let (face, place) = block.place(lane);
                let position = self.surface.position(face, place);
                darts.push(Dart { position, face: face as u32, number });
            }
        }
        darts
    }

    /// The candidates with these numbers as particles.
    pub(super) fn particles(&self, numbers: &[u32]) -> Vec<Particle> {
        let mut particles = Vec::with_capacity(numbers.len());
        for numbers in numbers.chunks(LANES) {
            let mut all = [0; LANES];
            all[..numbers.len()].copy_from_slice(numbers);
            particles.extend_from_slice(&self.block(&all).particles(self.surface)[..numbers.len()]);
        }
        particles
    }

    /// The candidate with this number as a particle.
    pub(super) fn particle(&self, number: u32) -> Particle {
        let (face, place) = self.place(number);
        self.surface.particle(face, place)
    }
}

/// The most steps of a guide table: more would hardly find a face sooner.
const MOST_STEPS: usize = 1 << 24;

fn guide_table(area_up_to: &[f64]) -> Vec<u32> {
    let faces = area_up_to.len();
    let steps = faces.min(MOST_STEPS);
    let total = area_up_to[faces - 1];
    let mut face = 0;
    (0..=steps)
        .map(|step| {
            let area = total * step as f64 / steps as f64;
            while face + 1 < faces && area_up_to[face] <= area {
                face += 1;
            }
            face as u32
        })
        .collect()
}
