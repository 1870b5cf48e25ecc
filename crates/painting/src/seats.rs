//! What a particle has whatever its direction: its region, its chances, its slow noise.

use std::sync::Arc;

use glam::DVec3;
use impasto_core::hash;
use impasto_core::noise;
use impasto_scene::document::Direction;
use rayon::prelude::*;

use crate::particles::Particles;
use crate::parts::{BodyParts, px_per_unit};
use crate::references::BodyReferences;
use crate::regions::{BodyRegions, RegionRule};

/// Which random number of a particle.
pub(crate) const ANGLE_JITTER: u32 = 1;
pub(crate) const LENGTH_JITTER: u32 = 2;
pub(crate) const WIDTH_JITTER: u32 = 3;
pub(crate) const SIZE_JITTER: u32 = 4;
pub(crate) const BOW: u32 = 5;
pub(crate) const THICKNESS_JITTER: u32 = 6;
pub(crate) const DRYNESS_JITTER: u32 = 7;
const RANK_BREAKING: u32 = 8;
const FAMILY: u32 = 9;
pub(crate) const BEND: u32 = 10;

/// One cycle of slow noise, pixels of a picture 720 high at the reference pose: of angle and hue, of a backdrop's angle, of
/// edges.
const SWING_PX: f64 = 170.0;
const BACKDROP_SWING_PX: f64 = 260.0;
const EDGE_PX: f64 = 60.0;

/// A share of the strokes breaks rank by this; by less where the angle's own jitter is under [`USUAL_JITTER_DEG`].
const RANK_BREAKERS: f32 = 0.08;
const RANK_BREAKING_DEG: f64 = 38.0;
pub(crate) const USUAL_JITTER_DEG: f64 = 7.0;

/// Crossing families swing and scatter this much more than one family does, and this share belongs to the second.
const CROSSING_SWING: f64 = 26.0 / 6.0;
const CROSSING_JITTER: f64 = 13.0 / 7.0;
const SECOND_FAMILY: f32 = 0.42;

/// How many particles one task looks at.
const CHUNK: usize = 512;

/// All that seats depend on, but for how many there are.
#[derive(Clone)]
pub(crate) struct SeatInputs {
    particles: Particles,
    regions: Arc<BodyRegions>,
    parts: Arc<BodyParts>,
    /// Hash of the object's name, the scene's seed and the layer.
    name_hash: u32,
    /// For each part, pixels of a picture 720 high per model unit, at the reference pose.
    scales: Vec<f64>,
    /// By rule; those that no particle of the body has are left as they are by default.
    rules: Vec<SeatRule>,
    /// For each part, what the second of two crossing families adds where its rule is automatic, radians.
    second_of_part_rad: Vec<Option<f64>>,
}

/// What seats take from a rule.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct SeatRule {
    angle_jitter_rad: f32,
    swing_rad: f32,
    family: Family,
}

/// How many families of strokes a rule has.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Family {
    /// As the part is brushed by itself.
    #[default]
    OfPart,
    One,
    /// Two that cross: the angle between them, radians.
    Two(f64),
}

/// Particles' seats, in progressive order: what pictures need of them.
#[derive(Clone)]
pub(crate) struct Seats {
    pub(crate) particles: Particles,
    regions: Arc<BodyRegions>,
    pub(crate) parts: Arc<BodyParts>,
    pub(crate) name_hash: u32,
    /// Region of each particle, where dabs decide; else its triangle's.
    dabbed: Vec<u16>,
    /// Slow noise per particle: of hue and value, and of how firm edges are.
    pub(crate) drift: Vec<[f32; 2]>,
}

/// Seats, with what they are made from and what only their directions need.
pub(crate) struct KeptSeats {
    inputs: SeatInputs,
    pub(crate) seats: Arc<Seats>,
    /// What chance and slow noise add to the base angle of each particle, radians.
    pub(crate) stray_rad: Vec<f64>,
}

impl KeptSeats {
    /// Whether both are made from the same, but for how many there are.
    pub(crate) fn same_inputs(&self, other: &Self) -> bool {
        self.inputs == other.inputs
    }
}

impl Seats {
    /// The region of a particle.
    #[inline]
    pub(crate) fn region(&self, particle: usize) -> u16 {
        match self.dabbed.get(particle) {
            Some(&region) => region,
            None => self.regions.of_triangle(self.particles.triangle(particle)),
        }
    }

    /// The part of a particle.
    #[inline]
    pub(crate) fn part(&self, particle: usize) -> usize {
        self.parts.of_triangle[self.particles.triangle(particle)] as usize
    }

    /// Random bits of a particle, for ever.
    #[inline]
    pub(crate) fn bits(&self, particle: usize) -> u32 {
        hash::combine(self.name_hash, particle as u32)
    }

    /// Whether all particles belong to the same regions; where in doubt, not.
    pub(crate) fn same_regions(&self, other: &Self) -> bool {
        self.particles.same(&other.particles)
            && (Arc::ptr_eq(&self.regions, &other.regions) || self.regions == other.regions)
    }
}

impl PartialEq for SeatInputs {
    fn eq(&self, other: &Self) -> bool {
        self.particles.same_order(&other.particles)
            && Arc::ptr_eq(&self.parts, &other.parts)
            && self.name_hash == other.name_hash
            && self.scales == other.scales
            && self.rules == other.rules
            && self.second_of_part_rad == other.second_of_part_rad
            && (Arc::ptr_eq(&self.regions, &other.regions) || self.regions == other.regions)
    }
}

/// What the second of two crossing families adds, radians; `None` where there is one family.
fn second_rad(direction: &Direction) -> Option<f64> {
    match *direction {
        Direction::Crossing(first, second) => Some((second - first).to_radians()),
        _ => None,
    }
}

impl SeatInputs {
    pub(crate) fn new(
        (particles, name_hash): (Particles, u32),
        (regions, used): (&Arc<BodyRegions>, &[u16]),
        rules: &[RegionRule],
        parts: &Arc<BodyParts>,
        references: &BodyReferences,
    ) -> Self {
        let own = references.own();
        let scale = 720.0 / f64::from(own.size_px[1]);
        let mut of_rule = vec![SeatRule::default(); rules.len()];
        for &rule in used {
            let RegionRule { direction, strokes, .. } = &rules[usize::from(rule)];
            let family = match direction {
                // The bend is the field's to find; what is automatic stands in for it where there is none.
                Direction::Auto | Direction::Curvature(_) => Family::OfPart,
                stated => second_rad(stated).map_or(Family::One, Family::Two),
            };
            let (angle_jitter_rad, swing_rad) = (strokes.angle_jitter_rad, strokes.swing_rad);
            of_rule[usize::from(rule)] = SeatRule { angle_jitter_rad, swing_rad, family };
        }
        Self {
            particles,
            regions: Arc::clone(regions),
            name_hash,
            scales: parts.parts.iter().map(|part| px_per_unit(&own.map, part) * scale).collect(),
            rules: of_rule,
            second_of_part_rad: parts.directions(own).iter().map(second_rad).collect(),
            parts: Arc::clone(parts),
        }
    }

    /// The seats of all particles; `kept` ones with the same inputs are cut or continued.
    pub(crate) fn seats(self, kept: Option<Arc<KeptSeats>>) -> Arc<KeptSeats> {
        let count = self.particles.len();
        let kept = kept.filter(|kept| kept.inputs == self);
        if let Some(kept) = &kept
            && kept.seats.drift.len() == count
        {
            return Arc::clone(kept);
        }
        let (mut dabbed, mut drift, mut stray_rad) = (Vec::new(), Vec::new(), Vec::new());
        if let Some(kept) = kept {
            // Copied only if a painting still holds them.
            let KeptSeats { seats, stray_rad: strays, .. } = match Arc::try_unwrap(kept) {
                Ok(kept) => kept,
                Err(kept) => KeptSeats {
                    inputs: kept.inputs.clone(),
                    seats: Arc::clone(&kept.seats),
                    stray_rad: kept.stray_rad.clone(),
                },
            };
            let seats = Arc::unwrap_or_clone(seats);
            (dabbed, drift, stray_rad) = (seats.dabbed, seats.drift, strays);
        }
        dabbed.truncate(count);
        drift.truncate(count);
        stray_rad.truncate(count);
        let from = drift.len();
        if self.regions.has_dabs() {
            let regions = self.particles.par_range(from..count).map(|particle| self.regions.of(&particle));
            dabbed.par_extend(regions);
        }
        drift.resize(count, [0.0; 2]);
        stray_rad.resize(count, 0.0);
        let seats = Seats {
            particles: self.particles.clone(),
            regions: Arc::clone(&self.regions),
            parts: Arc::clone(&self.parts),
            name_hash: self.name_hash,
            dabbed,
            drift: Vec::new(),
        };
        let chunks = drift[from..].par_chunks_mut(CHUNK).zip(stray_rad[from..].par_chunks_mut(CHUNK));
        chunks.enumerate().for_each(|(chunk, (drift, stray_rad))| {
            self.chances(&seats, from + chunk * CHUNK, (drift, stray_rad));
        });
        let seats = Arc::new(Seats { drift, ..seats });
        Arc::new(KeptSeats { inputs: self, seats, stray_rad })
    }

    /// The slow noise and the stray angles of the particles from `first` on; `seats` have no noise yet.
    fn chances(&self, seats: &Seats, first: usize, (drift, stray_rad): (&mut [[f32; 2]], &mut [f64])) {
        let count = drift.len();
        let mut at = [[DVec3::ZERO; CHUNK]; 3];
        let mut swings = [true; CHUNK];
        for index in 0..count {
            let particle = first + index;
            let (rule, part) = (self.rules[usize::from(seats.region(particle))], seats.part(particle));
            let position = self.particles.at(particle).position.as_dvec3();
            let scale = self.scales[part];
            let scaled = position * scale;
            at[0][index] = scaled / SWING_PX;
            at[1][index] = scaled / EDGE_PX;
            at[2][index] = position * (scale / self.cycle_px(rule, part));
            swings[index] = rule.swing_rad > 0.0;
        }
        let mut noise = [[0.0f32; CHUNK]; 3];
        for (which, noise) in noise.iter_mut().enumerate() {
            // The same swing in every layer.
            let seed = if which == 2 { 3 } else { hash::combine(self.name_hash, which as u32 + 1) };
            if which < 2 || swings[..count].contains(&true) {
                noise::slow(seed, &at[which][..count], &mut noise[..count]);
            }
        }
        for index in 0..count {
            drift[index] = [noise[0][index], noise[1][index]];
            stray_rad[index] = self.stray_rad(seats, first + index, noise[2][index]);
        }
    }

    /// What the second of two crossing families adds, where there are two.
    fn second_rad(&self, rule: SeatRule, part: usize) -> Option<f64> {
        match rule.family {
            Family::OfPart => self.second_of_part_rad[part],
            Family::One => None,
            Family::Two(turned) => Some(turned),
        }
    }

    /// One cycle of the swing.
    fn cycle_px(&self, rule: SeatRule, part: usize) -> f64 {
        if self.second_rad(rule, part).is_some() { BACKDROP_SWING_PX } else { SWING_PX }
    }

    /// What chance and slow noise add to a particle's base angle, radians.
    fn stray_rad(&self, seats: &Seats, particle: usize, swing_noise: f32) -> f64 {
        let bits = seats.bits(particle);
        let rule = self.rules[usize::from(seats.region(particle))];
        let second = self.second_rad(rule, seats.part(particle));
        let normal = |which: u32| f64::from(hash::normal(hash::combine(bits, which)));
        let (swing, jitter) = if second.is_some() { (CROSSING_SWING, CROSSING_JITTER) } else { (1.0, 1.0) };
        let jitter_rad = f64::from(rule.angle_jitter_rad);
        let mut stray = jitter_rad * jitter * normal(ANGLE_JITTER);
        if hash::unit(hash::combine(bits, RANK_BREAKING)) < RANK_BREAKERS {
            let share = (jitter_rad.to_degrees() / USUAL_JITTER_DEG).min(1.0);
            stray += RANK_BREAKING_DEG.to_radians() * share * normal(hash::combine(RANK_BREAKING, 1));
        }
        if rule.swing_rad > 0.0 {
            stray += f64::from(rule.swing_rad) * swing * f64::from(swing_noise);
        }
        if let Some(second) = second
            && hash::unit(hash::combine(bits, FAMILY)) < SECOND_FAMILY
        {
            stray += second;
        }
        stray
    }
}
