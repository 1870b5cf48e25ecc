//! A coat's particles: the first ones of a progressive order. More of that order may have been sampled than the coat
//! needs.

use std::ops::Range;
use std::sync::Arc;

use glam::Vec3;
use impasto_core::sampling::{PackedParticle, Particle};
use rayon::prelude::*;

use crate::body::BodySurface;

/// The first particles of an order, on a surface at rest. Only their places are stored; all else is computed when it is asked for.
#[derive(Clone)]
pub struct Particles {
    /// The same `Arc` in all `Particles` of one order, however many of its particles have been sampled; compared by
    /// address.
    order: Arc<()>,
    all: Arc<Vec<PackedParticle>>,
    surface: Arc<BodySurface>,
    count: usize,
}

/// Equal where they are the same particles of the same order.
impl PartialEq for Particles {
    fn eq(&self, other: &Self) -> bool {
        self.same_order(other) && self.count == other.count
    }
}

impl Particles {
    /// The first `count` of a new order on a surface at rest.
    pub(crate) fn new(surface: &Arc<BodySurface>, all: Arc<Vec<PackedParticle>>, count: usize) -> Self {
        let count = count.min(all.len());
        Self { order: Arc::new(()), all, surface: Arc::clone(surface), count }
    }

    /// The first `count` of the same order, if so many have been sampled.
    pub(crate) fn first(&self, count: usize) -> Option<Self> {
        (count <= self.all.len()).then(|| Self { count, ..self.clone() })
    }

    /// The same order with more particles.
    pub(crate) fn continued(&self, all: Arc<Vec<PackedParticle>>, count: usize) -> Self {
        Self { count: count.min(all.len()), all, ..self.clone() }
    }

    /// Whether one is the beginning of the other.
    pub(crate) fn same_order(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.order, &other.order)
    }

    /// The places of all particles of the order that have been sampled.
    pub(crate) fn places(&self) -> &Arc<Vec<PackedParticle>> {
        &self.all
    }

    /// How many.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// One of them; `index` is less than [`Particles::len`].
    #[inline]
    pub fn at(&self, index: usize) -> Particle {
        self.place_on_surface(self.all[..self.count][index])
    }

    /// One of them, if there are so many.
    pub fn get(&self, index: usize) -> Option<Particle> {
        (index < self.count).then(|| self.at(index))
    }

    /// All of them, in progressive order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Particle> + '_ {
        self.all[..self.count].iter().map(|&place| self.place_on_surface(place))
    }

    /// Positions and unit normals of all of them, in model space.
    pub(crate) fn points(&self) -> (Vec<Vec3>, Vec<Vec3>) {
        let point = |particle: Particle| (particle.position, particle.normal);
        self.par_range(0..self.count).map(point).unzip()
    }

    /// Index of the triangle of one of them.
    #[inline]
    pub(crate) fn triangle(&self, index: usize) -> usize {
        self.all[index].triangle()
    }

    /// Those of a range, on all threads.
    pub(crate) fn par_range(
        &self,
        range: Range<usize>,
    ) -> impl IndexedParallelIterator<Item = Particle> + '_ {
        self.all[range].par_iter().map(|&place| self.place_on_surface(place))
    }

    #[inline]
    fn place_on_surface(&self, place: PackedParticle) -> Particle {
        place.on(&self.surface.mesh)
    }
}
