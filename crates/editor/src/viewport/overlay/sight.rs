//! Tests by rays whether points of surfaces are visible, so that what lies behind a surface is not drawn over the
//! picture.

use glam::{DAffine3, DVec3};
use impasto_editor_model::picking::{Picker, View};

/// A point still counts as visible if a surface lies in front of it by at most this share of its distance.
const LEEWAY: f64 = 2e-3;

/// Tests whether points of surfaces are visible, by one ray for each point. Meant for few points, such as those of
/// guides.
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
    /// Whether a point faces the eye and nothing is in front of it. A zero normal counts as facing the eye.
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
