//! The levels of a progressive order: how many particles each is meant to have, and how far apart; and the state of an
//! order between two levels.

use super::{Surface, hexagonal_spacing};

/// Least distance between the particles of a level. It is a share of the hexagonal spacing for the number of particles
/// that the level is meant to end with.
const SPACING: f64 = 0.60;

/// Candidates thrown per particle that a level is meant to add. More is smoother and slower.
pub(super) const TRIES: usize = 16;

/// A level is meant to end with this many times the particles that it is meant to begin with.
const GROWTH: f64 = 1.08;

/// How many particles a level adds, as a share of those that it is meant to add. Measured: 1.043 to 1.044 on a sheet, a
/// ball and a creased sheet; 1.104 on a rod. The share may exceed 1, because the level's spacing follows from the
/// number meant, and nothing stops the level at that number.
const FILLED: f64 = 1.0433;

/// Where there is too little room (faces on top of each other, the first few particles of a thin rod), a counted level
/// is filled up to this share of the particles that it is meant to end with. A later level is filled up to this share
/// of those that it is meant to add, if the order is not crowded and lies on the whole surface. Particles that fill up
/// keep no distances.
pub(super) const LEAST_FILLED: f64 = 0.5;

/// An order that is meant to have fewer particles than this is never crowded: its spacings are so wide that the leaves
/// of a tree would seem to lie on each other.
const CROWDED_FROM: usize = 2048;

/// The fewest darts that one task handles: fewer are not worth another thread.
pub(super) const LEAST_CHUNK: usize = 1024;

/// How much of a progressive order has been made.
///
/// The first levels, up to at least 8,192 particles, are counted: they are thrown on the whole surface, and the ordinal
/// of a particle is its index. Later levels may be thrown on a part of the surface only, where the particles before a
/// given one cannot be counted. So in all later levels a particle's ordinal is computed from its turn among the tries
/// of its level. In this way neither a particle nor its ordinal depends on what is far away. How many tries a cell gets
/// depends on what earlier levels found there, but only in a crowded order ([`ProgressiveState::is_crowded`]) and in a
/// strict one ([`super::Needed::is_strict`]). As soon as an order is known to be crowded, its counted levels end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProgressiveState {
    /// How many candidates of the sequence have been used. Levels that are thrown cell by cell make candidates of
    /// their own, and use the sequence only to fill up.
    pub(super) thrown: u32,
    /// How many particles the last level was meant to end with.
    pub(super) level_end: usize,
    /// At the end of the last level in which ordinals are indices: how many particles there were, and how many there
    /// were meant to be.
    pub(super) counted: [usize; 2],
}

impl Default for ProgressiveState {
    /// Before the first particle.
    fn default() -> Self {
        Self { thrown: 0, level_end: 1, counted: [0, 1] }
    }
}

impl ProgressiveState {
    /// The state as numbers, to be stored for another process.
    pub fn to_numbers(self) -> [u64; 4] {
        let [count, level_end] = self.counted.map(|number| number as u64);
        [u64::from(self.thrown), self.level_end as u64, count, level_end]
    }

    /// The state for which [`ProgressiveState::to_numbers`] gave these numbers; `None` for numbers that it never gives.
    pub fn from_numbers([thrown, level_end, count, counted_end]: [u64; 4]) -> Option<Self> {
        let whole = |number: u64| usize::try_from(number).ok();
        let level_end = whole(level_end).filter(|&end| end > 0)?;
        let counted = [whole(count)?, whole(counted_end).filter(|&end| (1..=level_end).contains(&end))?];
        Some(Self { thrown: u32::try_from(thrown).ok()?, level_end, counted })
    }

    /// Whether an order on the whole surface may be in this state with this many particles.
    pub fn fits(self, particles: usize) -> bool {
        // Unless an order is crowded, levels are at least half filled. Only a quarter is asked for here, which leaves
        // room for rounding.
        let is_filled = self.is_crowded() || self.level_end / 4 <= particles.saturating_add(1);
        self.counted[0] <= particles && is_filled
    }

    /// [`super::ProgressiveOrder::len_of`] of an order in this state, from the number of its particles and their
    /// ordinals.
    pub fn len_of(self, count: usize, particles: usize, ordinals: &[f32]) -> Option<usize> {
        if !self.is_crowded() || ordinals.is_empty() {
            return (count <= particles).then_some(count);
        }
        let has_all = self.ordinal_at(self.level_end as f64) >= count as f64;
        has_all.then(|| ordinals.partition_point(|&ordinal| ordinal < count as f32))
    }

    /// How many particles, from the first on, have their indices as ordinals.
    pub fn counted(self) -> usize {
        self.counted[0]
    }

    /// Whether the counted levels ended with hardly more than half of the particles that they were meant to end with,
    /// as where several faces lie on each other. From then on, particles are only added where there is room: where
    /// several faces coincide, as many as one of them holds. When a later call asks for more, the order is made anew.
    pub(super) fn is_crowded(self) -> bool {
        let [count, level_end] = self.counted;
        level_end >= CROWDED_FROM && (count as f64) < 1.1 * LEAST_FILLED * level_end as f64
    }

    /// The ordinal of a particle that is added when the order is meant to have `meant` particles.
    #[inline(always)]
    pub(super) fn ordinal_at(self, meant: f64) -> f64 {
        let [count, level_end] = self.counted.map(|number| number as f64);
        count + FILLED * (meant - level_end)
    }
}

/// How many particles a level is meant to end with if it is meant to begin with `level_begin`.
pub(super) fn next_level_end(level_begin: usize) -> usize {
    (level_begin + 1).max((level_begin as f64 * GROWTH) as usize)
}

/// The least distance between the particles of a level that is meant to end with `level_end` particles.
pub(super) fn spacing(surface: &Surface<'_>, level_end: usize) -> f32 {
    (SPACING * hexagonal_spacing(surface.area(), level_end)) as f32
}
