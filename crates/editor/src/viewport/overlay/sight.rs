//! Tests by rays whether points of surfaces are visible.

use glam::{DAffine3, DVec3};
use impasto_editor_model::picking::{Picker, View};

/// A point that is this share of its distance behind the surface that its ray meets still counts as visible.
const LEEWAY: f64 = 2e-3;

/// Tests whether points of surfaces are visible, by one ray each: for the few points of guides and marks.
#[derive(Clone, Copy)]
pub struct Sight<'a> {
    /// The surfaces.
    pub picker: &'a Picker,
    /// `world_from_model` of each object.
    pub poses: &'a [DAffine3],
    /// Which objects can hide points.
    pub visible: &'a dyn Fn(usize) -> bool,
    /// The view to look from.
    pub view: &'a View,
}

impl Sight<'_> {
    /// Whether a point faces the eye and nothing is in front of it. The normal is in world space; zero faces every eye.
    pub fn sees(&self, position_in_world: DVec3, normal_in_world: DVec3) -> bool {
        let Some(at_px) = self.view.project(position_in_world) else { return false };
        let ray = self.view.ray(at_px);
        if normal_in_world.dot(ray.direction) > 0.0 {
            return false;
        }
        let distance = (position_in_world - ray.origin).dot(ray.direction);
        let hit = self.picker.pick(&ray, self.poses, self.visible);
        hit.is_none_or(|hit| hit.distance >= distance * (1.0 - LEEWAY))
    }
}
