//! How many particles each coat of an object has: as many as its views need, unless the object states the body layer's
//! count.

use std::sync::Arc;

use glam::DVec2;
use impasto_core::sampling::Surface;
use impasto_scene::presets::LayerKind;

use crate::body::BodySurface;
use crate::body_shape::BodyShape;
use crate::context::{Context, ObjectInputs};
use crate::particle_count::{self, Sighting};
use crate::parts::{BodyParts, Cap, fit_of, wanted_where_small};
use crate::regions::BodyRegions;

const LAYERS: usize = LayerKind::ALL.len();

/// All that the counts of an object's coats depend on.
pub(crate) struct CountInputs {
    surface: Arc<BodySurface>,
    regions: Arc<BodyRegions>,
    caps: Vec<Cap>,
    sightings: Vec<Sighting>,
    /// For each rule, at each moment of its keys: the length, the width and the coverage of each layer.
    layers: Vec<Vec<[[f32; 3]; LAYERS]>>,
    /// For each rule how far strokes fit the form.
    fits: Vec<f32>,
    left_out: [bool; LAYERS],
    /// The least count of a layer: see [`particle_count::least`].
    least: u32,
    /// The body layer's count, where the object states it.
    stated: Option<u64>,
    /// The factor, at least 1, by which painted amounts raise the counts.
    more_wanted: f32,
    paper: bool,
}

impl PartialEq for CountInputs {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.surface, &other.surface)
            && (self.left_out, self.least) == (other.left_out, other.least)
            && (self.stated, self.more_wanted, self.paper) == (other.stated, other.more_wanted, other.paper)
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
        let left_out = LayerKind::ALL.map(|kind| {
            kind == LayerKind::Underpainting && !context.underpainting
                || context.paper && kind != LayerKind::Body
                || has_no_paint(kind)
        });
        Self {
            surface,
            regions: Arc::clone(object.regions),
            caps: object.caps.to_vec(),
            sightings: sightings(context, object.index),
            layers,
            fits: context.rules.iter().map(|rule| rule.strokes.fit).collect(),
            left_out,
            least: particle_count::least(context.scene.objects.len()),
            stated: context.scene.objects[object.index].particles,
            more_wanted: object.amounts.more_wanted(),
            paper: context.paper,
        }
    }

    /// The counts, in the order of [`LayerKind::ALL`].
    pub(crate) fn counts(&self, surface: &Surface<'_>, parts: &BodyParts) -> [usize; LAYERS] {
        let body = &self.surface;
        let positions_at = |shape: &BodyShape| (!body.is_at_rest(shape)).then(|| body.positions_at(shape));
        let found: [usize; LAYERS] = particle_count::find(
            surface,
            &self.sightings,
            self.least,
            positions_at,
            |triangle, center, normal| {
                let cap = self.caps[parts.of_triangle[triangle] as usize];
                let form = parts.form.at(center.as_vec3(), normal.as_vec3());
                let mut densest = [0.0f32; LAYERS];
                for rule in self.regions.on_triangle(surface.mesh(), triangle) {
                    let moments = &self.layers[usize::from(rule)];
                    for (kind, densest) in
                        densest.iter_mut().enumerate().filter(|(kind, _)| !self.left_out[*kind])
                    {
                        let fit = fit_of(LayerKind::ALL[kind], self.fits[usize::from(rule)]);
                        for [length_px, width_px, coverage] in moments.iter().map(|layers| layers[kind]) {
                            let [length, width] = cap.fitted([length_px, width_px], form, fit);
                            let wanted =
                                coverage * wanted_where_small(LayerKind::ALL[kind], width / width_px);
                            *densest = densest.max(wanted / (length * width));
                        }
                    }
                }
                std::array::from_fn(|kind| densest[kind] * most_wanted(LayerKind::ALL[kind]))
            },
        );
        std::array::from_fn(|kind| match self.stated {
            Some(stated) if kind == LayerKind::Body as usize => stated as usize,
            _ if self.left_out[kind] => 0,
            // By the source paper's rule, a polygon without a particle would stay bare, so each polygon gets at least
            // one.
            _ if self.paper => found[kind].max(surface.faces().count()),
            _ if LayerKind::ALL[kind] != LayerKind::Underpainting => {
                particle_count::times(found[kind], self.more_wanted)
            }
            _ => found[kind],
        })
    }
}

/// The greatest factor on a layer's coverage: the body layer has more strokes where colours are light. The resolve
/// shader has the same number as `MOST_FULL`.
pub(crate) fn most_wanted(kind: LayerKind) -> f32 {
    if kind == LayerKind::Body { 1.35 } else { 1.0 }
}

fn sightings(context: &Context<'_>, object: usize) -> Vec<Sighting> {
    let half_size_px = DVec2::new(f64::from(context.scene.size.0), f64::from(context.scene.size.1)) * 0.5;
    context
        .views
        .iter()
        .zip(context.shapes)
        .map(|((view, poses), shapes)| Sighting {
            map: view.screen_map(poses[object]),
            half_size_px,
            near: view.near(),
            // Noise changes the area little.
            shape: BodyShape { noise: None, ..shapes[object].clone() },
        })
        .collect()
}
