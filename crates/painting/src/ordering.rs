//! Puts particles into painting order. They are sorted by the number `layer` of their region, low first; then by layer
//! of paint, in the scene's order; then by rank, high first.

use std::cmp::Reverse;
use std::collections::binary_heap::PeekMut;
use std::collections::{BTreeMap, BinaryHeap};
use std::sync::Arc;

use impasto_scene::presets::LayerKind;
use rayon::prelude::*;

use crate::coat::Coat;
use crate::order::{PaintingOrder, begins};
use crate::particles::Particles;
use crate::regions::RegionRule;
use crate::traits::Traits;

pub(crate) struct OrderInputs {
    /// The layers of paint, the lowest first.
    kinds: [LayerKind; 7],
    coats: Vec<OrderedCoat>,
    /// For each rule, the number `layer` of its stroke settings. Empty if all rules have the same.
    layers: Vec<i32>,
}

struct OrderedCoat {
    kind: LayerKind,
    name_hash: u32,
    particles: Particles,
    /// See [`crate::coat::Sampled::count_on_whole`].
    count_on_whole: usize,
    /// Tells the region of each particle; `None` if all rules have the same number `layer`.
    traits: Option<Arc<Traits>>,
}

impl PartialEq for OrderedCoat {
    fn eq(&self, other: &Self) -> bool {
        let same_regions = match (&self.traits, &other.traits) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b) || a.same_regions(b),
            (a, b) => a.is_none() && b.is_none(),
        };
        (self.kind, self.name_hash, self.count_on_whole)
            == (other.kind, other.name_hash, other.count_on_whole)
            && self.particles == other.particles
            && same_regions
    }
}

impl PartialEq for OrderInputs {
    fn eq(&self, other: &Self) -> bool {
        self.kinds == other.kinds && self.coats == other.coats && self.layers == other.layers
    }
}

impl OrderInputs {
    pub(crate) fn new(coats: &[Arc<Coat>], rules: &[RegionRule], kinds: [LayerKind; 7]) -> Self {
        let layers: Vec<i32> = rules.iter().map(|rule| rule.strokes.layer).collect();
        let one_layer = layers.windows(2).all(|pair| pair[0] == pair[1]);
        let coats = coats
            .iter()
            .map(|coat| OrderedCoat {
                kind: coat.kind,
                name_hash: coat.traits.name_hash,
                particles: coat.sampled.particles.clone(),
                count_on_whole: coat.sampled.count_on_whole,
                traits: (!one_layer).then(|| Arc::clone(&coat.traits)),
            })
            .collect();
        Self { kinds, coats, layers: if one_layer { Vec::new() } else { layers } }
    }

    /// All particles in painting order; equal ranks of two objects are ordered by the hash of their names.
    pub(crate) fn order(&self) -> PaintingOrder {
        let (firsts, _) = begins(self.coats.iter().map(|coat| coat.particles.len()));
        let mut runs: BTreeMap<(i32, Option<usize>), Vec<Queue<'_>>> = BTreeMap::new();
        for (index, coat) in self.coats.iter().enumerate() {
            let place = self.kinds.iter().position(|kind| *kind == coat.kind);
            for (layer, particles) in coat.by_layer(&self.layers) {
                let queue = Queue { first: firsts[index], coat, particles };
                runs.entry((layer, place)).or_default().push(queue);
            }
        }
        let runs: Vec<Vec<Queue<'_>>> = runs.into_values().collect();
        let runs: Vec<Vec<u32>> = runs.into_par_iter().map(merged).collect();
        PaintingOrder::new(runs.concat(), firsts)
    }
}

impl OrderedCoat {
    /// The coat's particles, grouped by the number `layer` of their regions, each group in progressive order.
    fn by_layer(&self, layers: &[i32]) -> BTreeMap<i32, LayerParticles> {
        let Some(traits) = &self.traits else {
            return BTreeMap::from([(0, LayerParticles::First(self.particles.len() as u32))]);
        };
        let mut of_layer: BTreeMap<i32, Vec<u32>> = BTreeMap::new();
        for particle in 0..self.particles.len() {
            let layer = layers[usize::from(traits.region(particle))];
            of_layer.entry(layer).or_default().push(particle as u32);
        }
        of_layer.into_iter().map(|(layer, particles)| (layer, LayerParticles::These(particles))).collect()
    }
}

/// The particles of a coat whose regions have the same number `layer`, in progressive order.
enum LayerParticles {
    /// This many particles, the first ones of the coat.
    First(u32),
    These(Vec<u32>),
}

/// Those of a coat's [`LayerParticles`] that are not in the order yet. They are taken from the end.
struct Queue<'a> {
    /// The number of the coat's first particle.
    first: u32,
    coat: &'a OrderedCoat,
    particles: LayerParticles,
}

impl Queue<'_> {
    fn len(&self) -> usize {
        match &self.particles {
            LayerParticles::First(count) => *count as usize,
            LayerParticles::These(particles) => particles.len(),
        }
    }

    fn pop(&mut self) -> Option<u32> {
        match &mut self.particles {
            LayerParticles::First(count) => {
                *count = count.checked_sub(1)?;
                Some(*count)
            }
            LayerParticles::These(particles) => particles.pop(),
        }
    }

    /// Twice the rank of a particle, (2 ordinal + 1) / count, as bits: the bits of positive floats sort as the floats
    /// do.
    fn rank(&self, particle: u32) -> u64 {
        let ordinal = f64::from(self.coat.particles.ordinal(particle as usize));
        ((ordinal * 2.0 + 1.0) / self.coat.count_on_whole as f64).to_bits()
    }
}

/// The next particle of a queue as the heap compares it. The highest rank comes first; of equal ranks the least hash of
/// the name, then the least particle, then the least index of the queue.
type Head = (u64, Reverse<(u32, u32, usize)>);

/// Merges queues, each of which has its highest rank at its end, into one list with the highest rank first. Returns the
/// particles' numbers, as in [`PaintingOrder`].
fn merged(mut queues: Vec<Queue<'_>>) -> Vec<u32> {
    let mut order = Vec::with_capacity(queues.iter().map(|queue| queue.len()).sum());
    let mut heads: BinaryHeap<Head> = BinaryHeap::new();
    for (index, queue) in queues.iter_mut().enumerate() {
        if let Some(particle) = queue.pop() {
            heads.push((queue.rank(particle), Reverse((queue.coat.name_hash, particle, index))));
        }
    }
    while let Some(mut head) = heads.peek_mut() {
        let (_, Reverse((_, particle, index))) = *head;
        let queue = &mut queues[index];
        order.push(queue.first + particle);
        match queue.pop() {
            Some(next) => *head = (queue.rank(next), Reverse((queue.coat.name_hash, next, index))),
            None => drop(PeekMut::pop(head)),
        }
    }
    order
}
