//! Commands on keys of objects and camera, and on the timeline.

use impasto_scene::document::{CameraKey, Ease, ObjectKey, Scene};
use impasto_scene::motion::{self, CameraPose};

use super::{Done, finite, object_mut, unlocked_object};
use crate::refusal::Refusal;

/// The owner of keys.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum KeyOf {
    /// The shot camera's.
    Camera,
    /// An object's.
    Object(String),
}

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
    pub(super) fn edit(&self, scene: &mut Scene) -> Result<Done, Refusal> {
        match self {
            Self::SetKey(of, frame) => {
                let pose = match of {
                    KeyOf::Camera => Pose::Camera(motion::camera_at(scene, *frame)),
                    KeyOf::Object(name) => {
                        let object = object_mut(&mut scene.clone(), name)?.clone();
                        Pose::Object(name.clone(), motion::key_at(scene, &object, *frame))
                    }
                };
                put_key(scene, &pose, finite(*frame)?)?;
                Ok(Done::new(format!("Key {} at {frame}", of.name())))
            }
            Self::PoseAtFrame(pose, frame) => pose_at_frame(scene, pose, finite(*frame)?),
            Self::MoveKeys(keys, by) => {
                finite(*by)?;
                for (of, frame) in sorted(keys, *by < 0.0) {
                    move_key(scene, of, *frame, frame + by)?;
                }
                Ok(Done::new(format!("Move {}", counted(keys))))
            }
            Self::CopyKeys(keys, by) => {
                finite(*by)?;
                let before = scene.clone();
                for (of, frame) in keys {
                    copy_key(scene, &before, of, *frame, frame + by)?;
                }
                Ok(Done::new(format!("Copy {}", counted(keys))))
            }
            Self::DeleteKeys(keys) => {
                for (of, frame) in keys {
                    delete_key(scene, of, *frame)?;
                }
                Ok(Done::new(format!("Delete {}", counted(keys))))
            }
            Self::SetEase(keys, ease) => {
                for (of, frame) in keys {
                    match of {
                        KeyOf::Camera => {
                            scene
                                .camera
                                .keys
                                .iter_mut()
                                .filter(|key| key.frame == *frame)
                                .for_each(|key| key.ease = *ease);
                        }
                        KeyOf::Object(name) => {
                            let keys = &mut unlocked_object(scene, name)?.keys;
                            keys.iter_mut()
                                .filter(|key| key.frame == *frame)
                                .for_each(|key| key.ease = *ease);
                        }
                    }
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

impl KeyOf {
    /// What people call it.
    pub fn name(&self) -> &str {
        match self {
            Self::Camera => "shot",
            Self::Object(name) => name,
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

/// The keys in an order in which they can move one by one without landing on one that has yet to move.
fn sorted(keys: &[(KeyOf, f64)], ascending: bool) -> Vec<&(KeyOf, f64)> {
    let mut keys: Vec<_> = keys.iter().collect();
    keys.sort_by(|a, b| if ascending { a.1.total_cmp(&b.1) } else { b.1.total_cmp(&a.1) });
    keys
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
        let old = match pose {
            Pose::Camera(_) => Pose::Camera(motion::camera_at(scene, reference)),
            Pose::Object(name, _) => {
                let object = object_mut(&mut scene.clone(), name)?.clone();
                Pose::Object(name.clone(), motion::key_at(scene, &object, reference))
            }
        };
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

fn move_key(scene: &mut Scene, of: &KeyOf, from: f64, to: f64) -> Result<(), Refusal> {
    match of {
        KeyOf::Camera => {
            let keys = &mut scene.camera.keys;
            let Some(index) = keys.iter().position(|key| key.frame == from) else { return Ok(()) };
            let key = CameraKey { frame: to, ..keys.remove(index) };
            keys.retain(|other| other.frame != to);
            keys.insert(keys.partition_point(|other| other.frame < to), key);
        }
        KeyOf::Object(name) => {
            let keys = &mut unlocked_object(scene, name)?.keys;
            let Some(index) = keys.iter().position(|key| key.frame == from) else { return Ok(()) };
            let key = ObjectKey { frame: to, ..keys.remove(index) };
            keys.retain(|other| other.frame != to);
            keys.insert(keys.partition_point(|other| other.frame < to), key);
        }
    }
    Ok(())
}

/// Copies a key of `before`, the scene as it was before the command copied any key.
fn copy_key(scene: &mut Scene, before: &Scene, of: &KeyOf, from: f64, to: f64) -> Result<(), Refusal> {
    match of {
        KeyOf::Camera => {
            let Some(key) = before.camera.keys.iter().find(|key| key.frame == from) else { return Ok(()) };
            let keys = &mut scene.camera.keys;
            keys.retain(|other| other.frame != to);
            let at = keys.partition_point(|other| other.frame < to);
            keys.insert(at, CameraKey { frame: to, ..key.clone() });
        }
        KeyOf::Object(name) => {
            let keys = &mut unlocked_object(scene, name)?.keys;
            let object = before.objects.iter().find(|object| object.name == *name);
            let key = object.and_then(|object| object.keys.iter().find(|key| key.frame == from));
            let Some(key) = key else { return Ok(()) };
            keys.retain(|other| other.frame != to);
            let at = keys.partition_point(|other| other.frame < to);
            keys.insert(at, ObjectKey { frame: to, ..key.clone() });
        }
    }
    Ok(())
}

fn delete_key(scene: &mut Scene, of: &KeyOf, frame: f64) -> Result<(), Refusal> {
    match of {
        KeyOf::Camera => {
            let keys = &mut scene.camera.keys;
            if keys.len() == 1 && keys[0].frame == frame {
                return Err(Refusal::new("The camera keeps its last key"));
            }
            keys.retain(|key| key.frame != frame);
        }
        KeyOf::Object(name) => unlocked_object(scene, name)?.keys.retain(|key| key.frame != frame),
    }
    Ok(())
}
