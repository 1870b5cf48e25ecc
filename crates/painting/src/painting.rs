//! A prepared scene.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::{DVec3, Vec3};
use impasto_core::bending::CarriedPlace;
use impasto_core::direction::singularities::Singularity;
use impasto_core::sampling::{PackedParticle, Particle};
use impasto_scene::document::{Amount, Scene, Solver, Style};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::presets::{self, LayerKind};

use crate::amounts::BodyAmounts;
use crate::bent::{Bent, BentMemo};
use crate::body::BodySurface;
use crate::body_shape::{BodyNoise, BodyShape, FrameNoise};
use crate::coat::Coat;
use crate::counts::BodyCounts;
use crate::finish::FinishRule;
use crate::frame::{ANY_COLOR, Brushes, Palette};
use crate::kept::Kept;
use crate::late_field::LateField;
use crate::order::PaintingOrder;
use crate::particles::{Particles, SampledPlaces};
use crate::parts::Cap;
use crate::prepare::Step;
use crate::references::SceneReferences;
use crate::regions::{BodyRegions, RegionRule};
use crate::shapes::{noises_at, shapes};
use crate::touches::LaidTouch;

/// A prepared scene, from which frames are made at any time and through any camera. Immutable; cheap to clone.
#[derive(Clone)]
pub struct Painting {
    pub(crate) loaded: Arc<LoadedScene>,
    /// One per object.
    pub(crate) bodies: Vec<PreparedBody>,
    /// By object, then by kind of layer in the order of [`LayerKind`].
    pub(crate) coats: Vec<Arc<Coat>>,
    pub(crate) rules: Arc<Vec<RegionRule>>,
    /// The palettes as they are without keys.
    pub(crate) palettes: Arc<Vec<Palette>>,
    /// Index of each rule's palette, or [`crate::frame::ANY_COLOR`].
    pub(crate) palette_of_rule: Vec<u8>,
    pub(crate) brushes: Arc<Brushes>,
    /// The strokes that were placed by hand, in the order of the scene.
    pub(crate) touches: Arc<Vec<LaidTouch>>,
    pub(crate) finish: FinishRule,
    pub(crate) order: Arc<PaintingOrder>,
    pub(crate) references: Arc<SceneReferences>,
    /// The bodies at the last frames that were asked for.
    pub(crate) bent: Arc<BentMemo>,
    pub(crate) noises: Vec<Option<Arc<BodyNoise>>>,
    pub(crate) solver: Solver,
    pub(crate) style: Style,
    /// The origin of the frames' world space.
    pub(crate) origin_in_world: DVec3,
    /// The sphere (centre, radius) that the shadow map covers, the same in all frames, in the frames' world space. It
    /// holds all bodies, or only what is seen if that is much smaller.
    pub(crate) shadow_bounds: (Vec3, f32),
    pub(crate) steps: Vec<Step>,
    pub(crate) kept: Kept,
}

/// One object, prepared: all that its coats share.
#[derive(Clone)]
pub(crate) struct PreparedBody {
    pub(crate) surface: Arc<BodySurface>,
    /// The largest strokes that each part carries.
    pub(crate) caps: Vec<Cap>,
    /// The smallest size of its form at any place, model units.
    pub(crate) least_form: f32,
    /// Whether it is left out of the picture.
    pub(crate) hidden: bool,
    /// The direction field, empty where all directions are stated outright; `None` before strokes are made.
    pub(crate) field: Option<Arc<LateField>>,
    /// How many particles each layer was to have.
    pub(crate) counts: BodyCounts,
    /// Which region each place of it belongs to.
    pub(crate) regions: Arc<BodyRegions>,
    /// The amounts painted onto it.
    pub(crate) amounts: Arc<BodyAmounts>,
}

impl Painting {
    /// The palettes at a frame; all frames share them if no rule has keys.
    pub(crate) fn palettes_at(&self, frame: f64) -> Arc<Vec<Palette>> {
        if self.rules.iter().all(|rule| rule.strokes.keys.is_empty()) {
            return Arc::clone(&self.palettes);
        }
        let mut palettes = Vec::clone(&self.palettes);
        for (rule, &index) in
            self.rules.iter().zip(&self.palette_of_rule).filter(|(_, index)| **index != ANY_COLOR)
        {
            palettes[usize::from(index)].mix = rule.strokes.at(frame).palette_mix;
        }
        Arc::new(palettes)
    }

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

    /// Whether the painting was taken from what another process kept.
    pub fn kept(&self) -> &Kept {
        &self.kept
    }

    /// How many particles the body layer of an object has; objects in the order of the scene.
    pub fn particle_counts(&self) -> Vec<usize> {
        (0..self.bodies.len()).map(|object| self.particles(object).len()).collect()
    }

    /// How many particles all layers of all objects have.
    pub fn particle_total(&self) -> usize {
        self.coats.iter().map(|coat| coat.sampled.particles.len()).sum()
    }

    /// Whether large surfaces have particles only where the views that the painting was prepared for need them: see
    /// [`crate::SeenFrom`].
    pub fn is_partial(&self) -> bool {
        self.coats.iter().any(|coat| !coat.sampled.is_everywhere)
    }

    /// Whether preparing the scene for other views may give another painting.
    pub fn depends_on_views(&self) -> bool {
        self.bodies.iter().any(|body| body.counts.counted.may_depend_on_views.contains(&true))
    }

    /// Whether both have the same particles in the same painting order.
    pub fn has_particles_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.order, &other.order)
    }

    /// Memory of all baked particles once all their looks are known, in bytes.
    pub fn particle_bytes(&self) -> usize {
        self.coats.iter().map(|coat| coat.baked.bytes()).sum()
    }

    /// The particles of one object's body layer, in progressive order.
    pub fn particles(&self, object: usize) -> Particles {
        self.coat(object, LayerKind::Body).map_or_else(
            || Particles::new(&self.bodies[object].surface, SampledPlaces::default(), 0),
            |coat| coat.sampled.particles.clone(),
        )
    }

    /// The surface of one object.
    pub fn surface(&self, object: usize) -> &Arc<BodySurface> {
        &self.bodies[object].surface
    }

    /// The shape of every object at a frame, in the order of the scene.
    pub fn shapes_at(&self, frame: f64) -> Vec<BodyShape> {
        shapes(&self.loaded, &self.noises, frame)
    }

    pub(crate) fn noises_at(&self, frame: f64) -> Vec<Option<FrameNoise>> {
        noises_at(self.scene(), &self.noises, frame)
    }

    /// Every object as it stands at a frame, in the order of the scene; `None` for those at rest. The last few frames
    /// are remembered.
    pub fn bent_at(&self, frame: f64) -> Arc<Vec<Option<Arc<Bent>>>> {
        self.bent.at(frame, self.bodies.iter().map(|body| &body.surface), || self.shapes_at(frame))
    }

    /// Begins to bend the bodies for a frame that will be asked for soon, in the background. No picture depends on it.
    pub fn foresee(&self, frame: f64) {
        let moves = |body: &PreparedBody| body.surface.bends();
        if self.bodies.iter().any(moves) {
            let painting = self.clone();
            rayon::spawn(move || {
                let strained = |bent: &Arc<Bent>| {
                    bent.carrier();
                };
                painting.bent_at(frame).iter().flatten().for_each(strained);
            });
        }
    }

    /// What went wrong since the scene's files were opened: point caches that could not be read any more, so that their
    /// bodies stay at rest. The messages are sorted, and each occurs once.
    pub fn faults(&self) -> Vec<String> {
        let mut faults: Vec<String> =
            self.bodies.iter().filter_map(|body| body.surface.fault().cloned()).collect();
        faults.sort();
        faults.dedup();
        faults
    }

    /// [`Painting::faults`] in one sentence; `None` where nothing went wrong.
    pub fn fault_words(&self) -> Option<String> {
        let faults = self.faults();
        let why = "a body stayed at rest in some frames, since its point cache could not be read";
        (!faults.is_empty()).then(|| format!("{why}: {}", faults.join("; ")))
    }

    /// Index of the region that a place of an object's surface belongs to; `regions.len()` of the scene if it belongs
    /// to none.
    pub fn region_at(&self, object: usize, place: &Particle) -> usize {
        usize::from(self.bodies[object].regions.of(place))
    }

    /// The factor that is painted onto an amount at a place of an object's surface; 1 where nothing is.
    pub fn painted_at(&self, object: usize, place: &Particle, of: Amount) -> f32 {
        let body = &self.bodies[object];
        if body.amounts.is_empty() {
            return 1.0;
        }
        body.amounts.at(of, body.regions.of(place), place.position, place.normal)
    }

    /// Where a place of an object is at a frame; `None` where the object is at rest.
    pub fn carried(&self, object: usize, place: &Particle, frame: f64) -> Option<CarriedPlace> {
        self.bent_at(frame)[object].as_ref().map(|bent| bent.place(PackedParticle::of(place)))
    }

    /// The name of the material under a stroke, or under the middle of a touch; the object's name where the material
    /// has none. For a touch, `particle` is its index in the scene.
    pub fn material_of(&self, object: usize, kind: LayerKind, particle: usize) -> &str {
        let body = &self.bodies[object].surface;
        let touch = || self.touches.iter().find(|laid| laid.number as usize == particle);
        let triangle = match kind {
            LayerKind::Touches => touch().map(LaidTouch::triangle),
            _ => self.coat(object, kind).map(|coat| coat.sampled.particles.triangle(particle)),
        };
        let material = triangle.and_then(|triangle| {
            body.materials.get(body.mesh.material_of_triangle.get(triangle).copied().unwrap_or(0) as usize)
        });
        match material {
            Some(material) if !material.name.is_empty() => &material.name,
            _ => &self.scene().objects[object].name,
        }
    }

    /// The layers of paint that this painting's frames may have, the lowest first: each as the `layer` that regions
    /// state, and the kind of layer.
    pub fn paint_layers(&self) -> Vec<(i32, LayerKind)> {
        let orders: BTreeSet<i32> = self.rules.iter().map(|rule| rule.strokes.layer).collect();
        let mut kinds = presets::laying_order(self.scene()).to_vec();
        kinds.retain(|&kind| self.coats.iter().any(|coat| coat.kind == kind));
        let of_regions = orders.iter().flat_map(|&order| kinds.iter().map(move |&kind| (order, kind)));
        of_regions.chain(self.has_touches().then(|| (self.highest_layer(), LayerKind::Touches))).collect()
    }

    /// Whether drafts leave the underpainting out: the toned ground can stand in for it only if nothing lies below it.
    pub(crate) fn drafts_lack_underpainting(&self) -> bool {
        presets::laying_order(self.scene())[0] == LayerKind::Underpainting
    }

    /// Whether there are strokes that were placed by hand and that the style paints.
    pub fn has_touches(&self) -> bool {
        !self.touches.is_empty() && self.style.settings().preparation().lays_touches
    }

    /// The highest `layer` of its regions: touches lie over it.
    pub(crate) fn highest_layer(&self) -> i32 {
        self.rules.iter().map(|rule| rule.strokes.layer).max().unwrap_or(0)
    }

    /// Area of the visible sides of one object, model units squared.
    pub fn surface_area(&self, object: usize) -> f64 {
        self.coat(object, LayerKind::Body).map_or(0.0, |coat| coat.sampled.area)
    }

    /// The points of one object where the direction field has no direction; none where there is no field.
    pub fn singularities(&self, object: usize) -> &[Singularity] {
        let field = self.bodies[object].field.as_ref().and_then(|field| field.get());
        field.map_or(&[], |field| field.singularities())
    }

    /// For each particle of an object's body layer, whether it lies near a singular point of its stated direction.
    /// There the surface faces along the axis by which the direction is stated.
    pub fn poles(&self, object: usize) -> Vec<bool> {
        self.coat(object, LayerKind::Body).map_or_else(Vec::new, |coat| coat.lift_sources.poles())
    }

    pub(crate) fn coat(&self, object: usize, kind: LayerKind) -> Option<&Coat> {
        let place = |coat: &Coat| (coat.object, coat.kind as usize);
        let index = self.coats.partition_point(|coat| place(coat) < (object, kind as usize));
        self.coats.get(index).map(Arc::as_ref).filter(|coat| place(coat) == (object, kind as usize))
    }
}
