//! The camera of a shot at a frame, as the poses of a scene's camera are stated.

use glam::{DMat4, DVec3};
use impasto_gltf::{Lens as ShotLens, Posed};

use super::Shot;
use crate::document::Lens;
use crate::motion::CameraPose;

/// The depth that an infinite camera sees, over its nearest one.
const FARTHEST: f64 = 1e5;

impl Shot {
    /// The camera that is looked through, in a picture of this size; `None` where the shot has none. What the camera's own picture
    /// shows is all inside: a picture of another aspect shows more at two sides.
    pub(crate) fn camera_pose(&self, posed: &Posed, (width, height): (u32, u32)) -> Option<CameraPose> {
        let node = self.camera?;
        let camera = self.file.gltf.nodes[node].camera?;
        let aspect = f64::from(width.max(1)) / f64::from(height.max(1));
        let lens = match posed.lenses[camera] {
            ShotLens::Perspective { yfov_rad, aspect: own, znear, zfar } => {
                let half = (0.5 * yfov_rad).tan();
                let half = half.max(own.map_or(0.0, |own| half * own / aspect));
                let fov_y_deg = (2.0 * half.atan()).to_degrees().clamp(1.0, 170.0);
                Lens::Perspective { fov_y_deg, near: znear, far: zfar.unwrap_or(znear * FARTHEST) }
            }
            ShotLens::Orthographic { xmag, ymag, znear, zfar } => {
                Lens::Orthographic { height: 2.0 * ymag.max(xmag / aspect), near: znear, far: zfar }
            }
        };
        Some(pose(posed.world_from_view(node), lens))
    }

    /// Width over height of the camera's own picture, where it is stated.
    pub fn camera_aspect(&self) -> Option<f64> {
        let camera = self.file.gltf.nodes[self.camera?].camera?;
        match self.file.gltf.cameras[camera].lens {
            ShotLens::Perspective { aspect, .. } => aspect,
            ShotLens::Orthographic { xmag, ymag, .. } => Some(xmag / ymag),
        }
    }
}

/// Eye, target and roll of a camera matrix.
fn pose(world_from_view: DMat4, lens: Lens) -> CameraPose {
    let eye = world_from_view.w_axis.truncate();
    let [up, back] = [world_from_view.y_axis, world_from_view.z_axis].map(|axis| axis.truncate());
    let unrolled = CameraPose { eye, target: eye - back, roll_rad: 0.0, lens };
    let up_unrolled: DVec3 = unrolled.view_from_world().transform_vector3(up);
    // Where the camera's up shows in a view without roll: straight up is no roll, to the left is one counter-clockwise.
    CameraPose { roll_rad: (-up_unrolled.x).atan2(up_unrolled.y), ..unrolled }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    #[test]
    fn any_turn_of_a_camera_is_kept() {
        for (axis, angle_deg) in [
            (DVec3::Y, 7.0f64),
            (DVec3::Z, 30.0),
            (DVec3::new(1.0, 2.0, 3.0), 137.0),
            (DVec3::X, -90.0),
            (DVec3::new(1.0, 0.0, 1.0), 179.0),
        ] {
            let turn = DQuat::from_axis_angle(axis.normalize(), angle_deg.to_radians());
            let world_from_view = DMat4::from_rotation_translation(turn, DVec3::new(1.0, -2.0, 0.5));
            let pose = pose(world_from_view, Lens::default());
            let again = pose.view_from_world() * world_from_view;
            assert!(again.abs_diff_eq(DMat4::IDENTITY, 1e-9), "{axis} {angle_deg}: {again}");
        }
    }
}
