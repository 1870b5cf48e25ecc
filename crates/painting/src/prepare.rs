//! From a scene to a painting, step by step; a step runs again only when its inputs have changed.

mod options;
mod seen;

use std::collections::HashMap;
use std::sync::Arc;

use glam::DAffine3;
use impasto_scene::document::{Lens, Scene, Solver, Style};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::{motion, presets};
use rayon::prelude::*;

use crate::amounts::BodyAmounts;
use crate::body::BodySurface;
use crate::body_shape::{BodyNoise, BodyShape};
use crate::brushes;
use crate::cached::Cached;
use crate::coat::Coat;
use crate::context::{Context, ObjectInputs};
use crate::counts::BodyCounts;
use crate::finish::FinishRule;
use crate::frame::Brushes;
use crate::kept::{Kept, KeptPainting, SceneKey, Wanted};
use crate::noise_displace::NoiseInputs;
use crate::object_cache::ObjectCache;
use crate::order::PaintingOrder;
use crate::ordering::OrderInputs;
use crate::painting::{Painting, PreparedBody};
use crate::particle_count;
use crate::parts::Cap;
use crate::references::{BodyReferences, SceneReferences};
use crate::regions::{self, BodyGuide, BodyRegions};
use crate::shadow_bounds;
use crate::shapes::{BodyShapes, shapes};
use crate::surface::SurfaceInputs;
use crate::touches::{TouchInputs, TouchMemo};
use crate::view::PictureView;
use options::{StepClock, fits};

pub use options::{PrepareError, PrepareOptions, Step};
pub(crate) use seen::Seen;
pub use seen::SeenFrom;

/// Prepares scenes one after the other and reuses every result whose inputs have not changed.
#[derive(Default)]
pub struct Preparer {
    /// By the objects' names.
    objects: HashMap<String, ObjectCache>,
    order: Cached<OrderInputs, Arc<PaintingOrder>>,
    brushes: Option<Arc<Brushes>>,
    touches: TouchMemo,
}

/// Prepares one scene; for many versions of one, keep a [`Preparer`].
///
/// # Errors
/// When a mesh that the scene names was not handed over with it, or when there are too many particles to number.
pub fn prepare(loaded: Arc<LoadedScene>) -> Result<Painting, PrepareError> {
    Preparer::default().prepare(loaded)
}

impl Preparer {
    /// Whether it has prepared nothing yet.
    pub fn is_new(&self) -> bool {
        self.objects.is_empty()
    }

    /// Prepares a scene, reusing every step whose inputs are those of the scene before.
    ///
    /// # Errors
    /// When a mesh that the scene names was not handed over with it, or when there are too many particles to number.
    pub fn prepare(&mut self, loaded: Arc<LoadedScene>) -> Result<Painting, PrepareError> {
        self.prepare_with(loaded, &PrepareOptions::default())
    }

    /// As [`Preparer::prepare`], with options. If preparing is given up, the steps done by then are not done again the
    /// next time.
    ///
    /// # Errors
    /// As [`Preparer::prepare`]; [`PrepareError::GivenUp`]; [`PrepareError::Memory`], before memory is taken for
    /// particles.
    pub fn prepare_with(
        &mut self,
        loaded: Arc<LoadedScene>,
        options: &PrepareOptions<'_>,
    ) -> Result<Painting, PrepareError> {
        let give_up = options.give_up;
        let mut clock = StepClock::new(options.peak_bytes);
        let scene = &loaded.scene;
        let inputs = surface_inputs(&loaded)?;
        let mut caches = self.take_caches(scene);
        build(&loaded, &mut caches, &inputs);
        let (views, frames) = sample_views(scene);
        let Plain { painting: plain, references: of_body, guides, shapes } =
            plain(&loaded, &mut caches, &views, &frames);
        clock.lap("surfaces");
        if give_up() {
            return self.given_up(scene, caches);
        }
        let style = scene.style.settings().preparation();
        if options.only_shown && !style.has_strokes {
            self.put_back(scene, caches);
            return Ok(Painting { steps: clock.steps, ..plain });
        }
        let Painting { rules, solver, .. } = &plain;
        let paper = presets::is_paper(scene);
        let seen = Seen::new(&loaded, options.seen_from);
        let context = Context {
            seen: &seen,
            scene,
            rules,
            views: &views,
            shapes: &shapes,
            solver: *solver,
            paper,
            orthographic: matches!(scene.camera.lens, Lens::Orthographic { .. }),
        };
        let mut bodies = plain.bodies.clone();
        let regions: Vec<Arc<BodyRegions>> = inputs
            .iter()
            .zip(&bodies)
            .zip(&scene.objects)
            .map(|((inputs, body), object)| {
                Arc::new(BodyRegions::new(scene, &object.name, inputs.file(), &body.surface.mesh))
            })
            .collect();
        let amounts: Vec<Arc<BodyAmounts>> =
            scene.objects.iter().map(|object| Arc::new(BodyAmounts::new(scene, &object.name))).collect();
        for ((body, regions), amounts) in bodies.iter_mut().zip(&regions).zip(&amounts) {
            body.regions = Arc::clone(regions);
            body.amounts = Arc::clone(amounts);
        }
        let used: Vec<Arc<Vec<u16>>> = regions.iter().map(|regions| Arc::new(regions.all())).collect();
        let caps: Vec<Vec<Cap>> = bodies.iter().map(|body| body.caps.clone()).collect();
        let groups = particle_count::groups_of_meshes(scene);
        let objects: Vec<ObjectInputs<'_>> = (0..caches.len())
            .map(|index| ObjectInputs {
                index,
                groups: groups[index],
                surface: &inputs[index],
                regions: &regions[index],
                used: &used[index],
                guides: &guides[index],
                amounts: &amounts[index],
                references: &of_body[index],
                caps: &caps[index],
            })
            .collect();
        let work = Work { loaded: &loaded, context: &context, objects: &objects, options };
        let (kept, found) = work.find_kept(&bodies);
        if options.kept.is_some() {
            clock.lap("cache");
        }
        let strokes = match found {
            Some(found) => self.take_kept(&work, &mut caches, &mut bodies, found),
            None => self.make(&work, &mut caches, &mut bodies, &mut clock),
        };
        self.put_back(scene, caches);
        let Strokes { coats, brushes, order } = strokes?;
        if matches!(kept, Kept::Taken(..)) {
            clock.lap("taken");
        }
        let bodies_laid: Vec<_> = bodies.iter().map(|body| (&body.surface, &*body.regions)).collect();
        let inputs =
            TouchInputs { rules: context.rules, bodies: &bodies_laid, coats: &coats, brushes: &brushes };
        let touches = self.touches.lay(scene, &inputs);
        Ok(Painting { bodies, coats, brushes, order, kept, touches, steps: clock.steps, ..plain })
    }

    /// Makes the strokes, step by step.
    fn make(
        &mut self,
        work: &Work<'_>,
        caches: &mut [ObjectCache],
        bodies: &mut [PreparedBody],
        clock: &mut StepClock<'_>,
    ) -> Result<Strokes, PrepareError> {
        let &Work { loaded, context, objects, options } = work;
        let go_on = || if (options.give_up)() { Err(PrepareError::GivenUp) } else { Ok(()) };
        let brushes =
            self.brushes(brushes::of_names(loaded, brushes::names_of(context.scene, context.rules)));
        clock.lap("brushes");
        go_on()?;
        caches.par_iter_mut().zip(objects).for_each(|(cache, &object)| cache.count(context, object));
        bodies.iter_mut().zip(&*caches).for_each(|(body, cache)| body.counts = cache.counted());
        work.fits(bodies)?;
        caches.par_iter_mut().zip(objects).for_each(|(cache, &object)| cache.sample(context, object));
        go_on()?;
        clock.lap("sampling");
        if matches!(context.solver, Solver::Horn | Solver::HornExact) {
            caches.par_iter_mut().for_each(ObjectCache::find_neighbours);
            clock.lap("neighbours");
        }
        go_on()?;
        caches.par_iter_mut().zip(objects).for_each(|(cache, &object)| {
            if go_on().is_ok() {
                cache.solve_field(context, object);
            }
        });
        clock.lap("field");
        go_on()?;
        let coats: Vec<Vec<Arc<Coat>>> = caches
            .par_iter_mut()
            .zip(objects)
            .map(|(cache, &object)| cache.bake(context, object, &brushes))
            .collect();
        let coats: Vec<Arc<Coat>> = coats.into_iter().flatten().collect();
        for (body, cache) in bodies.iter_mut().zip(&*caches) {
            body.field = Some(cache.field());
        }
        clock.lap("lift");
        let order = self.order.resize(
            OrderInputs::new(&coats, context.rules, presets::laying_order(context.scene)),
            |inputs, before| before.unwrap_or_else(|| Arc::new(inputs.order())),
        );
        let order = Arc::clone(order);
        clock.lap("order");
        Ok(Strokes { coats, brushes, order })
    }

    /// Takes the strokes as they were kept.
    fn take_kept(
        &mut self,
        work: &Work<'_>,
        caches: &mut [ObjectCache],
        bodies: &mut [PreparedBody],
        found: KeptPainting,
    ) -> Result<Strokes, PrepareError> {
        let &Work { context, objects, .. } = work;
        for (body, object) in bodies.iter_mut().zip(&found.objects) {
            body.counts = object.counts.clone();
        }
        work.fits(bodies)?;
        brushes::know(&found.brushes);
        let brushes = self.brushes(found.brushes);
        let coats: Vec<Vec<Arc<Coat>>> = caches
            .par_iter_mut()
            .zip(objects)
            .zip(found.objects)
            .map(|((cache, &object), kept)| cache.take_kept(context, object, &brushes, kept))
            .collect();
        let coats: Vec<Arc<Coat>> = coats.into_iter().flatten().collect();
        for ((body, cache), &object) in bodies.iter_mut().zip(&*caches).zip(objects) {
            body.field = Some(cache.late_field(context, object));
        }
        let order = Arc::new(found.order);
        self.order
            .update(OrderInputs::new(&coats, context.rules, presets::laying_order(context.scene)), |_, _| {
                Arc::clone(&order)
            });
        Ok(Strokes { coats, brushes, order })
    }

    /// The scene without strokes, in the style `Reference`: ready long before the strokes are.
    ///
    /// # Errors
    /// When a mesh that the scene names was not handed over with it.
    pub fn prepare_plain(&mut self, loaded: &Arc<LoadedScene>) -> Result<Painting, PrepareError> {
        let inputs = surface_inputs(loaded)?;
        let mut caches = self.take_caches(&loaded.scene);
        build(loaded, &mut caches, &inputs);
        let (views, frames) = sample_views(&loaded.scene);
        let plain = plain(loaded, &mut caches, &views, &frames).painting.in_style(Style::Reference);
        self.put_back(&loaded.scene, caches);
        Ok(plain)
    }
}

impl Preparer {
    fn given_up(&mut self, scene: &Scene, caches: Vec<ObjectCache>) -> Result<Painting, PrepareError> {
        self.put_back(scene, caches);
        Err(PrepareError::GivenUp)
    }

    /// The caches of the scene's objects, in their order. Those of objects that are gone stay behind; `put_back` drops
    /// them.
    fn take_caches(&mut self, scene: &Scene) -> Vec<ObjectCache> {
        let mut take = |name: &String| self.objects.remove(name).unwrap_or_default();
        scene.objects.iter().map(|object| take(&object.name)).collect()
    }

    fn put_back(&mut self, scene: &Scene, caches: Vec<ObjectCache>) {
        self.objects = scene.objects.iter().map(|object| object.name.clone()).zip(caches).collect();
    }

    /// These brushes; the same `Arc` as before where they are equal, so that a renderer need not compare them.
    fn brushes(&mut self, now: Brushes) -> Arc<Brushes> {
        let brushes = self.brushes.take().filter(|before| **before == now).unwrap_or_else(|| Arc::new(now));
        self.brushes = Some(Arc::clone(&brushes));
        brushes
    }
}

/// The inputs of the heavy steps.
struct Work<'a> {
    loaded: &'a LoadedScene,
    context: &'a Context<'a>,
    objects: &'a [ObjectInputs<'a>],
    options: &'a PrepareOptions<'a>,
}

/// The results of the heavy steps.
struct Strokes {
    coats: Vec<Arc<Coat>>,
    brushes: Arc<Brushes>,
    order: Arc<PaintingOrder>,
}

impl Work<'_> {
    /// Finds and reads what another process kept.
    fn find_kept(&self, bodies: &[PreparedBody]) -> (Kept, Option<KeptPainting>) {
        let Self { loaded, context, objects, options } = *self;
        let Some(find) = options.kept else { return (Kept::NotAsked, None) };
        let surfaces: Vec<Arc<BodySurface>> = bodies.iter().map(|body| Arc::clone(&body.surface)).collect();
        let key = SceneKey { loaded, context, objects, surfaces: &surfaces }.find();
        let Some(bytes) = find(&key) else { return (Kept::NotThere(key), None) };
        let brushes = brushes::names_of(context.scene, context.rules);
        let wanted = Wanted { surfaces: &surfaces, rules: context.rules.len(), brushes };
        match KeptPainting::read(&*bytes, &key, wanted) {
            Ok(found) => (Kept::Taken(key, bytes.count()), Some(found)),
            Err(unfit) => (Kept::Unfit(key, unfit.to_string()), None),
        }
    }

    /// Checks that all particles fit into memory.
    fn fits(&self, bodies: &[PreparedBody]) -> Result<(), PrepareError> {
        let counts: Vec<u64> = bodies.iter().map(|body| body.counts.made() as u64).collect();
        fits(self.options.memory_bytes, self.context.scene, &counts, self.context.solver)
    }
}

/// Builds the surfaces of all objects, and their noise. Instances share one surface.
fn build(loaded: &LoadedScene, caches: &mut [ObjectCache], inputs: &[SurfaceInputs]) {
    let twins = SurfaceInputs::twins(inputs);
    let objects = caches.par_iter_mut().zip(inputs).zip(&loaded.scene.objects).enumerate();
    objects.for_each(|(index, ((cache, inputs), object))| {
        if twins[index] == index {
            cache.build_surface(inputs);
        }
        cache.build_noise(NoiseInputs::new(loaded, object));
    });
    for (index, &twin) in twins.iter().enumerate().filter(|(index, twin)| index != *twin) {
        let [cache, of_twin] = caches.get_disjoint_mut([index, twin]).expect("a twin is another object");
        cache.share_surface(&inputs[index], of_twin);
    }
}

/// A painting without particles, and what its particles will be made from.
struct Plain {
    painting: Painting,
    /// For each object, how the references see it.
    references: Vec<Arc<BodyReferences>>,
    /// For each object, its guides.
    guides: Vec<Arc<Vec<BodyGuide>>>,
    /// For each view, the shapes of all objects.
    shapes: Vec<Vec<BodyShape>>,
}

/// The painting without particles, of objects whose surfaces are built.
fn plain(
    loaded: &Arc<LoadedScene>,
    caches: &mut [ObjectCache],
    views: &[(PictureView, Vec<DAffine3>)],
    frames: &[f64],
) -> Plain {
    let scene = &loaded.scene;
    let style = scene.style.settings().preparation();
    let rules = regions::rules(scene);
    let (palettes, palette_of_rule) = regions::palettes(&rules);
    let references = SceneReferences::of(scene);
    let noises: Vec<Option<Arc<BodyNoise>>> = caches.iter().map(ObjectCache::noise).collect();
    let shapes_at = |frame: f64| shapes(loaded, &noises, frame);
    let of_references: Vec<Vec<BodyShape>> =
        references.poses.iter().map(|reference| shapes_at(reference.frame)).collect();
    let mut guides: Vec<Vec<BodyGuide>> =
        scene.objects.iter().map(|object| regions::guides(scene, &object.name)).collect();
    let guide_frames = |guides: &[BodyGuide]| -> Vec<f64> {
        guides.iter().filter_map(|guide| guide.view.as_ref()?.frame).collect()
    };
    let mut frames_of_guides: Vec<f64> = guides.iter().flat_map(|guides| guide_frames(guides)).collect();
    frames_of_guides.sort_by(f64::total_cmp);
    frames_of_guides.dedup();
    let of_guides: Vec<Vec<BodyShape>> = frames_of_guides.iter().map(|frame| shapes_at(*frame)).collect();
    let of_body = caches.iter_mut().zip(&mut guides).enumerate().map(|(object, (cache, guides))| {
        let all = of_references.iter().chain(&of_guides).map(|shapes| shapes[object].clone());
        let mut stands = cache.stands(all.collect());
        let at_guides = stands.split_off(of_references.len());
        for view in guides.iter_mut().filter_map(|guide| guide.view.as_mut()) {
            let at = |frame| frames_of_guides.iter().position(|known| *known == frame);
            view.stands = view.frame.and_then(at).map(|index| at_guides[index].clone()).unwrap_or_default();
        }
        Arc::new(references.of_body(object, stands))
    });
    let of_body: Vec<Arc<BodyReferences>> = of_body.collect();
    let shapes: Vec<Vec<BodyShape>> = frames.iter().map(|frame| shapes_at(*frame)).collect();
    let bodies = caches.iter().zip(&scene.objects).enumerate();
    let bodies = bodies.map(|(index, (cache, object))| PreparedBody {
        hidden: object.hidden,
        surface: cache.surface(),
        caps: cache.parts().caps(of_body[index].own()),
        least_form: cache.parts().form.least(),
        field: None,
        counts: BodyCounts::default(),
        regions: Arc::default(),
        amounts: Arc::default(),
    });
    let bodies = bodies.collect();
    // Between the sampled frames a key may morph an object farther than at any of them, so the bounds take in the
    // farthest morph too.
    let farthest = BodyShapes::at(scene, references.own().frame).morphed_farthest(scene);
    let of_object = |object: usize| {
        let at_views = shapes.iter().map(|shapes| shapes[object].clone());
        at_views.chain([farthest.of(loaded, object)]).collect()
    };
    let bounds: Vec<_> =
        caches.iter_mut().enumerate().map(|(object, cache)| cache.bounds(of_object(object))).collect();
    let lit: Vec<_> = caches
        .iter()
        .zip(&scene.objects)
        .zip(&bounds)
        .map(|((cache, object), bounds)| bounds.filter(|_| !object.hidden && cache.surface().is_lit()))
        .collect();
    let origin_in_world = shadow_bounds::far_origin(&bounds, views);
    let painting = Painting {
        loaded: Arc::clone(loaded),
        bodies,
        coats: Vec::new(),
        palettes: Arc::new(palettes),
        palette_of_rule,
        brushes: Arc::default(),
        touches: Arc::default(),
        finish: FinishRule::new(scene, &style, &references.own().view),
        rules: Arc::new(rules),
        order: Arc::default(),
        bent: Arc::default(),
        noises,
        references: Arc::new(references),
        solver: if presets::is_paper(scene) { Solver::HornExact } else { style.solver },
        style: scene.style.clone(),
        origin_in_world,
        shadow_bounds: shadow_bounds::find(&bounds, &lit, views, origin_in_world),
        steps: Vec::new(),
        kept: Kept::NotAsked,
    };
    let guides = guides.into_iter().map(Arc::new).collect();
    Plain { painting, references: of_body, guides, shapes }
}

fn surface_inputs(loaded: &LoadedScene) -> Result<Vec<SurfaceInputs>, PrepareError> {
    let objects = &loaded.scene.objects;
    objects
        .iter()
        .enumerate()
        .map(|(index, object)| {
            SurfaceInputs::new(loaded, index).ok_or_else(|| PrepareError::MeshMissing {
                object: object.name.clone(),
                mesh: object.mesh.clone(),
            })
        })
        .collect()
}

/// Views that stand for the whole timeline: the reference, and up to 17 spread evenly over the timeline, each with the
/// poses of all objects; and the frame of each view.
fn sample_views(scene: &Scene) -> (Vec<(PictureView, Vec<DAffine3>)>, Vec<f64>) {
    let (first, last) = (scene.timeline.first as f64, scene.timeline.last as f64);
    let count = (last - first).clamp(0.0, 16.0) as u32;
    let frames: Vec<f64> =
        (0..=count).map(|step| first + (last - first) * f64::from(step) / f64::from(count.max(1))).collect();
    let size_px = [scene.size.0, scene.size.1];
    let view = |&frame: &f64| PictureView { pose: motion::camera_at(scene, frame), size_px };
    let (camera, frame) = motion::referred_to(scene, &scene.reference);
    let reference = (PictureView { pose: camera, size_px }, motion::poses_at(scene, frame));
    let along = frames.iter().map(|frame| (view(frame), motion::poses_at(scene, *frame)));
    let views = std::iter::once(reference).chain(along).collect();
    (views, std::iter::once(frame).chain(frames).collect())
}

#[cfg(test)]
mod tests;
