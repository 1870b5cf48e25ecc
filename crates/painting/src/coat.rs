//! A coat: the particles of one object that carry one layer of paint. Layers do not share particles: otherwise every
//! large stroke would have a small one at its centre.

use std::sync::{Arc, OnceLock};

use glam::Vec3;
use impasto_core::bending::SortedParticles;

use impasto_core::sampling::{self, Needed, PackedParticle, ProgressiveOrder, Surface};
use impasto_core::solve::{Bounds, ParticleView};
use impasto_scene::presets::LayerKind;
use rayon::prelude::*;

use crate::bake::{BakedBody, LiftSources};
use crate::bent::Bent;
use crate::body::BodySurface;
use crate::coat_amounts::CoatAmounts;
use crate::context::{Context, ObjectInputs};
use crate::counts::CoatCount;
use crate::kept::KeptCoat;
use crate::made_once::made_once;
use crate::paper::PolygonCounts;
use crate::particles::{Particles, SampledPlaces};
use crate::references::RaisedPlace;
use crate::surface::{Albedo, SurfaceInputs};
use crate::traits::Traits;

pub(crate) struct Coat {
    /// Index of the object in the scene.
    pub(crate) object: usize,
    pub(crate) kind: LayerKind,
    pub(crate) sampled: Arc<Sampled>,
    pub(crate) lift_sources: LiftSources,
    /// Indices of the rules that may apply to its particles.
    pub(crate) used: Arc<Vec<u16>>,
    pub(crate) traits: Arc<Traits>,
    pub(crate) amounts: Arc<CoatAmounts>,
    pub(crate) baked: Arc<BakedBody>,
    /// The particles in the order of their triangles; made when the body first bends.
    pub(crate) sorted: OnceLock<SortedParticles>,
    pub(crate) surface: Arc<BodySurface>,
    /// For each rule and each of its brushes: the index of the brush's first mark in the list of all brushes' marks.
    pub(crate) first_marks: Vec<Vec<u32>>,
}

impl Sampled {
    /// Restores the particles that another process kept. The large arrays are taken out of `kept`.
    pub(crate) fn of_kept(body: &Arc<BodySurface>, kept: &mut KeptCoat) -> Self {
        let none = Particles::new(body, SampledPlaces::default(), 0);
        let sampled = SampledPlaces {
            places: std::mem::take(&mut kept.places),
            ordinals: std::mem::take(&mut kept.ordinals),
            state: kept.state,
        };
        Self {
            particles: Particles::new(body, sampled, kept.count),
            albedo: Arc::new(match body.has_colors() {
                true => Albedo::OfParticle(std::mem::take(&mut kept.albedo)),
                false => body.albedo(none.par_range(0..0)),
            }),
            area: kept.area,
            polygons: kept.polygons.take().map(Arc::new),
            count_on_whole: kept.count_on_whole,
            is_everywhere: kept.is_everywhere,
        }
    }

    /// The rank of a particle, in (0, 1]: its ordinal (about how many particles come before it in the order of the
    /// whole surface) divided by how many the whole surface would have.
    pub(crate) fn rank(&self, index: usize) -> f32 {
        ((self.particles.ordinal(index) + 0.5) / self.count_on_whole as f32).min(1.0)
    }

    /// The albedo of every particle sampled so far; empty where it follows from the surface's materials.
    pub(crate) fn albedo_of_particles(&self) -> &[u32] {
        match &*self.albedo {
            Albedo::OfParticle(all) => all,
            Albedo::OfMaterial(_) => &[],
        }
    }
}

impl Coat {
    /// A particle as a body that is not at rest carries it: its position, its normal, and the two columns of `lift`.
    pub(crate) fn carried(&self, bent: &Bent, index: usize, lift: [Vec3; 2]) -> [Vec3; 4] {
        let place = self.sampled.particles.places()[index];
        let normal = self.baked.placed.normal_of(index).as_vec3();
        bent.carrier().particle(&self.surface.mesh, place, [normal, lift[0], lift[1]], self.heights()(index))
    }

    /// One baked particle at rest.
    pub(crate) fn raised(&self, index: usize) -> RaisedPlace {
        let placed = &self.baked.placed;
        RaisedPlace {
            place: self.sampled.particles.places()[index],
            position: placed.position_of(index),
            normal: placed.normal_of(index),
            height: f64::from(self.heights()(index)),
        }
    }

    /// A bit for each particle, carried by a body that is not at rest: whether it faces the eye within the bounds.
    pub(crate) fn carried_within(&self, bent: &Bent, view: &ParticleView, bounds: &Bounds) -> Vec<u64> {
        let sorted = made_once(&self.sorted, || {
            let particles = &self.sampled.particles;
            let (places, ordinals) = (particles.places(), particles.ordinals());
            SortedParticles::new(places, &self.baked.placed, ordinals, self.heights())
        });
        bent.carrier().within(&self.surface.mesh, sorted, view, bounds)
    }

    /// How far each particle is lifted off its surface.
    fn heights(&self) -> impl Fn(usize) -> f32 + Sync + '_ {
        let offset = |rule: u16| self.lift_sources.rules[usize::from(rule)].strokes.offset;
        let is_lifted = self.used.iter().any(|&rule| offset(rule) != 0.0);
        move |index| if is_lifted { offset(self.traits.region(index)) } else { 0.0 }
    }

    /// sRGB albedo at a particle, 8 bits a channel, as 0xAABBGGRR; A is 0 for an unlit material, else 255. `HOLE` where
    /// a texture cuts a hole.
    pub(crate) fn albedo_srgb8(&self, particle: usize) -> u32 {
        let triangle = self.sampled.particles.triangle(particle);
        self.sampled.albedo.of(&self.surface, particle, triangle)
    }
}

/// The particles of a coat.
#[derive(Clone)]
pub(crate) struct Sampled {
    pub(crate) particles: Particles,
    /// The albedo at every particle sampled so far. These may be more particles than the coat has.
    albedo: Arc<Albedo>,
    /// Area of all sides of triangles that can be seen, model units squared. Of an open sheet, both sides count.
    pub(crate) area: f64,
    pub(crate) polygons: Option<Arc<PolygonCounts>>,
    /// How many particles the coat would have if it had those of its whole surface; at least 1.
    pub(crate) count_on_whole: usize,
    /// Whether it has those of its whole surface, or only those that views need.
    pub(crate) is_everywhere: bool,
}

/// The inputs that decide which particles a coat has. How many it has is not one of them, except with the source
/// paper's rule ([`crate::paper`]).
#[derive(Clone, PartialEq)]
pub(crate) struct SampleInputs {
    pub(crate) surface: SurfaceInputs,
    pub(crate) name_hash: u32,
    /// With the paper's rule, the number of particles: another number gives other particles, so nothing can be reused.
    pub(crate) per_polygon: Option<usize>,
    /// Where particles are needed; `None`: everywhere.
    pub(crate) needed: Option<Arc<Needed>>,
}

impl SampleInputs {
    /// The inputs of a coat that is to have this many particles.
    pub(crate) fn new(
        context: &Context<'_>,
        object: ObjectInputs<'_>,
        kind: LayerKind,
        count: &CoatCount,
    ) -> Self {
        Self {
            surface: object.surface.clone(),
            name_hash: context.name_hash(object.index, kind),
            per_polygon: (context.paper && count.count_on_whole > 0).then_some(count.count_on_whole),
            needed: count.needed.clone(),
        }
    }

    /// The first `count` particles of a body, or fewer where faces lie on each other ([`ProgressiveOrder::len_of`]). If
    /// particles are not needed everywhere, these are only the needed ones, and `count` says how many the whole surface
    /// would have.
    ///
    /// If `before` has these particles, they are taken from it. If not, further ones are sampled and appended to those
    /// of `before`. But all are sampled anew with the paper's rule, if particles are not needed everywhere, and in a
    /// crowded order ([`ProgressiveOrder::grow`]). `before` must come from equal inputs. `surface` is called only if
    /// particles are sampled.
    pub(crate) fn sample<'a, 'mesh: 'a>(
        &self,
        before: Option<Arc<Sampled>>,
        count: usize,
        body: &Arc<BodySurface>,
        surface: impl Fn() -> &'a Surface<'mesh>,
    ) -> Arc<Sampled> {
        if let Some(sampled) = &before
            && self.needed.is_some()
            && sampled.count_on_whole == count
        {
            return Arc::clone(sampled);
        }
        if let Some(sampled) = &before
            && self.needed.is_none()
            && let Some(particles) = sampled.particles.first(count)
        {
            return if particles == sampled.particles && sampled.count_on_whole == count.max(1) {
                Arc::clone(sampled)
            } else {
                Arc::new(Sampled { particles, count_on_whole: count.max(1), ..Sampled::clone(sampled) })
            };
        }
        let surface = surface();
        if let Some(needed) = &self.needed {
            let order = ProgressiveOrder::where_needed(surface, self.name_hash, needed);
            return Arc::new(Sampled {
                albedo: Arc::new(body.albedo(order.particles.par_iter().copied())),
                particles: Particles::new(body, SampledPlaces::of(&order), usize::MAX),
                area: surface.area(),
                polygons: None,
                count_on_whole: count.max(1),
                is_everywhere: false,
            });
        }
        if self.per_polygon.is_some() {
            let entries = sampling::per_polygon(surface, count, self.name_hash);
            let polygons = PolygonCounts::new(surface, &body.mesh, &entries);
            let places: Vec<PackedParticle> =
                entries.iter().map(|entry| PackedParticle::of(&entry.particle)).collect();
            let particles = Particles::new(body, SampledPlaces::unordered(places), usize::MAX);
            return Arc::new(Sampled {
                albedo: Arc::new(body.albedo(particles.par_range(0..particles.len()))),
                count_on_whole: particles.len().max(1),
                particles,
                area: surface.area(),
                polygons: Some(Arc::new(polygons)),
                is_everywhere: true,
            });
        }
        let mut order = before.as_ref().map_or_else(ProgressiveOrder::default, |before| {
            let SampledPlaces { places, ordinals, state } = before.particles.sampled();
            let particles = places.iter().map(|place| place.on(&body.mesh)).collect();
            ProgressiveOrder { particles, ordinals: ordinals.clone(), state: *state }
        });
        order.grow(surface, self.name_hash, count);
        let places = SampledPlaces::of(&order);
        let len = places.len_of(count).unwrap_or_default();
        Arc::new(Sampled {
            albedo: Arc::new(body.albedo(order.particles.par_iter().copied())),
            particles: match before {
                Some(before) => before.particles.continued(places, len),
                None => Particles::new(body, places, len),
            },
            area: surface.area(),
            polygons: None,
            count_on_whole: count.max(1),
            is_everywhere: true,
        })
    }
}
