//! The ring that shows a brush on the surface, and the needle in it that shows a direction.

use glam::{DVec2, DVec3};

use super::Surroundings;
use crate::path::MirrorAxes;
use crate::picking::{Hit, world_units_per_model_unit};

const PIECES: usize = 48;

/// A brush as it lies on the surface, pixels of the viewport.
#[derive(Clone, Debug, PartialEq)]
pub struct Ring {
    /// The ring itself: a closed circle in the tangent plane.
    pub points_px: Vec<DVec2>,
    /// A closed circle where the smooth falloff is one half; empty while the pointer is on no surface.
    pub half_px: Vec<DVec2>,
    /// Its centre.
    pub at_px: DVec2,
    /// Whether it is drawn grey, because there is no surface under the pointer or at the mirrored place.
    pub hollow: bool,
    /// Whether it is a mirror image, drawn fainter.
    pub mirrored: bool,
}

/// The direction at the pointer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Needle {
    /// Its middle.
    pub at_px: DVec2,
    /// The direction in the viewport: unit, Y down.
    pub along: DVec2,
    /// Whether it has an arrow head, because the pointer moves or the needle shows which way strokes run.
    pub headed: bool,
}

/// The comb that a press at the pointer would begin. The strokes inside its ring are previewed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CombPreview {
    /// Index of the object under the ring.
    pub object: usize,
    /// Index of the region that the comb would stay inside of; none if it would make a new one.
    pub region: Option<usize>,
    /// The hit, in the object's own space.
    pub position_in_model: DVec3,
    /// Surface normal there, unit length.
    pub normal_in_model: DVec3,
    /// Radius of the ring, model units.
    pub radius: f64,
    /// The hit, pixels of the viewport.
    pub at_px: DVec2,
    /// The direction that strokes would take in the viewport: unit, Y down.
    pub along: DVec2,
}

impl Ring {
    /// The ring of the brush at a place of the picture, with its mirror images.
    pub(super) fn all_at(at_px: DVec2, around: &Surroundings) -> Vec<Self> {
        match around.hit(at_px) {
            Some(hit) => Self::all_on(&hit, around),
            None => vec![Self::hollow(at_px, around.options.radius_px)],
        }
    }

    pub(super) fn all_on(hit: &Hit, around: &Surroundings) -> Vec<Self> {
        let mut rings = Self::mirrored(hit, around.options.radius_px, around);
        rings.push(Self::on(hit, around.options.radius_px, around));
        rings
    }

    /// The ring of a pointer that is over no surface.
    pub(super) fn hollow(at_px: DVec2, radius_px: f64) -> Self {
        let points_px = (0..=PIECES).map(|piece| at_px + angle(piece) * radius_px).collect();
        Self { points_px, half_px: Vec::new(), at_px, hollow: true, mirrored: false }
    }

    /// A ring at a hit, with a radius of `radius_px` where the surface faces the eye.
    pub(super) fn on(hit: &Hit, radius_px: f64, around: &Surroundings) -> Self {
        let radius = radius_px / hit.px_per_model_unit(around.view, around.poses);
        Self::lying(hit.object, hit.position_in_model, hit.normal_in_model, radius, around)
    }

    fn lying(object: usize, position: DVec3, normal: DVec3, radius: f64, around: &Surroundings) -> Self {
        let (right, up) = normal.any_orthonormal_pair();
        let now = around.now_from_rest(object, position);
        let circle = |radius: f64| -> Vec<DVec2> {
            let at = |piece: usize| {
                let way = angle(piece);
                around.view.project(now.transform_point3(position + (right * way.x + up * way.y) * radius))
            };
            (0..=PIECES).filter_map(at).collect()
        };
        // Where the falloff (1 − (r/R)²)² is one half.
        let half = (1.0 - 0.5f64.sqrt()).sqrt();
        let at_px = around.view.project(now.transform_point3(position)).unwrap_or_default();
        let (points_px, half_px) = (circle(radius), circle(radius * half));
        Self { points_px, half_px, at_px, hollow: false, mirrored: false }
    }

    /// The mirror images of a ring at a hit, about the axes that are chosen in the options.
    pub(super) fn mirrored(hit: &Hit, radius_px: f64, around: &Surroundings) -> Vec<Self> {
        let [x, y, z] = around.options.mirror;
        let radius = radius_px / hit.px_per_model_unit(around.view, around.poses);
        let flips = MirrorAxes { x, y, z }.flips().into_iter();
        flips
            .map(|flip| {
                let (at, normal) = (hit.position_in_model * flip, hit.normal_in_model * flip);
                let found = around.picker.closest_on_surface(hit.object, at, normal, radius * 0.5);
                let (position, normal) = found.map_or((at, normal), |found| (found.position, found.normal));
                let ring = Self::lying(hit.object, position, normal, radius, around);
                Self { mirrored: true, hollow: found.is_none(), ..ring }
            })
            .collect()
    }
}

fn angle(piece: usize) -> DVec2 {
    DVec2::from_angle(std::f64::consts::TAU * piece as f64 / PIECES as f64)
}

pub(super) fn radius_in_model(hit: &Hit, radius_px: f64, around: &Surroundings) -> f64 {
    let scale = world_units_per_model_unit(around.pose(hit.object));
    radius_px / (around.view.px_per_unit(hit.position_in_world) * scale)
}
