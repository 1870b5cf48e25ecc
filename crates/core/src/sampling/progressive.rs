//! Progressive dart throwing: an order in which every beginning is blue noise.

use std::ops::Range;

use rayon::prelude::*;

use super::candidates::Candidates;
use super::dart_grid::{Dart, DartGrid};
use super::face_cones::FaceCones;
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

/// How many candidates one task handles: fewer are not worth another thread. The more there are, the nearer to each other those lie
/// that are looked at one after the other.
const LEAST_CHUNK: usize = 1024;
const MOST_CHUNK: usize = 1 << 20;

/// Stands for no dart.
const NONE: u32 = u32::MAX;

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
        let spacing = |level_end: usize| (SPACING * hexagonal_spacing(surface.area(), level_end)) as f32;
        let field = DartField { candidates: Candidates::new(surface, seed), cones: FaceCones::new(surface) };
        let Self { thrown, level_end } = self;
        let mut grid = DartGrid::new(&surface.darts(particles), spacing(*level_end));
        // Grows as particles are found, so that a count is never taken on trust.
        while particles.len() < count {
            let level_begin = *level_end;
            *level_end = (level_begin + 1).max((level_begin as f64 * GROWTH) as usize);
            let radius = spacing(*level_end);
            grid.fit(radius);
            let tries = ((*level_end - level_begin) * TRIES) as u32;
            let level = *thrown..thrown.wrapping_add(tries);
            // First against those that stood before, then, the few that are left, against each other.
            let roomy = field.roomy(level.clone(), &Standing { grid: &grid, particles, radius });
            let mut kept = field.kept(&level, &roomy, radius);
            let least = (*level_end as f64 * LEAST_FILLED) as usize;
            let missing = least.saturating_sub(particles.len() + kept.len());
            kept.extend(level.clone().take(missing).map(|number| field.candidates.dart(number)));
            let numbers: Vec<u32> = kept.iter().map(|dart| dart.number).collect();
            kept.iter_mut().zip(particles.len() as u32..).for_each(|(dart, number)| dart.number = number);
            if kept.len() < LEAST_CHUNK {
                particles.extend(field.candidates.particles(&numbers));
                grid.insert(&kept);
            } else {
                let chosen = numbers.par_chunks(LEAST_CHUNK);
                let chosen = chosen.flat_map_iter(|numbers| field.candidates.particles(numbers));
                rayon::join(|| particles.par_extend(chosen), || grid.insert(&kept));
            }
            *thrown = level.end;
        }
    }
}

/// What stood before a level, and how far apart its particles are.
struct Standing<'a> {
    grid: &'a DartGrid,
    particles: &'a [Particle],
    radius: f32,
}

/// Where darts fall.
struct DartField<'a> {
    candidates: Candidates<'a>,
    cones: FaceCones,
}

impl DartField<'_> {
    /// Those of a level's candidates that nothing crowds of what stood before, in any order.
    fn roomy(&self, level: Range<u32>, standing: &Standing<'_>) -> Vec<Dart> {
        let threads = rayon::current_num_threads();
        let chunk = (level.len() / (2 * threads)).clamp(LEAST_CHUNK, MOST_CHUNK);
        let of_chunk = |first: u32| {
            let numbers = first..level.end.min(first.saturating_add(chunk as u32));
            self.roomy_of(numbers, standing)
        };
        if level.len() <= chunk {
            return of_chunk(level.start);
        }
        let firsts: Vec<u32> = level.clone().step_by(chunk).collect();
        let found: Vec<Vec<Dart>> = firsts.into_par_iter().map(of_chunk).collect();
        found.concat()
    }

    fn roomy_of(&self, numbers: Range<u32>, standing: &Standing<'_>) -> Vec<Dart> {
        let Standing { grid, particles, radius } = standing;
        let mut darts = grid.in_order(self.candidates.darts(numbers));
        darts.retain(|dart| {
            let mut normal = None;
            let crowds = |other: &Dart| {
                self.cones.same_side(dart.face, other.face).unwrap_or_else(|| {
                    let normal = *normal.get_or_insert_with(|| self.candidates.particle(dart.number).normal);
                    particles[other.number as usize].normal.dot(normal) > 0.0
                })
            };
            !grid.any_near(dart.position, *radius, crowds)
        });
        darts
    }

    /// Those that stay when each in turn, by number, is dropped if one before it crowds it; by number.
    fn kept(&self, level: &Range<u32>, darts: &[Dart], radius: f32) -> Vec<Dart> {
        let grid = DartGrid::new(darts, radius);
        let rivals = |dart: &Dart| {
            let mut rivals = Vec::new();
            grid.any_near(dart.position, radius, |other| {
                let crowded = other.number < dart.number
                    && self.cones.same_side(dart.face, other.face).unwrap_or_else(|| {
                        let [own, other] =
                            [dart, other].map(|dart| self.candidates.particle(dart.number).normal);
                        other.dot(own) > 0.0
                    });
                if crowded {
                    rivals.push((dart.number - level.start, other.number - level.start));
                }
                false
            });
            rivals
        };
        let sorted = grid.darts();
        let mut pairs: Vec<(u32, u32)> = if sorted.len() <= LEAST_CHUNK {
            sorted.iter().flat_map(rivals).collect()
        } else {
            sorted.par_iter().with_min_len(LEAST_CHUNK).flat_map_iter(rivals).collect()
        };
        pairs.sort_unstable();
        // Which dart has a number and stays.
        let mut stays = vec![NONE; level.len()];
        for (index, dart) in darts.iter().enumerate() {
            stays[(dart.number - level.start) as usize] = index as u32;
        }
        for (later, earlier) in pairs {
            // All that could drop the earlier one was looked at before.
            if stays[earlier as usize] != NONE {
                stays[later as usize] = NONE;
            }
        }
        stays.into_iter().filter(|&index| index != NONE).map(|index| darts[index as usize]).collect()
    }
}
