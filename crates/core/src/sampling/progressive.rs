//! Progressive dart throwing: an order of particles whose first n are blue noise, for every n.

use std::ops::Range;

use rayon::prelude::*;

use super::candidates::Candidates;
use super::dart_grid::{Dart, DartGrid};
use super::face_cones::FaceCones;
use super::{Particle, Surface, hexagonal_spacing};

/// Least distance between the particles of a level. It is a share of the hexagonal spacing for the number of particles
/// that the level is meant to end with.
const SPACING: f64 = 0.56;

/// Candidates thrown per particle that a level is meant to add. More is smoother and slower.
const TRIES: usize = 5;

/// A level ends with this many times the particles that it began with.
const GROWTH: f64 = 1.08;

/// Where there is too little room (faces on top of each other, the first few particles of a thin rod), a level is
/// filled up to this share of the particles that it is meant to end with. Distances do not count then, so that the work
/// stays proportional to the count.
const LEAST_FILLED: f64 = 0.5;

/// The least and the most candidates that one task handles. Fewer are not worth another thread. A task sorts its
/// candidates by place: the more there are, the better consecutive searches share the cache.
const LEAST_CHUNK: usize = 1024;
const MOST_CHUNK: usize = 1 << 20;

/// Stands for no dart, in place of an index.
const NONE: u32 = u32::MAX;

/// `count` particles in progressive blue-noise order: the first `n` of them are spread evenly, for every `n`, and a
/// greater `count` keeps the particles that a smaller one gives.
///
/// Darts are thrown in levels whose spacings do not depend on how many particles there will be in the end. Two
/// particles crowd each other only on the same side of the surface, so thin sheets carry their full share on both
/// sides. The result depends on the mesh, the count and the seed alone. An empty surface gives no particles.
pub fn progressive(surface: &Surface<'_>, count: usize, seed: u32) -> Vec<Particle> {
    let mut particles = Vec::new();
    ProgressiveState::default().grow(surface, seed, &mut particles, count);
    particles.truncate(count);
    particles
}

/// How far a progressive order has come, so that it can go on later. Going on takes the time for the added particles,
/// and for one pass over those that are there.
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
    /// The state as two numbers, to be stored for another process.
    pub fn to_numbers(self) -> [u64; 2] {
        [u64::from(self.thrown), self.level_end as u64]
    }

    /// The state for which [`ProgressiveState::to_numbers`] gave these numbers; `None` for numbers that it never gives.
    pub fn from_numbers([thrown, level_end]: [u64; 2]) -> Option<Self> {
        let level_end = usize::try_from(level_end).ok().filter(|&end| end > 0)?;
        Some(Self { thrown: u32::try_from(thrown).ok()?, level_end })
    }

    /// Grows `particles` by whole levels to at least `count`, unless the surface is empty. Surface, seed and particles
    /// must be those of the call before. The first `n` particles are those that [`progressive`] gives.
    pub fn grow(&mut self, surface: &Surface<'_>, seed: u32, particles: &mut Vec<Particle>, count: usize) {
        if surface.faces.is_empty() || particles.len() >= count {
            return;
        }
        let spacing = |level_end: usize| (SPACING * hexagonal_spacing(surface.area(), level_end)) as f32;
        let field = DartField { candidates: Candidates::new(surface, seed), cones: FaceCones::new(surface) };
        let Self { thrown, level_end } = self;
        let mut grid = DartGrid::new(&surface.darts(particles), spacing(*level_end));
        // Memory grows as particles are found, never by the count that was asked for.
        while particles.len() < count {
            let level_begin = *level_end;
            *level_end = (level_begin + 1).max((level_begin as f64 * GROWTH) as usize);
            let radius = spacing(*level_end);
            grid.fit(radius);
            let tries = ((*level_end - level_begin) * TRIES) as u32;
            let level = *thrown..thrown.wrapping_add(tries);
            // Candidates are tested against the particles of earlier levels; the few that are left, against each other.
            let clear = field.clear_of(&Accepted { grid: &grid, particles, radius }, level.clone());
            let mut added = field.thinned(&level, &clear, radius);
            let least = (*level_end as f64 * LEAST_FILLED) as usize;
            let missing = least.saturating_sub(particles.len() + added.len());
            added.extend(level.clone().take(missing).map(|number| field.candidates.dart(number)));
            let numbers: Vec<u32> = added.iter().map(|dart| dart.number).collect();
            added.iter_mut().zip(particles.len() as u32..).for_each(|(dart, number)| dart.number = number);
            if added.len() < LEAST_CHUNK {
                particles.extend(field.candidates.particles(&numbers));
                grid.insert(&added);
            } else {
                let chosen = numbers.par_chunks(LEAST_CHUNK);
                let chosen = chosen.flat_map_iter(|numbers| field.candidates.particles(numbers));
                rayon::join(|| particles.par_extend(chosen), || grid.insert(&added));
            }
            *thrown = level.end;
        }
    }
}

/// The particles of earlier levels, and the least distance that the present level keeps from them.
struct Accepted<'a> {
    grid: &'a DartGrid,
    particles: &'a [Particle],
    radius: f32,
}

/// The candidates of a surface, and the cones that tell whether two of them are on the same side of it.
struct DartField<'a> {
    candidates: Candidates<'a>,
    cones: FaceCones,
}

impl DartField<'_> {
    /// A level's candidates that no accepted particle crowds, in any order.
    fn clear_of(&self, accepted: &Accepted<'_>, level: Range<u32>) -> Vec<Dart> {
        let threads = rayon::current_num_threads();
        let chunk = (level.len() / (2 * threads)).clamp(LEAST_CHUNK, MOST_CHUNK);
        let of_chunk = |first: u32| {
            let numbers = first..level.end.min(first.saturating_add(chunk as u32));
            self.chunk_clear_of(accepted, numbers)
        };
        if level.len() <= chunk {
            return of_chunk(level.start);
        }
        let firsts: Vec<u32> = level.clone().step_by(chunk).collect();
        let found: Vec<Vec<Dart>> = firsts.into_par_iter().map(of_chunk).collect();
        found.concat()
    }

    fn chunk_clear_of(&self, accepted: &Accepted<'_>, numbers: Range<u32>) -> Vec<Dart> {
        let Accepted { grid, particles, radius } = accepted;
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

    /// Goes through the darts in order of their numbers, and drops each dart that is crowded by an earlier one which
    /// was kept. Returns the kept darts in this order.
    fn thinned(&self, level: &Range<u32>, darts: &[Dart], radius: f32) -> Vec<Dart> {
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
        // For each number of the level, the index of its dart; `NONE` if it has none, or once it is dropped.
        let mut stays = vec![NONE; level.len()];
        for (index, dart) in darts.iter().enumerate() {
            stays[(dart.number - level.start) as usize] = index as u32;
        }
        for (later, earlier) in pairs {
            // Pairs are sorted, so all that could drop the earlier one has been handled.
            if stays[earlier as usize] != NONE {
                stays[later as usize] = NONE;
            }
        }
        stays.into_iter().filter(|&index| index != NONE).map(|index| darts[index as usize]).collect()
    }
}
