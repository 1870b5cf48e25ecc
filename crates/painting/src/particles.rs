//! A coat's particles: the first ones of a progressive order. More of that order may have been sampled than the coat
//! needs.

use std::ops::Range;
use std::sync::Arc;

use glam::Vec3;
use impasto_core::hash;
use impasto_core::sampling::{PackedParticle, Particle, ProgressiveOrder, ProgressiveState};
use rayon::prelude::*;

use crate::body::BodySurface;

/// The first particles of a progressive order, on a surface at rest. Only their places are stored; all else is computed
/// when it is asked for.
#[derive(Clone)]
pub struct Particles {
    /// The same `Arc` in all `Particles` of one order, however many of its particles have been sampled; compared by
    /// address.
    order: Arc<()>,
    sampled: Arc<SampledPlaces>,
    surface: Arc<BodySurface>,
    count: usize,
}

/// The places of all particles that have been sampled of a progressive order.
#[derive(Clone, Debug, Default)]
pub(crate) struct SampledPlaces {
    pub(crate) places: Vec<PackedParticle>,
    /// See [`ProgressiveOrder::ordinals`].
    pub(crate) ordinals: Vec<f32>,
    /// Where sampling goes on when more particles are wanted.
    pub(crate) state: ProgressiveState,
}

impl SampledPlaces {
    /// The places of a progressive order.
    pub(crate) fn of(order: &ProgressiveOrder) -> Self {
        Self {
            places: order.particles.iter().map(PackedParticle::of).collect(),
            ordinals: order.ordinals.clone(),
            state: order.state,
        }
    }

    /// How many particles count as the first `wanted`: `wanted` itself, but in a crowded order maybe fewer. `None` if
    /// the order has not been sampled that far. See [`ProgressiveOrder::len_of`].
    pub(crate) fn len_of(&self, wanted: usize) -> Option<usize> {
        self.state.len_of(wanted, self.places.len(), &self.ordinals)
    }

    /// Particles without a progressive order: their ordinals are their indices.
    pub(crate) fn unordered(places: Vec<PackedParticle>) -> Self {
        Self { places, ..Self::default() }
    }
}

/// Equal where they are the same particles of the same order.
impl PartialEq for Particles {
    fn eq(&self, other: &Self) -> bool {
        self.same_order(other) && self.count == other.count
    }
}

impl Particles {
    /// The first `count` of a new order on a surface at rest.
    pub(crate) fn new(surface: &Arc<BodySurface>, sampled: SampledPlaces, count: usize) -> Self {
        let count = count.min(sampled.places.len());
        Self { order: Arc::new(()), sampled: Arc::new(sampled), surface: Arc::clone(surface), count }
    }

    /// The particles that count as the first `wanted` of the same order, if it has been sampled that far.
    pub(crate) fn first(&self, wanted: usize) -> Option<Self> {
        self.sampled.len_of(wanted).map(|count| Self { count, ..self.clone() })
    }

    /// The first `count` of the same order, after more of it was sampled.
    pub(crate) fn continued(&self, sampled: SampledPlaces, count: usize) -> Self {
        Self { count: count.min(sampled.places.len()), sampled: Arc::new(sampled), ..self.clone() }
    }

    /// Whether both are the first particles of one order, so that the shorter is the beginning of the longer. Orders
    /// that were made separately never count as one.
    pub(crate) fn same_order(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.order, &other.order)
    }

    /// The places of all sampled particles of the order, which may be more than [`Particles::len`].
    pub(crate) fn places(&self) -> &[PackedParticle] {
        &self.sampled.places
    }

    pub(crate) fn sampled(&self) -> &SampledPlaces {
        &self.sampled
    }

    /// The ordinals of all particles; empty where they are the particles' indices. Later particles may lie on a part of
    /// the surface only. An ordinal says about how many would come before the particle if they lay on all of it.
    pub(crate) fn ordinals(&self) -> &[f32] {
        self.sampled.ordinals.get(..self.count).unwrap_or_default()
    }

    #[inline]
    pub(crate) fn ordinal(&self, index: usize) -> f32 {
        self.sampled.ordinals.get(index).copied().unwrap_or(index as f32)
    }

    /// Random bits of a particle. They stay the same however many other particles there are: they are made from its
    /// index if it is one of the first, whose ordinals are their indices, else from its place.
    #[inline]
    pub(crate) fn random_bits(&self, index: usize, seed: u32) -> u32 {
        let SampledPlaces { places, ordinals, state } = &*self.sampled;
        if ordinals.is_empty() || index < state.counted() {
            hash::combine(seed, index as u32)
        } else {
            places[index].random_bits(seed)
        }
    }

    /// How many particles there are.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// A particle; `index` is less than [`Particles::len`].
    #[inline]
    pub fn at(&self, index: usize) -> Particle {
        self.place_on_surface(self.sampled.places[..self.count][index])
    }

    /// A particle; `None` if `index` is not less than [`Particles::len`].
    pub fn get(&self, index: usize) -> Option<Particle> {
        (index < self.count).then(|| self.at(index))
    }

    /// All particles, in progressive order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Particle> + '_ {
        self.sampled.places[..self.count].iter().map(|&place| self.place_on_surface(place))
    }

    /// Positions and unit normals of all particles, in model space.
    pub(crate) fn points(&self) -> (Vec<Vec3>, Vec<Vec3>) {
        let point = |particle: Particle| (particle.position, particle.normal);
        self.par_range(0..self.count).map(point).unzip()
    }

    #[inline]
    pub(crate) fn triangle(&self, index: usize) -> usize {
        self.sampled.places[index].triangle()
    }

    /// The particles of a range, on all threads.
    pub(crate) fn par_range(
        &self,
        range: Range<usize>,
    ) -> impl IndexedParallelIterator<Item = Particle> + '_ {
        self.sampled.places[range].par_iter().map(|&place| self.place_on_surface(place))
    }

    #[inline]
    fn place_on_surface(&self, place: PackedParticle) -> Particle {
        place.on(&self.surface.mesh)
    }
}
