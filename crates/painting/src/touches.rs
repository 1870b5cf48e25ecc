//! Lays touches (strokes placed by hand) onto surfaces at rest: finds the places of a triangle mesh that each touch
//! runs through. From then on these places move with the mesh as particles do.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DVec3, Vec3};
use impasto_core::hash;
use impasto_core::nearest::nearest_point;
use impasto_core::sampling::{PackedParticle, Particle};
use impasto_core::shells::Side;
use impasto_core::smooth_path::smooth_path;
use impasto_scene::document::{Scene, Touch, TouchPoint};
use impasto_scene::presets::LayerKind;
use rayon::prelude::*;

use crate::body::BodySurface;
use crate::brushes;
use crate::coat::Coat;
use crate::frame::Brushes;
use crate::lights::linear;
use crate::regions::{BodyRegions, RegionRule};

/// Steps of a touch between two of its points, and the least and most steps of a whole touch.
const STEPS_BETWEEN: usize = 8;
const STEPS: std::ops::RangeInclusive<usize> = 24..=192;

/// How often corners of a line are rounded.
const ROUNDINGS: usize = 6;

/// A touch at a single place lies along the mean of this many strokes round it, since single strokes stray.
const ROUND: usize = 7;

pub(crate) struct TouchInputs<'a> {
    pub(crate) rules: &'a [RegionRule],
    /// Surface and regions of each object.
    pub(crate) bodies: &'a [(&'a Arc<BodySurface>, &'a BodyRegions)],
    pub(crate) coats: &'a [Arc<Coat>],
    pub(crate) brushes: &'a Brushes,
}

/// A touch on its surface.
#[derive(Clone, Debug)]
pub(crate) struct LaidTouch {
    /// Index in the scene's list of touches.
    pub(crate) number: u32,
    /// Index of the object.
    pub(crate) object: usize,
    /// The rule where its middle lies.
    pub(crate) rule: u16,
    /// The places that it runs through. If there is only one, the strokes round that place give its direction.
    pub(crate) places: Arc<Vec<TouchPlace>>,
    /// If it has a single place: the particles of the body layer nearest to that place; else empty.
    pub(crate) round: Vec<u32>,
    /// Random bits, the same in every frame.
    pub(crate) bits: u32,
    /// Index of its mark; bit 16 flips it.
    pub(crate) mark: u32,
    /// The touch's own colour if it has one, else the albedo of the surface in its middle; packed as in a stroke.
    pub(crate) albedo_srgb8: u32,
}

impl LaidTouch {
    /// The triangle in its middle.
    pub(crate) fn triangle(&self) -> usize {
        self.places[self.places.len() / 2].place.triangle()
    }
}

/// A place that a touch runs through, at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TouchPlace {
    pub(crate) place: PackedParticle,
    /// Model space.
    pub(crate) position: DVec3,
    /// Unit, model space.
    pub(crate) normal: DVec3,
}

/// Remembers where touches lie, because finding their places on a large mesh takes longer than all other work on them.
#[derive(Default)]
pub(crate) struct TouchMemo(HashMap<String, Remembered>);

struct Remembered {
    points: Vec<TouchPoint>,
    surface: Arc<BodySurface>,
    places: Arc<Vec<TouchPlace>>,
}

impl TouchMemo {
    /// All touches of a scene that are not hidden and whose object has a surface.
    pub(crate) fn lay(&mut self, scene: &Scene, inputs: &TouchInputs<'_>) -> Arc<Vec<LaidTouch>> {
        let objects: HashMap<&str, usize> =
            scene.objects.iter().enumerate().map(|(index, object)| (object.name.as_str(), index)).collect();
        let known = std::mem::take(&mut self.0);
        let placed: Vec<_> = scene
            .touches
            .par_iter()
            .enumerate()
            .filter_map(|(number, touch)| {
                let object = *objects.get(touch.on.as_str())?;
                let surface = inputs.bodies[object].0;
                let same = |known: &&Remembered| {
                    known.points == touch.points && Arc::ptr_eq(&known.surface, surface)
                };
                let places = known.get(&touch.name).filter(same).map(|known| Arc::clone(&known.places));
                let places = places.unwrap_or_else(|| Arc::new(places_of(&touch.points, surface)));
                let remembered =
                    Remembered { points: touch.points.clone(), surface: Arc::clone(surface), places };
                Some((number, object, touch, remembered))
            })
            .collect();
        let laid = placed
            .iter()
            .filter(|(_, _, touch, remembered)| !touch.hidden && !remembered.places.is_empty())
            .map(|(number, object, touch, remembered)| {
                inputs.laid(scene, (*number, touch), *object, Arc::clone(&remembered.places))
            });
        let laid = Arc::new(laid.collect());
        self.0 = placed.into_iter().map(|(_, _, touch, kept)| (touch.name.clone(), kept)).collect();
        laid
    }
}

impl TouchInputs<'_> {
    fn laid(
        &self,
        scene: &Scene,
        (number, touch): (usize, &Touch),
        object: usize,
        places: Arc<Vec<TouchPlace>>,
    ) -> LaidTouch {
        let (surface, regions) = self.bodies[object];
        let middle = places[places.len() / 2].place.on(&surface.mesh);
        let rule = regions.of(&middle);
        let of_object = hash::combine(scene.seed, hash::of_name(&touch.on));
        let bits = hash::combine(of_object, hash::of_name(&touch.name));
        let names = match &touch.brush {
            Some(name) => std::slice::from_ref(name),
            None => &self.rules[usize::from(rule)].strokes.body().brushes[..],
        };
        let first_mark = |name: &String| self.brushes.names.iter().position(|known| known == name);
        let first_marks: Vec<u32> = names
            .iter()
            .map(|name| first_mark(name).unwrap_or(0) as u32 * impasto_core::brush::VARIANTS)
            .collect();
        let round = if places.len() == 1 { self.round(object, &places[0]) } else { Vec::new() };
        let own = touch.color.map(|color| {
            let [r, g, b] = linear(color)
                .map(|channel| (impasto_core::color::srgb_from_linear(channel) * 255.0).round() as u32);
            u32::from(crate::frame::Stroke::AS_IT_IS) << 24 | b << 16 | g << 8 | r
        });
        LaidTouch {
            number: number as u32,
            object,
            rule,
            places,
            round,
            bits,
            mark: brushes::mark(&first_marks, bits & 1023, bits),
            albedo_srgb8: own.unwrap_or_else(|| surface.albedo_srgb8(&middle)),
        }
    }

    /// The particles of an object's body layer that are nearest to a place and face about the same way.
    fn round(&self, object: usize, place: &TouchPlace) -> Vec<u32> {
        let is_body = |coat: &&Arc<Coat>| coat.object == object && coat.kind == LayerKind::Body;
        let Some(coat) = self.coats.iter().find(is_body) else { return Vec::new() };
        let placed = &coat.baked.placed;
        let mut near: Vec<(f64, u32)> = (0..placed.len())
            .filter(|&index| placed.normal_of(index).dot(place.normal) > 0.5)
            .map(|index| (placed.position_of(index).distance_squared(place.position), index as u32))
            .collect();
        let order = |a: &(f64, u32), b: &(f64, u32)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        if near.len() > ROUND {
            near.select_nth_unstable_by(ROUND, order);
            near.truncate(ROUND);
        }
        near.sort_unstable_by(order);
        near.into_iter().map(|(_, index)| index).collect()
    }
}

/// The places of a surface that a touch through these points runs through. A single point gives a single place.
fn places_of(points: &[TouchPoint], surface: &BodySurface) -> Vec<TouchPlace> {
    let given: Vec<(DVec3, DVec3)> = points
        .iter()
        .map(|point| (DVec3::from(point.at), DVec3::from(point.normal)))
        .filter(|(at, normal)| at.is_finite() && normal.is_finite())
        .collect();
    let positions: Vec<DVec3> = given.iter().map(|(at, _)| *at).collect();
    let Some(near) = Near::of(surface, &positions) else { return Vec::new() };
    // The mesh may have changed since the points were set, so the points are first moved onto it.
    let given: Vec<(DVec3, DVec3)> = given
        .into_iter()
        .filter_map(|(at, normal)| near.place(at, normal).map(|place| (place.position, normal)))
        .collect();
    let positions: Vec<DVec3> = given.iter().map(|(at, _)| *at).collect();
    let steps = (STEPS_BETWEEN * given.len().saturating_sub(1)).clamp(*STEPS.start(), *STEPS.end());
    let path = smooth_path(&positions, steps);
    if path.is_empty() {
        return given.first().and_then(|&(at, normal)| near.place(at, normal)).into_iter().collect();
    }
    // The normal to look for at a place is the mean of the points' normals, weighted by the inverse square of their
    // distance.
    let onto = |path: &[DVec3]| -> Vec<TouchPlace> {
        let place = |&at: &DVec3| {
            let weight = |&(point, normal): &(DVec3, DVec3)| {
                normal.normalize_or_zero() / (at.distance_squared(point) + 1e-12)
            };
            near.place(at, given.iter().map(weight).sum())
        };
        path.iter().filter_map(place).collect()
    };
    // Faces of a coarse mesh would show as corners of the line.
    let mut path: Vec<DVec3> = onto(&path).iter().map(|place| place.position).collect();
    for _ in 0..ROUNDINGS {
        path = rounded(&path);
    }
    onto(&path)
}

/// Moves each point of a line, except its ends, half-way to the middle of its neighbours.
fn rounded(path: &[DVec3]) -> Vec<DVec3> {
    let mut rounded = path.to_vec();
    for (index, three) in path.windows(3).enumerate() {
        rounded[index + 1] = 0.25 * three[0] + 0.5 * three[1] + 0.25 * three[2];
    }
    rounded
}

/// The triangles round a touch.
struct Near<'a> {
    surface: &'a BodySurface,
    triangles: Vec<u32>,
}

impl<'a> Near<'a> {
    /// `None` for a surface without triangles, or no points.
    fn of(surface: &'a BodySurface, points: &[DVec3]) -> Option<Self> {
        let mesh = &surface.mesh;
        let (low, high) = mesh.bounds()?;
        let first = points.first()?;
        let (least, most) = points.iter().fold((*first, *first), |(a, b), at| (a.min(*at), b.max(*at)));
        // A line on a round surface bulges out of the box of its points.
        let room = DVec3::splat(0.5 * most.distance(least) + 0.03 * f64::from(high.distance(low)));
        let (least, most) = ((least - room).as_vec3(), (most + room).as_vec3());
        let meets = |&triangle: &u32| {
            let [a, b, c] = mesh.corners(triangle as usize);
            a.min(b).min(c).cmple(most).all() && a.max(b).max(c).cmpge(least).all()
        };
        let all = 0..mesh.triangles.len() as u32;
        let mut triangles: Vec<u32> = all.clone().filter(meets).collect();
        if triangles.is_empty() {
            triangles = all.collect();
        }
        Some(Self { surface, triangles })
    }

    /// The nearest place to `at` that faces about the same way as `normal`. If none does, the nearest place of all.
    fn place(&self, at: DVec3, normal: DVec3) -> Option<TouchPlace> {
        let mesh = &self.surface.mesh;
        let normal = normal.normalize_or_zero();
        let mut best: Option<(bool, f64, u32, bool, DVec3)> = None;
        for &triangle in &self.triangles {
            let corners = mesh.corners(triangle as usize).map(Vec3::as_dvec3);
            let across = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
            let flipped = match self.surface.sides[triangle as usize] {
                Side::Front => false,
                Side::Back => true,
                Side::Both => across.dot(normal) < 0.0,
            };
            let turned_away = if flipped { -across } else { across }.dot(normal) <= 0.0;
            let nearest = nearest_point(at, corners);
            let away = nearest.distance_squared(at);
            let is_better =
                best.as_ref().is_none_or(|best| (turned_away, away) < (best.0, best.1)) && away.is_finite();
            if is_better {
                best = Some((turned_away, away, triangle, flipped, nearest));
            }
        }
        let (_, _, triangle, flipped, nearest) = best?;
        let particle = Particle {
            triangle,
            barycentric: barycentric(nearest, mesh.corners(triangle as usize).map(Vec3::as_dvec3)),
            flipped,
            position: nearest.as_vec3(),
            normal: Vec3::Y,
        }
        .on(mesh, &mesh.positions, &mesh.normals);
        Some(TouchPlace {
            place: PackedParticle::of(&particle),
            position: particle.position.as_dvec3(),
            normal: particle.normal.as_dvec3(),
        })
    }
}

/// Weights of the second and third corner of a triangle at a point on it (Ericson, Real-Time Collision Detection, 3.4).
fn barycentric(at: DVec3, [a, b, c]: [DVec3; 3]) -> [f32; 2] {
    let (v0, v1, v2) = (b - a, c - a, at - a);
    let (d00, d01, d11) = (v0.dot(v0), v0.dot(v1), v1.dot(v1));
    let (d20, d21) = (v2.dot(v0), v2.dot(v1));
    let area = d00 * d11 - d01 * d01;
    let v = (d11 * d20 - d01 * d21) / area;
    let w = (d00 * d21 - d01 * d20) / area;
    if v.is_finite() && w.is_finite() {
        let v = v.clamp(0.0, 1.0);
        [v as f32, w.clamp(0.0, 1.0 - v) as f32]
    } else {
        [0.0; 2]
    }
}
