//! Replaces a scene's shot by a whole turn of the camera.

use impasto_scene::document::{CameraKey, Ease, ObjectKey, Reference};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::motion;

use crate::cameras;
use crate::versions::{leave_out, orbit_blockers};

/// The scene with its shot replaced by a whole turn of the camera about its target in the reference frame, one degree per frame.
/// Objects keep their reference pose, and objects that would hide the target are left out.
pub fn turntable(loaded: &LoadedScene) -> LoadedScene {
    let mut version = loaded.clone();
    let scene = &mut version.scene;
    let (camera, frame) = motion::referred_to(scene, &scene.reference);
    let poses = motion::poses_at(scene, frame);
    let morphs = motion::morphs_at(scene, frame);
    scene.reference = Reference::Frame(0);
    (scene.timeline.first, scene.timeline.last) = (0, 360);
    scene.camera.lens = camera.lens.clone();
    scene.camera.keys = (0..=360u32)
        .map(|degree| CameraKey {
            frame: f64::from(degree),
            eye: cameras::orbited(&camera, f64::from(degree)).eye.to_array(),
            target: camera.target.to_array(),
            roll_deg: camera.roll_rad.to_degrees(),
            fov_y_deg: None,
            ease: Ease::default(),
        })
        .collect();
    for (object, (pose, morph)) in scene.objects.iter_mut().zip(poses.iter().zip(morphs)) {
        object.parent = None;
        object.hold = 1;
        object.keys = vec![ObjectKey {
            translation: pose.translation.to_array(),
            rotation_deg: euler_deg(pose.matrix3 / pose.matrix3.x_axis.length()),
            scale: pose.matrix3.x_axis.length(),
            morph,
            ..ObjectKey::at(0.0)
        }];
    }
    let blockers = orbit_blockers(&version);
    leave_out(&mut version, &blockers);
    version
}

/// Euler angles of R = Rz·Ry·Rx.
fn euler_deg(rotation: glam::DMat3) -> [f64; 3] {
    let (x, y, z) = (rotation.x_axis, rotation.y_axis, rotation.z_axis);
    let about_y = (-x.z).clamp(-1.0, 1.0).asin();
    let (about_x, about_z) = if x.z.abs() < 1.0 - 1e-12 {
        (y.z.atan2(z.z), x.y.atan2(x.x))
    } else {
        // At ±90 degrees about Y only a combination of the other two is determined.
        (0.0, (-y.x).atan2(y.y))
    };
    [about_x, about_y, about_z].map(f64::to_degrees)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use impasto_scene::motion::rotation_from_euler_deg;

    #[test]
    fn euler_angles_come_back() {
        for angles in [[10.0, 20.0, 30.0], [-170.0, 80.0, 5.0], [0.0, 90.0, 40.0], [3.0, -90.0, 0.0]] {
            let rotation = rotation_from_euler_deg(DVec3::from(angles));
            let again = rotation_from_euler_deg(DVec3::from(euler_deg(rotation)));
            assert!((rotation - again).abs_diff_eq(glam::DMat3::ZERO, 1e-9), "{angles:?}");
        }
    }
}
