//! The lens of a shot's camera, as the lenses of scenes are stated.

use impasto_gltf::Lens as ShotLens;

use super::Shot;
use crate::document::Lens;

/// The depth that an infinite camera sees, over its nearest one.
const FARTHEST: f64 = 1e5;

/// The lens in a picture of this size: all that the camera's own picture shows is inside.
pub(super) fn lens_in(lens: ShotLens, (width, height): (u32, u32)) -> Lens {
    let aspect = f64::from(width.max(1)) / f64::from(height.max(1));
    match lens {
        ShotLens::Perspective { yfov_rad, aspect: own, znear, zfar } => {
            let half = (0.5 * yfov_rad).tan();
            let half = half.max(own.map_or(0.0, |own| half * own / aspect));
            let fov_y_deg = (2.0 * half.atan()).to_degrees().clamp(1.0, 170.0);
            Lens::Perspective { fov_y_deg, near: znear, far: zfar.unwrap_or(znear * FARTHEST) }
        }
        ShotLens::Orthographic { xmag, ymag, znear, zfar } => {
            Lens::Orthographic { height: 2.0 * ymag.max(xmag / aspect), near: znear, far: zfar }
        }
    }
}

impl Shot {
    /// Width over height of the camera's own picture, where it is stated.
    pub fn camera_aspect(&self) -> Option<f64> {
        let camera = self.file.gltf.nodes[self.camera?].camera?;
        match self.file.gltf.cameras[camera].lens {
            ShotLens::Perspective { aspect, .. } => aspect,
            ShotLens::Orthographic { xmag, ymag, .. } => Some(xmag / ymag),
        }
    }
}
