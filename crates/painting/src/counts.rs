//! How many particles each coat of an object has: as many as its views need, unless the object states the body layer's
//! count.

use std::sync::Arc;

use glam::{DAffine3, DVec3};
use impasto_core::TriangleMesh;
use impasto_core::sampling::{Needed, Surface};
use impasto_scene::document::Solver;
use impasto_scene::presets::{self, LayerKind};

use crate::body::BodySurface;
use crate::body_shape::BodyShape;
use crate::context::{Context, ObjectInputs};
use crate::particle_count::{self, Found, Sighting};
use crate::parts::{BodyParts, Cap, fit_of, wanted_where_small};
use crate::regions::BodyRegions;
use crate::size_follow::Following;
use crate::stroke_size::reach_px;
use crate::view::PictureView;

const LAYERS: usize = LayerKind::ALL.len();

/// Coats with fewer particles have them everywhere.
pub(crate) const LEAST_ON_WHOLE: f64 = 16_384.0;

/// All that the counts of an object's coats depend on.
pub(crate) struct CountInputs {
    surface: Arc<BodySurface>,
    regions: Arc<BodyRegions>,
    caps: Vec<Cap>,
    sightings: Vec<Sighting>,
    /// For each rule, at each moment of its keys: the length, the width and the coverage of each layer.
    layers: Vec<Vec<[[f32; 3]; LAYERS]>>,
    /// For each rule, how far strokes fit the form.
    fits: Vec<f32>,
    left_out: [bool; LAYERS],
    /// The least count of a layer: see [`particle_count::least`].
    least: u32,
    /// See [`ObjectInputs::groups`].
    groups: usize,
    /// The body layer's count, where the object states it.
    stated: Option<u64>,
    /// The factor, at least 1, by which painted amounts raise the counts.
    more_wanted: f32,
    paper: bool,
    /// Whether particles may be left out.
    unneeded: Unneeded,
}

impl PartialEq for CountInputs {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.surface, &other.surface)
            && (self.left_out, self.least, self.groups) == (other.left_out, other.least, other.groups)
            && (self.stated, self.more_wanted, self.paper) == (other.stated, other.more_wanted, other.paper)
            && self.unneeded == other.unneeded
            && self.layers == other.layers
            && self.fits == other.fits
            && self.caps == other.caps
            && self.sightings == other.sightings
            && self.regions == other.regions
    }
}

impl CountInputs {
    pub(crate) fn new(context: &Context<'_>, object: ObjectInputs<'_>, surface: Arc<BodySurface>) -> Self {
        let mut layers = vec![Vec::new(); context.rules.len()];
        for &rule in object.used.iter() {
            let strokes = &context.rules[usize::from(rule)].strokes;
            let at = |frame: f64| {
                let strokes = strokes.at(frame);
                LayerKind::ALL.map(|kind| {
                    let layer = strokes.layer_of(kind);
                    [layer.length_px, layer.width_px, layer.coverage]
                })
            };
            layers[usize::from(rule)] = strokes.moments().into_iter().map(at).collect();
        }
        let has_no_paint = |kind: LayerKind| {
            let mut moments = object.used.iter().flat_map(|&rule| &layers[usize::from(rule)]);
            moments.all(|layers| layers[kind as usize][2] <= 0.0)
        };
        let left_out =
            LayerKind::ALL.map(|kind| !presets::paints_layer(context.scene, kind) || has_no_paint(kind));
        Self {
            regions: Arc::clone(object.regions),
            caps: object.caps.to_vec(),
            sightings: sightings(context, object.index),
            layers,
            fits: context.rules.iter().map(|rule| rule.strokes.fit).collect(),
            left_out,
            least: particle_count::least(context.scene.objects.len()),
            groups: object.groups,
            stated: context.scene.objects[object.index].particles,
            more_wanted: object.amounts.more_wanted(),
            paper: context.paper,
            unneeded: Unneeded::of(context, object, &surface),
            surface,
        }
    }

    /// The counts, in the order of [`LayerKind::ALL`].
    pub(crate) fn counts(&self, surface: &Surface<'_>, parts: &BodyParts) -> Counted {
        let body = &self.surface;
        let positions_at = |shape: &BodyShape| (!body.is_at_rest(shape)).then(|| body.positions_at(shape));
        let wanted_per_px = self.wanted_per_px(surface.mesh(), parts);
        let Found { needed, is_cut, deepness } = particle_count::find::<LAYERS>(
            surface,
            &self.sightings,
            particle_count::deepest(self.groups),
            positions_at,
            wanted_per_px,
        );
        let found = needed.map(|needed| particle_count::bounded(needed, self.least));
        let is_stated = |kind: usize| self.stated.filter(|_| kind == LayerKind::Body as usize);
        let counts = std::array::from_fn(|kind| match is_stated(kind) {
            Some(stated) => stated as usize,
            None if self.left_out[kind] => 0,
            // By the source paper's rule, a polygon without a particle would stay bare, so each polygon gets at least
            // one.
            None if self.paper => found[kind].max(surface.faces().count()),
            None if LayerKind::ALL[kind] != LayerKind::Underpainting => {
                particle_count::times(found[kind], self.more_wanted)
            }
            None => found[kind],
        });
        let may_depend_on_views = std::array::from_fn(|kind| {
            let may_be_more = match self.unneeded {
                Unneeded::None => false,
                Unneeded::OfMoving { .. } => counts[kind] as f64 > LEAST_ON_WHOLE,
                Unneeded::AtRest => is_cut || needed[kind] * f64::from(self.more_wanted) > LEAST_ON_WHOLE,
            };
            may_be_more && is_stated(kind).is_none() && !self.left_out[kind]
        });
        Counted { counts, may_depend_on_views, more_wanted: f64::from(self.more_wanted), deepness }
    }

    /// Whether particles may be left out.
    pub(crate) fn unneeded(&self) -> Unneeded {
        self.unneeded
    }

    /// Whether it is one of several groups of its mesh that are objects.
    pub(crate) fn is_group(&self) -> bool {
        self.groups > 1
    }

    pub(crate) fn surface(&self) -> &BodySurface {
        &self.surface
    }

    /// Whether nothing shows through a triangle: no texture cuts holes into it.
    pub(crate) fn is_solid(&self, triangle: usize) -> bool {
        let material = self.surface.materials.get(self.surface.material_of_triangle(triangle));
        material.is_none_or(|material| material.cutoff.is_none())
    }

    /// Whether both are of one surface.
    pub(crate) fn same_surface(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.surface, &other.surface)
    }

    /// How far the largest strokes reach from their particles, pixels at the scene's own size, before chance changes
    /// their size.
    pub(crate) fn most_reach_px(&self) -> f64 {
        let sizes = self.layers.iter().flatten().flatten();
        let reach = sizes.map(|&[length_px, width_px, _]| reach_px([1.0; 2], [length_px, width_px]));
        f64::from(reach.fold(0.0, f32::max))
    }

    /// Returns a function that takes the index of a triangle, a point of it and its normal. It gives, for each layer,
    /// the most strokes that may be wanted per pixel there.
    pub(crate) fn wanted_per_px<'a>(
        &'a self,
        mesh: &'a TriangleMesh,
        parts: &'a BodyParts,
    ) -> impl Fn(usize, DVec3, DVec3) -> [f32; LAYERS] + Sync + 'a {
        |triangle, center, normal| {
            let cap = self.caps[parts.of_triangle[triangle] as usize];
            let form = parts.form.at(center.as_vec3(), normal.as_vec3());
            let mut densest = [0.0f32; LAYERS];
            for rule in self.regions.on_triangle(mesh, triangle) {
                let moments = &self.layers[usize::from(rule)];
                for (kind, densest) in
                    densest.iter_mut().enumerate().filter(|(kind, _)| !self.left_out[*kind])
                {
                    let fit = fit_of(LayerKind::ALL[kind], self.fits[usize::from(rule)]);
                    for [length_px, width_px, coverage] in moments.iter().map(|layers| layers[kind]) {
                        let [length, width] = cap.fitted([length_px, width_px], form, fit);
                        let wanted = coverage * wanted_where_small(LayerKind::ALL[kind], width / width_px);
                        *densest = densest.max(wanted / (length * width));
                    }
                }
            }
            std::array::from_fn(|kind| densest[kind] * most_wanted(LayerKind::ALL[kind]))
        }
    }
}

/// Whether particles of a body may be left out where no view needs them. They may only if a stroke's size and presence
/// follow from its ordinal, the view and, where its size follows that of the surface, the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Unneeded {
    /// They may not.
    None,
    /// They may; the body stays at rest.
    AtRest,
    /// They may; the body bends, or noise moves its vertices.
    OfMoving {
        /// How far noise moves a vertex at most, model units.
        noise: f64,
    },
}

impl Unneeded {
    fn of(context: &Context<'_>, object: ObjectInputs<'_>, surface: &BodySurface) -> Self {
        let follows = |rule: &u16| context.rules[usize::from(*rule)].strokes.size_follow > 0.0;
        let follow = object.used.iter().any(follows);
        let has_several_references = follow && following(context, object).is_none();
        if context.solver != Solver::Tangent || context.paper || has_several_references {
            return Self::None;
        }
        let mut shapes = context.shapes.iter().map(|shapes| &shapes[object.index]);
        let noise = shapes.clone().find_map(|shape| shape.noise.as_ref());
        if !surface.bends() && noise.is_none() && shapes.all(|shape| surface.is_at_rest(shape)) {
            return Self::AtRest;
        }
        // How far strokes grow with a surface that bends is not known. And the key of a kept painting has the positions
        // of a point cache at a few frames only, not in every view.
        if follow || surface.has_cache() {
            return Self::None;
        }
        // Noise moves a vertex by at most `reach` along each of three axes.
        Self::OfMoving { noise: noise.map_or(0.0, |noise| 3.0f64.sqrt() * f64::from(noise.noise.reach())) }
    }
}

/// How the strokes on an object at rest follow its size. `None` if none do, or if those that do have several
/// references.
pub(crate) fn following(context: &Context<'_>, object: ObjectInputs<'_>) -> Option<Following> {
    let follow = |rule: u16| f64::from(context.rules[usize::from(rule)].strokes.size_follow);
    let mut following = object.used.iter().copied().filter(|&rule| follow(rule) > 0.0);
    let reference = |rule: u16| {
        let reference = object.references.of_rule(usize::from(rule));
        (reference.map, reference.near)
    };
    let (map, near) = reference(following.next()?);
    let all = || object.used.iter().copied().map(follow);
    let range = [all().fold(f64::INFINITY, f64::min), all().fold(0.0, f64::max)];
    following.all(|rule| reference(rule) == (map, near)).then(|| Following::new(map, near, range))
}

/// How many particles the coats of an object need.
#[derive(Clone, Debug, Default)]
pub(crate) struct Counted {
    /// The counts if the particles lie on the whole surface.
    pub(crate) counts: [usize; LAYERS],
    /// Whether it may pay to make the particles only where they are needed.
    pub(crate) may_depend_on_views: [bool; LAYERS],
    /// The factor, at least 1, by which painted amounts raise the counts.
    pub(crate) more_wanted: f64,
    /// See [`Found::deepness`].
    pub(crate) deepness: f64,
}

/// How many particles a coat is to have, and where.
#[derive(Clone, Debug, Default)]
pub(crate) struct CoatCount {
    /// How many it has, or would have on its whole surface.
    pub(crate) count_on_whole: usize,
    /// Where they are needed; `None` everywhere.
    pub(crate) needed: Option<Arc<Needed>>,
    /// How many particles are made, roughly.
    pub(crate) made: usize,
}

/// How many particles the coats of an object are to have, in the order of [`LayerKind::ALL`].
#[derive(Clone, Debug, Default)]
pub(crate) struct BodyCounts {
    pub(crate) counted: Counted,
    pub(crate) of_coats: [CoatCount; LAYERS],
}

impl BodyCounts {
    /// How many particles are made, roughly.
    pub(crate) fn made(&self) -> usize {
        self.of_coats.iter().map(|count| count.made).sum()
    }
}

impl CoatCount {
    /// This many particles, everywhere on the surface.
    pub(crate) fn everywhere(count: usize) -> Self {
        Self { count_on_whole: count, needed: None, made: count }
    }
}

/// The greatest factor on a layer's coverage: the body layer has more strokes where colours are light. The resolve
/// shader has the same number as `MOST_FULL`.
pub(crate) fn most_wanted(kind: LayerKind) -> f32 {
    if kind == LayerKind::Body { 1.35 } else { 1.0 }
}

fn sightings(context: &Context<'_>, object: usize) -> Vec<Sighting> {
    let of_view = |((view, poses), shapes): (&(PictureView, Vec<DAffine3>), &Vec<BodyShape>)| Sighting {
        // Noise changes the area little.
        shape: BodyShape { noise: None, ..shapes[object].clone() },
        ..Sighting::of(view, poses[object])
    };
    context.views.iter().zip(context.shapes).map(of_view).collect()
}
