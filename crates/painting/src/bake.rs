//! Baking: places every particle. For each particle that is seen, finds the lift ([`Lift`]) from its references, base
//! direction and jitter.

use std::sync::Arc;

use glam::{DVec2, DVec3, Vec3};
use impasto_core::lift::Lift;
use impasto_core::neighbours::{Neighbours, Points};
use impasto_core::solve::PlacedParticles;
use impasto_scene::document::Solver;
use rayon::prelude::*;

use crate::amounts::painted_flatness;
use crate::coat_amounts::CoatAmounts;
use crate::field::{BodyField, FieldInputs, Near};
use crate::looks::{FindLooks, Look, Looks};
use crate::references::{BodyReference, BodyReferences, RaisedPlace, SurfacePoint, Views};
use crate::regions::RegionRule;
use crate::stated::DirectionRules;
use crate::traits::{self, TraitInputs, Traits};

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
    pub(crate) trait_inputs: Arc<TraitInputs>,
    /// The painted amounts at the particles; only flatness matters here.
    pub(crate) amounts: Arc<CoatAmounts>,
    pub(crate) solver: Solver,
    /// Indices of the rules that particles of the body may have.
    pub(crate) used: Arc<Vec<u16>>,
    /// The guides and the field that comb the directions; `None` if all directions are stated outright.
    pub(crate) combed: Option<Combed>,
}

/// The guides and the field that comb the directions of a body.
#[derive(Clone)]
pub(crate) struct Combed {
    pub(crate) inputs: Arc<FieldInputs>,
    /// `None` where no field was needed; then only guides comb, if any.
    pub(crate) field: Option<Arc<BodyField>>,
}

/// Equal where the same lifts would be baked. The number of particles matters in two cases: where flatness is painted
/// (one factor for each particle), and where neighbours are used (for another number their lists are made anew).
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
#[derive(Default)]
pub(crate) struct BakedBody {
    pub(crate) placed: PlacedParticles,
    /// How much a stroke lies flat on the picture ([`impasto_core::solve::BakedParticles::flatness`]); empty when all
    /// are 1.
    pub(crate) flatness: Vec<f32>,
    pub(crate) looks: Looks,
}

impl BakedBody {
    pub(crate) fn bytes(&self) -> usize {
        self.placed.bytes() + size_of_val(&self.flatness[..]) + self.looks.bytes()
    }

    /// A particle's lift N'.
    pub(crate) fn lift(&self, particle: usize) -> Lift {
        let [along, across] =
            self.looks.at(particle).lift.map(|column| DVec3::from_array(column.map(f64::from)));
        Lift { along, across }
    }

    /// The angle of a particle's stroke in the reference picture of its rule, radians.
    pub(crate) fn base_angle_rad(
        &self,
        particle: usize,
        raised: RaisedPlace,
        reference: &BodyReference,
    ) -> f64 {
        if self.looks.has_angles() {
            return f64::from(self.looks.at(particle).base_angle_rad);
        }
        // The angle at which N' shows in that picture.
        let then = reference.then(raised);
        let jacobian = then.pulled_back(reference.map.jacobian(then.position));
        self.lift(particle).map(jacobian).angle_rad()
    }
}

/// How many particles one task places.
const CHUNK: usize = 1024;

/// How many looks are found together.
const BATCH: usize = traits::BATCH;

impl BakeInputs {
    /// Places all particles; their looks are found later. Shortens or extends `before`, which must come from equal
    /// inputs.
    pub(crate) fn bake(self: &Arc<Self>, before: Option<Arc<BakedBody>>) -> Arc<BakedBody> {
        let sources = &self.sources;
        let count = sources.traits.particles.len();
        if let Some(before) = &before
            && before.placed.len() == count
        {
            return Arc::clone(before);
        }
        let looks = match &before {
            Some(before) => before.looks.resized(Arc::clone(self) as _, count),
            None => Looks::unknown(Arc::clone(self) as _, count),
        };
        let mut placed = match before.map(Arc::try_unwrap) {
            Some(Ok(before)) => before.placed,
            Some(Err(shared)) => shared.placed.clone(),
            None => PlacedParticles::default(),
        };
        let first = placed.len().min(count);
        placed.resize(count);
        let chunks = placed.chunks_mut(first, CHUNK);
        chunks.into_par_iter().enumerate().for_each(|(number, mut placed)| {
            for offset in 0..CHUNK.min(count - first - number * CHUNK) {
                let index = first + number * CHUNK + offset;
                let point = sources.point(index, sources.traits.region(index));
                placed.set(offset, sources.off_surface(point).position, point.normal);
            }
        });
        let of_rule = |rule: u16| sources.rules[usize::from(rule)].strokes.flatness;
        let painted = self.amounts.flatness();
        let flatness = |index: usize| {
            let of_rule = of_rule(sources.traits.region(index));
            painted.get(index).map_or(of_rule, |&by| painted_flatness(of_rule, by))
        };
        let may_follow = !painted.is_empty() || self.used.iter().any(|&rule| of_rule(rule) < 1.0);
        let follows = may_follow && (0..count).any(|index| flatness(index) < 1.0);
        let flatness = if follows { (0..count).map(flatness).collect() } else { Vec::new() };
        Arc::new(BakedBody { placed, flatness, looks })
    }

    /// N' of a particle, and the angle of its stroke in the reference picture, radians (0 with the solver `Tangent`,
    /// which has no use for it). Both include the rule's turn and `stray_rad`, which chance and slow noise add.
    fn lift(
        &self,
        index: usize,
        point: SurfacePoint,
        stray_rad: f64,
        stated: &DirectionRules<'_>,
        near: Option<Near<'_>>,
    ) -> (Lift, f64) {
        let sources = &self.sources;
        let views = sources.views(index, point, self.solver == Solver::Horn);
        let base = stated.base(point, &views);
        let mut tangent = base.tangent;
        if let Some(combed) = &self.combed {
            let field = combed.field.as_ref().zip(near);
            if let Some((field, near)) = field {
                tangent = field.direction(near, point, &base);
            }
            let relaxed = || field.and_then(|(field, near)| field.relaxed(near, point, &base));
            tangent = combed.inputs.with_guides(point, &views, tangent, relaxed);
        }
        let stray = stray_rad + sources.rules[point.rule].turn_rad;
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

impl FindLooks for BakeInputs {
    fn has_angles(&self) -> bool {
        self.solver != Solver::Tangent
    }

    fn find_looks(&self, particles: &[u32], found: &mut dyn FnMut(usize, Look)) {
        let sources = &self.sources;
        let stated = sources.stated();
        let stencils = self.combed.as_ref().filter(|combed| combed.field.is_some()).map(|combed| {
            let at = |&particle: &u32| sources.traits.particles.at(particle as usize);
            let (positions, normals): (Vec<Vec3>, Vec<Vec3>) =
                particles.iter().map(at).map(|particle| (particle.position, particle.normal)).unzip();
            combed.inputs.samples.stencils(Points { positions: &positions, normals: &normals })
        });
        for (number, batch) in particles.chunks(BATCH).enumerate() {
            let noise = self.trait_inputs.noise(&sources.traits, batch);
            for (offset, &particle) in batch.iter().enumerate() {
                let index = particle as usize;
                let point = sources.point(index, sources.traits.region(index));
                let near =
                    stencils.as_ref().map(|stencils| Near { stencils, offset: number * BATCH + offset });
                let (lift, base_rad) = self.lift(index, point, noise.stray_rad[offset], &stated, near);
                let lift = [lift.along, lift.across].map(|column| column.as_vec3().to_array());
                found(index, Look { lift, drift: noise.drift[offset], base_angle_rad: base_rad as f32 });
            }
        }
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

    /// The lift of the tangent plane, without base angle: the trust κ is measured with it, whatever the solver.
    pub(crate) fn surface_lift(&self, index: usize, region: u16) -> Lift {
        self.views(index, self.point(index, region), false).bare_lift()
    }
}
