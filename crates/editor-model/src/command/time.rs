//! Commands on keys of objects and camera, and on the timeline.

use impasto_scene::document::{CameraKey, Ease, ObjectKey, Scene};
use impasto_scene::motion::{self, CameraPose};

use super::keys::{self, KeyOf, KeyedValue};
use super::{Done, finite, unlocked_object};
use crate::refusal::Refusal;

/// A pose to key.
#[derive(Clone, Debug, PartialEq)]
pub enum Pose {
    /// Of the camera.
    Camera(CameraPose),
    /// Of an object, in its parent's space; its frame and ease are not read.
    Object(String, ObjectKey),
}

/// Keys and the timeline.
#[derive(Clone, Debug, PartialEq)]
pub enum Time {
    /// Sets a key with the current pose at a frame.
    SetKey(KeyOf, f64),
    /// Sets a new pose at a frame. The first key at another frame than the reference also keys the old pose at the
    /// reference, so that there is a motion between the two.
    PoseAtFrame(Pose, f64),
    /// Sets the value of a light, the background or strokes at a frame.
    PutValue(KeyedValue, f64),
    /// Moves keys by this many frames; a key that lands on another replaces it.
    MoveKeys(Vec<(KeyOf, f64)>, f64),
    /// Copies keys by this many frames; a copy that lands on another key replaces it.
    CopyKeys(Vec<(KeyOf, f64)>, f64),
    /// Deletes keys. The camera keeps its last one.
    DeleteKeys(Vec<(KeyOf, f64)>),
    /// Sets the ease from each of these keys to the next key.
    SetEase(Vec<(KeyOf, f64)>, Ease),
    /// First and last frame.
    SetRange(i64, i64),
    /// Frames per second.
    SetFps(f64),
}

impl Time {
    pub(crate) fn edit(&self, scene: &mut Scene) -> Result<Done, Refusal> {
        match self {
            Self::SetKey(of, frame) => {
                let frame = finite(*frame)?;
                match KeyedValue::at(scene, of, frame)? {
                    Some(value) => value.put(scene, frame)?,
                    None => put_key(scene, &pose_at(scene, of, frame)?, frame)?,
                }
                Ok(Done::new(format!("Key {} at {frame}", of.name())))
            }
            Self::PoseAtFrame(pose, frame) => pose_at_frame(scene, pose, finite(*frame)?),
            Self::PutValue(value, frame) => {
                value.put(scene, finite(*frame)?)?;
                Ok(Done::new(format!("Key {} at {frame}", value.of().name())))
            }
            Self::MoveKeys(keys, by) => {
                shift(scene, keys, finite(*by)?, false)?;
                Ok(Done::new(format!("Move {}", counted(keys))))
            }
            Self::CopyKeys(keys, by) => {
                shift(scene, keys, finite(*by)?, true)?;
                Ok(Done::new(format!("Copy {}", counted(keys))))
            }
            Self::DeleteKeys(keys) => {
                for (of, frames) in keys::by_owner(keys) {
                    let list = keys::list(scene, of)?;
                    list.delete(&frames);
                    if *of == KeyOf::Camera && list.is_bare() {
                        return Err(Refusal::new("The camera keeps its last key"));
                    }
                }
                Ok(Done::new(format!("Delete {}", counted(keys))))
            }
            Self::SetEase(keys, ease) => {
                for (of, frames) in keys::by_owner(keys) {
                    keys::list(scene, of)?.set_ease(&frames, *ease);
                }
                Ok(Done::new(format!("Ease: {}", ease_name(*ease))))
            }
            Self::SetRange(first, last) => {
                (scene.timeline.first, scene.timeline.last) = (*first, *last);
                Ok(Done::new(format!("Range {first}–{last}")))
            }
            Self::SetFps(fps) => {
                scene.timeline.fps = finite(*fps)?;
                Ok(Done::new(format!("{fps} frames per second")))
            }
        }
    }
}

/// What people call an ease.
pub fn ease_name(ease: Ease) -> &'static str {
    match ease {
        Ease::Smooth => "smooth",
        Ease::Linear => "linear",
        Ease::Step => "hold",
    }
}

fn counted(keys: &[(KeyOf, f64)]) -> String {
    if keys.len() == 1 { "1 key".to_owned() } else { format!("{} keys", keys.len()) }
}

fn shift(scene: &mut Scene, keys: &[(KeyOf, f64)], by: f64, copies: bool) -> Result<(), Refusal> {
    for (of, frames) in keys::by_owner(keys) {
        keys::list(scene, of)?.shift(&frames, by, copies);
    }
    Ok(())
}

/// The pose of the camera or an object at a frame.
fn pose_at(scene: &Scene, of: &KeyOf, frame: f64) -> Result<Pose, Refusal> {
    let KeyOf::Object(name) = of else { return Ok(Pose::Camera(motion::camera_at(scene, frame))) };
    let object = scene.objects.iter().find(|object| object.name == *name);
    let object = object.ok_or_else(|| Refusal::unknown("object", name))?;
    Ok(Pose::Object(name.clone(), motion::key_at(scene, object, frame)))
}

fn pose_at_frame(scene: &mut Scene, pose: &Pose, frame: f64) -> Result<Done, Refusal> {
    let reference = motion::referred_to(scene, &scene.reference).1;
    let name = match pose {
        Pose::Camera(_) => "shot".to_owned(),
        Pose::Object(name, _) => name.clone(),
    };
    let only_at = |frames: Vec<f64>| frames.iter().all(|&other| other == frame);
    let is_alone = match pose {
        Pose::Camera(_) => only_at(scene.camera.keys.iter().map(|key| key.frame).collect()),
        Pose::Object(name, _) => {
            let object = unlocked_object(scene, name)?;
            only_at(object.keys.iter().map(|key| key.frame).collect())
        }
    };
    let mut done = Done::new(format!("Pose {name} at {frame}"));
    if is_alone && frame != reference {
        let of = match pose {
            Pose::Camera(_) => KeyOf::Camera,
            Pose::Object(name, _) => KeyOf::Object(name.clone()),
        };
        let old = pose_at(scene, &of, reference)?;
        put_key(scene, &old, reference)?;
        done = done.noting(format!("Also keyed frame {reference}, so that {name} moves from there"));
    }
    put_key(scene, pose, frame)?;
    Ok(done)
}

fn put_key(scene: &mut Scene, pose: &Pose, frame: f64) -> Result<(), Refusal> {
    match pose {
        Pose::Camera(pose) => {
            let keys = &mut scene.camera.keys;
            let at = keys.partition_point(|key| key.frame < frame);
            let old = keys.get(at).filter(|key| key.frame == frame).cloned();
            let ease = old.as_ref().map_or(Ease::Smooth, |old| old.ease);
            let [eye, target] = [pose.eye, pose.target].map(|at| at.to_array());
            let fov_y_deg = old.as_ref().and_then(|old| old.fov_y_deg);
            let roll_deg = pose.roll_rad.to_degrees();
            let key = CameraKey { frame, eye, target, roll_deg, fov_y_deg, ease };
            keys.splice(at..at + usize::from(old.is_some()), [key]);
        }
        Pose::Object(name, pose) => {
            let keys = &mut unlocked_object(scene, name)?.keys;
            let at = keys.partition_point(|key| key.frame < frame);
            let old = keys.get(at).filter(|key| key.frame == frame).cloned();
            let ease = old.as_ref().map_or(Ease::Smooth, |old| old.ease);
            keys.splice(at..at + usize::from(old.is_some()), [ObjectKey { frame, ease, ..pose.clone() }]);
        }
    }
    Ok(())
}
