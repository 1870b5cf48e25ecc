//! Replaces a scene's shot by a whole turn of the camera.

use impasto_scene::document::{CameraKey, Ease, ObjectKey, Reference};
use impasto_scene::limits;
use impasto_scene::loaded::LoadedScene;
use impasto_scene::motion;

use crate::cameras;
use crate::versions::{leave_out, orbit_blockers};

/// The scene with its shot replaced by a whole turn of the reference camera about its target, one degree per frame,
/// from the reference's frame on. Objects keep their reference pose, and objects that would hide the target are left
/// out.
pub fn turntable(loaded: &LoadedScene) -> LoadedScene {
    let mut version = loaded.clone();
    let scene = &mut version.scene;
    let (camera, frame) = motion::referred_to(scene, &scene.reference);
    let poses = motion::poses_at(scene, frame);
    let morphs = motion::morphs_at(scene, frame);
    // The frame of a reference is a whole number.
    let first = frame as i64;
    scene.reference = Reference::Frame(first);
    (scene.timeline.first, scene.timeline.last) = (first, first + 360);
    scene.camera.lens = camera.lens.clone();
    scene.camera.keys = (0..=360u32)
        .map(|degree| CameraKey {
            frame: frame + f64::from(degree),
            eye: cameras::orbited(&camera, f64::from(degree)).eye.to_array(),
            target: camera.target.to_array(),
            roll_deg: camera.roll_rad.to_degrees(),
            fov_y_deg: None,
            ease: Ease::default(),
        })
        .collect();
    let bends: Vec<bool> = scene.objects.iter().map(|object| motion::bends(scene, object)).collect();
    for ((object, bends), (pose, morph)) in scene.objects.iter_mut().zip(bends).zip(poses.iter().zip(morphs))
    {
        object.parent = None;
        // A body that bends keeps its shape of the first frame, because `hold` counts frames from there.
        object.hold = if bends { limits::MAX_HOLD } else { 1 };
        object.keys = vec![ObjectKey { morph, ..motion::key_of_pose(*pose, frame) }];
    }
    let blockers = orbit_blockers(&version);
    leave_out(&mut version, &blockers);
    version
}
