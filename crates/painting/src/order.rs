//! The painting order: the regions' layers, the layers of paint, then rank from high to low.

use std::collections::BTreeMap;
use std::sync::Arc;

use impasto_scene::presets::LayerKind;
use rayon::prelude::*;

use crate::coat::Coat;
use crate::regions::RegionRule;
use crate::seats::Seats;

/// A particle's place in the painting order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct OrderEntry {
    pub(crate) coat: u32,
    pub(crate) particle: u32,
}

/// All that the order depends on.
pub(crate) struct OrderInputs {
    coats: Vec<OrderedCoat>,
    /// The regions' layers, by rule.
    layers: Vec<i32>,
}

struct OrderedCoat {
    kind: LayerKind,
    name_hash: u32,
    count: usize,
    /// The regions of the particles, where those decide.
    seats: Option<Arc<Seats>>,
}

/// Particles of one layer of paint: the bits of a rank, the hash of the object's name, the particle.
type Run = Vec<(u64, u32, OrderEntry)>;

impl PartialEq for OrderedCoat {
    fn eq(&self, other: &Self) -> bool {
        let same_regions = match (&self.seats, &other.seats) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b) || a.same_regions(b),
            (a, b) => a.is_none() && b.is_none(),
        };
        (self.kind, self.name_hash, self.count) == (other.kind, other.name_hash, other.count) && same_regions
    }
}

impl PartialEq for OrderInputs {
    fn eq(&self, other: &Self) -> bool {
        self.coats == other.coats && self.layers == other.layers
    }
}

impl OrderInputs {
    pub(crate) fn new(coats: &[Arc<Coat>], rules: &[RegionRule]) -> Self {
        let layers: Vec<i32> = rules.iter().map(|rule| rule.strokes.layer).collect();
        let one_layer = layers.windows(2).all(|pair| pair[0] == pair[1]);
        let coats = coats
            .iter()
            .map(|coat| OrderedCoat {
                kind: coat.kind,
                name_hash: coat.seats.name_hash,
                count: coat.sampled.particles.len(),
                seats: (!one_layer).then(|| Arc::clone(&coat.seats)),
            })
            .collect();
        Self { coats, layers: if one_layer { Vec::new() } else { layers } }
    }

    /// All particles in painting order; equal ranks of two objects by name.
    pub(crate) fn order(&self) -> Vec<OrderEntry> {
        // Each layer is a few lists that are sorted already.
        let mut runs: BTreeMap<(i32, LayerKind), Run> = BTreeMap::new();
        for (index, coat) in self.coats.iter().enumerate() {
            for particle in (0..coat.count).rev() {
                let layer = match &coat.seats {
                    Some(seats) => self.layers[usize::from(seats.region(particle))],
                    None => 0,
                };
                // Twice the order plus one over the count is the rank, compared without rounding.
                let rank = (particle as u64 * 2 + 1) as f64 / coat.count as f64;
                let entry = OrderEntry { coat: index as u32, particle: particle as u32 };
                runs.entry((layer, coat.kind)).or_default().push((rank.to_bits(), coat.name_hash, entry));
            }
        }
        let mut runs: Vec<Run> = runs.into_values().collect();
        runs.par_iter_mut().for_each(|run| {
            run.sort_by_key(|&(rank, name_hash, entry)| (std::cmp::Reverse(rank), name_hash, entry.particle));
        });
        runs.iter().flatten().map(|&(.., entry)| entry).collect()
    }
}
