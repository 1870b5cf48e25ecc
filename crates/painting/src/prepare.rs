//! From a scene to a painting, step by step; each step is kept while its inputs stay the same.

use std::collections::HashMap;
use std::sync::Arc;
use std::time::Instant;

use glam::{DAffine3, DVec2, DVec3, Vec3};
use impasto_core::hash;
use impasto_core::neighbours::{Neighbours, full_list_radius};
use impasto_core::sampling::{self, Particle, Surface};
use impasto_scene::document::{Reference, Scene, Solver, Style};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::{motion, presets};
use rayon::prelude::*;

use crate::bake::{BakeInputs, BakedBody, BodyReference};
use crate::frame::{BodySurface, FrameStyle};
use crate::lights;
use crate::paper::PolygonCounts;
use crate::particle_count::{self, Sighting};
use crate::regions::{self, RegionRule};
use crate::surface::SurfaceInputs;
use crate::view::PictureView;

/// Why a scene cannot be prepared.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PrepareError {
    /// An object's mesh was not handed over with the scene.
    #[error("object {object:?}: mesh {mesh:?} was not read")]
    MeshMissing {
        /// Name of the object.
        object: String,
        /// Path of the mesh as written in the scene.
        mesh: String,
    },
}

/// How long a step of preparing took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// What was done.
    pub name: &'static str,
    /// Wall clock seconds.
    pub seconds: f64,
}

/// A scene, ready to be seen at any time from its camera. Immutable; cheap to clone.
#[derive(Clone)]
pub struct Painting {
    pub(crate) loaded: Arc<LoadedScene>,
    pub(crate) bodies: Vec<Arc<Body>>,
    pub(crate) rules: Vec<RegionRule>,
    /// All particles in painting order.
    pub(crate) order: Arc<Vec<OrderEntry>>,
    pub(crate) reference: Arc<ReferencePose>,
    pub(crate) solver: Solver,
    pub(crate) underpainting: bool,
    pub(crate) style: FrameStyle,
    pub(crate) shadow_bounds: (Vec3, f32),
    steps: Vec<Step>,
}

/// The pose that stroke directions are stated in.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ReferencePose {
    pub(crate) view: PictureView,
    pub(crate) poses: Vec<DAffine3>,
}

/// One object, prepared.
pub(crate) struct Body {
    pub(crate) surface: Arc<BodySurface>,
    pub(crate) sampled: Arc<Sampled>,
    pub(crate) inputs: BakeInputs,
    pub(crate) baked: Arc<BakedBody>,
    /// Per particle: the part of "strokes wanted over particles there are, over rank" that no view changes.
    pub(crate) wanted_over_rank: Vec<f32>,
}

/// The particles of a body.
pub(crate) struct Sampled {
    pub(crate) particles: Arc<Vec<Particle>>,
    pub(crate) albedo_srgb8: Vec<u32>,
    pub(crate) area: f64,
    pub(crate) polygons: Option<PolygonCounts>,
}

/// A particle's place in the painting order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct OrderEntry {
    pub(crate) body: u32,
    pub(crate) particle: u32,
}

/// Prepares scenes and keeps what can be kept from one to the next.
#[derive(Default)]
pub struct Preparer {
    kept: HashMap<String, Kept>,
}

/// What is kept of one object, each with the inputs that it was made from.
#[derive(Clone, Default)]
struct Kept {
    surface: Option<(SurfaceInputs, Arc<BodySurface>)>,
    sampled: Option<(SampleInputs, Arc<Sampled>)>,
    neighbours: Option<(Arc<Vec<Particle>>, Arc<Neighbours>)>,
    baked: Option<(BakeInputs, Arc<BakedBody>)>,
}

#[derive(Clone, PartialEq)]
struct SampleInputs {
    surface: SurfaceInputs,
    count: usize,
    name_hash: u32,
    per_polygon: bool,
}

/// Prepares one scene; for many versions of one, keep a [`Preparer`].
///
/// # Errors
/// When a mesh that the scene names was not handed over with it.
pub fn prepare(loaded: Arc<LoadedScene>) -> Result<Painting, PrepareError> {
    Preparer::default().prepare(loaded)
}

/// What the steps of one object share.
struct Context<'a> {
    scene: &'a Scene,
    rules: &'a [RegionRule],
    reference: &'a ReferencePose,
    sighting_frames: &'a [f64],
    solver: Solver,
    paper: bool,
}

impl Preparer {
    /// Prepares a scene, reusing every step whose inputs are those of the scene before.
    ///
    /// # Errors
    /// When a mesh that the scene names was not handed over with it.
    pub fn prepare(&mut self, loaded: Arc<LoadedScene>) -> Result<Painting, PrepareError> {
        let mut clock = StepClock::new();
        let scene = &loaded.scene;
        let paper = presets::is_paper(scene);
        let (solver, underpainting, style) = match scene.style {
            Style::RotatingStrokes { .. } if paper => (Solver::HornExact, false, FrameStyle::RotatingStrokes),
            Style::RotatingStrokes { solver, underpainting } => {
                (solver, underpainting, FrameStyle::RotatingStrokes)
            }
            Style::Reference => (Solver::Tangent, false, FrameStyle::Reference),
        };
        let rules = regions::rules(scene);
        let reference = Arc::new(reference_pose(scene));
        let frames = sample_frames(scene);
        let context =
            Context { scene, rules: &rules, reference: &reference, sighting_frames: &frames, solver, paper };

        let mut kept: Vec<Kept> =
            scene.objects.iter().map(|object| self.kept.remove(&object.name).unwrap_or_default()).collect();
        let inputs = surface_inputs(&loaded)?;
        kept.par_iter_mut().zip(&inputs).for_each(|(kept, inputs)| kept.surface(inputs));
        clock.lap("surfaces");
        let surfaces: Vec<Arc<BodySurface>> =
            kept.iter().zip(&inputs).map(|(kept, _)| kept.surface_now()).collect();
        let regions: Vec<Vec<u16>> = inputs
            .iter()
            .zip(&surfaces)
            .map(|(inputs, surface)| regions::of_triangles(scene, &inputs.name, inputs.file(), &surface.mesh))
            .collect();
        kept.par_iter_mut().enumerate().for_each(|(index, kept)| {
            kept.sample(&context, index, &inputs[index], &regions[index]);
        });
        clock.lap("sampling");
        if matches!(solver, Solver::Horn | Solver::HornExact) {
            kept.par_iter_mut().for_each(Kept::find_neighbours);
            clock.lap("neighbours");
        }
        let bodies: Vec<Arc<Body>> = kept
            .par_iter_mut()
            .zip(regions)
            .enumerate()
            .map(|(index, (kept, regions))| Arc::new(kept.bake(&context, index, regions)))
            .collect();
        clock.lap("lift");
        let order = Arc::new(painting_order(&bodies, &rules));
        clock.lap("order");
        self.kept = scene.objects.iter().map(|object| object.name.clone()).zip(kept).collect();

        let bounds: Vec<_> = surfaces.iter().map(|surface| surface.mesh.bounds()).collect();
        let shadow_bounds =
            lights::bounds_over(&bounds, frames.iter().map(|&frame| motion::poses_at(scene, frame)));
        clock.lap("bounds");
        let steps = clock.steps;
        Ok(Painting {
            loaded: Arc::clone(&loaded),
            bodies,
            rules,
            order,
            reference,
            solver,
            underpainting,
            style,
            shadow_bounds,
            steps,
        })
    }
}

impl Painting {
    /// The scene that was prepared.
    pub fn scene(&self) -> &Scene {
        &self.loaded.scene
    }

    /// The scene with its files.
    pub fn loaded(&self) -> &Arc<LoadedScene> {
        &self.loaded
    }

    /// How long each step of preparing took.
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// How many particles an object has; objects in the order of the scene.
    pub fn particle_counts(&self) -> Vec<usize> {
        self.bodies.iter().map(|body| body.sampled.particles.len()).collect()
    }

    /// Memory of all baked particles, in bytes.
    pub fn particle_bytes(&self) -> usize {
        self.bodies.iter().map(|body| body.baked.baked.bytes()).sum()
    }

    /// The particles of one object, in progressive order.
    pub fn particles(&self, object: usize) -> &[Particle] {
        &self.bodies[object].sampled.particles
    }

    /// Area of the visible sides of one object, model units squared.
    pub fn surface_area(&self, object: usize) -> f64 {
        self.bodies[object].sampled.area
    }
}

impl Kept {
    fn surface(&mut self, inputs: &SurfaceInputs) {
        if self.surface.as_ref().is_none_or(|(before, _)| before != inputs) {
            self.surface = Some((inputs.clone(), Arc::new(inputs.build())));
        }
    }

    fn surface_now(&self) -> Arc<BodySurface> {
        Arc::clone(&self.surface.as_ref().expect("the surface step ran before").1)
    }

    fn sample(&mut self, context: &Context<'_>, index: usize, inputs: &SurfaceInputs, region: &[u16]) {
        let body = self.surface_now();
        let object = &context.scene.objects[index];
        let surface = Surface::new(&body.mesh, |_| true);
        let count = match object.particles {
            Some(count) => count as usize,
            None => particle_count::find(&surface, &body.mesh, &context.sightings(index), |triangle| {
                context.rules[region[triangle] as usize].wanted_per_px()
            }),
        };
        let name_hash = hash::combine(context.scene.seed, hash::of_name(&object.name));
        let now = SampleInputs { surface: inputs.clone(), count, name_hash, per_polygon: context.paper };
        if self.sampled.as_ref().is_some_and(|(before, _)| *before == now) {
            return;
        }
        let (particles, polygons) = if context.paper {
            let entries = sampling::per_polygon(&surface, count, name_hash);
            let polygons = PolygonCounts::new(&surface, &body.mesh, &entries);
            (entries.into_iter().map(|entry| entry.particle).collect(), Some(polygons))
        } else {
            (sampling::progressive(&surface, count, name_hash), None)
        };
        let albedo_srgb8 = particles.iter().map(|particle: &Particle| body.albedo_srgb8(particle)).collect();
        let sampled =
            Sampled { particles: Arc::new(particles), albedo_srgb8, area: surface.area(), polygons };
        self.sampled = Some((now, Arc::new(sampled)));
    }

    fn sampled_now(&self) -> Arc<Sampled> {
        Arc::clone(&self.sampled.as_ref().expect("the sampling step ran before").1)
    }

    fn find_neighbours(&mut self) {
        let sampled = self.sampled_now();
        if self.neighbours.as_ref().is_some_and(|(before, _)| Arc::ptr_eq(before, &sampled.particles)) {
            return;
        }
        let positions: Vec<Vec3> = sampled.particles.iter().map(|particle| particle.position).collect();
        let normals: Vec<Vec3> = sampled.particles.iter().map(|particle| particle.normal).collect();
        let radius = full_list_radius(sampled.area, positions.len()) as f32;
        let found = Neighbours::find(&positions, &normals, radius);
        self.neighbours = Some((Arc::clone(&sampled.particles), Arc::new(found)));
    }

    fn bake(&mut self, context: &Context<'_>, index: usize, region_of_triangle: Vec<u16>) -> Body {
        let (surface, sampled) = (self.surface_now(), self.sampled_now());
        let (low, high) = surface.mesh.bounds().unwrap_or_default();
        let pose = context.reference.poses[index];
        let inputs = BakeInputs {
            particles: Arc::clone(&sampled.particles),
            neighbours: match context.solver {
                Solver::Tangent => None,
                Solver::Horn | Solver::HornExact => {
                    self.neighbours.as_ref().map(|(_, lists)| Arc::clone(lists))
                }
            },
            reference: BodyReference {
                map: context.reference.view.screen_map(pose),
                near: context.reference.view.near(),
                roll_rad: context.reference.view.pose.roll_rad,
                up_in_model: pose.matrix3.transpose() * DVec3::Y,
            },
            solver: context.solver,
            region_of_triangle,
            rules: context.rules.to_vec(),
            name_hash: hash::combine(context.scene.seed, hash::of_name(&context.scene.objects[index].name)),
            extent: (((low + high) * 0.5).as_dvec3(), f64::from((high - low).length())),
        };
        if self.baked.as_ref().is_none_or(|(before, _)| *before != inputs) {
            self.baked = Some((inputs.clone(), Arc::new(inputs.bake())));
        }
        let baked = Arc::clone(&self.baked.as_ref().expect("it was just baked").1);
        let wanted_over_rank = wanted_over_rank(&baked, context.rules, sampled.area);
        Body { surface, sampled, inputs, baked, wanted_over_rank }
    }
}

/// ρ*·A/(order + ½): strokes wanted per pixel over particles per surface area, over rank. How many particles there are
/// cancels out, so twice as many leave the first half as they were.
fn wanted_over_rank(baked: &BakedBody, rules: &[RegionRule], area: f64) -> Vec<f32> {
    let wanted_per_px: Vec<f64> = rules.iter().map(|rule| f64::from(rule.wanted_per_px())).collect();
    baked
        .region
        .iter()
        .enumerate()
        .map(|(order, &region)| (wanted_per_px[region as usize] * area / (order as f64 + 0.5)) as f32)
        .collect()
}

impl Context<'_> {
    fn sightings(&self, index: usize) -> Vec<Sighting> {
        let size_px = [self.scene.size.0, self.scene.size.1];
        self.sighting_frames
            .iter()
            .map(|&frame| {
                let view = PictureView { pose: motion::camera_at(self.scene, frame), size_px };
                Sighting {
                    map: view.screen_map(motion::poses_at(self.scene, frame)[index]),
                    half_size_px: DVec2::new(f64::from(size_px[0]), f64::from(size_px[1])) * 0.5,
                    near: view.near(),
                }
            })
            .collect()
    }
}

fn surface_inputs(loaded: &LoadedScene) -> Result<Vec<SurfaceInputs>, PrepareError> {
    let objects = &loaded.scene.objects;
    objects
        .iter()
        .map(|object| {
            SurfaceInputs::new(loaded, object).ok_or_else(|| PrepareError::MeshMissing {
                object: object.name.clone(),
                mesh: object.mesh.clone(),
            })
        })
        .collect()
}

fn reference_pose(scene: &Scene) -> ReferencePose {
    let Reference::Frame(frame) = scene.reference;
    let size_px = [scene.size.0, scene.size.1];
    let view = PictureView { pose: motion::camera_at(scene, frame as f64), size_px };
    ReferencePose { view, poses: motion::poses_at(scene, frame as f64) }
}

/// Frames at which the scene is looked at in advance: the reference, and up to 17 evenly over the timeline.
fn sample_frames(scene: &Scene) -> Vec<f64> {
    let Reference::Frame(reference) = scene.reference;
    let (first, last) = (scene.timeline.first as f64, scene.timeline.last as f64);
    let count = (last - first).clamp(0.0, 16.0) as u32;
    let mut frames = vec![reference as f64];
    frames.extend((0..=count).map(|step| first + (last - first) * f64::from(step) / f64::from(count.max(1))));
    frames
}

/// Layer, then rank from high to low; equal ranks of two bodies by name.
fn painting_order(bodies: &[Arc<Body>], rules: &[RegionRule]) -> Vec<OrderEntry> {
    let layers: Vec<i32> = rules.iter().map(|rule| rule.strokes.layer).collect();
    let mut order: Vec<OrderEntry> = bodies
        .iter()
        .enumerate()
        .flat_map(|(body, prepared)| {
            (0..prepared.sampled.particles.len() as u32)
                .map(move |particle| OrderEntry { body: body as u32, particle })
        })
        .collect();
    let key = |entry: &OrderEntry| {
        let body = &bodies[entry.body as usize];
        let layer = layers[body.baked.region[entry.particle as usize] as usize];
        // Twice the order plus one over the count is the rank, compared without rounding.
        let rank = (u64::from(entry.particle) * 2 + 1) as f64 / body.sampled.particles.len() as f64;
        (layer, std::cmp::Reverse(rank.to_bits()), body.inputs.name_hash, entry.particle)
    };
    if bodies.len() == 1 && layers.windows(2).all(|pair| pair[0] == pair[1]) {
        order.reverse();
    } else {
        order.par_sort_by_cached_key(key);
    }
    order
}

/// Notes how long each step takes.
struct StepClock {
    since: Instant,
    steps: Vec<Step>,
}

impl StepClock {
    fn new() -> Self {
        Self { since: Instant::now(), steps: Vec::new() }
    }

    fn lap(&mut self, name: &'static str) {
        self.steps.push(Step { name, seconds: self.since.elapsed().as_secs_f64() });
        self.since = Instant::now();
    }
}
