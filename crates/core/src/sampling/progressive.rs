//! Progressive dart throwing: an order of particles whose first n are blue noise, for every n.

use std::ops::Range;

use rayon::prelude::*;

use super::candidates::Candidates;
use super::cell_level::{ActiveCells, CellLevel};
use super::cells::Needed;
use super::dart_field::{Accepted, DartField};
use super::dart_grid::{Dart, DartGrid};
use super::levels::{LEAST_CHUNK, LEAST_FILLED, ProgressiveState, TRIES, next_level_end, spacing};
use super::{Particle, Surface};

/// Until an order has this many particles or is crowded, its levels are counted: thrown on the whole surface, with each
/// particle's index as its ordinal. See [`ProgressiveState`]. Calls that ask for fewer particles end sooner.
const LEAST_COUNTED: usize = 8192;

/// Distinct places on a surface differ by at least about this share of its greatest coordinate.
const FINEST: f32 = 0.5 * f32::EPSILON;

/// The most candidates that one task handles. It sorts them by place: the more there are, the better consecutive
/// searches share the cache.
const MOST_CHUNK: usize = 1 << 20;

/// `count` particles in progressive blue-noise order: the first `n` of them are spread evenly, for every `n`, and a
/// greater `count` keeps the particles that a smaller one gives.
///
/// Darts are thrown in levels whose spacings do not depend on how many particles there will be in the end. Two
/// particles crowd each other only on the same side of the surface, so thin sheets carry their full share on both
/// sides. The result depends on the mesh, the count and the seed alone. An empty surface gives no particles, and one
/// whose faces lie on each other may give fewer than `count`.
pub fn progressive(surface: &Surface<'_>, count: usize, seed: u32) -> Vec<Particle> {
    let mut order = ProgressiveOrder::default();
    order.grow(surface, seed, count);
    order.particles.truncate(order.len_of(count).unwrap_or_default());
    order.particles
}

/// Samples of a surface: `count` of them, but at most 8,192; none on an empty surface. They are spread as particles
/// are. Where faces lie on each other and leave too little room, samples that keep no distance from others are added,
/// evenly by area.
pub fn samples(surface: &Surface<'_>, count: usize, seed: u32) -> Vec<Particle> {
    let mut order = ProgressiveOrder::default();
    if surface.faces.is_empty() {
        return Vec::new();
    }
    let count = count.min(LEAST_COUNTED);
    let mut levels = Levels::new(&mut order, surface, seed, None);
    while levels.order.particles.len() < count {
        levels.throw_counted();
    }
    order.particles.truncate(count);
    order.particles
}

/// Particles in progressive order, and the state from which the order is continued. Continuing takes the time for the
/// added particles, and for one pass over those that are there. A crowded order begins anew.
#[derive(Clone, Debug, Default)]
pub struct ProgressiveOrder {
    /// The particles.
    pub particles: Vec<Particle>,
    /// For each particle its ordinal: about how many particles come before it in an order on the whole surface (fewer
    /// if that order is crowded). Empty if each ordinal is the particle's index.
    pub ordinals: Vec<f32>,
    /// How much of the order has been made.
    pub state: ProgressiveState,
}

impl ProgressiveOrder {
    /// Grows the order by whole levels until it has the first `count` particles ([`ProgressiveOrder::len_of`]), unless
    /// the surface is empty. Surface and seed must be those of the call before. The first particles are those that
    /// [`progressive`] gives.
    pub fn grow(&mut self, surface: &Surface<'_>, seed: u32, count: usize) {
        if surface.faces.is_empty() || self.len_of(count).is_some() {
            return;
        }
        // In a crowded order, tries depend on what earlier levels found in each cell. That is not remembered.
        if self.state.is_crowded() {
            *self = Self::default();
        }
        let mut levels = Levels::new(self, surface, seed, None);
        // Memory grows as particles are found. It is not reserved for the count asked for.
        while levels.order.len_of(count).is_none() {
            levels.throw();
        }
    }

    /// How many particles count as the first `count`: `count` itself, but in a crowded order the number of ordinals
    /// less than `count`, which may be smaller. `None` if the order does not reach that far.
    pub fn len_of(&self, count: usize) -> Option<usize> {
        self.state.len_of(count, self.particles.len(), &self.ordinals)
    }

    /// A new order. The first particles, whose ordinals are their indices, lie on the whole surface, all others where
    /// they are needed. There, except near the borders of what is needed, particles and ordinals are the same as in an
    /// order for the whole surface. They differ if `needed` is strict or faces lie on each other.
    pub fn where_needed(surface: &Surface<'_>, seed: u32, needed: &Needed) -> Self {
        let mut order = Self::default();
        if surface.faces.is_empty() {
            return order;
        }
        let most = f64::from(needed.most());
        let mut levels = Levels::new(&mut order, surface, seed, Some(needed));
        while levels.is_counting() {
            levels.throw_counted();
        }
        while levels.order.state.ordinal_at(levels.order.state.level_end as f64) < most
            && !levels.is_too_fine()
        {
            levels.throw_by_cells();
        }
        order
    }
}

/// Throws level after level of an order.
struct Levels<'a> {
    order: &'a mut ProgressiveOrder,
    surface: &'a Surface<'a>,
    seed: u32,
    candidates: Candidates<'a>,
    field: DartField,
    grid: DartGrid,
    /// About the least distance between different places on the surface.
    finest: f32,
    /// Where particles are needed; `None` if they are needed everywhere.
    needed: Option<&'a Needed>,
    /// How many particles found room in the last counted level, per particle that it was meant to add; 1 until this
    /// `Levels` has thrown a counted level.
    found: f64,
    /// Made when a level is first thrown cell by cell.
    cells: Option<ActiveCells<'a>>,
}

impl<'a> Levels<'a> {
    fn new(
        order: &'a mut ProgressiveOrder,
        surface: &'a Surface<'a>,
        seed: u32,
        needed: Option<&'a Needed>,
    ) -> Self {
        let positions = surface.mesh.positions.iter();
        let greatest = positions.map(|position| position.abs().max_element()).fold(0.0, f32::max);
        let grid = DartGrid::new(&surface.darts(&order.particles), spacing(surface, order.state.level_end));
        Self {
            order,
            surface,
            seed,
            candidates: Candidates::new(surface, seed),
            field: DartField::new(surface),
            grid,
            finest: FINEST * greatest,
            needed,
            found: 1.0,
            cells: None,
        }
    }

    /// Whether the next level's spacing is less than the least distance between distinct places on the surface. Places
    /// are f32, computed from f32 weights of the corners.
    fn is_too_fine(&self) -> bool {
        spacing(self.surface, next_level_end(self.order.state.level_end)) < self.finest
    }

    /// Whether the next level is a counted one, in which ordinals are indices.
    fn is_counting(&self) -> bool {
        self.order.particles.len() < LEAST_COUNTED && !self.order.state.is_crowded()
    }

    /// Throws the next level.
    fn throw(&mut self) {
        if self.is_counting() {
            self.throw_counted();
        } else {
            self.throw_by_cells();
        }
    }

    /// Throws a counted level, in which ordinals are indices.
    fn throw_counted(&mut self) {
        let Self { order: ProgressiveOrder { particles, state, .. }, candidates, field, grid, found, .. } =
            self;
        let level_begin = state.level_end;
        let level_end = next_level_end(level_begin);
        let radius = spacing(self.surface, level_end);
        grid.fit(radius);
        let tries = ((level_end - level_begin) * TRIES) as u32;
        let level = state.thrown..state.thrown.wrapping_add(tries);
        // Candidates are tested against the particles of earlier levels; the few that are left, against each other.
        let normal_of = |number: u32| candidates.particle(number).normal;
        let clear = clear_of(level.clone(), |numbers| {
            let mut darts = grid.in_order(candidates.darts(numbers));
            let accepted = Accepted { grid, particles, radius };
            darts.retain(|dart| field.is_clear(&accepted, dart, || normal_of(dart.number)));
            darts
        });
        let mut added = field.thinned(&level, &clear, radius, normal_of);
        *found = added.len() as f64 / (level_end - level_begin) as f64;
        let least = (level_end as f64 * LEAST_FILLED) as usize;
        let missing = least.saturating_sub(particles.len() + added.len());
        added.extend(level.clone().take(missing).map(|number| candidates.dart(number)));
        let numbers: Vec<u32> = added.iter().map(|dart| dart.number).collect();
        added.iter_mut().zip(particles.len() as u32..).for_each(|(dart, number)| dart.number = number);
        if added.len() < LEAST_CHUNK {
            particles.extend(candidates.particles(&numbers));
            grid.insert(&added);
        } else {
            let chosen = numbers.par_chunks(LEAST_CHUNK);
            let chosen = chosen.flat_map_iter(|numbers| candidates.particles(numbers));
            rayon::join(|| particles.par_extend(chosen), || grid.insert(&added));
        }
        *state = ProgressiveState { thrown: level.end, level_end, counted: [particles.len(), level_end] };
    }

    /// Throws a level cell by cell, where particles are needed.
    fn throw_by_cells(&mut self) {
        let Self { order, surface, field, grid, needed, found, .. } = self;
        let cells = self.cells.get_or_insert_with(|| ActiveCells::new(surface, *needed, *found));
        let ProgressiveOrder { particles, ordinals, state } = &mut **order;
        if ordinals.is_empty() {
            ordinals.extend((0..particles.len()).map(|index| index as f32));
        }
        let level_end = next_level_end(state.level_end);
        let level = CellLevel {
            seed: self.seed,
            ends: [state.level_end, level_end],
            state: *state,
            radius: spacing(surface, level_end),
        };
        grid.fit(level.radius);
        let accepted = Accepted { grid, particles, radius: level.radius };
        let mut added = level.added(surface, cells, field, &accepted);
        if needed.is_none() && !state.is_crowded() {
            // Where the spacing is too fine for f32, few tries are accepted. If the level then has less than half of
            // the particles that it was meant to add, candidates of the sequence, which is even by area, make up that
            // half.
            let least = (LEAST_FILLED * (level_end - state.level_end) as f64) as usize;
            let missing = least.saturating_sub(added.particles.len());
            let numbers: Vec<u32> =
                (0..missing as u32).map(|number| state.thrown.wrapping_add(number)).collect();
            added.particles.extend(self.candidates.particles(&numbers));
            added.ordinals.resize(added.particles.len(), level.ordinal(1.0));
            state.thrown = state.thrown.wrapping_add(missing as u32);
        }
        let mut darts = surface.darts(&added.particles);
        darts.iter_mut().zip(particles.len() as u32..).for_each(|(dart, number)| dart.number = number);
        grid.insert(&darts);
        particles.append(&mut added.particles);
        ordinals.append(&mut added.ordinals);
        state.level_end = level_end;
    }
}

/// A level's candidates that no accepted particle crowds, in any order. `of_chunk` finds them among the candidates with
/// the numbers that it is given.
fn clear_of(level: Range<u32>, of_chunk: impl Fn(Range<u32>) -> Vec<Dart> + Sync) -> Vec<Dart> {
    let threads = rayon::current_num_threads();
    let chunk = (level.len() / (2 * threads)).clamp(LEAST_CHUNK, MOST_CHUNK);
    if level.len() <= chunk {
        return of_chunk(level);
    }
    let firsts: Vec<u32> = level.clone().step_by(chunk).collect();
    let numbers = |first: u32| first..level.end.min(first.saturating_add(chunk as u32));
    let found: Vec<Vec<Dart>> = firsts.into_par_iter().map(|first| of_chunk(numbers(first))).collect();
    found.concat()
}
