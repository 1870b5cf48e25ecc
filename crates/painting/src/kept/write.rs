//! Collects what is to be kept of a painting, and writes it.

use std::io::{self, Write};

use impasto_scene::presets::LayerKind;

use super::KeptKey;
use super::arrays::ArraysToWrite;
use super::contents::{CoatNumbers, Sizes};
use crate::coat::Coat;
use crate::counts::Counted;
use crate::painting::Painting;
use crate::paper::KeptPolygons;

/// The arrays of a painting that are to be kept, ready to be written.
pub struct ToKeep<'a>(ArraysToWrite<'a>);

impl ToKeep<'_> {
    /// How many bytes are written.
    pub fn bytes(&self) -> u64 {
        self.0.bytes()
    }

    /// Writes them under the painting's key.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, key: &KeptKey, out: &mut dyn Write) -> io::Result<()> {
        self.0.write(key, out)
    }
}

impl Painting {
    /// The arrays to be kept for another process that prepares the same scene. `None` if there was a fault (a point
    /// cache that could not be read any more), because the wrong results would be kept too.
    pub fn to_keep(&self) -> Option<ToKeep<'_>> {
        if !self.faults().is_empty() {
            return None;
        }
        let mut arrays = ArraysToWrite::default();
        arrays.push_made(&[Sizes {
            objects: self.bodies.len() as u64,
            rules: self.rules.len() as u64,
            brushes: self.brushes.names.len() as u64,
        }]);
        for mark in self.brushes.marks.iter().flat_map(|marks| marks.iter()) {
            arrays.push(&mark.texels);
        }
        for (object, body) in self.bodies.iter().enumerate() {
            let coats = LayerKind::ALL.map(|kind| self.coat(object, kind));
            let has = coats.map(|coat| u64::from(coat.is_some()));
            let Counted { counts, may_depend_on_views, more_wanted, deepness } = body.counts.counted;
            arrays.push_made(&[counts.map(|count| count as u64), may_depend_on_views.map(u64::from), has]);
            arrays.push_made(&[[more_wanted, deepness].map(f64::to_bits)]);
            coats.into_iter().flatten().for_each(|coat| push_coat(coat, &mut arrays));
        }
        let [numbers, firsts] = self.order.to_keep();
        arrays.push(numbers);
        arrays.push(firsts);
        Some(ToKeep(arrays))
    }
}

fn push_coat<'a>(coat: &'a Coat, arrays: &mut ArraysToWrite<'a>) {
    let Coat { sampled, lift_sources, traits, baked, .. } = coat;
    let particles = sampled.particles.sampled();
    let neighbours = lift_sources.neighbours.as_ref().map(|lists| lists.arrays());
    let polygons = sampled.polygons.as_ref().map(|polygons| polygons.to_keep());
    arrays.push_made(&[CoatNumbers {
        count: sampled.particles.len() as u64,
        count_on_whole: sampled.count_on_whole as u64,
        state: particles.state.to_numbers(),
        area: sampled.area.to_bits(),
        is_everywhere: u64::from(sampled.is_everywhere),
        has_angles: u64::from(baked.looks.has_angles()),
        has_polygons: u64::from(polygons.is_some()),
        has_neighbours: u64::from(neighbours.is_some()),
        most_neighbours: neighbours.map_or(0, |lists| lists.most as u64),
    }]);
    arrays.push(&particles.places);
    arrays.push(&particles.ordinals);
    arrays.push(sampled.albedo_of_particles());
    arrays.push(traits.dabbed());
    let placed = &baked.placed;
    for array in placed.position.iter().chain(&placed.normal) {
        arrays.push(array);
    }
    arrays.push_made(&baked.looks.to_words());
    arrays.push(&baked.flatness);
    if let Some(KeptPolygons { of_particle, sides, faces }) = polygons {
        arrays.push_made(&of_particle);
        arrays.push(sides);
        arrays.push_made(&faces);
    }
    if let Some(lists) = neighbours {
        arrays.push(lists.slots);
        arrays.push(lists.lengths);
        arrays.push(lists.indices);
    }
}
