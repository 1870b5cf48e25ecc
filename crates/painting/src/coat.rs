//! A coat: the particles of one object that carry one layer of paint. Each layer has particles of its own, so that a small
//! stroke does not sit in the middle of each large one.

use std::sync::Arc;

use glam::{DVec2, Vec3};
use impasto_core::direction::carry::Stencils;
use impasto_core::hash;
use impasto_core::neighbours::{Neighbours, full_list_radius};
use impasto_core::sampling::{self, Particle, Surface};
use impasto_scene::document::Solver;
use impasto_scene::presets::LayerKind;

use crate::bake::{BakeInputs, BakedBody, Combed};
use crate::field::{BodyField, FieldInputs, FieldSamples};
use crate::frame::BodySurface;
use crate::paper::PolygonCounts;
use crate::particle_count::{self, Sighting};
use crate::parts::{BodyParts, Cap};
use crate::prepare::Context;
use crate::references::BodyReferences;
use crate::regions::{BodyGuide, BodyRegions};
use crate::surface::SurfaceInputs;

/// One coat, prepared.
pub(crate) struct Coat {
    /// Index of the object in the scene.
    pub(crate) object: usize,
    pub(crate) kind: LayerKind,
    pub(crate) sampled: Arc<Sampled>,
    pub(crate) inputs: BakeInputs,
    pub(crate) baked: Arc<BakedBody>,
    /// The surface that the particles ride.
    pub(crate) surface: Arc<BodySurface>,
    /// For each region, the marks that its brushes begin with.
    pub(crate) first_marks: Vec<Vec<u32>>,
}

/// The particles of a coat.
pub(crate) struct Sampled {
    pub(crate) particles: Arc<Vec<Particle>>,
    pub(crate) albedo_srgb8: Vec<u32>,
    pub(crate) area: f64,
    pub(crate) polygons: Option<PolygonCounts>,
}

/// What is kept of one object, each with the inputs that it was made from.
#[derive(Default)]
pub(crate) struct KeptObject {
    surface: Option<(SurfaceInputs, Arc<BodySurface>, Arc<BodyParts>)>,
    samples: Option<(SampleKey, Arc<FieldSamples>)>,
    field: Option<(Arc<FieldInputs>, Option<Arc<BodyField>>)>,
    coats: [KeptCoat; LayerKind::ALL.len()],
}

#[derive(Default)]
struct KeptCoat {
    sampled: Option<(SampleInputs, Arc<Sampled>)>,
    posed: Option<(PosedInputs, Arc<Vec<Particle>>)>,
    neighbours: Option<(Arc<Vec<Particle>>, Arc<Neighbours>)>,
    stencils: Option<KeptStencils>,
    baked: Option<(BakeInputs, Arc<BakedBody>)>,
}

/// Which samples of the field each particle listens to.
struct KeptStencils {
    particles: Arc<Vec<Particle>>,
    samples: Arc<FieldSamples>,
    stencils: Arc<Stencils>,
}

/// Particles and the surface that they ride, as it stands at this share of its morph.
#[derive(Clone)]
struct PosedInputs {
    particles: Arc<Vec<Particle>>,
    surface: Arc<BodySurface>,
    morph: f64,
}

impl PartialEq for PosedInputs {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.particles, &other.particles)
            && Arc::ptr_eq(&self.surface, &other.surface)
            && self.morph == other.morph
    }
}

/// What the samples of the field depend on.
#[derive(Clone, PartialEq)]
struct SampleKey {
    surface: SurfaceInputs,
    name_hash: u32,
    morph: f64,
}

#[derive(Clone, PartialEq)]
struct SampleInputs {
    surface: SurfaceInputs,
    count: usize,
    name_hash: u32,
    per_polygon: bool,
}

/// One object while it is prepared.
#[derive(Clone, Copy)]
pub(crate) struct ObjectInputs<'a> {
    pub(crate) index: usize,
    pub(crate) surface: &'a SurfaceInputs,
    pub(crate) regions: &'a Arc<BodyRegions>,
    pub(crate) guides: &'a Arc<Vec<BodyGuide>>,
    pub(crate) references: &'a Arc<BodyReferences>,
    /// Of each part.
    pub(crate) caps: &'a [Cap],
    /// How far the body has turned into its morph in the reference pose.
    pub(crate) morph: f64,
}

impl KeptObject {
    pub(crate) fn build_surface(&mut self, inputs: &SurfaceInputs) {
        if self.surface.as_ref().is_none_or(|(before, ..)| before != inputs) {
            let surface = inputs.build();
            let parts = BodyParts::of(&surface.mesh);
            self.surface = Some((inputs.clone(), Arc::new(surface), Arc::new(parts)));
        }
    }

    pub(crate) fn surface(&self) -> Arc<BodySurface> {
        Arc::clone(&self.surface.as_ref().expect("the surface step ran before").1)
    }

    pub(crate) fn parts(&self) -> Arc<BodyParts> {
        Arc::clone(&self.surface.as_ref().expect("the surface step ran before").2)
    }

    /// Samples the particles of every coat.
    pub(crate) fn sample(&mut self, context: &Context<'_>, object: ObjectInputs<'_>) {
        let (body, parts) = (self.surface(), self.parts());
        let surface = Surface::new(&body.mesh, |_| true);
        let sightings = context.sightings(object.index);
        for kind in LayerKind::ALL {
            let count = count(context, object, kind, (&surface, &parts, &sightings));
            let name_hash = name_hash(context, object.index, kind);
            let now = SampleInputs {
                surface: object.surface.clone(),
                count,
                name_hash,
                per_polygon: context.paper,
            };
            let kept = &mut self.coats[kind as usize];
            if kept.sampled.as_ref().is_some_and(|(before, _)| *before == now) {
                continue;
            }
            let (particles, polygons) = if context.paper && count > 0 {
                let entries = sampling::per_polygon(&surface, count, name_hash);
                let polygons = PolygonCounts::new(&surface, &body.mesh, &entries);
                (entries.into_iter().map(|entry| entry.particle).collect(), Some(polygons))
            } else {
                (sampling::progressive(&surface, count, name_hash), None)
            };
            let albedo_srgb8 =
                particles.iter().map(|particle: &Particle| body.albedo_srgb8(particle)).collect();
            let sampled =
                Sampled { particles: Arc::new(particles), albedo_srgb8, area: surface.area(), polygons };
            kept.sampled = Some((now, Arc::new(sampled)));
        }
    }

    /// Puts the particles where they are in the reference pose.
    pub(crate) fn pose(&mut self, object: ObjectInputs<'_>) {
        let surface = self.surface();
        for coat in &mut self.coats {
            let particles = Arc::clone(&coat.sampled_now().particles);
            let now = PosedInputs { particles, surface: Arc::clone(&surface), morph: object.morph };
            if coat.posed.as_ref().is_none_or(|(before, _)| *before != now) {
                let posed = surface.posed(&now.particles, object.morph);
                coat.posed = Some((now, posed));
            }
        }
    }

    pub(crate) fn find_neighbours(&mut self) {
        for coat in &mut self.coats {
            let particles = coat.posed_now();
            if coat.neighbours.as_ref().is_some_and(|(before, _)| Arc::ptr_eq(before, &particles)) {
                continue;
            }
            let positions: Vec<Vec3> = particles.iter().map(|particle| particle.position).collect();
            let normals: Vec<Vec3> = particles.iter().map(|particle| particle.normal).collect();
            let radius = full_list_radius(coat.sampled_now().area, positions.len()) as f32;
            let found = Neighbours::find(&positions, &normals, radius);
            coat.neighbours = Some((particles, Arc::new(found)));
        }
    }

    /// Joins what regions state and guides comb, where that is needed.
    pub(crate) fn solve_field(&mut self, context: &Context<'_>, object: ObjectInputs<'_>) {
        // The paper knows no field.
        let needed = FieldInputs::may_be_needed(object.regions, context.rules, object.guides);
        if !needed || context.paper {
            self.field = None;
            return;
        }
        let surface = self.surface();
        let name_hash = name_hash(context, object.index, LayerKind::Body);
        let key = SampleKey { surface: object.surface.clone(), name_hash, morph: object.morph };
        if self.samples.as_ref().is_none_or(|(before, _)| *before != key) {
            let samples = FieldSamples::new(&Surface::new(&surface.mesh, |_| true), name_hash);
            self.samples = Some((key, Arc::new(samples.posed(&surface, object.morph))));
        }
        let samples = Arc::clone(&self.samples.as_ref().expect("it was just made").1);
        let inputs = FieldInputs {
            samples: Arc::clone(&samples),
            references: Arc::clone(object.references),
            regions: Arc::clone(object.regions),
            guides: Arc::clone(object.guides),
            rules: Arc::clone(context.rules),
            parts: self.parts(),
            extent: surface.extent(),
            orthographic: context.orthographic,
        };
        if self.field.as_ref().is_none_or(|(before, _)| **before != inputs) {
            let field = inputs.solve().map(Arc::new);
            self.field = Some((Arc::new(inputs), field));
        }
        for coat in &mut self.coats {
            let particles = coat.posed_now();
            let same = |kept: &KeptStencils| {
                Arc::ptr_eq(&kept.particles, &particles) && Arc::ptr_eq(&kept.samples, &samples)
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
        let (surface, parts) = (self.surface(), self.parts());
        let field = self.field.clone();
        let wanted = |kind: LayerKind| {
            kind == LayerKind::Body || !self.coats[kind as usize].sampled_now().particles.is_empty()
        };
        let kinds: Vec<LayerKind> = LayerKind::ALL.into_iter().filter(|&kind| wanted(kind)).collect();
        kinds
            .into_iter()
            .map(|kind| {
                let kept = &mut self.coats[kind as usize];
                let inputs = BakeInputs {
                    particles: kept.posed_now(),
                    neighbours: match context.solver {
                        Solver::Tangent => None,
                        Solver::Horn | Solver::HornExact => {
                            kept.neighbours.as_ref().map(|(_, lists)| Arc::clone(lists))
                        }
                    },
                    references: Arc::clone(object.references),
                    solver: context.solver,
                    regions: Arc::clone(object.regions),
                    rules: Arc::clone(context.rules),
                    name_hash: name_hash(context, object.index, kind),
                    extent: surface.extent(),
                    parts: Arc::clone(&parts),
                    combed: field.as_ref().zip(kept.stencils.as_ref()).map(|((inputs, field), stencils)| {
                        let (inputs, stencils) = (Arc::clone(inputs), Arc::clone(&stencils.stencils));
                        Combed { inputs, field: field.clone(), stencils }
                    }),
                };
                let surface = Arc::clone(&surface);
                Arc::new(kept.coat(context, (object.index, kind), inputs, surface))
            })
            .collect()
    }
}

impl KeptCoat {
    fn sampled_now(&self) -> Arc<Sampled> {
        Arc::clone(&self.sampled.as_ref().expect("the sampling step ran before").1)
    }

    /// The particles where they are in the reference pose.
    fn posed_now(&self) -> Arc<Vec<Particle>> {
        Arc::clone(&self.posed.as_ref().expect("the pose step ran before").1)
    }

    fn coat(
        &mut self,
        context: &Context<'_>,
        (object, kind): (usize, LayerKind),
        inputs: BakeInputs,
        surface: Arc<BodySurface>,
    ) -> Coat {
        if self.baked.as_ref().is_none_or(|(before, _)| *before != inputs) {
            self.baked = Some((inputs.clone(), Arc::new(inputs.bake())));
        }
        let baked = Arc::clone(&self.baked.as_ref().expect("it was just baked").1);
        let first_marks = context
            .rules
            .iter()
            .map(|rule| context.brushes.first_marks(rule.strokes.layer_of(kind)))
            .collect();
        Coat { object, kind, sampled: self.sampled_now(), inputs, baked, surface, first_marks }
    }
}

/// How many particles a coat has: as the object states for its body layer, else as its sightings ask for.
fn count(
    context: &Context<'_>,
    object: ObjectInputs<'_>,
    kind: LayerKind,
    (surface, parts, sightings): (&Surface<'_>, &BodyParts, &[Sighting]),
) -> usize {
    let layer = |rule: u16| context.rules[usize::from(rule)].strokes.layer_of(kind);
    let left_out = kind == LayerKind::Underpainting && !context.underpainting
        || context.paper && kind != LayerKind::Body
        || object.regions.all().into_iter().all(|rule| layer(rule).coverage <= 0.0);
    if kind == LayerKind::Body
        && let Some(count) = context.scene.objects[object.index].particles
    {
        return count as usize;
    }
    if left_out {
        return 0;
    }
    let found = particle_count::find(surface, sightings, |triangle| {
        let cap = object.caps[parts.of_triangle[triangle] as usize];
        let wanted = |rule: u16| {
            let layer = layer(rule);
            let [length, width] = cap.apply(layer.length_px, layer.width_px);
            layer.coverage / (length * width)
        };
        let densest = object.regions.on_triangle(surface.mesh(), triangle).map(wanted).fold(0.0, f32::max);
        densest * most_wanted(kind)
    });
    // By the paper's rule a polygon without a particle stays bare.
    if context.paper { found.max(surface.faces().count()) } else { found }
}

/// The most that a layer is wanted anywhere, where its coverage says 1; as `MOST_FULL` of the resolve shader.
pub(crate) fn most_wanted(kind: LayerKind) -> f32 {
    if kind == LayerKind::Body { 1.35 } else { 1.0 }
}

/// What all chances of a coat come from. The body's is the object's own.
fn name_hash(context: &Context<'_>, object: usize, kind: LayerKind) -> u32 {
    let of_object = hash::combine(context.scene.seed, hash::of_name(&context.scene.objects[object].name));
    if kind == LayerKind::Body { of_object } else { hash::combine(of_object, hash::of_name(kind.name())) }
}

impl Context<'_> {
    fn sightings(&self, object: usize) -> Vec<Sighting> {
        let size_px = [self.scene.size.0, self.scene.size.1];
        self.views
            .iter()
            .map(|(view, poses)| Sighting {
                map: view.screen_map(poses[object]),
                half_size_px: DVec2::new(f64::from(size_px[0]), f64::from(size_px[1])) * 0.5,
                near: view.near(),
            })
            .collect()
    }
}
