//! The lift of every particle of a body: its reference view, its base direction, its jitter.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use impasto_core::direction::carry::Stencils;
use impasto_core::hash;
use impasto_core::lift::Lift;
use impasto_core::neighbours::Neighbours;
use impasto_core::noise;
use impasto_core::sampling::Particle;
use impasto_core::solve::BakedParticles;
use impasto_scene::document::Solver;
use rayon::prelude::*;

use crate::field::{BodyField, FieldInputs};
use crate::parts::{BodyParts, px_per_unit};
use crate::references::{BodyReferences, Views};
use crate::regions::{BodyRegions, RegionRule};
use crate::stated::{Point, Stated};

/// All that the lifts of a coat depend on.
#[derive(Clone)]
pub(crate) struct BakeInputs {
    pub(crate) particles: Arc<Vec<Particle>>,
    pub(crate) neighbours: Option<Arc<Neighbours>>,
    pub(crate) references: Arc<BodyReferences>,
    pub(crate) solver: Solver,
    pub(crate) regions: Arc<BodyRegions>,
    pub(crate) rules: Arc<Vec<RegionRule>>,
    /// Hash of the object's name, the scene's seed and the layer.
    pub(crate) name_hash: u32,
    /// Centre and length of the diagonal of the body's bounds, model space.
    pub(crate) extent: (DVec3, f64),
    pub(crate) parts: Arc<BodyParts>,
    /// Where directions are not all stated outright: what combs them, with the samples each particle listens to.
    pub(crate) combed: Option<Combed>,
}

/// What combs the directions of a coat.
#[derive(Clone)]
pub(crate) struct Combed {
    pub(crate) inputs: Arc<FieldInputs>,
    /// None where guides alone have a say.
    pub(crate) field: Option<Arc<BodyField>>,
    pub(crate) stencils: Arc<Stencils>,
}

impl PartialEq for BakeInputs {
    fn eq(&self, other: &Self) -> bool {
        let same_lists = match (&self.neighbours, &other.neighbours) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (a, b) => a.is_none() && b.is_none(),
        };
        let same_combing = match (&self.combed, &other.combed) {
            (Some(a), Some(b)) => Arc::ptr_eq(&a.inputs, &b.inputs),
            (a, b) => a.is_none() && b.is_none(),
        };
        same_lists
            && same_combing
            && Arc::ptr_eq(&self.particles, &other.particles)
            && self.references == other.references
            && self.solver == other.solver
            && self.regions == other.regions
            && self.rules == other.rules
            && self.name_hash == other.name_hash
            && self.extent == other.extent
            && Arc::ptr_eq(&self.parts, &other.parts)
    }
}

/// Baked particles with what belongs to them, in progressive order.
#[derive(Debug)]
pub(crate) struct BakedBody {
    pub(crate) baked: BakedParticles,
    pub(crate) region: Vec<u16>,
    /// θ₀ with jitter in the reference picture, radians: what `horn-exact` adds to its turn.
    pub(crate) base_angle_rad: Vec<f32>,
    /// Random bits of each particle, for ever.
    pub(crate) bits: Vec<u32>,
    /// Slow noise per particle: of hue and value, and of how firm edges are.
    pub(crate) drift: Vec<[f32; 2]>,
    /// Part of each particle.
    pub(crate) part: Vec<u32>,
}

/// Which random number of a particle.
pub(crate) const ANGLE_JITTER: u32 = 1;
pub(crate) const LENGTH_JITTER: u32 = 2;
pub(crate) const WIDTH_JITTER: u32 = 3;
pub(crate) const SIZE_JITTER: u32 = 4;
pub(crate) const BEND: u32 = 5;
pub(crate) const THICKNESS_JITTER: u32 = 6;
pub(crate) const DRYNESS_JITTER: u32 = 7;
const RANK_BREAKING: u32 = 8;
const FAMILY: u32 = 9;

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

impl BakeInputs {
    pub(crate) fn bake(&self) -> BakedBody {
        let count = self.particles.len();
        let scales = self.scales();
        let stated = Stated {
            rules: &self.rules,
            automatic: self.parts.directions(self.references.own()),
            extent: self.extent,
        };
        let region: Vec<u16> =
            self.particles.par_iter().with_min_len(4096).map(|particle| self.regions.of(particle)).collect();
        let lifts: Vec<(Lift, f64)> = (0..count)
            .into_par_iter()
            .with_min_len(1024)
            .map(|index| self.lift(index, self.point(index, region[index]), (&stated, &scales)))
            .collect();
        let mut baked = BakedParticles::default();
        for (index, (lift, _)) in lifts.iter().enumerate() {
            let point = self.point(index, region[index]);
            baked.push(self.lifted(point), point.normal, *lift);
        }
        let flatness = |&region: &u16| self.rules[usize::from(region)].strokes.flatness;
        if region.iter().any(|region| flatness(region) < 1.0) {
            baked.flatness = region.iter().map(flatness).collect();
        }
        BakedBody {
            baked,
            region,
            base_angle_rad: lifts.iter().map(|&(_, base)| base as f32).collect(),
            bits: (0..count).map(|particle| self.bits_of(particle)).collect(),
            drift: (0..count)
                .into_par_iter()
                .with_min_len(2048)
                .map(|particle| {
                    let at = self.particles[particle].position.as_dvec3() * scales[self.part_of(particle)];
                    let noise =
                        |which: u32, px: f64| noise::slow(hash::combine(self.name_hash, which), at / px);
                    [noise(1, SWING_PX), noise(2, EDGE_PX)]
                })
                .collect(),
            part: (0..count).map(|particle| self.part_of(particle) as u32).collect(),
        }
    }

    fn point(&self, index: usize, region: u16) -> Point {
        let particle = &self.particles[index];
        Point {
            position: particle.position.as_dvec3(),
            normal: particle.normal.as_dvec3(),
            rule: usize::from(region),
            part: self.part_of(index),
        }
    }

    /// Where the stroke of a point is: off the surface by its region's offset.
    fn lifted(&self, point: Point) -> DVec3 {
        point.position + point.normal * f64::from(self.rules[point.rule].strokes.offset)
    }

    /// Which particles lie near a singular point of their stated direction.
    pub(crate) fn poles(&self) -> Vec<bool> {
        let stated = Stated {
            rules: &self.rules,
            automatic: self.parts.directions(self.references.own()),
            extent: self.extent,
        };
        let up_in_model = self.references.own().up_in_model;
        (0..self.particles.len())
            .map(|index| {
                stated.is_pole(self.point(index, self.regions.of(&self.particles[index])), up_in_model)
            })
            .collect()
    }

    fn part_of(&self, particle: usize) -> usize {
        self.parts.of_triangle[self.particles[particle].triangle as usize] as usize
    }

    fn bits_of(&self, particle: usize) -> u32 {
        hash::combine(self.name_hash, particle as u32)
    }

    /// For each part, pixels of a picture 720 high per model unit, at the reference pose.
    fn scales(&self) -> Vec<f64> {
        let own = self.references.own();
        let scale = 720.0 / f64::from(own.size_px[1]);
        self.parts.parts.iter().map(|part| px_per_unit(&own.map, part) * scale).collect()
    }

    /// What chance and slow noise add to a base angle, radians.
    fn stray(&self, index: usize, rule: &RegionRule, crossing: bool, scale: f64) -> f64 {
        let bits = self.bits_of(index);
        let normal = |which: u32| f64::from(hash::normal(hash::combine(bits, which)));
        let (swing, jitter, cycle_px) = if crossing {
            (CROSSING_SWING, CROSSING_JITTER, BACKDROP_SWING_PX)
        } else {
            (1.0, 1.0, SWING_PX)
        };
        let jitter_rad = f64::from(rule.strokes.angle_jitter_rad);
        let mut stray = jitter_rad * jitter * normal(ANGLE_JITTER);
        if hash::unit(hash::combine(bits, RANK_BREAKING)) < RANK_BREAKERS {
            let share = (jitter_rad.to_degrees() / USUAL_JITTER_DEG).min(1.0);
            stray += RANK_BREAKING_DEG.to_radians() * share * normal(hash::combine(RANK_BREAKING, 1));
        }
        if rule.strokes.swing_rad > 0.0 {
            let at = self.particles[index].position.as_dvec3() * (scale / cycle_px);
            // The same swing in every layer.
            stray += f64::from(rule.strokes.swing_rad) * swing * f64::from(noise::slow(3, at));
        }
        stray
    }

    /// N' of a particle, and its base angle in the reference picture.
    fn lift(&self, index: usize, point: Point, (stated, scales): (&Stated<'_>, &[f64])) -> (Lift, f64) {
        let views = self.views(index, point, self.solver == Solver::Horn);
        let base = stated.base(point, &views);
        let mut tangent = base.tangent;
        if let Some(combed) = &self.combed {
            if let Some(field) = &combed.field {
                tangent = field.direction((&combed.stencils, index), point, &base);
            }
            let relaxed = || combed.field.as_ref()?.relaxed((&combed.stencils, index), point, &base);
            tangent = combed.inputs.with_guides(point, &views, tangent, relaxed);
        }
        let second = stated.second_family_rad(point);
        let mut stray = self.stray(index, &self.rules[point.rule], second.is_some(), scales[point.part]);
        stray += self.rules[point.rule].turn_rad;
        if let Some(second) = second
            && hash::unit(hash::combine(self.bits_of(index), FAMILY)) < SECOND_FAMILY
        {
            stray += second;
        }
        let base_rad =
            if tangent == base.tangent { base.in_reference_rad } else { views.angle_in_reference(tangent) };
        (views.lift(tangent).turned(stray), if base_rad.is_finite() { base_rad + stray } else { stray })
    }

    /// How the references see a particle; with Horn's estimate from its neighbours or the tangent plane's own.
    fn views(&self, index: usize, point: Point, with_horn: bool) -> Views {
        let lists = self.neighbours.as_deref().filter(|_| with_horn);
        let position = self.lifted(point);
        self.references.views((position, point.normal), point.rule, |reference| {
            let neighbours = lists?.of(index);
            let center_px = reference.map.project(position);
            let at = |other: &u32| self.particles[*other as usize].position.as_dvec3();
            let in_front = neighbours.iter().filter(|other| reference.map.depth(at(other)) > reference.near);
            Some(Lift::horn(in_front.map(|other| {
                let offset_px: DVec2 = reference.map.project(at(other)) - center_px;
                (at(other) - position, offset_px)
            })))
        })
    }

    /// The tangent plane's own lift, without base angle: what κ is measured with, whatever the solver.
    pub(crate) fn surface_lift(&self, index: usize, region: u16) -> Lift {
        self.views(index, self.point(index, region), false).bare_lift()
    }
}
