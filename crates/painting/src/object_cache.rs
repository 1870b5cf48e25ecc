//! The steps of preparing one object, each with its result cached beside the inputs that it was computed from.

use std::sync::{Arc, OnceLock};

use glam::{DVec3, Vec3};
use impasto_core::neighbours::{Neighbours, full_list_radius};
use impasto_core::sampling::Surface;
use impasto_scene::document::Solver;
use impasto_scene::presets::LayerKind;
use rayon::prelude::*;

use crate::bake::{BakeInputs, BakedBody, Combed, LiftSources};
use crate::body::BodySurface;
use crate::body_shape::{BodyNoise, BodyShape};
use crate::cached::Cached;
use crate::coat::{Coat, SampleInputs, Sampled};
use crate::coat_amounts::{AmountInputs, CoatAmounts};
use crate::context::{Context, ObjectInputs};
use crate::counts::{BodyCounts, CoatCount, CountInputs, Counted};
use crate::field::{BodyField, FieldInputs, FieldSamples};
use crate::frame::Brushes;
use crate::kept::{KeptCoat, KeptObject};
use crate::late_field::LateField;
use crate::needed::NeededInputs;
use crate::noise_displace::NoiseInputs;
use crate::particles::Particles;
use crate::parts::BodyParts;
use crate::references::Standing;
use crate::regions::RegionRule;
use crate::surface::SurfaceInputs;
use crate::traits::{TraitInputs, Traits};

const LAYERS: usize = LayerKind::ALL.len();

/// The results of all steps for one object.
#[derive(Default)]
pub(crate) struct ObjectCache {
    surface: Cached<SurfaceInputs, ObjectSurface>,
    noise: Cached<NoiseInputs, Option<Arc<BodyNoise>>>,
    bounds: Cached<Shaped, Option<(Vec3, Vec3)>>,
    stands: Cached<Shaped, Vec<Standing>>,
    counts: Cached<Arc<CountInputs>, Counted>,
    /// For each coat, how many particles it needs and where. Nothing is cached if no coat's particles may depend on the
    /// views, or if the coats come from a kept painting (see [`Self::take_kept`]).
    needed: Cached<NeededInputs, [CoatCount; LAYERS]>,
    samples: Cached<FieldSampleInputs, Arc<FieldSamples>>,
    /// `None` if the body needs no field (see [`BodyField::solve`]).
    field: Cached<Arc<FieldInputs>, Option<Arc<BodyField>>>,
    coats: [CoatCache; LAYERS],
}

/// The results of all steps for one coat.
#[derive(Default)]
struct CoatCache {
    sampled: Cached<SampleInputs, Arc<Sampled>>,
    neighbours: Cached<Particles, Arc<Neighbours>>,
    traits: Cached<Arc<TraitInputs>, Arc<Traits>>,
    amounts: Cached<AmountInputs, Arc<CoatAmounts>>,
    baked: Cached<Arc<BakeInputs>, Arc<BakedBody>>,
}

#[derive(Clone)]
struct ObjectSurface {
    body: Arc<BodySurface>,
    parts: Arc<BodyParts>,
    extent: (DVec3, f64),
}

/// The inputs of the field's samples.
#[derive(PartialEq)]
struct FieldSampleInputs {
    surface: SurfaceInputs,
    name_hash: u32,
}

/// A surface, and shapes that it takes on.
#[derive(Clone)]
struct Shaped {
    surface: Arc<BodySurface>,
    shapes: Vec<BodyShape>,
}

impl PartialEq for Shaped {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.surface, &other.surface) && self.shapes == other.shapes
    }
}

/// Shapes without noise, each once.
fn distinct(shapes: Vec<BodyShape>) -> Vec<BodyShape> {
    let mut all: Vec<BodyShape> = Vec::new();
    for shape in shapes.into_iter().map(|shape| BodyShape { noise: None, ..shape }) {
        if !all.contains(&shape) {
            all.push(shape);
        }
    }
    all
}

impl ObjectCache {
    pub(crate) fn build_surface(&mut self, inputs: &SurfaceInputs) {
        self.surface.update(inputs.clone(), |inputs, _| {
            let body = inputs.build();
            let surface = Surface::with_sides(&body.mesh, &body.sides, |_| true);
            ObjectSurface {
                parts: Arc::new(BodyParts::of(&surface)),
                extent: body.extent(),
                body: Arc::new(body),
            }
        });
    }

    /// Takes the surface of another object, which is built and has equal inputs.
    pub(crate) fn share_surface(&mut self, inputs: &SurfaceInputs, twin: &Self) {
        self.surface.update(inputs.clone(), |_, _| twin.object_surface().clone());
    }

    pub(crate) fn build_noise(&mut self, inputs: NoiseInputs) {
        self.noise.update(inputs, |inputs, before| inputs.build(before.as_ref()));
    }

    /// The noise that displaces and colours the object.
    pub(crate) fn noise(&self) -> Option<Arc<BodyNoise>> {
        self.noise.output()?.clone()
    }

    fn object_surface(&self) -> &ObjectSurface {
        self.surface.output().expect("the surface step ran before")
    }

    pub(crate) fn surface(&self) -> Arc<BodySurface> {
        Arc::clone(&self.object_surface().body)
    }

    pub(crate) fn parts(&self) -> Arc<BodyParts> {
        Arc::clone(&self.object_surface().parts)
    }

    /// Least and greatest corner of the box round the surface in all these shapes.
    pub(crate) fn bounds(&mut self, shapes: Vec<BodyShape>) -> Option<(Vec3, Vec3)> {
        let surface = self.surface();
        let noise = self.noise().map_or(0.0, |noise| noise.reach());
        let inputs = Shaped { surface: Arc::clone(&surface), shapes: distinct(shapes) };
        let bounds = self.bounds.update(inputs, |Shaped { shapes, .. }, _| {
            let bent = shapes.iter().map(|shape| surface.positions_at(shape));
            let boxes = bent.filter_map(|positions| surface.mesh.bounds_at(&positions));
            boxes.reduce(|(low, high), (least, greatest)| (low.min(least), high.max(greatest)))
        });
        bounds.map(|(low, high)| (low - noise, high + noise))
    }

    /// The body in each of these shapes.
    pub(crate) fn stands(&mut self, shapes: Vec<BodyShape>) -> Vec<Standing> {
        let (surface, parts) = (self.surface(), self.parts());
        let known = self.stands.update(Shaped { surface: Arc::clone(&surface), shapes }, |inputs, before| {
            let known = before.map_or(Vec::new(), |(inputs, known)| {
                if Arc::ptr_eq(&inputs.surface, &surface) { known } else { Vec::new() }
            });
            let stand = |shape: &BodyShape| {
                let same = known.iter().find(|standing: &&Standing| standing.shape == *shape);
                same.cloned().unwrap_or_else(|| {
                    let bent = surface.bent(shape);
                    let centers = bent
                        .as_ref()
                        .map_or(Vec::new(), |bent| parts.centers(&surface.mesh, &bent.vertices.positions));
                    Standing { shape: shape.clone(), bent, centers }
                })
            };
            inputs.shapes.iter().map(stand).collect::<Vec<_>>()
        });
        known.clone()
    }

    /// Finds how many particles each coat has, and where.
    pub(crate) fn count(&mut self, context: &Context<'_>, object: ObjectInputs<'_>) {
        let ObjectSurface { body, parts, .. } = self.object_surface().clone();
        let surface = OnceLock::new();
        let surface = || surface.get_or_init(|| Surface::with_sides(&body.mesh, &body.sides, |_| true));
        let inputs = Arc::new(CountInputs::new(context, object, Arc::clone(&body)));
        let counted = self.counts.update(inputs, |inputs, _| inputs.counts(surface(), &parts)).clone();
        match self.counts.inputs() {
            Some(inputs)
                if context.seen.is_as_before()
                    && self.needed.inputs().is_some_and(|before| before.counted.same_surface(inputs)) => {}
            Some(inputs) if counted.may_depend_on_views.contains(&true) => {
                let inputs = NeededInputs::new(context, object, inputs);
                self.needed.update(inputs, |inputs, _| inputs.counts(&counted, surface(), &parts));
            }
            _ => self.needed.clear(),
        }
    }

    /// How many particles each coat is to have.
    pub(crate) fn counted(&self) -> BodyCounts {
        let counted = self.counts.output().cloned().unwrap_or_default();
        let mut of_coats = counted.counts.map(CoatCount::everywhere);
        for (count, needed) in of_coats.iter_mut().zip(self.needed.output().into_iter().flatten()) {
            if needed.needed.is_some() {
                *count = needed.clone();
            }
        }
        BodyCounts { of_coats, counted }
    }

    /// Samples the particles of every coat.
    pub(crate) fn sample(&mut self, context: &Context<'_>, object: ObjectInputs<'_>) {
        let body = self.surface();
        let surface = OnceLock::new();
        let surface = || surface.get_or_init(|| Surface::with_sides(&body.mesh, &body.sides, |_| true));
        let counts = self.counted().of_coats;
        let coats = self.coats.par_iter_mut().zip(LayerKind::ALL).zip(counts);
        coats.for_each(|((coat, kind), count)| {
            let inputs = SampleInputs::new(context, object, kind, &count);
            let count = count.count_on_whole;
            coat.sampled.resize(inputs, |inputs, before| inputs.sample(before, count, &body, surface));
        });
    }

    /// Finds the neighbours of every particle.
    pub(crate) fn find_neighbours(&mut self) {
        for coat in &mut self.coats {
            let (area, particles) = (coat.sampled().area, coat.sampled().particles.clone());
            coat.neighbours.update(particles, |particles, _| {
                let (positions, normals) = particles.points();
                let radius = full_list_radius(area, positions.len()) as f32;
                Arc::new(Neighbours::find(&positions, &normals, radius))
            });
        }
    }

    /// Solves the direction field of the body, where it needs one.
    pub(crate) fn solve_field(&mut self, context: &Context<'_>, object: ObjectInputs<'_>) {
        if !needs_field(context, object) {
            self.field.clear();
            return;
        }
        let body = self.surface();
        let name_hash = context.name_hash(object.index, LayerKind::Body);
        let sample_inputs = FieldSampleInputs { surface: object.surface.clone(), name_hash };
        let samples =
            Arc::clone(self.samples.update(sample_inputs, |_, _| Arc::new(field_samples(&body, name_hash))));
        let inputs = self.field_inputs(context, object, Arc::clone(&samples));
        self.field.update(Arc::new(inputs), |inputs, before| {
            let before = before.and_then(|(_, field)| field);
            BodyField::solve(inputs, before.as_deref()).map(Arc::new)
        });
    }

    fn field_inputs(
        &self,
        context: &Context<'_>,
        object: ObjectInputs<'_>,
        samples: Arc<FieldSamples>,
    ) -> FieldInputs {
        let ObjectSurface { parts, extent, .. } = self.object_surface();
        FieldInputs {
            samples,
            references: Arc::clone(object.references),
            regions: Arc::clone(object.regions),
            guides: Arc::clone(object.guides),
            amounts: Arc::clone(object.amounts),
            rules: Arc::clone(context.rules),
            parts: Arc::clone(parts),
            extent: *extent,
            used: Arc::clone(object.used),
            orthographic: context.orthographic,
        }
    }

    /// The field of the body, if it has one.
    pub(crate) fn field(&self) -> Arc<LateField> {
        Arc::new(LateField::solved(self.field.output().and_then(Clone::clone)))
    }

    /// The field of a body whose coats were kept, to be solved when it is first asked for.
    pub(crate) fn late_field(&self, context: &Context<'_>, object: ObjectInputs<'_>) -> Arc<LateField> {
        if !needs_field(context, object) {
            return Arc::new(LateField::solved(None));
        }
        let (body, name_hash) = (self.surface(), context.name_hash(object.index, LayerKind::Body));
        let inputs = self.field_inputs(context, object, Arc::default());
        Arc::new(LateField::later(move || {
            let samples = Arc::new(field_samples(&body, name_hash));
            BodyField::solve(&Arc::new(FieldInputs { samples, ..inputs.clone() }), None).map(Arc::new)
        }))
    }

    /// Bakes the coats that have particles, and the coat of the body layer in any case.
    pub(crate) fn bake(
        &mut self,
        context: &Context<'_>,
        object: ObjectInputs<'_>,
        brushes: &Brushes,
    ) -> Vec<Arc<Coat>> {
        let surface = self.object_surface().clone();
        let field = self.field.inputs().cloned().zip(self.field.output().cloned());
        let combed = field.map(|(inputs, field)| Combed { inputs, field });
        let coats = self.coats.par_iter_mut().zip(LayerKind::ALL);
        let coats =
            coats.filter(|(coat, kind)| *kind == LayerKind::Body || !coat.sampled().particles.is_empty());
        coats
            .map(|(coat, kind)| {
                let combed = combed.clone();
                let given = CoatInputs { context, object, brushes, kind, surface: &surface };
                Arc::new(coat.bake(&given, combed))
            })
            .collect()
    }

    /// Makes the coats from what was kept. It caches three things for later edits: the counts, the lists of neighbours
    /// that were kept, and the particles of coats that have them everywhere on the surface.
    pub(crate) fn take_kept(
        &mut self,
        context: &Context<'_>,
        object: ObjectInputs<'_>,
        brushes: &Brushes,
        kept: KeptObject,
    ) -> Vec<Arc<Coat>> {
        let surface = self.object_surface().clone();
        let inputs = Arc::new(CountInputs::new(context, object, Arc::clone(&surface.body)));
        self.counts.update(inputs, |_, _| kept.counts.counted);
        self.needed.clear();
        let coats = self.coats.par_iter_mut().zip(LayerKind::ALL).zip(kept.coats);
        let coats = coats.filter_map(|((coat, kind), kept)| {
            coat.sampled.clear();
            let given = CoatInputs { context, object, brushes, kind, surface: &surface };
            kept.map(|kept| Arc::new(coat.take_kept(&given, kept)))
        });
        coats.collect()
    }
}

/// Whether the body of an object may need a direction field. None does where the source paper's own rule is used.
fn needs_field(context: &Context<'_>, object: ObjectInputs<'_>) -> bool {
    FieldInputs::may_be_needed(object.used, context.rules, object.guides) && !context.paper
}

fn field_samples(body: &BodySurface, name_hash: u32) -> FieldSamples {
    FieldSamples::new(&Surface::with_sides(&body.mesh, &body.sides, |_| true), name_hash)
}

/// The inputs of a coat.
struct CoatInputs<'a> {
    context: &'a Context<'a>,
    object: ObjectInputs<'a>,
    brushes: &'a Brushes,
    kind: LayerKind,
    surface: &'a ObjectSurface,
}

impl CoatInputs<'_> {
    /// The inputs of the traits of these particles.
    fn traits(&self, particles: Particles) -> TraitInputs {
        TraitInputs::new(self.context, self.object, self.kind, particles, &self.surface.parts)
    }

    fn lift_sources(&self, traits: &Arc<Traits>, neighbours: Option<&Arc<Neighbours>>) -> LiftSources {
        LiftSources {
            traits: Arc::clone(traits),
            neighbours: match self.context.solver {
                Solver::Tangent => None,
                Solver::Horn | Solver::HornExact => neighbours.cloned(),
            },
            references: Arc::clone(self.object.references),
            rules: Arc::clone(self.context.rules),
            extent: self.surface.extent,
        }
    }

    fn amounts(&self, traits: &Arc<Traits>) -> AmountInputs {
        let (amounts, traits) = (Arc::clone(self.object.amounts), Arc::clone(traits));
        AmountInputs { kind: self.kind, amounts, traits }
    }

    fn coat(
        &self,
        sampled: &Arc<Sampled>,
        lift_sources: LiftSources,
        amounts: Arc<CoatAmounts>,
        baked: Arc<BakedBody>,
    ) -> Coat {
        let brushes = self.brushes;
        let of_rule = |rule: &RegionRule| brushes.first_marks(rule.strokes.layer_of(self.kind));
        Coat {
            object: self.object.index,
            kind: self.kind,
            sampled: Arc::clone(sampled),
            used: Arc::clone(self.object.used),
            traits: Arc::clone(&lift_sources.traits),
            lift_sources,
            amounts,
            baked,
            sorted: OnceLock::new(),
            surface: Arc::clone(&self.surface.body),
            first_marks: self.context.rules.iter().map(of_rule).collect(),
        }
    }
}

impl CoatCache {
    fn sampled(&self) -> &Arc<Sampled> {
        self.sampled.output().expect("the sampling step ran before")
    }

    fn bake(&mut self, given: &CoatInputs<'_>, combed: Option<Combed>) -> Coat {
        let trait_inputs = Arc::new(given.traits(self.sampled().particles.clone()));
        let traits = self.traits.resize(Arc::clone(&trait_inputs), |inputs, before| inputs.traits(before));
        let traits = Arc::clone(traits);
        let amounts =
            Arc::clone(self.amounts.update(given.amounts(&traits), |inputs, _| Arc::new(inputs.find())));
        let lift_sources = given.lift_sources(&traits, self.neighbours.output());
        let inputs = BakeInputs {
            sources: lift_sources.clone(),
            trait_inputs,
            amounts: Arc::clone(&amounts),
            solver: given.context.solver,
            used: Arc::clone(given.object.used),
            combed,
        };
        let baked = Arc::clone(self.baked.resize(Arc::new(inputs), |inputs, before| inputs.bake(before)));
        given.coat(self.sampled(), lift_sources, amounts, baked)
    }

    fn take_kept(&mut self, given: &CoatInputs<'_>, mut kept: KeptCoat) -> Coat {
        let sampled = Arc::new(Sampled::of_kept(&given.surface.body, &mut kept));
        // The places where particles are needed were not kept, so particles that do not lie everywhere cannot be
        // reused.
        if kept.is_everywhere {
            let wanted = CoatCount::everywhere(kept.wanted);
            let inputs = SampleInputs::new(given.context, given.object, given.kind, &wanted);
            self.sampled.update(inputs, |_, _| Arc::clone(&sampled));
        }
        if let Some(lists) = kept.neighbours {
            self.neighbours.update(sampled.particles.clone(), |_, _| Arc::new(lists));
        }
        let traits = given.traits(sampled.particles.clone()).with_regions(kept.dabbed);
        let traits = Arc::new(traits);
        let amounts = Arc::new(given.amounts(&traits).find());
        let lift_sources = given.lift_sources(&traits, self.neighbours.output());
        given.coat(&sampled, lift_sources, amounts, Arc::new(kept.baked))
    }
}
