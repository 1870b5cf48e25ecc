//! Traits: what is fixed for a particle besides its direction, namely its region, its part and its random numbers. Also
//! computes slow noise, for the particles that are asked for.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use glam::DVec3;
use impasto_core::hash;
use impasto_core::noise;
use impasto_scene::document::Direction;
use impasto_scene::presets::LayerKind;
use rayon::prelude::*;

use crate::context::{Context, ObjectInputs};
use crate::particles::Particles;
use crate::parts::{BodyParts, fit_of, px_per_unit};
use crate::regions::{BodyRegions, RegionRule};

/// Each particle has several random numbers. These say which of them is used for what.
pub(crate) const ANGLE_JITTER: u32 = 1;
pub(crate) const LENGTH_JITTER: u32 = 2;
pub(crate) const WIDTH_JITTER: u32 = 3;
pub(crate) const SIZE_JITTER: u32 = 4;
pub(crate) const BOW: u32 = 5;
pub(crate) const THICKNESS_JITTER: u32 = 6;
pub(crate) const DRYNESS_JITTER: u32 = 7;
const STRAY: u32 = 8;
const FAMILY: u32 = 9;
pub(crate) const BEND: u32 = 10;

/// The length of one cycle of slow noise, in pixels of a picture 720 high at the reference pose: for angle and hue, for
/// the angle of crossing strokes, for edges.
const SWING_PX: f64 = 170.0;
const CROSSING_SWING_PX: f64 = 260.0;
const EDGE_PX: f64 = 60.0;

/// This share of the strokes strays from its neighbours by this standard deviation, or less where the angle jitter is
/// under [`USUAL_JITTER_DEG`].
const STRAY_SHARE: f32 = 0.08;
const STRAY_DEG: f64 = 38.0;
pub(crate) const USUAL_JITTER_DEG: f64 = 7.0;

/// Two crossing families of strokes swing and scatter this many times as much as one family does. The last number is
/// the share of the strokes in the second family.
const CROSSING_SWING: f64 = 26.0 / 6.0;
const CROSSING_JITTER: f64 = 13.0 / 7.0;
const SECOND_FAMILY: f32 = 0.42;

/// Noise is computed for this many particles at once.
pub(crate) const BATCH: usize = 64;

/// All that traits depend on. The number of particles is not compared.
#[derive(Clone)]
pub(crate) struct TraitInputs {
    particles: Particles,
    regions: Arc<BodyRegions>,
    parts: Arc<BodyParts>,
    /// Hash of the object's name, the scene's seed and the layer.
    name_hash: u32,
    /// Whether any strokes are fitted to the form (the setting `fit`).
    fits: bool,
    /// For each part, pixels of a picture 720 high per model unit, at the reference pose.
    scales: Vec<f64>,
    /// By rule; default where no particle of the body has the rule.
    rules: Vec<TraitRule>,
}

/// The part of a rule that traits depend on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct TraitRule {
    angle_jitter_rad: f32,
    swing_rad: f32,
    /// What the second of two crossing families adds to the angle, radians; `None` where there is one family.
    second_rad: Option<f64>,
}

/// The traits that pictures need, of particles in progressive order.
pub(crate) struct Traits {
    pub(crate) particles: Particles,
    regions: Arc<BodyRegions>,
    pub(crate) parts: Arc<BodyParts>,
    pub(crate) name_hash: u32,
    /// The region of each particle where there are dabs; empty where it follows from the triangles.
    dabbed: Vec<u16>,
    /// The size of the form at each particle; empty where no strokes are fitted to the form.
    form: FormMemo,
}

/// The size of the form at each particle, model units. It is computed on first use, because few particles are ever
/// seen.
#[derive(Default)]
struct FormMemo(Vec<AtomicU32>);

impl FormMemo {
    fn new(count: usize) -> Self {
        Self(bytemuck::allocation::zeroed_vec(count))
    }

    /// No size has these bits.
    const UNKNOWN: u32 = 0;

    fn at(&self, particle: usize, find: impl FnOnce() -> f32) -> f32 {
        // Where no strokes are fitted to the form, its size must not limit them.
        let Some(known) = self.0.get(particle) else { return f32::INFINITY };
        // Two threads that ask at once compute the same size.
        let bits = known.load(Ordering::Relaxed);
        if bits != Self::UNKNOWN {
            return f32::from_bits(bits);
        }
        let found = find();
        known.store(found.to_bits(), Ordering::Relaxed);
        found
    }
}

/// The slow noise of up to [`BATCH`] particles.
pub(crate) struct Noise {
    /// [`crate::looks::Look::drift`].
    pub(crate) drift: [[f32; 2]; BATCH],
    /// What chance and slow noise add to the base angle, radians.
    pub(crate) stray_rad: [f64; BATCH],
}

impl Traits {
    pub(crate) fn dabbed(&self) -> &[u16] {
        &self.dabbed
    }

    #[inline]
    pub(crate) fn region(&self, particle: usize) -> u16 {
        match self.dabbed.get(particle) {
            Some(&region) => region,
            None => self.regions.of_triangle(self.particles.triangle(particle)),
        }
    }

    #[inline]
    pub(crate) fn part(&self, particle: usize) -> usize {
        self.parts.of_triangle[self.particles.triangle(particle)] as usize
    }

    /// The size of the form at a particle, model units; infinite where no strokes are fitted to the form.
    #[inline]
    pub(crate) fn form(&self, particle: usize) -> f32 {
        self.form.at(particle, || {
            let at_rest = self.particles.at(particle);
            self.parts.form.at(at_rest.position, at_rest.normal)
        })
    }

    /// Random bits of a particle. Only another object name or another seed of the scene changes them.
    #[inline]
    pub(crate) fn bits(&self, particle: usize) -> u32 {
        self.particles.random_bits(particle, self.name_hash)
    }

    /// Whether each particle is known to belong to the same region in both.
    pub(crate) fn same_regions(&self, other: &Self) -> bool {
        self.particles == other.particles
            && (Arc::ptr_eq(&self.regions, &other.regions) || self.regions == other.regions)
    }
}

impl PartialEq for TraitInputs {
    fn eq(&self, other: &Self) -> bool {
        self.particles.same_order(&other.particles)
            && Arc::ptr_eq(&self.parts, &other.parts)
            && (self.name_hash, self.fits) == (other.name_hash, other.fits)
            && self.scales == other.scales
            && self.rules == other.rules
            && (Arc::ptr_eq(&self.regions, &other.regions) || self.regions == other.regions)
    }
}

fn second_rad(direction: &Direction) -> Option<f64> {
    match *direction {
        Direction::Crossing(first, second) => Some((second - first).to_radians()),
        _ => None,
    }
}

impl TraitInputs {
    pub(crate) fn new(
        context: &Context<'_>,
        object: ObjectInputs<'_>,
        kind: LayerKind,
        particles: Particles,
        parts: &Arc<BodyParts>,
    ) -> Self {
        let rules = context.rules;
        let own = object.references.own();
        let scale = 720.0 / f64::from(own.size_px[1]);
        let mut of_rule = vec![TraitRule::default(); rules.len()];
        for &rule in object.used.iter() {
            let RegionRule { direction, strokes, .. } = &rules[usize::from(rule)];
            let (angle_jitter_rad, swing_rad) = (strokes.angle_jitter_rad, strokes.swing_rad);
            let second_rad = second_rad(direction);
            of_rule[usize::from(rule)] = TraitRule { angle_jitter_rad, swing_rad, second_rad };
        }
        Self {
            particles,
            regions: Arc::clone(object.regions),
            name_hash: context.name_hash(object.index, kind),
            fits: object.used.iter().any(|&rule| fit_of(kind, rules[usize::from(rule)].strokes.fit) > 0.0),
            scales: {
                let of_part = |(index, part)| px_per_unit(own, index, part) * scale;
                parts.parts.iter().enumerate().map(of_part).collect()
            },
            rules: of_rule,
            parts: Arc::clone(parts),
        }
    }

    /// The traits, with the region of each particle where there are dabs.
    pub(crate) fn with_regions(&self, dabbed: Vec<u16>) -> Traits {
        Traits {
            particles: self.particles.clone(),
            regions: Arc::clone(&self.regions),
            parts: Arc::clone(&self.parts),
            name_hash: self.name_hash,
            dabbed,
            form: FormMemo::new(if self.fits { self.particles.len() } else { 0 }),
        }
    }

    /// The traits of all particles. `before` was made from equal inputs: it is shortened or extended.
    pub(crate) fn traits(&self, before: Option<Arc<Traits>>) -> Arc<Traits> {
        let count = self.particles.len();
        if let Some(before) = &before
            && before.particles.len() == count
        {
            return Arc::clone(before);
        }
        let mut dabbed = before.map_or_else(Vec::new, |before| before.dabbed.clone());
        dabbed.truncate(count);
        if self.regions.has_dabs() {
            let rest = self.particles.par_range(dabbed.len()..count);
            dabbed.par_extend(rest.map(|particle| self.regions.of(&particle)));
        }
        Arc::new(self.with_regions(dabbed))
    }

    /// The slow noise and the stray angles of up to [`BATCH`] particles.
    pub(crate) fn noise(&self, traits: &Traits, particles: &[u32]) -> Noise {
        let count = particles.len();
        let mut at = [[DVec3::ZERO; BATCH]; 3];
        let mut swings = [true; BATCH];
        for (index, &particle) in particles.iter().enumerate() {
            let particle = particle as usize;
            let (rule, part) = (self.rules[usize::from(traits.region(particle))], traits.part(particle));
            let position = self.particles.at(particle).position.as_dvec3();
            let scale = self.scales[part];
            let scaled = position * scale;
            at[0][index] = scaled / SWING_PX;
            at[1][index] = scaled / EDGE_PX;
            at[2][index] = position * (scale / self.cycle_px(rule));
            swings[index] = rule.swing_rad > 0.0;
        }
        let mut noise = [[0.0f32; BATCH]; 3];
        for (which, noise) in noise.iter_mut().enumerate() {
            // All layers and objects share the noise of the swing.
            let seed = if which == 2 { 3 } else { hash::combine(self.name_hash, which as u32 + 1) };
            if which < 2 || swings[..count].contains(&true) {
                noise::slow(seed, &at[which][..count], &mut noise[..count]);
            }
        }
        let mut found = Noise { drift: [[0.0; 2]; BATCH], stray_rad: [0.0; BATCH] };
        for (index, &particle) in particles.iter().enumerate() {
            found.drift[index] = [noise[0][index], noise[1][index]];
            found.stray_rad[index] = self.stray_rad(traits, particle as usize, noise[2][index]);
        }
        found
    }

    /// The length of one cycle of the swing, pixels of a picture 720 high.
    fn cycle_px(&self, rule: TraitRule) -> f64 {
        if rule.second_rad.is_some() { CROSSING_SWING_PX } else { SWING_PX }
    }

    fn stray_rad(&self, traits: &Traits, particle: usize, swing_noise: f32) -> f64 {
        let bits = traits.bits(particle);
        let rule = self.rules[usize::from(traits.region(particle))];
        let second = rule.second_rad;
        let normal = |which: u32| f64::from(hash::normal(hash::combine(bits, which)));
        let (swing, jitter) = if second.is_some() { (CROSSING_SWING, CROSSING_JITTER) } else { (1.0, 1.0) };
        let jitter_rad = f64::from(rule.angle_jitter_rad);
        let mut stray = jitter_rad * jitter * normal(ANGLE_JITTER);
        if hash::unit(hash::combine(bits, STRAY)) < STRAY_SHARE {
            let share = (jitter_rad.to_degrees() / USUAL_JITTER_DEG).min(1.0);
            stray += STRAY_DEG.to_radians() * share * normal(hash::combine(STRAY, 1));
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
