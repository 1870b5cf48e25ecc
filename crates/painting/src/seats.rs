//! What a particle has whatever its direction: its region, its chances, its slow noise.

use std::ops::Range;
use std::sync::Arc;

use impasto_core::hash;
use impasto_core::noise;
use impasto_core::sampling::Particle;
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

/// Particles below this number are not worth a thread.
const MIN_LEN: usize = 2048;

/// All that seats depend on, but for how many there are.
#[derive(Clone)]
pub(crate) struct SeatInputs {
    particles: Particles,
    regions: Arc<BodyRegions>,
    parts: Arc<BodyParts>,
    /// Hash of the object's name, the scene's seed and the layer.
    pub(crate) name_hash: u32,
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

/// Particles' seats, in progressive order.
#[derive(Clone)]
pub(crate) struct Seats {
    pub(crate) inputs: SeatInputs,
    pub(crate) region: Vec<u16>,
    /// Random bits of each particle, for ever.
    pub(crate) bits: Vec<u32>,
    /// Slow noise per particle: of hue and value, and of how firm edges are.
    pub(crate) drift: Vec<[f32; 2]>,
    /// Part of each particle.
    pub(crate) part: Vec<u32>,
    /// What chance and slow noise add to the base angle, radians.
    pub(crate) stray_rad: Vec<f64>,
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
    pub(crate) fn seats(self, kept: Option<Arc<Seats>>) -> Arc<Seats> {
        let count = self.particles.len();
        let kept = kept.filter(|kept| kept.inputs == self);
        if let Some(kept) = &kept
            && kept.region.len() == count
        {
            return Arc::clone(kept);
        }
        let empty = || Seats {
            inputs: self.clone(),
            region: Vec::new(),
            bits: Vec::new(),
            drift: Vec::new(),
            part: Vec::new(),
            stray_rad: Vec::new(),
        };
        let mut seats = kept.map_or_else(empty, Arc::unwrap_or_clone);
        let from = seats.region.len().min(count);
        seats.region.truncate(count);
        seats.bits.truncate(count);
        seats.drift.truncate(count);
        seats.part.truncate(count);
        seats.stray_rad.truncate(count);
        seats.inputs = self;
        seats.continue_from(from..count);
        Arc::new(seats)
    }

    fn part_of(&self, particle: &Particle) -> usize {
        self.parts.of_triangle[particle.triangle as usize] as usize
    }

    /// What chance and slow noise add to a base angle, radians.
    fn stray_rad(&self, (particle, bits): (&Particle, u32), rule: u16, part: usize) -> f64 {
        let rule = &self.rules[usize::from(rule)];
        let second = match rule.family {
            Family::OfPart => self.second_of_part_rad[part],
            Family::One => None,
            Family::Two(turned) => Some(turned),
        };
        let normal = |which: u32| f64::from(hash::normal(hash::combine(bits, which)));
        let (swing, jitter, cycle_px) = if second.is_some() {
            (CROSSING_SWING, CROSSING_JITTER, BACKDROP_SWING_PX)
        } else {
            (1.0, 1.0, SWING_PX)
        };
        let jitter_rad = f64::from(rule.angle_jitter_rad);
        let mut stray = jitter_rad * jitter * normal(ANGLE_JITTER);
        if hash::unit(hash::combine(bits, RANK_BREAKING)) < RANK_BREAKERS {
            let share = (jitter_rad.to_degrees() / USUAL_JITTER_DEG).min(1.0);
            stray += RANK_BREAKING_DEG.to_radians() * share * normal(hash::combine(RANK_BREAKING, 1));
        }
        if rule.swing_rad > 0.0 {
            let at = particle.position.as_dvec3() * (self.scales[part] / cycle_px);
            // The same swing in every layer.
            stray += f64::from(rule.swing_rad) * swing * f64::from(noise::slow(3, at));
        }
        if let Some(second) = second
            && hash::unit(hash::combine(bits, FAMILY)) < SECOND_FAMILY
        {
            stray += second;
        }
        stray
    }
}

impl Seats {
    fn continue_from(&mut self, range: Range<usize>) {
        let inputs = &self.inputs;
        let particles = &inputs.particles[range.clone()];
        let first = range.start;
        let each = particles.par_iter().enumerate().with_min_len(MIN_LEN);
        let found: Vec<(u16, [f32; 2], f64)> = each
            .map(|(index, particle)| {
                let bits = hash::combine(inputs.name_hash, (first + index) as u32);
                let (region, part) = (inputs.regions.of(particle), inputs.part_of(particle));
                let at = particle.position.as_dvec3() * inputs.scales[part];
                let noise =
                    |which: u32, px: f64| noise::slow(hash::combine(inputs.name_hash, which), at / px);
                let drift = [noise(1, SWING_PX), noise(2, EDGE_PX)];
                (region, drift, inputs.stray_rad((particle, bits), region, part))
            })
            .collect();
        self.region.extend(found.iter().map(|&(region, ..)| region));
        self.drift.extend(found.iter().map(|&(_, drift, _)| drift));
        self.stray_rad.extend(found.iter().map(|&(.., stray_rad)| stray_rad));
        self.bits.extend(range.map(|particle| hash::combine(inputs.name_hash, particle as u32)));
        self.part.extend(particles.iter().map(|particle| inputs.part_of(particle) as u32));
    }
}
