//! Progressive dart throwing: an order in which every beginning is blue noise.

use rayon::prelude::*;

use super::candidates::candidates;
use super::dart_grid::DartGrid;
use super::{Particle, Surface, hexagonal_spacing};

/// Particles keep this share of the hexagonal spacing of as many as their level is meant to end with.
const SPACING: f64 = 0.56;

/// Candidates thrown per particle that a level is meant to add. More is smoother and slower.
const TRIES: usize = 5;

/// A level ends with this many times the particles that it began with.
const GROWTH: f64 = 1.08;

/// Where there is no room (faces that lie on each other, the first few particles of a thin rod), a level still ends with
/// this share of the particles that it is meant for, so that the work is in proportion to the count.
const LEAST_FILLED: f64 = 0.5;

/// `count` particles in progressive blue-noise order: the first `n` of them are spread evenly, for every `n`, and a
/// greater `count` keeps the particles that a smaller one gives.
///
/// Dart throwing in levels, whose spacings are absolute: they do not depend on how many particles there will be. Two
/// particles crowd each other only on the same side of the surface, so thin sheets carry their full share on both.
/// The result depends on the mesh, the count and the seed alone. An empty surface gives no particles.
pub fn progressive(surface: &Surface<'_>, count: usize, seed: u32) -> Vec<Particle> {
    let mut particles = Vec::new();
    ProgressiveState::default().grow(surface, seed, &mut particles, count);
    particles.truncate(count);
    particles
}

/// Where a progressive order has come to, so that it can go on: more particles later cost no more than what is added, and one
/// look at what is there.
#[derive(Clone, Copy, Debug)]
pub struct ProgressiveState {
    /// Candidates thrown so far.
    thrown: u32,
    /// How many particles the last level was meant to end with.
    level_end: usize,
}

impl Default for ProgressiveState {
    /// Before the first particle.
    fn default() -> Self {
        Self { thrown: 0, level_end: 1 }
    }
}

impl ProgressiveState {
    /// Grows `particles` by whole levels to at least `count`, unless the surface is empty. Surface, seed and particles are those
    /// of the growth before; the first `n` particles are those of [`progressive`].
    pub fn grow(&mut self, surface: &Surface<'_>, seed: u32, particles: &mut Vec<Particle>, count: usize) {
        if surface.faces.is_empty() || particles.len() >= count {
            return;
        }
        let candidates = candidates(surface, seed);
        let spacing = |level_end: usize| (SPACING * hexagonal_spacing(surface.area(), level_end)) as f32;
        let mut grid = DartGrid::new();
        if !particles.is_empty() {
            grid.shrink_to(spacing(self.level_end));
        }
        for particle in particles.iter() {
            grid.insert(particle.position, particle.normal);
        }
        // Grows as particles are found, so that a count is never taken on trust.
        let Self { thrown, level_end } = self;
        while particles.len() < count {
            let level_begin = *level_end;
            *level_end = (level_begin + 1).max((level_begin as f64 * GROWTH) as usize);
            let radius = spacing(*level_end);
            grid.shrink_to(radius);
            let tries = ((*level_end - level_begin) * TRIES) as u32;
            let thrown_then = thrown.wrapping_add(tries);
            // First against those that stood before, on all threads; then, the few that are left, against each other.
            let roomy: Vec<Particle> = (*thrown..thrown_then)
                .into_par_iter()
                .with_min_len(512)
                .map(&candidates)
                .filter(|candidate| grid.has_room(candidate.position, candidate.normal, radius))
                .collect();
            for candidate in roomy {
                if grid.has_room(candidate.position, candidate.normal, radius) {
                    grid.insert(candidate.position, candidate.normal);
                    particles.push(candidate);
                }
            }
            let least = (*level_end as f64 * LEAST_FILLED) as usize;
            for index in *thrown..thrown_then {
                if particles.len() >= least {
                    break;
                }
                let forced = candidates(index);
                grid.insert(forced.position, forced.normal);
                particles.push(forced);
            }
            *thrown = thrown_then;
        }
    }
}
