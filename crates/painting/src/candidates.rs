//! Finds the strokes of a frame: a quick test picks the particles that may show, then the strokes of those are
//! computed.

use impasto_core::solve::Bounds;
use impasto_scene::presets::LayerKind;
use rayon::prelude::*;

use crate::frame::{LayerRun, Lines, Quality, Stroke, StrokeSource, Strokes};
use crate::looks::Looks;
use crate::order::{OrderEntry, PaintingOrder};
use crate::painting_view::{CoatView, PaintingView};
use crate::recall::Recall;
use crate::size_follow::MOST_GROWTH;
use crate::stroke::Candidate;
use crate::surface::HOLE;

/// How many candidates are read before any of them is tested; also the fewest looks that a task is meant to find.
const BATCH: usize = 64;

/// How many particles one task takes.
const CHUNK: usize = 64 * Recall::WORD;

/// The number `layer` of a region, and the layer of paint. All strokes of one key lie together in the painting order.
type LayerKey = (i32, LayerKind);

/// Strokes of particles that follow each other in the painting order.
#[derive(Default)]
struct Found {
    strokes: Vec<Stroke>,
    sources: Vec<StrokeSource>,
    layers: Vec<(LayerKey, LayerRun)>,
}

impl Found {
    fn add(&mut self, view: &PaintingView<'_>, candidate: &Candidate) {
        let Some((stroke, source)) = view.stroke(candidate) else { return };
        let rule = &view.painting.rules[usize::from(candidate.region)];
        let kind = view.coats[candidate.entry.coat as usize].coat.kind;
        let layer = (rule.strokes.layer, kind);
        match self.layers.last_mut() {
            Some((last, run)) if *last == layer => run.count += 1,
            _ => {
                let first = self.strokes.len() as u32;
                self.layers.push((layer, LayerRun { order: rule.strokes.layer, kind, first, count: 1 }));
            }
        }
        self.strokes.push(stroke);
        self.sources.push(source);
    }
}

impl PaintingView<'_> {
    /// The strokes of all particles, or, with a recall, of those that it asks for.
    pub(crate) fn strokes(&self) -> Strokes {
        let numbers = self.painting.order.numbers();
        let may_show: Vec<Vec<u64>> = self.coats.iter().map(|coat| self.may_show(coat)).collect();
        // Particles are numbered through all coats. The numbers of each coat begin with a new word of bits.
        let may_show = may_show.concat();
        let chunk = |(number, part): (usize, &[u32])| self.candidates(number * CHUNK, part, &may_show);
        let candidates: Vec<Vec<Candidate>> = numbers.par_chunks(CHUNK).enumerate().map(chunk).collect();
        self.find_looks(&candidates);
        let found: Vec<Found> =
            candidates.into_par_iter().map(|candidates| self.found(&candidates)).collect();
        let count = found.iter().map(|found| found.strokes.len()).sum();
        let (mut strokes, mut sources) = (Vec::with_capacity(count), Vec::with_capacity(count));
        let mut layers: Vec<(LayerKey, LayerRun)> = Vec::new();
        for part in found {
            let before = strokes.len() as u32;
            strokes.extend_from_slice(&part.strokes);
            sources.extend_from_slice(&part.sources);
            for (layer, run) in part.layers {
                match layers.last_mut() {
                    Some((last, whole)) if *last == layer => whole.count += run.count,
                    _ => layers.push((layer, LayerRun { first: before + run.first, ..run })),
                }
            }
        }
        Strokes {
            strokes,
            sources,
            layers: layers.into_iter().map(|(_, run)| run).collect(),
            lines: Lines::default(),
        }
    }

    /// A bit for each particle of a coat: whether it faces the eye and its stroke may be present in the picture, judged
    /// by the widest bounds among the coat's regions.
    fn may_show(&self, coat: &CoatView<'_>) -> Vec<u64> {
        let (mut most_reach_px, mut most_per_area) = (0.0f32, 0.0f32);
        for &rule in coat.coat.used.iter() {
            let Some(bound) = &coat.presence_bounds[usize::from(rule)] else { continue };
            let follows = self.strokes_of(rule).size_follow > 0.0;
            let most_growth = if follows { MOST_GROWTH } else { 1.0 };
            most_reach_px = most_reach_px.max(bound.reach_px * most_growth);
            most_per_area =
                bound.most_per_area.iter().fold(most_per_area, |most, &of_part| most.max(of_part));
        }
        let half_px = self.half_px.map(|half| half + most_reach_px);
        let bounds = Bounds { half_px, near_far: self.near_far, most_per_area };
        if coat.hidden || self.is_left_out(coat.coat.kind) || most_per_area <= 0.0 {
            return vec![0; coat.len().div_ceil(PaintingOrder::WORD)];
        }
        coat.within(&bounds)
    }

    /// Those particles among `numbers` whose strokes may show; `first` is the place of `numbers[0]` in the painting
    /// order.
    fn candidates(&self, first: usize, numbers: &[u32], may_show: &[u64]) -> Vec<Candidate> {
        let shows = |offset: &usize| {
            let number = numbers[*offset] as usize;
            may_show[number / PaintingOrder::WORD] >> (number % PaintingOrder::WORD) & 1 != 0
        };
        // Most particles do not show. A tight loop finds those that do, before anything else is read.
        let asked: Vec<usize> = match self.recall {
            Some(recall) => recall.asked(first, numbers.len()).filter(shows).collect(),
            None => (0..numbers.len()).filter(shows).collect(),
        };
        let mut found: Vec<Candidate> = Vec::new();
        // Particles lie far apart in memory: reading many of them at once lets the processor fetch them in parallel.
        let mut batch: Vec<Candidate> = Vec::with_capacity(BATCH);
        for offsets in asked.chunks(BATCH) {
            batch.extend(offsets.iter().map(|&offset| {
                let entry = self.painting.order.entry(numbers[offset]);
                self.coats[entry.coat as usize].candidate(entry, first + offset)
            }));
            batch.retain(|candidate| self.is_in_picture(candidate));
            for candidate in &mut batch {
                candidate.look = self.looks(candidate.entry).known(candidate.entry.particle as usize);
            }
            // Finding a look takes longer than testing more closely whether the look is needed.
            found.extend(
                batch
                    .drain(..)
                    .filter(|candidate| candidate.look.is_some() || self.may_be_present(candidate)),
            );
        }
        found
    }

    /// Finds those looks of the candidates that are not known yet.
    fn find_looks(&self, candidates: &[Vec<Candidate>]) {
        let unknown = candidates.iter().flatten().filter(|candidate| candidate.look.is_none());
        let mut unknown: Vec<OrderEntry> = unknown.map(|candidate| candidate.entry).collect();
        unknown.sort_unstable_by_key(|entry| (entry.coat, entry.particle));
        for of_coat in unknown.chunk_by(|one, next| one.coat == next.coat) {
            let particles: Vec<u32> = of_coat.iter().map(|entry| entry.particle).collect();
            let task = particles.len().div_ceil(2 * rayon::current_num_threads()).clamp(BATCH, CHUNK);
            particles.par_chunks(task).for_each(|particles| self.looks(of_coat[0]).find(particles));
        }
    }

    fn looks(&self, entry: OrderEntry) -> &Looks {
        &self.coats[entry.coat as usize].coat.baked.looks
    }

    fn found(&self, candidates: &[Candidate]) -> Found {
        let mut found = Found::default();
        for candidate in candidates {
            found.add(self, candidate);
        }
        found
    }

    /// A draft has no underpainting where the toned ground can stand in for it.
    fn is_left_out(&self, kind: LayerKind) -> bool {
        self.quality == Quality::Draft
            && kind == LayerKind::Underpainting
            && self.painting.drafts_lack_underpainting()
    }

    fn is_in_picture(&self, candidate: &Candidate) -> bool {
        let &Candidate { entry, ref seen, region, part, .. } = candidate;
        let (coat, index) = (&self.coats[entry.coat as usize], entry.particle as usize);
        let Some(bound) = &coat.presence_bounds[usize::from(region)] else { return false };
        let reach = bound.reach_px * coat.growth(index, self);
        candidate.albedo_srgb8 != HOLE
            && seen.area_px > 0.0
            && seen.area_px * bound.most_per_area[part] > coat.coat.sampled.particles.ordinal(index)
            && self.is_between(seen.depth)
            && seen.x_px.abs() < self.half_px[0] + reach
            && seen.y_px.abs() < self.half_px[1] + reach
    }
}

impl CoatView<'_> {
    fn candidate(&self, entry: OrderEntry, place: usize) -> Candidate {
        let (coat, index) = (self.coat, entry.particle as usize);
        Candidate {
            entry,
            place: place as u32,
            seen: self.seen(index),
            region: coat.traits.region(index),
            part: coat.traits.part(index),
            bits: coat.traits.bits(index),
            look: None,
            albedo_srgb8: coat.albedo_srgb8(index),
        }
    }
}
