//! From a scene to a painting, step by step; each step is kept while its inputs stay the same.

mod options;

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DAffine3, Vec3};
use impasto_core::direction::singularities::Singularity;
use impasto_core::sampling::Particle;
use impasto_scene::document::{Lens, Scene, Solver, Style};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::presets::LayerKind;
use impasto_scene::{motion, presets};
use rayon::prelude::*;

use crate::brushes;
use crate::coat::{Coat, KeptObject, ObjectInputs};
use crate::field::BodyField;
use crate::finish::FinishRule;
use crate::frame::{BodySurface, Brushes};
use crate::lights;
use crate::noise_displace::{BodyNoise, BodyShape, NoiseInputs};
use crate::order::{OrderInputs, PaintingOrder};
use crate::particles::Particles;
use crate::parts::Cap;
use crate::references::{BodyReferences, SceneReferences};
use crate::regions::{self, BodyGuide, BodyRegions, RegionRule};
use crate::surface::SurfaceInputs;
use crate::view::PictureView;
use options::{StepClock, fits};

pub use options::{PrepareError, PrepareOptions, Step};

/// A scene, ready to be seen at any time from its camera. Immutable; cheap to clone.
#[derive(Clone)]
pub struct Painting {
    pub(crate) loaded: Arc<LoadedScene>,
    /// One per object.
    pub(crate) bodies: Vec<PreparedBody>,
    /// By object, then in the order of the layers.
    pub(crate) coats: Vec<Arc<Coat>>,
    pub(crate) rules: Arc<Vec<RegionRule>>,
    /// Palettes, and for each rule which is its own.
    pub(crate) palettes: Arc<Vec<Vec<[f32; 3]>>>,
    pub(crate) palette_of_rule: Vec<u8>,
    pub(crate) brushes: Arc<Brushes>,
    pub(crate) finish: FinishRule,
    /// All particles in painting order.
    pub(crate) order: Arc<PaintingOrder>,
    pub(crate) references: Arc<SceneReferences>,
    /// How each object stands in the reference pose.
    pub(crate) reference_shapes: Arc<Vec<BodyShape>>,
    /// Of each object.
    pub(crate) noises: Vec<Option<Arc<BodyNoise>>>,
    pub(crate) solver: Solver,
    pub(crate) style: Style,
    pub(crate) shadow_bounds: (Vec3, f32),
    steps: Vec<Step>,
}

/// What all coats of an object lie on.
#[derive(Clone)]
pub(crate) struct PreparedBody {
    pub(crate) surface: Arc<BodySurface>,
    /// The largest strokes that each part carries.
    pub(crate) caps: Vec<Cap>,
    /// Left out of the picture.
    pub(crate) hidden: bool,
    /// Where directions were combed, their field.
    pub(crate) field: Option<Arc<BodyField>>,
    /// Which region lies where.
    pub(crate) regions: Arc<BodyRegions>,
}

/// Prepares scenes and keeps what can be kept from one to the next.
#[derive(Default)]
pub struct Preparer {
    kept: HashMap<String, KeptObject>,
    order: Option<(OrderInputs, Arc<PaintingOrder>)>,
    brushes: Option<Arc<Brushes>>,
}

/// Prepares one scene; for many versions of one, keep a [`Preparer`].
///
/// # Errors
/// When a mesh that the scene names was not handed over with it.
pub fn prepare(loaded: Arc<LoadedScene>) -> Result<Painting, PrepareError> {
    Preparer::default().prepare(loaded)
}

/// What the steps of one object share.
pub(crate) struct Context<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) rules: &'a Arc<Vec<RegionRule>>,
    /// The views in which the scene is looked at in advance, with the objects' poses.
    pub(crate) views: &'a [(PictureView, Vec<DAffine3>)],
    pub(crate) brushes: &'a Brushes,
    pub(crate) solver: Solver,
    pub(crate) paper: bool,
    pub(crate) underpainting: bool,
    pub(crate) orthographic: bool,
}

impl Preparer {
    /// Prepares a scene, reusing every step whose inputs are those of the scene before.
    ///
    /// # Errors
    /// When a mesh that the scene names was not handed over with it.
    pub fn prepare(&mut self, loaded: Arc<LoadedScene>) -> Result<Painting, PrepareError> {
        self.prepare_with(loaded, &PrepareOptions::default())
    }

    /// As [`Preparer::prepare`]. Given up, it keeps what was made by then for the next time.
    ///
    /// # Errors
    /// As there, [`PrepareError::GivenUp`], and [`PrepareError::Memory`] before any memory is taken for particles.
    pub fn prepare_with(
        &mut self,
        loaded: Arc<LoadedScene>,
        options: &PrepareOptions<'_>,
    ) -> Result<Painting, PrepareError> {
        let give_up = options.give_up;
        let mut clock = StepClock::new(options.peak_bytes);
        let scene = &loaded.scene;
        let inputs = surface_inputs(&loaded)?;
        let mut kept = self.take_kept(scene);
        build(&loaded, &mut kept, &inputs);
        let plain = plain(&loaded, &kept);
        clock.lap("surfaces");
        let brushes = self.brushes(&loaded, &plain.rules);
        clock.lap("brushes");
        if give_up() {
            return self.given_up(scene, kept);
        }
        let Painting { rules, references, reference_shapes, solver, .. } = &plain;
        let views = views_in_advance(scene);
        let paper = presets::is_paper(scene);
        let context = Context {
            scene,
            rules,
            views: &views,
            brushes: &brushes,
            solver: *solver,
            paper,
            underpainting: scene.style.settings().preparation().underpainting && !paper,
            orthographic: matches!(scene.camera.lens, Lens::Orthographic { .. }),
        };
        let of_body: Vec<Arc<BodyReferences>> =
            (0..kept.len()).map(|object| Arc::new(references.of_body(object))).collect();
        let mut bodies = plain.bodies.clone();
        let regions: Vec<Arc<BodyRegions>> = inputs
            .iter()
            .zip(&bodies)
            .map(|(inputs, body)| {
                Arc::new(BodyRegions::new(scene, &inputs.name, inputs.file(), &body.surface.mesh))
            })
            .collect();
        for (body, regions) in bodies.iter_mut().zip(&regions) {
            body.regions = Arc::clone(regions);
        }
        let guides: Vec<Arc<Vec<BodyGuide>>> =
            inputs.iter().map(|inputs| Arc::new(regions::guides(scene, &inputs.name))).collect();
        let used: Vec<Arc<Vec<u16>>> = regions.iter().map(|regions| Arc::new(regions.all())).collect();
        let objects: Vec<ObjectInputs<'_>> = (0..kept.len())
            .map(|index| ObjectInputs {
                index,
                surface: &inputs[index],
                regions: &regions[index],
                used: &used[index],
                guides: &guides[index],
                references: &of_body[index],
                caps: &bodies[index].caps,
                shape: &reference_shapes[index],
            })
            .collect();
        kept.par_iter_mut().zip(&objects).for_each(|(kept, &object)| kept.count(&context, object));
        if let Err(error) = fits(options.memory_bytes, scene, &kept, *solver) {
            self.keep(scene, kept);
            return Err(error);
        }
        kept.par_iter_mut().zip(&objects).for_each(|(kept, &object)| kept.sample(&context, object));
        if give_up() {
            return self.given_up(scene, kept);
        }
        kept.par_iter_mut().zip(&objects).for_each(|(kept, &object)| kept.pose(object));
        clock.lap("sampling");
        if matches!(solver, Solver::Horn | Solver::HornExact) {
            kept.par_iter_mut().for_each(KeptObject::find_neighbours);
            clock.lap("neighbours");
        }
        if give_up() {
            return self.given_up(scene, kept);
        }
        kept.par_iter_mut().zip(&objects).for_each(|(kept, &object)| {
            if !give_up() {
                kept.solve_field(&context, object);
            }
        });
        clock.lap("field");
        if give_up() {
            return self.given_up(scene, kept);
        }
        let coats: Vec<Vec<Arc<Coat>>> =
            kept.par_iter_mut().zip(&objects).map(|(kept, &object)| kept.bake(&context, object)).collect();
        let coats: Vec<Arc<Coat>> = coats.into_iter().flatten().collect();
        for (body, kept) in bodies.iter_mut().zip(&kept) {
            body.field = kept.field();
        }
        clock.lap("lift");
        let order = self.order(&coats, rules);
        clock.lap("order");
        self.keep(scene, kept);
        Ok(Painting { bodies, coats, brushes, order, steps: clock.steps, ..plain })
    }

    /// The scene without a stroke: what its style `Reference` shows, there long before the strokes are.
    ///
    /// # Errors
    /// When a mesh that the scene names was not handed over with it.
    pub fn prepare_plain(&mut self, loaded: &Arc<LoadedScene>) -> Result<Painting, PrepareError> {
        let inputs = surface_inputs(loaded)?;
        let mut kept = self.take_kept(&loaded.scene);
        build(loaded, &mut kept, &inputs);
        let plain = plain(loaded, &kept).in_style(Style::Reference);
        self.keep(&loaded.scene, kept);
        Ok(plain)
    }
}

impl Preparer {
    /// Each step is kept with its inputs, so that those that are done need not be done again.
    fn given_up(&mut self, scene: &Scene, kept: Vec<KeptObject>) -> Result<Painting, PrepareError> {
        self.keep(scene, kept);
        Err(PrepareError::GivenUp)
    }

    fn take_kept(&mut self, scene: &Scene) -> Vec<KeptObject> {
        let mut kept = |name: &String| self.kept.remove(name).unwrap_or_default();
        scene.objects.iter().map(|object| kept(&object.name)).collect()
    }

    fn keep(&mut self, scene: &Scene, kept: Vec<KeptObject>) {
        self.kept = scene.objects.iter().map(|object| object.name.clone()).zip(kept).collect();
    }

    fn order(&mut self, coats: &[Arc<Coat>], rules: &[RegionRule]) -> Arc<PaintingOrder> {
        let inputs = OrderInputs::new(coats, rules);
        let kept = self.order.take().filter(|(before, _)| *before == inputs);
        let order = kept.map_or_else(|| Arc::new(inputs.order()), |(_, order)| order);
        self.order = Some((inputs, Arc::clone(&order)));
        order
    }

    /// The marks of the brushes; the very ones of the scene before where they are the same, so that a renderer need not look.
    fn brushes(&mut self, loaded: &LoadedScene, rules: &[RegionRule]) -> Arc<Brushes> {
        let now = brushes::of_rules(loaded, rules);
        let brushes = self.brushes.take().filter(|before| **before == now).unwrap_or_else(|| Arc::new(now));
        self.brushes = Some(Arc::clone(&brushes));
        brushes
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

    /// The same painting, drawn in another style.
    pub fn in_style(&self, style: Style) -> Self {
        Self { style, ..self.clone() }
    }

    /// How long each step of preparing took.
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// How many particles the body layer of an object has; objects in the order of the scene.
    pub fn particle_counts(&self) -> Vec<usize> {
        (0..self.bodies.len()).map(|object| self.particles(object).len()).collect()
    }

    /// How many particles all layers of all objects have.
    pub fn particle_total(&self) -> usize {
        self.coats.iter().map(|coat| coat.sampled.particles.len()).sum()
    }

    /// Memory of all baked particles, in bytes.
    pub fn particle_bytes(&self) -> usize {
        self.coats.iter().map(|coat| coat.baked.baked.bytes()).sum()
    }

    /// The particles of one object's body layer, in progressive order.
    pub fn particles(&self, object: usize) -> Particles {
        self.coat(object, LayerKind::Body).map_or_else(
            || Particles::new(&self.bodies[object].surface, Arc::default(), 0),
            |coat| coat.sampled.particles.clone(),
        )
    }

    /// The surface of one object.
    pub fn surface(&self, object: usize) -> &Arc<BodySurface> {
        &self.bodies[object].surface
    }

    /// How every object stands at a frame, in the order of the scene.
    pub fn shapes_at(&self, frame: f64) -> Vec<BodyShape> {
        shapes(self.scene(), &self.noises, frame)
    }

    /// Index of the region that a place of an object's surface belongs to: `regions.len()` of the scene for none of them.
    pub fn region_at(&self, object: usize, place: &Particle) -> usize {
        usize::from(self.bodies[object].regions.of(place))
    }

    /// Area of the visible sides of one object, model units squared.
    pub fn surface_area(&self, object: usize) -> f64 {
        self.coat(object, LayerKind::Body).map_or(0.0, |coat| coat.sampled.area)
    }

    /// The points of one object where strokes have no direction, as far as its directions were combed.
    pub fn singularities(&self, object: usize) -> &[Singularity] {
        self.bodies[object].field.as_ref().map_or(&[], |field| field.singularities())
    }

    /// For each particle of an object's body layer, whether the direction that is stated there has a singular point near by:
    /// the surface faces along the axis that it is stated by.
    pub fn poles(&self, object: usize) -> Vec<bool> {
        self.coat(object, LayerKind::Body).map_or_else(Vec::new, |coat| coat.ground.poles())
    }

    fn coat(&self, object: usize, kind: LayerKind) -> Option<&Coat> {
        self.coats.iter().map(Arc::as_ref).find(|coat| coat.object == object && coat.kind == kind)
    }
}

/// Builds the surfaces of all objects, and their noise.
fn build(loaded: &LoadedScene, kept: &mut [KeptObject], inputs: &[SurfaceInputs]) {
    kept.par_iter_mut().zip(inputs).zip(&loaded.scene.objects).for_each(|((kept, inputs), object)| {
        kept.build_surface(inputs);
        kept.build_noise(NoiseInputs::new(loaded, object));
    });
}

/// How every object stands at a frame.
fn shapes(scene: &Scene, noises: &[Option<Arc<BodyNoise>>], frame: f64) -> Vec<BodyShape> {
    let morphs = motion::morphs_at(scene, frame);
    if noises.iter().all(Option::is_none) {
        return morphs.into_iter().map(BodyShape::from).collect();
    }
    let (poses, seconds) = (motion::poses_at(scene, frame), motion::seconds_at(scene, frame));
    let shape = |(index, morph): (usize, f64)| BodyShape {
        morph,
        noise: noises[index].as_ref().map(|noise| noise.at(seconds[index], poses[index])),
    };
    morphs.into_iter().enumerate().map(shape).collect()
}

/// All that a painting has but for particles, of objects whose surfaces are built.
fn plain(loaded: &Arc<LoadedScene>, kept: &[KeptObject]) -> Painting {
    let scene = &loaded.scene;
    let style = scene.style.settings().preparation();
    let rules = regions::rules(scene);
    let (palettes, palette_of_rule) = regions::palettes(&rules);
    let references = SceneReferences::of(scene);
    let bodies = kept.iter().zip(&scene.objects).enumerate();
    let bodies = bodies.map(|(index, (kept, object))| PreparedBody {
        hidden: object.hidden,
        surface: kept.surface(),
        caps: kept.parts().caps(&references.of_body(index).own().map),
        field: None,
        regions: Arc::default(),
    });
    let bounds: Vec<_> = kept.iter().map(KeptObject::bounds).collect();
    let views = views_in_advance(scene);
    let noises: Vec<Option<Arc<BodyNoise>>> = kept.iter().map(KeptObject::noise).collect();
    let reference_shapes = shapes(scene, &noises, motion::referred_to(scene, &scene.reference).1);
    Painting {
        loaded: Arc::clone(loaded),
        bodies: bodies.collect(),
        coats: Vec::new(),
        palettes: Arc::new(palettes),
        palette_of_rule,
        brushes: Arc::default(),
        finish: FinishRule::new(scene, &style, &references.own().view),
        rules: Arc::new(rules),
        order: Arc::default(),
        reference_shapes: Arc::new(reference_shapes),
        noises,
        references: Arc::new(references),
        solver: if presets::is_paper(scene) { Solver::HornExact } else { style.solver },
        style: scene.style.clone(),
        shadow_bounds: lights::bounds_over(&bounds, views.iter().map(|(_, poses)| poses.as_slice())),
        steps: Vec::new(),
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

/// The views in which the scene is looked at in advance: the reference, and up to 17 evenly over the timeline.
fn views_in_advance(scene: &Scene) -> Vec<(PictureView, Vec<DAffine3>)> {
    let (first, last) = (scene.timeline.first as f64, scene.timeline.last as f64);
    let count = (last - first).clamp(0.0, 16.0) as u32;
    let frames: Vec<f64> =
        (0..=count).map(|step| first + (last - first) * f64::from(step) / f64::from(count.max(1))).collect();
    let size_px = [scene.size.0, scene.size.1];
    let view = |&frame: &f64| PictureView { pose: motion::camera_at(scene, frame), size_px };
    let (camera, frame) = motion::referred_to(scene, &scene.reference);
    let reference = (PictureView { pose: camera, size_px }, motion::poses_at(scene, frame));
    let along = frames.iter().map(|frame| (view(frame), motion::poses_at(scene, *frame)));
    std::iter::once(reference).chain(along).collect()
}

#[cfg(test)]
mod tests;
