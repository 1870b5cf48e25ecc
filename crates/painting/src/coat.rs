//! A coat: the particles of one object that carry one layer of paint. Each layer has particles of its own, so that a small
//! stroke does not sit in the middle of each large one.

use std::sync::{Arc, OnceLock};

use glam::{DVec3, Vec3};
use impasto_core::direction::carry::Stencils;
use impasto_core::hash;
use impasto_core::neighbours::{Neighbours, full_list_radius};
use impasto_core::sampling::{self, PackedParticle, ProgressiveState, Surface};
use impasto_scene::document::Solver;
use impasto_scene::presets::LayerKind;
use rayon::prelude::*;

use crate::bake::{BakeInputs, BakedBody, Combed, LiftGround};
use crate::counts::CountInputs;
use crate::field::{BodyField, FieldInputs, FieldSamples};
use crate::frame::BodySurface;
use crate::noise_displace::{BodyNoise, BodyShape, NoiseInputs};
use crate::paper::PolygonCounts;
use crate::particles::Particles;
use crate::parts::{BodyParts, Cap};
use crate::prepare::Context;
use crate::references::BodyReferences;
use crate::regions::{BodyGuide, BodyRegions};
use crate::seats::{KeptSeats, SeatInputs, Seats};
use crate::surface::{Albedo, SurfaceInputs};

/// One coat, prepared.
pub(crate) struct Coat {
    /// Index of the object in the scene.
    pub(crate) object: usize,
    pub(crate) kind: LayerKind,
    pub(crate) sampled: Arc<Sampled>,
    pub(crate) ground: LiftGround,
    /// The rules that its particles may have.
    pub(crate) used: Arc<Vec<u16>>,
    pub(crate) seats: Arc<Seats>,
    pub(crate) baked: Arc<BakedBody>,
    /// The surface that the particles ride.
    pub(crate) surface: Arc<BodySurface>,
    /// For each region, the marks that its brushes begin with.
    pub(crate) first_marks: Vec<Vec<u32>>,
}

impl Coat {
    /// sRGB albedo at a particle, 8 bits a channel, as 0xAABBGGRR; A is 0 where unlit.
    pub(crate) fn albedo_srgb8(&self, particle: usize) -> u32 {
        let triangle = self.sampled.particles.triangle(particle);
        self.sampled.albedo.of(&self.surface, (particle, triangle))
    }
}

/// The particles of a coat.
#[derive(Clone)]
pub(crate) struct Sampled {
    pub(crate) particles: Particles,
    /// Of all that is there of the particles' order.
    albedo: Arc<Albedo>,
    pub(crate) area: f64,
    pub(crate) polygons: Option<Arc<PolygonCounts>>,
}

/// What is kept of one object, each with the inputs that it was made from.
#[derive(Default)]
pub(crate) struct KeptObject {
    surface: Option<(SurfaceInputs, KeptSurface)>,
    noise: Option<(NoiseInputs, Option<Arc<BodyNoise>>)>,
    counts: Option<(CountInputs, [usize; LayerKind::ALL.len()])>,
    samples: Option<(SampleKey, Arc<FieldSamples>)>,
    field: Option<(Arc<FieldInputs>, Option<Arc<BodyField>>)>,
    coats: [KeptCoat; LayerKind::ALL.len()],
}

#[derive(Clone)]
struct KeptSurface {
    body: Arc<BodySurface>,
    parts: Arc<BodyParts>,
    bounds: Option<(Vec3, Vec3)>,
    extent: (DVec3, f64),
}

#[derive(Default)]
struct KeptCoat {
    sampled: Option<(SampleInputs, ProgressiveState, Arc<Sampled>)>,
    posed: Option<(PosedInputs, Particles)>,
    neighbours: Option<(Particles, Arc<Neighbours>)>,
    stencils: Option<KeptStencils>,
    seats: Option<Arc<KeptSeats>>,
    baked: Option<(BakeInputs, Arc<BakedBody>)>,
}

/// Which samples of the field each particle listens to.
struct KeptStencils {
    particles: Particles,
    samples: Arc<FieldSamples>,
    stencils: Arc<Stencils>,
}

/// Particles and the surface that they ride, standing like this.
#[derive(Clone)]
struct PosedInputs {
    particles: Particles,
    surface: Arc<BodySurface>,
    shape: BodyShape,
}

impl PosedInputs {
    /// Equal but for how many particles there are.
    fn same(&self, other: &Self) -> bool {
        self.particles.same_order(&other.particles)
            && Arc::ptr_eq(&self.surface, &other.surface)
            && self.shape == other.shape
    }
}

/// What the samples of the field depend on.
#[derive(Clone, PartialEq)]
struct SampleKey {
    surface: SurfaceInputs,
    name_hash: u32,
    shape: BodyShape,
}

#[derive(Clone, PartialEq)]
struct SampleInputs {
    surface: SurfaceInputs,
    name_hash: u32,
    /// By the paper's rule, where a count asks for an order of its own.
    per_polygon: Option<usize>,
}

/// One object while it is prepared.
#[derive(Clone, Copy)]
pub(crate) struct ObjectInputs<'a> {
    pub(crate) index: usize,
    pub(crate) surface: &'a SurfaceInputs,
    pub(crate) regions: &'a Arc<BodyRegions>,
    /// The rules that may show on the object.
    pub(crate) used: &'a Arc<Vec<u16>>,
    pub(crate) guides: &'a Arc<Vec<BodyGuide>>,
    pub(crate) references: &'a Arc<BodyReferences>,
    /// Of each part.
    pub(crate) caps: &'a [Cap],
    /// How the body stands in the reference pose.
    pub(crate) shape: &'a BodyShape,
}

impl KeptObject {
    pub(crate) fn build_surface(&mut self, inputs: &SurfaceInputs) {
        if self.surface.as_ref().is_none_or(|(before, _)| before != inputs) {
            let body = inputs.build();
            let surface = KeptSurface {
                parts: Arc::new(BodyParts::of(&body.mesh)),
                bounds: body.bounds(),
                extent: body.extent(),
                body: Arc::new(body),
            };
            self.surface = Some((inputs.clone(), surface));
        }
    }

    pub(crate) fn build_noise(&mut self, inputs: NoiseInputs) {
        if self.noise.as_ref().is_none_or(|(before, _)| *before != inputs) {
            let noise = inputs.build(self.noise.as_ref());
            self.noise = Some((inputs, noise));
        }
    }

    /// The noise that displaces and colours the object.
    pub(crate) fn noise(&self) -> Option<Arc<BodyNoise>> {
        self.noise.as_ref()?.1.clone()
    }

    fn kept_surface(&self) -> &KeptSurface {
        &self.surface.as_ref().expect("the surface step ran before").1
    }

    pub(crate) fn surface(&self) -> Arc<BodySurface> {
        Arc::clone(&self.kept_surface().body)
    }

    pub(crate) fn parts(&self) -> Arc<BodyParts> {
        Arc::clone(&self.kept_surface().parts)
    }

    /// Least and greatest corner of the box round the surface, whatever its morph and its noise.
    pub(crate) fn bounds(&self) -> Option<(Vec3, Vec3)> {
        let reach = self.noise().map_or(0.0, |noise| noise.reach());
        self.kept_surface().bounds.map(|(low, high)| (low - reach, high + reach))
    }

    /// Finds how many particles each coat has.
    pub(crate) fn count(&mut self, context: &Context<'_>, object: ObjectInputs<'_>) {
        let KeptSurface { body, parts, .. } = self.kept_surface().clone();
        let inputs = CountInputs::new(context, object, Arc::clone(&body));
        if self.counts.as_ref().is_none_or(|(before, _)| *before != inputs) {
            let counts = inputs.counts(&Surface::with_sides(&body.mesh, &body.sides, |_| true), &parts);
            self.counts = Some((inputs, counts));
        }
    }

    /// How many particles all coats have together.
    pub(crate) fn counted(&self) -> usize {
        self.counts.as_ref().map_or(0, |(_, counts)| counts.iter().sum())
    }

    /// Samples the particles of every coat.
    pub(crate) fn sample(&mut self, context: &Context<'_>, object: ObjectInputs<'_>) {
        let body = self.surface();
        let surface = OnceLock::new();
        let surface = || surface.get_or_init(|| Surface::with_sides(&body.mesh, &body.sides, |_| true));
        let counts = self.counts.as_ref().map_or([0; LayerKind::ALL.len()], |(_, counts)| *counts);
        let coats = self.coats.par_iter_mut().zip(LayerKind::ALL).zip(counts);
        coats.for_each(|((coat, kind), count)| {
            let name_hash = name_hash(context, object.index, kind);
            let per_polygon = (context.paper && count > 0).then_some(count);
            let now = SampleInputs { surface: object.surface.clone(), name_hash, per_polygon };
            coat.sample(now, count, (&body, surface));
        });
    }

    /// Puts the particles where they are in the reference pose.
    pub(crate) fn pose(&mut self, object: ObjectInputs<'_>) {
        let surface = self.surface();
        for coat in &mut self.coats {
            let particles = coat.sampled_now().particles.clone();
            let now = PosedInputs { particles, surface: Arc::clone(&surface), shape: object.shape.clone() };
            let count = now.particles.len();
            let kept = coat.posed.take().filter(|(before, _)| before.same(&now));
            let posed = kept.and_then(|(_, posed)| posed.first(count)).unwrap_or_else(|| {
                if surface.is_at_rest(object.shape) {
                    return now.particles.clone();
                }
                now.particles.posed(surface.vertices_at(object.shape))
            });
            coat.posed = Some((now, posed));
        }
    }

    pub(crate) fn find_neighbours(&mut self) {
        for coat in &mut self.coats {
            let particles = coat.posed_now();
            if coat.neighbours.as_ref().is_some_and(|(before, _)| before.same(&particles)) {
                continue;
            }
            let (positions, normals) = particles.points();
            let radius = full_list_radius(coat.sampled_now().area, positions.len()) as f32;
            let found = Neighbours::find(&positions, &normals, radius);
            coat.neighbours = Some((particles, Arc::new(found)));
        }
    }

    /// Joins what regions state and guides comb, where that is needed.
    pub(crate) fn solve_field(&mut self, context: &Context<'_>, object: ObjectInputs<'_>) {
        // The paper knows no field.
        let needed = FieldInputs::may_be_needed(object.used, context.rules, object.guides);
        if !needed || context.paper {
            self.field = None;
            return;
        }
        let surface = self.surface();
        let name_hash = name_hash(context, object.index, LayerKind::Body);
        let key = SampleKey { surface: object.surface.clone(), name_hash, shape: object.shape.clone() };
        if self.samples.as_ref().is_none_or(|(before, _)| *before != key) {
            let sampled = Surface::with_sides(&surface.mesh, &surface.sides, |_| true);
            let samples = FieldSamples::new(&sampled, name_hash);
            self.samples = Some((key, Arc::new(samples.posed(&surface, object.shape))));
        }
        let samples = Arc::clone(&self.samples.as_ref().expect("it was just made").1);
        let inputs = FieldInputs {
            samples: Arc::clone(&samples),
            references: Arc::clone(object.references),
            regions: Arc::clone(object.regions),
            guides: Arc::clone(object.guides),
            rules: Arc::clone(context.rules),
            parts: self.parts(),
            extent: self.kept_surface().extent,
            used: Arc::clone(object.used),
            orthographic: context.orthographic,
        };
        if self.field.as_ref().is_none_or(|(before, _)| **before != inputs) {
            let before = self.field.take().and_then(|(_, field)| field);
            let field = inputs.solve(before.as_deref()).map(Arc::new);
            self.field = Some((Arc::new(inputs), field));
        }
        for coat in &mut self.coats {
            let particles = coat.posed_now();
            // Those of more particles of the same order will do.
            let same = |kept: &KeptStencils| {
                kept.particles.same_order(&particles)
                    && kept.particles.len() >= particles.len()
                    && Arc::ptr_eq(&kept.samples, &samples)
            };
            if !coat.stencils.as_ref().is_some_and(same) {
                let stencils = Arc::new(samples.stencils(&particles));
                coat.stencils = Some(KeptStencils { particles, samples: Arc::clone(&samples), stencils });
            }
        }
    }

    /// The field of the body, if it has one.
    pub(crate) fn field(&self) -> Option<Arc<BodyField>> {
        self.field.as_ref().and_then(|(_, field)| field.clone())
    }

    /// The coats that have particles; the body's layer always counts as one.
    pub(crate) fn bake(&mut self, context: &Context<'_>, object: ObjectInputs<'_>) -> Vec<Arc<Coat>> {
        let KeptSurface { body, parts, extent, .. } = self.kept_surface().clone();
        let field = self.field.clone();
        let coats = self.coats.par_iter_mut().zip(LayerKind::ALL);
        let coats =
            coats.filter(|(kept, kind)| *kind == LayerKind::Body || !kept.sampled_now().particles.is_empty());
        coats
            .map(|(kept, kind)| {
                let particles = kept.posed_now();
                let seats = SeatInputs::new(
                    (particles, name_hash(context, object.index, kind)),
                    (object.regions, object.used),
                    context.rules,
                    &parts,
                    object.references,
                );
                let seats = seats.seats(kept.seats.take());
                kept.seats = Some(Arc::clone(&seats));
                let ground = LiftGround {
                    seats: Arc::clone(&seats.seats),
                    neighbours: match context.solver {
                        Solver::Tangent => None,
                        Solver::Horn | Solver::HornExact => {
                            kept.neighbours.as_ref().map(|(_, lists)| Arc::clone(lists))
                        }
                    },
                    references: Arc::clone(object.references),
                    rules: Arc::clone(context.rules),
                    extent,
                };
                let inputs = BakeInputs {
                    ground,
                    seats,
                    solver: context.solver,
                    used: Arc::clone(object.used),
                    combed: field.as_ref().zip(kept.stencils.as_ref()).map(|((inputs, field), stencils)| {
                        let (inputs, stencils) = (Arc::clone(inputs), Arc::clone(&stencils.stencils));
                        Combed { inputs, field: field.clone(), stencils }
                    }),
                };
                Arc::new(kept.coat(context, (object.index, kind), inputs, Arc::clone(&body)))
            })
            .collect()
    }
}

impl KeptCoat {
    fn sampled_now(&self) -> &Arc<Sampled> {
        &self.sampled.as_ref().expect("the sampling step ran before").2
    }

    /// The particles where they are in the reference pose.
    fn posed_now(&self) -> Particles {
        self.posed.as_ref().expect("the pose step ran before").1.clone()
    }

    /// Finds `count` particles: of a kept order the first so many, or the next ones too.
    fn sample<'a, 'mesh: 'a>(
        &mut self,
        inputs: SampleInputs,
        count: usize,
        (body, surface): (&Arc<BodySurface>, impl Fn() -> &'a Surface<'mesh>),
    ) {
        let kept = self.sampled.take().filter(|(before, ..)| *before == inputs);
        if let Some((_, state, sampled)) = &kept
            && let Some(particles) = sampled.particles.first(count)
        {
            let sampled = if particles.same(&sampled.particles) {
                Arc::clone(sampled)
            } else {
                Arc::new(Sampled { particles, ..Sampled::clone(sampled) })
            };
            self.sampled = Some((inputs, *state, sampled));
            return;
        }
        let (surface, mut state) = (surface(), ProgressiveState::default());
        let sampled = if inputs.per_polygon.is_some() {
            let entries = sampling::per_polygon(surface, count, inputs.name_hash);
            let polygons = PolygonCounts::new(surface, &body.mesh, &entries);
            let places: Vec<PackedParticle> =
                entries.iter().map(|entry| PackedParticle::of(&entry.particle)).collect();
            let particles = Particles::new(body, Arc::new(places), usize::MAX);
            let albedo = Arc::new(body.albedo(particles.par_range(0..particles.len())));
            Sampled { particles, albedo, area: surface.area(), polygons: Some(Arc::new(polygons)) }
        } else {
            let (mut all, mut before) = (Vec::new(), None);
            if let Some((_, at, sampled)) = kept {
                state = at;
                all.extend(sampled.particles.places().iter().map(|place| place.on(&body.mesh)));
                before = Some(sampled.particles.clone());
            }
            state.grow(surface, inputs.name_hash, &mut all, count);
            let places: Arc<Vec<PackedParticle>> = Arc::new(all.iter().map(PackedParticle::of).collect());
            let albedo = Arc::new(body.albedo(all.par_iter().copied()));
            let particles = match before {
                Some(before) => before.continued(places, count),
                None => Particles::new(body, places, count),
            };
            Sampled { particles, albedo, area: surface.area(), polygons: None }
        };
        self.sampled = Some((inputs, state, Arc::new(sampled)));
    }

    fn coat(
        &mut self,
        context: &Context<'_>,
        (object, kind): (usize, LayerKind),
        inputs: BakeInputs,
        surface: Arc<BodySurface>,
    ) -> Coat {
        let kept = self.baked.take().filter(|(before, _)| *before == inputs);
        let baked = inputs.bake(kept.map(|(_, baked)| baked));
        self.baked = Some((inputs.clone(), Arc::clone(&baked)));
        let first_marks = context
            .rules
            .iter()
            .map(|rule| context.brushes.first_marks(rule.strokes.layer_of(kind)))
            .collect();
        let (sampled, seats) = (Arc::clone(self.sampled_now()), Arc::clone(&inputs.ground.seats));
        Coat {
            object,
            kind,
            sampled,
            ground: inputs.ground,
            used: inputs.used,
            seats,
            baked,
            surface,
            first_marks,
        }
    }
}

/// What all chances of a coat come from. The body's is the object's own.
fn name_hash(context: &Context<'_>, object: usize, kind: LayerKind) -> u32 {
    let of_object = hash::combine(context.scene.seed, hash::of_name(&context.scene.objects[object].name));
    if kind == LayerKind::Body { of_object } else { hash::combine(of_object, hash::of_name(kind.name())) }
}
