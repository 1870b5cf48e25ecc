//! Baking: the lift of every particle, from its references, its base direction and its jitter.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use impasto_core::direction::carry::Stencils;
use impasto_core::lift::Lift;
use impasto_core::neighbours::Neighbours;
use impasto_core::solve::BakedParticles;
use impasto_scene::document::Solver;
use rayon::prelude::*;

use crate::amounts::painted_flatness;
use crate::coat_amounts::CoatAmounts;
use crate::field::{BodyField, FieldInputs};
use crate::references::{BodyReference, BodyReferences, RaisedPlace, SurfacePoint, Views};
use crate::regions::RegionRule;
use crate::stated::DirectionRules;
use crate::traits::{TraitInputs, Traits};

/// Those inputs of the lifts that are still needed after baking, when pictures are made.
#[derive(Clone)]
pub(crate) struct LiftSources {
    pub(crate) traits: Arc<Traits>,
    pub(crate) neighbours: Option<Arc<Neighbours>>,
    pub(crate) references: Arc<BodyReferences>,
    pub(crate) rules: Arc<Vec<RegionRule>>,
    /// Centre and length of the diagonal of the body's bounds, model space.
    pub(crate) extent: (DVec3, f64),
}

/// All that the lifts of a coat depend on.
pub(crate) struct BakeInputs {
    pub(crate) sources: LiftSources,
    /// What the traits are made from.
    pub(crate) trait_inputs: Arc<TraitInputs>,
    /// What chance and slow noise add to the base angle of each particle, radians.
    pub(crate) stray_rad: Arc<Vec<f64>>,
    /// What is painted onto the particles; only flatness matters here.
    pub(crate) amounts: Arc<CoatAmounts>,
    pub(crate) solver: Solver,
    /// The rules that particles of the body may have.
    pub(crate) used: Arc<Vec<u16>>,
    /// What combs the directions; none if they are all stated outright.
    pub(crate) combed: Option<Combed>,
}

/// What combs the directions of a coat.
pub(crate) struct Combed {
    pub(crate) inputs: Arc<FieldInputs>,
    /// `None` where no field was needed; then only guides comb, if any.
    pub(crate) field: Option<Arc<BodyField>>,
    /// Which samples of the field each particle uses.
    pub(crate) stencils: Arc<Stencils>,
}

/// Equal where the same lifts would be baked. The number of particles matters only where flatness is painted: its
/// factors are compared, and there is one per particle.
impl PartialEq for BakeInputs {
    fn eq(&self, other: &Self) -> bool {
        let (sources, before) = (&self.sources, &other.sources);
        let same_lists = match (&sources.neighbours, &before.neighbours) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (a, b) => a.is_none() && b.is_none(),
        };
        let same_combing = match (&self.combed, &other.combed) {
            (Some(a), Some(b)) => Arc::ptr_eq(&a.inputs, &b.inputs),
            (a, b) => a.is_none() && b.is_none(),
        };
        same_lists
            && same_combing
            && self.trait_inputs == other.trait_inputs
            && self.amounts.flatness() == other.amounts.flatness()
            && sources.references == before.references
            && self.solver == other.solver
            && sources.extent == before.extent
            && self.used == other.used
            && self.used.iter().all(|&rule| {
                let of = |rules: &[RegionRule]| {
                    let RegionRule { sense, turn_rad, strokes, .. } = &rules[usize::from(rule)];
                    (*sense, *turn_rad, strokes.flatness, strokes.offset)
                };
                let direction = |rules: &'_ [RegionRule]| rules[usize::from(rule)].direction.clone();
                of(&sources.rules) == of(&before.rules)
                    && direction(&sources.rules) == direction(&before.rules)
            })
    }
}

/// Baked particles, in progressive order.
#[derive(Clone, Debug, Default)]
pub(crate) struct BakedBody {
    pub(crate) baked: BakedParticles,
    /// The base angles with jitter in the reference picture, radians; `horn-exact` adds its turn to them. Empty with
    /// the solver `Tangent`, where the lift N' alone gives the angle.
    base_angle_rad: Vec<f32>,
}

impl BakedBody {
    /// Puts a body together from what a file kept.
    pub(crate) fn of_kept(baked: BakedParticles, base_angle_rad: Vec<f32>) -> Self {
        Self { baked, base_angle_rad }
    }

    /// The base angles of all particles; empty with the solver `Tangent`.
    pub(crate) fn base_angles_rad(&self) -> &[f32] {
        &self.base_angle_rad
    }

    /// The angle of a particle's stroke in the reference picture of its rule, radians.
    pub(crate) fn base_angle_rad(
        &self,
        particle: usize,
        raised: RaisedPlace,
        reference: &BodyReference,
    ) -> f64 {
        match self.base_angle_rad.get(particle) {
            Some(&angle_rad) => f64::from(angle_rad),
            // The angle at which N' shows in that picture.
            None => {
                let then = reference.then(raised);
                let jacobian = then.pulled_back(reference.map.jacobian(then.position));
                self.baked.lift_of(particle).map(jacobian).angle_rad()
            }
        }
    }
}

/// How many particles one task bakes.
const CHUNK: usize = 1024;

impl BakeInputs {
    /// Bakes the lifts of all particles. Shortens or extends `before`, which must come from equal inputs.
    pub(crate) fn bake(&self, before: Option<Arc<BakedBody>>) -> Arc<BakedBody> {
        let sources = &self.sources;
        let count = sources.traits.particles.len();
        if let Some(before) = &before
            && before.baked.len() == count
        {
            return Arc::clone(before);
        }
        let mut body = before.map_or_else(BakedBody::default, Arc::unwrap_or_clone);
        let first = body.baked.len().min(count);
        body.baked.resize(count);
        body.base_angle_rad.truncate(count);
        if self.solver != Solver::Tangent {
            body.base_angle_rad.resize(count, 0.0);
        }
        let stated = sources.stated();
        let mut angles = body.base_angle_rad.get_mut(first..).unwrap_or_default().chunks_mut(CHUNK);
        let chunks = body.baked.chunks_mut(first, CHUNK).into_iter();
        let chunks: Vec<_> = chunks.map(|baked| (baked, angles.next().unwrap_or_default())).collect();
        chunks.into_par_iter().enumerate().for_each(|(number, (mut baked, base_angles_rad))| {
            for offset in 0..CHUNK.min(count - first - number * CHUNK) {
                let index = first + number * CHUNK + offset;
                let point = sources.point(index, sources.traits.region(index));
                let (lift, base_rad) = self.lift(index, point, &stated);
                baked.set(offset, sources.off_surface(point).position, point.normal, lift);
                if let Some(base_angle_rad) = base_angles_rad.get_mut(offset) {
                    *base_angle_rad = base_rad as f32;
                }
            }
        });
        let of_rule = |rule: u16| sources.rules[usize::from(rule)].strokes.flatness;
        let painted = self.amounts.flatness();
        let flatness = |index: usize| {
            let of_rule = of_rule(sources.traits.region(index));
            painted.get(index).map_or(of_rule, |&by| painted_flatness(of_rule, by))
        };
        body.baked.flatness.clear();
        let may_follow = !painted.is_empty() || self.used.iter().any(|&rule| of_rule(rule) < 1.0);
        if may_follow && (0..count).any(|index| flatness(index) < 1.0) {
            body.baked.flatness.extend((0..count).map(flatness));
        }
        Arc::new(body)
    }

    /// N' of a particle and its base angle in the reference picture, radians (0 with the solver `Tangent`, which has no
    /// use for it).
    fn lift(&self, index: usize, point: SurfacePoint, stated: &DirectionRules<'_>) -> (Lift, f64) {
        let sources = &self.sources;
        let views = sources.views(index, point, self.solver == Solver::Horn);
        let base = stated.base(point, &views);
        let mut tangent = base.tangent;
        if let Some(combed) = &self.combed {
            if let Some(field) = &combed.field {
                tangent = field.direction(&combed.stencils, index, point, &base);
            }
            let relaxed = || combed.field.as_ref()?.relaxed(&combed.stencils, index, point, &base);
            tangent = combed.inputs.with_guides(point, &views, tangent, relaxed);
        }
        let stray = self.stray_rad[index] + sources.rules[point.rule].turn_rad;
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

impl LiftSources {
    fn stated(&self) -> DirectionRules<'_> {
        DirectionRules {
            rules: &self.rules,
            automatic: self.traits.parts.directions(self.references.own()),
            extent: self.extent,
        }
    }

    fn point(&self, index: usize, region: u16) -> SurfacePoint {
        let particle = self.traits.particles.at(index);
        SurfacePoint {
            place: self.traits.particles.places()[index],
            height: 0.0,
            position: particle.position.as_dvec3(),
            normal: particle.normal.as_dvec3(),
            rule: usize::from(region),
            part: self.traits.part(index),
        }
    }

    /// The point where the stroke lies: lifted off the surface by its region's offset.
    fn off_surface(&self, point: SurfacePoint) -> SurfacePoint {
        let offset = f64::from(self.rules[point.rule].strokes.offset);
        SurfacePoint { position: point.position + point.normal * offset, height: offset, ..point }
    }

    /// Which particles lie near a singular point of their stated direction.
    pub(crate) fn poles(&self) -> Vec<bool> {
        let stated = self.stated();
        let up_in_model = self.references.own().up_in_model;
        let is_pole =
            |index: usize| stated.is_pole(self.point(index, self.traits.region(index)), up_in_model);
        (0..self.traits.particles.len()).map(is_pole).collect()
    }

    /// How the references see a particle: by its tangent plane or, `with_horn`, by Horn's estimate from its neighbours.
    fn views(&self, index: usize, point: SurfacePoint, with_horn: bool) -> Views {
        let lists = self.neighbours.as_deref().filter(|_| with_horn);
        let point = self.off_surface(point);
        let position = point.position;
        self.references.views(point, |reference| {
            let neighbours = lists?.of(index);
            let center_px = reference.map.project(reference.then(point.raised()).position);
            // A neighbour's position at rest, and its position at the reference's frame.
            let at = |other: &u32| {
                let at_rest = self.traits.particles.at(*other as usize).position.as_dvec3();
                let carried = reference.carried(self.traits.particles.places()[*other as usize]);
                [at_rest, carried.map_or(at_rest, |carried| carried.position)]
            };
            let in_front =
                neighbours.iter().map(at).filter(|[_, at]| reference.map.depth(*at) > reference.near);
            Some(Lift::horn(in_front.map(|[at_rest, at]| {
                let offset_px: DVec2 = reference.map.project(at) - center_px;
                (at_rest - position, offset_px)
            })))
        })
    }

    /// The lift of the tangent plane, without base angle: κ is measured with it, whatever the solver.
    pub(crate) fn surface_lift(&self, index: usize, region: u16) -> Lift {
        self.views(index, self.point(index, region), false).bare_lift()
    }
}
