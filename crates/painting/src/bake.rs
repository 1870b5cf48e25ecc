//! The lift of every particle of a body: its reference view, its base direction, its jitter.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use impasto_core::direction::carry::Stencils;
use impasto_core::lift::Lift;
use impasto_core::neighbours::Neighbours;
use impasto_core::solve::BakedParticles;
use impasto_scene::document::Solver;
use rayon::prelude::*;

use crate::field::{BodyField, FieldInputs};
use crate::references::{BodyReference, BodyReferences, Views};
use crate::regions::RegionRule;
use crate::seats::{KeptSeats, Seats};
use crate::stated::{Point, Stated};

/// How references see the particles of a coat: what a picture still needs once lifts are baked.
#[derive(Clone)]
pub(crate) struct LiftGround {
    pub(crate) seats: Arc<Seats>,
    pub(crate) neighbours: Option<Arc<Neighbours>>,
    pub(crate) references: Arc<BodyReferences>,
    pub(crate) rules: Arc<Vec<RegionRule>>,
    /// Centre and length of the diagonal of the body's bounds, model space.
    pub(crate) extent: (DVec3, f64),
}

/// All that the lifts of a coat depend on.
#[derive(Clone)]
pub(crate) struct BakeInputs {
    pub(crate) ground: LiftGround,
    /// The same seats, with what they are made from.
    pub(crate) seats: Arc<KeptSeats>,
    pub(crate) solver: Solver,
    /// The rules that particles of the body may have.
    pub(crate) used: Arc<Vec<u16>>,
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

/// Equal but for how many particles there are.
impl PartialEq for BakeInputs {
    fn eq(&self, other: &Self) -> bool {
        let (ground, before) = (&self.ground, &other.ground);
        let same_lists = match (&ground.neighbours, &before.neighbours) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (a, b) => a.is_none() && b.is_none(),
        };
        let same_combing = match (&self.combed, &other.combed) {
            (Some(a), Some(b)) => Arc::ptr_eq(&a.inputs, &b.inputs),
            (a, b) => a.is_none() && b.is_none(),
        };
        same_lists
            && same_combing
            && self.seats.same_inputs(&other.seats)
            && ground.references == before.references
            && self.solver == other.solver
            && ground.extent == before.extent
            && self.used == other.used
            && self.used.iter().all(|&rule| {
                let of = |rules: &[RegionRule]| {
                    let RegionRule { sense, turn_rad, strokes, .. } = &rules[usize::from(rule)];
                    (*sense, *turn_rad, strokes.flatness, strokes.offset)
                };
                let direction = |rules: &'_ [RegionRule]| rules[usize::from(rule)].direction.clone();
                of(&ground.rules) == of(&before.rules) && direction(&ground.rules) == direction(&before.rules)
            })
    }
}

/// Baked particles, in progressive order.
#[derive(Clone, Debug, Default)]
pub(crate) struct BakedBody {
    pub(crate) baked: BakedParticles,
    /// θ₀ with jitter in the reference picture, radians: what `horn-exact` adds to its turn. Empty where N' alone turns.
    base_angle_rad: Vec<f32>,
}

impl BakedBody {
    /// The angle of a particle's stroke in the reference picture of its rule, radians.
    pub(crate) fn base_angle_rad(&self, particle: usize, reference: &BodyReference) -> f64 {
        match self.base_angle_rad.get(particle) {
            Some(&angle_rad) => f64::from(angle_rad),
            // What N' shows there.
            None => {
                let jacobian = reference.map.jacobian(self.baked.position_of(particle));
                self.baked.lift_of(particle).map(jacobian).angle_rad()
            }
        }
    }
}

/// How many particles one task bakes.
const CHUNK: usize = 1024;

impl BakeInputs {
    /// The lifts of all particles; those `kept` are of the same inputs, and are cut or continued.
    pub(crate) fn bake(&self, kept: Option<Arc<BakedBody>>) -> Arc<BakedBody> {
        let ground = &self.ground;
        let count = ground.seats.particles.len();
        if let Some(kept) = &kept
            && kept.baked.len() == count
        {
            return Arc::clone(kept);
        }
        let mut body = kept.map_or_else(BakedBody::default, Arc::unwrap_or_clone);
        let first = body.baked.len().min(count);
        body.baked.resize(count);
        body.base_angle_rad.truncate(count);
        if self.solver != Solver::Tangent {
            body.base_angle_rad.resize(count, 0.0);
        }
        let stated = ground.stated();
        let mut angles = body.base_angle_rad.get_mut(first..).unwrap_or_default().chunks_mut(CHUNK);
        let chunks = body.baked.chunks_mut(first, CHUNK).into_iter();
        let chunks: Vec<_> = chunks.map(|baked| (baked, angles.next().unwrap_or_default())).collect();
        chunks.into_par_iter().enumerate().for_each(|(number, (mut baked, base_angles_rad))| {
            for offset in 0..CHUNK.min(count - first - number * CHUNK) {
                let index = first + number * CHUNK + offset;
                let point = ground.point(index, ground.seats.region(index));
                let (lift, base_rad) = self.lift(index, point, &stated);
                baked.set(offset, ground.lifted(point), point.normal, lift);
                if let Some(base_angle_rad) = base_angles_rad.get_mut(offset) {
                    *base_angle_rad = base_rad as f32;
                }
            }
        });
        let flatness = |rule: u16| ground.rules[usize::from(rule)].strokes.flatness;
        body.baked.flatness.clear();
        let may_follow = self.used.iter().any(|&rule| flatness(rule) < 1.0);
        if may_follow && (0..count).any(|index| flatness(ground.seats.region(index)) < 1.0) {
            body.baked.flatness.extend((0..count).map(|index| flatness(ground.seats.region(index))));
        }
        Arc::new(body)
    }

    /// N' of a particle, and, where N' does not tell it, its base angle in the reference picture.
    fn lift(&self, index: usize, point: Point, stated: &Stated<'_>) -> (Lift, f64) {
        let ground = &self.ground;
        let views = ground.views(index, point, self.solver == Solver::Horn);
        let base = stated.base(point, &views);
        let mut tangent = base.tangent;
        if let Some(combed) = &self.combed {
            if let Some(field) = &combed.field {
                tangent = field.direction((&combed.stencils, index), point, &base);
            }
            let relaxed = || combed.field.as_ref()?.relaxed((&combed.stencils, index), point, &base);
            tangent = combed.inputs.with_guides(point, &views, tangent, relaxed);
        }
        let stray = self.seats.stray_rad[index] + ground.rules[point.rule].turn_rad;
        let lift = views.lift(tangent).turned(stray);
        if self.solver == Solver::Tangent {
            return (lift, 0.0);
        }
        let base_rad = if tangent == base.tangent {
            stated.in_reference_rad(point, &views)
        } else {
            views.angle_in_reference(tangent)
        };
        (lift, if base_rad.is_finite() { base_rad + stray } else { stray })
    }
}

impl LiftGround {
    fn stated(&self) -> Stated<'_> {
        Stated {
            rules: &self.rules,
            automatic: self.seats.parts.directions(self.references.own()),
            extent: self.extent,
        }
    }

    fn point(&self, index: usize, region: u16) -> Point {
        let particle = self.seats.particles.at(index);
        Point {
            position: particle.position.as_dvec3(),
            normal: particle.normal.as_dvec3(),
            rule: usize::from(region),
            part: self.seats.part(index),
        }
    }

    /// Where the stroke of a point is: off the surface by its region's offset.
    fn lifted(&self, point: Point) -> DVec3 {
        point.position + point.normal * f64::from(self.rules[point.rule].strokes.offset)
    }

    /// Which particles lie near a singular point of their stated direction.
    pub(crate) fn poles(&self) -> Vec<bool> {
        let stated = self.stated();
        let up_in_model = self.references.own().up_in_model;
        let is_pole = |index: usize| stated.is_pole(self.point(index, self.seats.region(index)), up_in_model);
        (0..self.seats.particles.len()).map(is_pole).collect()
    }

    /// How the references see a particle; with Horn's estimate from its neighbours or the tangent plane's own.
    fn views(&self, index: usize, point: Point, with_horn: bool) -> Views {
        let lists = self.neighbours.as_deref().filter(|_| with_horn);
        let position = self.lifted(point);
        self.references.views((position, point.normal), point.rule, |reference| {
            let neighbours = lists?.of(index);
            let center_px = reference.map.project(position);
            let at = |other: &u32| self.seats.particles.at(*other as usize).position.as_dvec3();
            let in_front = neighbours.iter().map(at).filter(|&at| reference.map.depth(at) > reference.near);
            Some(Lift::horn(in_front.map(|at| {
                let offset_px: DVec2 = reference.map.project(at) - center_px;
                (at - position, offset_px)
            })))
        })
    }

    /// The tangent plane's own lift, without base angle: what κ is measured with, whatever the solver.
    pub(crate) fn surface_lift(&self, index: usize, region: u16) -> Lift {
        self.views(index, self.point(index, region), false).bare_lift()
    }
}
