//! The axes of a new scene's camera.

use glam::DVec3;

/// The camera's axes in world space, unit vectors.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axes {
    pub right: DVec3,
    pub up: DVec3,
    /// From the target to the eye.
    pub back: DVec3,
}

impl Axes {
    pub fn looking_from(back: DVec3) -> Self {
        let back = back.normalize();
        let right = DVec3::Y.cross(back).normalize_or(DVec3::X);
        Self { right, up: back.cross(right), back }
    }

    /// World space to camera space, without translation.
    pub fn to_camera(self, vector: DVec3) -> DVec3 {
        DVec3::new(self.right.dot(vector), self.up.dot(vector), self.back.dot(vector))
    }

    /// Camera space to world space, without translation.
    pub fn to_world(self, vector: DVec3) -> DVec3 {
        self.right * vector.x + self.up * vector.y + self.back * vector.z
    }
}
