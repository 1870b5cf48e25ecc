//! Decides which candidates of dart throwing are accepted.

use std::ops::Range;

use glam::Vec3;
use rayon::prelude::*;

use super::dart_grid::{Dart, DartGrid, Visitor};
use super::face_cones::FaceCones;
use super::levels::LEAST_CHUNK;
use super::{Particle, Surface};

/// Stands for no dart, in place of an index.
const NONE: u32 = u32::MAX;

/// The particles of earlier levels, and the least distance that the present level keeps from them.
pub(super) struct Accepted<'a> {
    pub(super) grid: &'a DartGrid,
    pub(super) particles: &'a [Particle],
    pub(super) radius: f32,
}

/// Tells which candidates are crowded, by accepted particles or by each other.
pub(super) struct DartField {
    /// For most pairs of candidates, they tell whether both are on the same side of the surface.
    cones: FaceCones,
}

impl DartField {
    pub(super) fn new(surface: &Surface<'_>) -> Self {
        Self { cones: FaceCones::new(surface) }
    }

    /// Whether no accepted particle crowds a candidate, whose normal `own_normal` finds.
    #[inline(always)]
    pub(super) fn is_clear(
        &self,
        accepted: &Accepted<'_>,
        dart: &Dart,
        own_normal: impl Fn() -> Vec3,
    ) -> bool {
        let mut crowds = Crowds { cones: &self.cones, accepted, dart, own_normal, normal: None };
        !accepted.grid.visit_near(dart.position, accepted.radius, &mut crowds)
    }

    /// Goes through the darts of a level in order of their numbers, and drops each dart that is crowded by an earlier
    /// one which was kept. Returns the kept darts in this order. `normal_of` finds a dart's normal from its number.
    pub(super) fn thinned(
        &self,
        level: &Range<u32>,
        darts: &[Dart],
        radius: f32,
        normal_of: impl Fn(u32) -> Vec3 + Sync,
    ) -> Vec<Dart> {
        let grid = DartGrid::new(darts, radius);
        let rivals = |dart: &Dart| {
            let mut rivals = Rivals {
                cones: &self.cones,
                dart,
                normal_of: &normal_of,
                first: level.start,
                found: Vec::new(),
            };
            grid.visit_near(dart.position, radius, &mut rivals);
            rivals.found
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
            // Pairs are sorted, so all pairs that could drop the earlier dart have been handled.
            if stays[earlier as usize] != NONE {
                stays[later as usize] = NONE;
            }
        }
        stays.into_iter().filter(|&index| index != NONE).map(|index| darts[index as usize]).collect()
    }
}

/// Ends a search at the first particle that is on the candidate's side of the surface.
struct Crowds<'a, F> {
    cones: &'a FaceCones,
    accepted: &'a Accepted<'a>,
    dart: &'a Dart,
    own_normal: F,
    /// The candidate's normal, found when it is first needed.
    normal: Option<Vec3>,
}

impl<F: Fn() -> Vec3> Visitor for Crowds<'_, F> {
    #[inline(always)]
    fn ends_at(&mut self, face: u32, number: u32) -> bool {
        match self.cones.same_side(self.dart.face, face) {
            Some(same) => same,
            None => {
                let normal = *self.normal.get_or_insert_with(&self.own_normal);
                self.accepted.particles[number as usize].normal.dot(normal) > 0.0
            }
        }
    }
}

/// Notes which earlier darts crowd a dart.
struct Rivals<'a, F> {
    cones: &'a FaceCones,
    dart: &'a Dart,
    normal_of: &'a F,
    /// The first number of the level.
    first: u32,
    /// Pairs of numbers, the dart's and a rival's, both counted from `first`.
    found: Vec<(u32, u32)>,
}

impl<F: Fn(u32) -> Vec3> Visitor for Rivals<'_, F> {
    #[inline(always)]
    fn ends_at(&mut self, face: u32, number: u32) -> bool {
        let Self { dart, normal_of, .. } = self;
        let is_crowded = number < dart.number
            && self
                .cones
                .same_side(dart.face, face)
                .unwrap_or_else(|| normal_of(number).dot(normal_of(dart.number)) > 0.0);
        if is_crowded {
            self.found.push((dart.number - self.first, number - self.first));
        }
        false
    }
}
