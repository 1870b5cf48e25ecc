//! A coat's particles: the beginning of a progressive order that may be kept longer than it is needed.

use std::ops::Deref;
use std::sync::Arc;

use impasto_core::sampling::Particle;

/// The first particles of an order.
#[derive(Clone)]
pub(crate) struct Particles {
    /// Stands for the order, whatever of it is there.
    order: Arc<()>,
    all: Arc<Vec<Particle>>,
    count: usize,
}

impl Particles {
    /// The first `count` of a new order.
    pub(crate) fn new(all: Arc<Vec<Particle>>, count: usize) -> Self {
        let count = count.min(all.len());
        Self { order: Arc::new(()), all, count }
    }

    /// As many of the same order, if so many are there.
    pub(crate) fn first(&self, count: usize) -> Option<Self> {
        (count <= self.all.len()).then(|| Self { count, ..self.clone() })
    }

    /// The same order with more particles.
    pub(crate) fn continued(&self, all: Arc<Vec<Particle>>, count: usize) -> Self {
        Self { order: Arc::clone(&self.order), ..Self::new(all, count) }
    }

    /// Whether one is the beginning of the other.
    pub(crate) fn same_order(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.order, &other.order)
    }

    /// Whether they are the very same.
    pub(crate) fn same(&self, other: &Self) -> bool {
        self.same_order(other) && self.count == other.count
    }

    /// All that is there of the order.
    pub(crate) fn all(&self) -> &Arc<Vec<Particle>> {
        &self.all
    }
}

impl Deref for Particles {
    type Target = [Particle];

    fn deref(&self) -> &[Particle] {
        &self.all[..self.count]
    }
}
