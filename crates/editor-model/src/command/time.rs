//! Commands on keys and on the timeline.

use impasto_scene::document::{CameraKey, Ease, Key, Lens, Object, ObjectKey, Scene};
use impasto_scene::motion::{self, CameraPose};

use super::keys::{self, KeyOf, KeyedValue};
use super::{Done, finite, moved_by_shot, posable_object, unlocked_object};
use crate::euler;
use crate::refusal::Refusal;

/// A pose to key.
#[derive(Clone, Debug, PartialEq)]
pub enum Pose {
    /// The camera's pose.
    Camera(CameraPose),
    /// An object's pose in its parent's space. The frame and the ease of the [`ObjectKey`] are not read.
    Object(String, ObjectKey),
}

/// Keys and the timeline.
#[derive(Clone, Debug, PartialEq)]
pub enum Time {
    /// Sets a key at a frame, with the pose or value that its owner has there.
    SetKey(KeyOf, f64),
    /// Gives keys of its own to the camera or an object, in place of the motion from the scene's shot. There is one key
    /// per frame, without those that lie on a straight line between their neighbours.
    OwnKeys(KeyOf),
    /// Sets a new pose at a frame. If there are no keys at other frames, the old pose is also keyed at the reference's
    /// frame, so that there is a motion between the two.
    PoseAtFrame(Pose, f64),
    /// Sets the value of a light, the background or strokes at a frame.
    PutValue(KeyedValue, f64),
    /// Moves keys by this many frames; a key that lands on another replaces it.
    MoveKeys(Vec<(KeyOf, f64)>, f64),
    /// Copies keys to places this many frames later; a copy that lands on another key replaces it.
    CopyKeys(Vec<(KeyOf, f64)>, f64),
    /// Deletes keys; refused if the camera would have none left.
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
            Self::OwnKeys(of) => own_keys(scene, of),
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

/// The name of an ease, as users read it.
pub fn ease_name(ease: Ease) -> &'static str {
    match ease {
        Ease::Smooth => "smooth",
        Ease::Linear => "linear",
        Ease::Step => "hold",
        Ease::In => "in",
        Ease::Out => "out",
        Ease::Bounce => "bounce",
        Ease::Curve(..) => "curve",
    }
}

/// Whether two eases are of the same kind. All curves are of one kind.
pub fn same_ease(one: Ease, other: Ease) -> bool {
    std::mem::discriminant(&one) == std::mem::discriminant(&other)
}

fn counted(keys: &[(KeyOf, f64)]) -> String {
    if keys.len() == 1 { "1 key".to_owned() } else { format!("{} keys", keys.len()) }
}

/// Two numbers in keys count as equal up to this difference. For numbers above 1, the difference is relative.
const SAME: f64 = 1e-9;

fn own_keys(scene: &mut Scene, of: &KeyOf) -> Result<Done, Refusal> {
    match of {
        KeyOf::Camera if scene.has_camera_of_shot() => {
            let mut keys: Vec<CameraKey> = Vec::new();
            for frame in scene.timeline.first..=scene.timeline.last {
                let frame = frame as f64;
                let pose = motion::camera_at(scene, frame);
                let fov_y_deg = match pose.lens {
                    Lens::Perspective { fov_y_deg, .. } => Some(fov_y_deg),
                    Lens::Orthographic { .. } => None,
                };
                // The roll is unwrapped: it is within half a turn of the roll of the key before.
                let before = keys.last().map_or(0.0, |key| key.roll_deg);
                let roll_deg = pose.roll_rad.to_degrees();
                let roll_deg = roll_deg + ((before - roll_deg) / 360.0).round() * 360.0;
                let [eye, target] = [pose.eye, pose.target].map(|at| at.to_array());
                keys.push(CameraKey { frame, eye, target, roll_deg, fov_y_deg, ease: Ease::Linear });
            }
            scene.camera.lens = motion::camera_at(scene, scene.timeline.first as f64).lens;
            let numbers = |key: &CameraKey| {
                let fov = key.fov_y_deg.unwrap_or_default();
                key.eye.into_iter().chain(key.target).chain([key.roll_deg, fov]).collect()
            };
            scene.camera.keys = thinned(keys, numbers);
        }
        KeyOf::Object(name) => {
            let object = unlocked_object(scene, name)?.clone();
            if !scene.is_moved_by_shot(&object) {
                return Err(Refusal::new(format!("{name} has keys of its own already")));
            }
            let keys = keys_of_shot(scene, &object);
            unlocked_object(scene, name)?.keys = keys;
        }
        _ => return Err(Refusal::new(format!("{} has keys of its own already", of.name()))),
    }
    Ok(Done::new(format!("Own keys for {}", of.name())))
}

/// How the shot moves an object, as keys.
pub(super) fn keys_of_shot(scene: &Scene, object: &Object) -> Vec<ObjectKey> {
    let mut keys: Vec<ObjectKey> = Vec::new();
    for frame in scene.timeline.first..=scene.timeline.last {
        let frame = frame as f64;
        let key = motion::key_at(scene, object, frame);
        let near = keys.last().map_or([0.0; 3], |key| key.rotation_deg);
        let rotation_deg = euler::degrees(euler::matrix(key.rotation_deg), near);
        keys.push(ObjectKey { frame, rotation_deg, ease: Ease::Linear, ..key });
    }
    let numbers =
        |key: &ObjectKey| key.translation.into_iter().chain(key.rotation_deg).chain(key.scale.0).collect();
    thinned(keys, numbers)
}

/// The keys (one per frame) without those that lie on a straight line between their neighbours.
fn thinned<K: Key>(keys: Vec<K>, numbers: impl Fn(&K) -> Vec<f64>) -> Vec<K> {
    let all: Vec<Vec<f64>> = keys.iter().map(numbers).collect();
    let is_straight = |at: usize| {
        let around = all[at - 1].iter().zip(&all[at]).zip(&all[at + 1]);
        around
            .into_iter()
            .all(|((before, now), after)| ((before + after) * 0.5 - now).abs() <= SAME * now.abs().max(1.0))
    };
    let last = keys.len().saturating_sub(1);
    let keeps = |at: usize| at == 0 || at == last || !is_straight(at);
    keys.into_iter().enumerate().filter(|(at, _)| keeps(*at)).map(|(_, key)| key).collect()
}

fn shift(scene: &mut Scene, keys: &[(KeyOf, f64)], by: f64, copies: bool) -> Result<(), Refusal> {
    for (of, frames) in keys::by_owner(keys) {
        keys::list(scene, of)?.shift(&frames, by, copies);
    }
    Ok(())
}

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
            if scene.has_camera_of_shot() {
                return Err(moved_by_shot(scene, "the camera"));
            }
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
            let keys = &mut posable_object(scene, name)?.keys;
            let at = keys.partition_point(|key| key.frame < frame);
            let old = keys.get(at).filter(|key| key.frame == frame).cloned();
            let ease = old.as_ref().map_or(Ease::Smooth, |old| old.ease);
            keys.splice(at..at + usize::from(old.is_some()), [ObjectKey { frame, ease, ..pose.clone() }]);
        }
    }
    Ok(())
}
