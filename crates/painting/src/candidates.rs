//! The strokes of a frame: of all particles in painting order, those that may show, then those that do.

use impasto_core::solve::{Bounds, SolvedParticle};
use impasto_scene::presets::LayerKind;
use rayon::prelude::*;

use crate::at::{Look, MOST_GROWTH, SeenCoat};
use crate::frame::{LayerRun, Quality, Stroke, StrokeSource, Strokes};
use crate::order::{OrderEntry, PaintingOrder};
use crate::recall::Recall;

/// How many candidates are read side by side.
const TOGETHER: usize = 64;

/// How many particles one task looks at.
const CHUNK: usize = 64 * Recall::WORD;

/// Strokes of particles that come one after the other.
#[derive(Default)]
struct Found {
    strokes: Vec<Stroke>,
    sources: Vec<StrokeSource>,
    /// With the regions' layer and the layer of paint.
    layers: Vec<((i32, LayerKind), LayerRun)>,
}

impl Found {
    fn add(&mut self, look: &Look<'_>, candidate: &Candidate) {
        if !look.is_in_picture(candidate) {
            return;
        }
        let Some((stroke, source)) = look.stroke(candidate) else { return };
        let rule = &look.painting.rules[usize::from(candidate.region)];
        let kind = look.seen[candidate.entry.coat as usize].coat.kind;
        // The region's layer and the layer of paint.
        let layer = (rule.strokes.layer, kind);
        match self.layers.last_mut() {
            Some((last, run)) if *last == layer => run.count += 1,
            _ => {
                let first = self.strokes.len() as u32;
                self.layers.push((layer, LayerRun { kind, first, count: 1 }));
            }
        }
        self.strokes.push(stroke);
        self.sources.push(source);
    }
}

/// A particle that may show, with what its stroke depends on.
pub(crate) struct Candidate {
    pub(crate) entry: OrderEntry,
    /// Of the entry in the order.
    pub(crate) place: u32,
    pub(crate) solved: SolvedParticle,
    pub(crate) region: u16,
    pub(crate) part: usize,
    pub(crate) bits: u32,
    pub(crate) drift: [f32; 2],
    pub(crate) albedo_srgb8: u32,
}

impl Look<'_> {
    /// Of all particles that the recall asks for.
    pub(crate) fn strokes(&self) -> Strokes {
        let numbers = self.painting.order.numbers();
        let may_show: Vec<Vec<u64>> = self.seen.iter().map(|seen| self.may_show(seen)).collect();
        // One after the other, as the numbers go on from coat to coat.
        let may_show = may_show.concat();
        let chunk = |(number, part): (usize, &[u32])| self.found(number * CHUNK, part, &may_show);
        let found: Vec<Found> = numbers.par_chunks(CHUNK).enumerate().map(chunk).collect();
        let count = found.iter().map(|found| found.strokes.len()).sum();
        let (mut strokes, mut sources) = (Vec::with_capacity(count), Vec::with_capacity(count));
        let mut layers: Vec<((i32, LayerKind), LayerRun)> = Vec::new();
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
        Strokes { strokes, sources, layers: layers.into_iter().map(|(_, run)| run).collect() }
    }

    /// Of each particle of a coat, a bit: whether it faces the eye and is about where strokes may show. No region asks for more
    /// than is asked here.
    fn may_show(&self, seen: &SeenCoat<'_>) -> Vec<u64> {
        let (mut most_reach_px, mut most_per_area) = (0.0f32, 0.0f32);
        for &rule in seen.coat.used.iter() {
            let Some(gate) = &seen.gates[usize::from(rule)] else { continue };
            let follows = self.painting.rules[usize::from(rule)].strokes.size_follow > 0.0;
            let most_growth = if follows { MOST_GROWTH } else { 1.0 };
            most_reach_px = most_reach_px.max(gate.reach_px * most_growth);
            most_per_area = gate.most_per_area.iter().fold(most_per_area, |most, &of_part| most.max(of_part));
        }
        let half_px = self.half_px.map(|half| half + most_reach_px);
        let bounds = Bounds { half_px, near_far: self.near_far, most_per_area };
        if self.is_left_out(seen.coat.kind) || most_per_area <= 0.0 {
            return vec![0; seen.baked.len().div_ceil(PaintingOrder::WORD)];
        }
        seen.view.within(&seen.baked, &bounds)
    }

    /// The strokes of the particles from a place of the order on, of those that may show.
    fn found(&self, first: usize, numbers: &[u32], may_show: &[u64]) -> Found {
        let shows = |offset: &usize| {
            let number = numbers[*offset] as usize;
            may_show[number / PaintingOrder::WORD] >> (number % PaintingOrder::WORD) & 1 != 0
        };
        // Found first, in a loop of their own: most do not show.
        let asked: Vec<usize> = match self.recall {
            Some(recall) => recall.asked(first, numbers.len()).filter(shows).collect(),
            None => (0..numbers.len()).filter(shows).collect(),
        };
        let mut found = Found::default();
        // What is read of particles comes from far apart; read side by side, it is waited for once.
        let mut candidates: Vec<Candidate> = Vec::with_capacity(TOGETHER);
        for offsets in asked.chunks(TOGETHER) {
            candidates.clear();
            candidates.extend(offsets.iter().map(|&offset| {
                let entry = self.painting.order.entry(numbers[offset]);
                self.seen[entry.coat as usize].candidate(entry, first + offset)
            }));
            for candidate in &candidates {
                found.add(self, candidate);
            }
        }
        found
    }

    /// A draft has no underpainting: its ground stands in.
    fn is_left_out(&self, kind: LayerKind) -> bool {
        self.quality == Quality::Draft && kind == LayerKind::Underpainting
    }

    fn is_in_picture(&self, candidate: &Candidate) -> bool {
        let &Candidate { entry, ref solved, region, part, .. } = candidate;
        let (seen, index) = (&self.seen[entry.coat as usize], entry.particle as usize);
        let Some(gate) = &seen.gates[usize::from(region)] else { return false };
        // Half a diagonal, for the largest of a lively crowd.
        let reach = gate.reach_px * seen.growth(index, self.painting, self.px_scale);
        solved.area_px > 0.0
            && solved.area_px * gate.most_per_area[part] > index as f32
            && self.is_between(solved.depth)
            && solved.x_px.abs() < self.half_px[0] + reach
            && solved.y_px.abs() < self.half_px[1] + reach
    }
}

impl SeenCoat<'_> {
    fn candidate(&self, entry: OrderEntry, place: usize) -> Candidate {
        let (coat, index) = (self.coat, entry.particle as usize);
        Candidate {
            entry,
            place: place as u32,
            solved: self.solved(index),
            region: coat.seats.region(index),
            part: coat.seats.part(index),
            bits: coat.seats.bits(index),
            drift: coat.seats.drift[index],
            albedo_srgb8: coat.albedo_srgb8(index),
        }
    }
}
