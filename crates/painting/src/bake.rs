//! The lift of every particle of a body: its reference view, its base direction, its jitter.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use impasto_core::ScreenMap;
use impasto_core::direction;
use impasto_core::hash;
use impasto_core::lift::{Lift, turntable_axes};
use impasto_core::neighbours::Neighbours;
use impasto_core::noise;
use impasto_core::presence::smoothstep;
use impasto_core::sampling::Particle;
use impasto_core::screen_map::facing;
use impasto_core::solve::BakedParticles;
use impasto_scene::document::{Direction, Solver};
use rayon::prelude::*;

use crate::parts::{BodyParts, px_per_unit};
use crate::regions::RegionRule;

/// The reference view as one body sees it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BodyReference {
    pub(crate) map: ScreenMap,
    pub(crate) near: f64,
    pub(crate) roll_rad: f64,
    /// The world's up in model space, at the reference pose.
    pub(crate) up_in_model: DVec3,
    /// Width and height of the scene's picture.
    pub(crate) size_px: [u32; 2],
}

/// All that the lifts of a body depend on.
#[derive(Clone)]
pub(crate) struct BakeInputs {
    pub(crate) particles: Arc<Vec<Particle>>,
    pub(crate) neighbours: Option<Arc<Neighbours>>,
    pub(crate) reference: BodyReference,
    pub(crate) solver: Solver,
    /// Region of each triangle.
    pub(crate) region_of_triangle: Vec<u16>,
    pub(crate) rules: Vec<RegionRule>,
    /// Hash of the object's name, the scene's seed and the layer.
    pub(crate) name_hash: u32,
    /// Centre and length of the diagonal of the body's bounds, model space.
    pub(crate) extent: (DVec3, f64),
    pub(crate) parts: Arc<BodyParts>,
}

impl PartialEq for BakeInputs {
    fn eq(&self, other: &Self) -> bool {
        let same_lists = match (&self.neighbours, &other.neighbours) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (a, b) => a.is_none() && b.is_none(),
        };
        same_lists
            && Arc::ptr_eq(&self.particles, &other.particles)
            && self.reference == other.reference
            && self.solver == other.solver
            && self.region_of_triangle == other.region_of_triangle
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
        let directions = self.parts.directions(&self.reference, self.reference.size_px);
        let lifts: Vec<(Lift, f64)> = (0..count)
            .into_par_iter()
            .with_min_len(2048)
            .map(|particle| {
                let part = self.part_of(particle);
                self.lift(particle, &directions[part], scales[part])
            })
            .collect();
        let mut baked = BakedParticles::default();
        for (particle, (lift, _)) in self.particles.iter().zip(&lifts) {
            baked.push(particle.position.as_dvec3(), particle.normal.as_dvec3(), *lift);
        }
        let region: Vec<u16> = self
            .particles
            .iter()
            .map(|particle| self.region_of_triangle[particle.triangle as usize])
            .collect();
        if self.rules.iter().any(|rule| rule.strokes.flatness < 1.0) {
            baked.flatness =
                region.iter().map(|&region| self.rules[region as usize].strokes.flatness).collect();
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

    fn part_of(&self, particle: usize) -> usize {
        self.parts.of_triangle[self.particles[particle].triangle as usize] as usize
    }

    fn bits_of(&self, particle: usize) -> u32 {
        hash::combine(self.name_hash, particle as u32)
    }

    /// For each part, pixels of a picture 720 high per model unit, at the reference pose.
    fn scales(&self) -> Vec<f64> {
        let scale = 720.0 / f64::from(self.reference.size_px[1]);
        self.parts.parts.iter().map(|part| px_per_unit(&self.reference.map, part) * scale).collect()
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

    /// N' of a particle, and its base angle in the reference picture. `automatic` is the direction of its part where its
    /// region states none, `scale` the part's own.
    fn lift(&self, index: usize, automatic: &Direction, scale: f64) -> (Lift, f64) {
        let particle = &self.particles[index];
        let rule = &self.rules[self.region_of_triangle[particle.triangle as usize] as usize];
        let (position, normal) = (particle.position.as_dvec3(), particle.normal.as_dvec3());
        let direction = if rule.direction == Direction::Auto { automatic } else { &rule.direction };
        let crossing = matches!(direction, Direction::Crossing(..));
        let jitter = self.stray(index, rule, crossing, scale);
        let tangent = match *direction {
            Direction::Auto | Direction::Angle(_) | Direction::Crossing(..) => DVec3::ZERO,
            Direction::Around(axis) => {
                let (center, size) = self.extent;
                direction::around(DVec3::from(axis), normal, position - center, size)
            }
            Direction::Along(axis) => direction::towards(DVec3::from(axis), normal),
            Direction::Up => direction::towards(DVec3::Y, normal),
        };
        let stated_rad = match *direction {
            Direction::Angle(degrees) => degrees.to_radians(),
            Direction::Crossing(first, second) => {
                let in_second = hash::unit(hash::combine(self.bits_of(index), FAMILY)) < SECOND_FAMILY;
                if in_second { second.to_radians() } else { first.to_radians() }
            }
            Direction::Auto | Direction::Along(_) | Direction::Around(_) | Direction::Up => 0.0,
        };
        // A base direction on the surface shows at another angle in each view; a stated angle is the same in all.
        let angle_in = |axes: [DVec3; 2]| {
            if tangent == DVec3::ZERO { stated_rad } else { tangent.dot(axes[1]).atan2(tangent.dot(axes[0])) }
        };
        let jacobian = self.reference.map.jacobian(position);
        let base_rad = angle_in(jacobian) + jitter;
        let lists = self.neighbours.as_deref().filter(|_| self.solver == Solver::Horn);
        let (seen, virtual_view) = self.references(index, lists);
        let rolled = {
            let [right, above] = turntable_axes(normal, self.reference.up_in_model);
            let (sin, cos) = self.reference.roll_rad.sin_cos();
            [right * cos + above * sin, above * cos - right * sin]
        };
        let unseen = virtual_view.turned(angle_in(rolled) + jitter);
        let lift = match seen {
            Some((lift, share)) if share < 1.0 => {
                lift.turned(base_rad).blended(unseen, 1.0 - share, jacobian)
            }
            Some((lift, _)) => lift.turned(base_rad),
            None => unseen,
        };
        (lift, if base_rad.is_finite() { base_rad } else { 0.0 })
    }

    /// The lift from the reference view with its share (1 where the view faces the surface squarely, none where it does
    /// not), and the one from the virtual view. With neighbours, Horn's estimate; without, the tangent's.
    fn references(&self, index: usize, neighbours: Option<&Neighbours>) -> (Option<(Lift, f64)>, Lift) {
        let particle = &self.particles[index];
        let (position, normal) = (particle.position.as_dvec3(), particle.normal.as_dvec3());
        let jacobian = self.reference.map.jacobian(position);
        let px_per_unit = jacobian[0].cross(jacobian[1]).length().sqrt();
        let px_per_unit = if px_per_unit.is_finite() && px_per_unit > 0.0 { px_per_unit } else { 1.0 };
        let virtual_view =
            Lift::facing_view(normal, self.reference.up_in_model, self.reference.roll_rad, px_per_unit);
        let faced = facing(jacobian, normal);
        let share = f64::from(smoothstep(((faced - 0.2) / 0.3) as f32));
        if self.reference.map.depth(position) <= self.reference.near || share.is_nan() || share <= 0.0 {
            return (None, virtual_view);
        }
        let lift = match neighbours {
            Some(neighbours) => {
                let center_px = self.reference.map.project(position);
                let in_front = |&other: &u32| {
                    self.reference.map.depth(self.particles[other as usize].position.as_dvec3())
                        > self.reference.near
                };
                Lift::horn(neighbours.of(index).iter().filter(|other| in_front(other)).map(|&other| {
                    let neighbour = self.particles[other as usize].position.as_dvec3();
                    let offset_px: DVec2 = self.reference.map.project(neighbour) - center_px;
                    (neighbour - position, offset_px)
                }))
            }
            None => Lift::tangent(jacobian, normal),
        };
        (lift.map(|lift| (lift, share)), virtual_view)
    }

    /// The tangent plane's own lift, without base angle: what κ is measured with, whatever the solver.
    pub(crate) fn surface_lift(&self, index: usize) -> Lift {
        match self.references(index, None) {
            (Some((lift, share)), virtual_view) if share < 1.0 => {
                let jacobian = self.reference.map.jacobian(self.particles[index].position.as_dvec3());
                lift.blended(virtual_view, 1.0 - share, jacobian)
            }
            (Some((lift, _)), _) => lift,
            (None, virtual_view) => virtual_view,
        }
    }
}
