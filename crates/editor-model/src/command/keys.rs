//! The keys of everything that can be keyed: who owns them, how they are moved and copied, and values at a frame.

use std::borrow::Cow;

use impasto_scene::document::{
    BackgroundKey, Color, Ease, Key, Light, LightKey, LightKind, Scene, StrokesKey,
};
use impasto_scene::{motion, presets};

use super::region::{StrokesOf, in_file, settings};
use super::unlocked_object;
use crate::euler::tidy;
use crate::refusal::Refusal;

/// The owner of keys.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum KeyOf {
    /// The shot camera.
    Camera,
    /// The object of this name.
    Object(String),
    /// The light of this name.
    Light(String),
    /// The background.
    Background,
    /// The strokes of the scene or of a region.
    Strokes(StrokesOf),
}

/// A value to key: anything but a pose.
#[derive(Clone, Debug, PartialEq)]
pub enum KeyedValue {
    /// The values of a light, by its name. The frame and the ease of the [`LightKey`] are not read.
    Light(String, LightKey),
    /// The background.
    Background(Color),
    /// The values of strokes. The frame and the ease of the [`StrokesKey`] are not read.
    Strokes(StrokesOf, StrokesKey),
}

impl KeyOf {
    /// The owner's name, as users read it.
    pub fn name(&self) -> Cow<'_, str> {
        match self {
            Self::Camera => "shot".into(),
            Self::Object(name) | Self::Light(name) => name.into(),
            Self::Background => "background".into(),
            Self::Strokes(StrokesOf::Scene) => "all strokes".into(),
            Self::Strokes(StrokesOf::Region(name)) => format!("{name} strokes").into(),
        }
    }
}

impl KeyedValue {
    /// The owner's value at a frame; `None` for the camera and objects, whose keys are poses.
    pub(super) fn at(scene: &Scene, of: &KeyOf, frame: f64) -> Result<Option<Self>, Refusal> {
        Ok(match of {
            KeyOf::Camera | KeyOf::Object(_) => None,
            KeyOf::Light(name) => {
                let light = scene.lights.iter().find(|light| light.name == *name);
                let light = light.ok_or_else(|| Refusal::unknown("light", name))?;
                Some(Self::Light(name.clone(), whole_key(&motion::light_at(scene, light, frame), frame)))
            }
            KeyOf::Background => Some(Self::Background(motion::background_at(scene, frame))),
            KeyOf::Strokes(of) => Some(Self::Strokes(of.clone(), strokes_at(scene, of, frame))),
        })
    }

    /// The owner of the value.
    pub fn of(&self) -> KeyOf {
        match self {
            Self::Light(name, _) => KeyOf::Light(name.clone()),
            Self::Background(_) => KeyOf::Background,
            Self::Strokes(of, _) => KeyOf::Strokes(of.clone()),
        }
    }

    /// Keys the value at a frame. What a light's new key leaves out, but another key of the light states, is added to
    /// the new key as it is at this frame. Without that, the value of an earlier key would hold from here on.
    pub(super) fn put(&self, scene: &mut Scene, frame: f64) -> Result<(), Refusal> {
        match self {
            Self::Light(name, key) => {
                let index = scene.lights.iter().position(|light| light.name == *name);
                let index = index.ok_or_else(|| Refusal::unknown("light", name))?;
                let now = whole_key(&motion::light_at(scene, &scene.lights[index], frame), frame);
                let light = &mut scene.lights[index];
                let keyed = |states: fn(&LightKey) -> bool| light.keys.iter().any(states);
                let intensity = now.intensity.filter(|_| keyed(|key| key.intensity.is_some()));
                let color = now.color.filter(|_| keyed(|key| key.color.is_some()));
                let ground = now.ground.filter(|_| keyed(|key| key.ground.is_some()));
                let direction = now.direction.filter(|_| keyed(|key| key.direction.is_some()));
                let position = now.position.filter(|_| keyed(|key| key.position.is_some()));
                put(
                    &mut light.keys,
                    LightKey {
                        frame,
                        intensity: key.intensity.or(intensity).map(tidy),
                        color: key.color.or(color).map(in_file),
                        ground: key.ground.or(ground).map(in_file),
                        direction: key.direction.or(direction).map(|at| at.map(tidy)),
                        position: key.position.or(position).map(|at| at.map(tidy)),
                        ease: Ease::Smooth,
                    },
                );
            }
            Self::Background(color) => {
                let key = BackgroundKey { frame, color: in_file(*color), ease: Ease::Smooth };
                put(&mut scene.background_keys, key);
            }
            Self::Strokes(of, key) => {
                let inherited = strokes_keys(scene, of);
                let keys = &mut settings(scene, of)?.keys;
                // A region's keys replace the scene's, so the scene's are copied before the first one is added.
                if keys.is_empty() {
                    *keys = inherited;
                }
                put(keys, StrokesKey { frame, ease: Ease::Smooth, ..key.clone() });
            }
        }
        Ok(())
    }
}

/// A key that states everything that a light of its kind has.
fn whole_key(light: &Light, frame: f64) -> LightKey {
    LightKey {
        intensity: Some(light.intensity),
        color: Some(light.color),
        ground: light.ground.filter(|_| light.kind == LightKind::Ambient),
        direction: light.direction.filter(|_| matches!(light.kind, LightKind::Sun | LightKind::Spot)),
        position: light.position.filter(|_| matches!(light.kind, LightKind::Point | LightKind::Spot)),
        ..LightKey::at(frame)
    }
}

/// The keys in force for strokes; a region may inherit them from the scene.
fn strokes_keys(scene: &Scene, of: &StrokesOf) -> Vec<StrokesKey> {
    let region = match of {
        StrokesOf::Scene => None,
        StrokesOf::Region(name) => scene.regions.iter().position(|region| region.name == *name),
    };
    presets::resolve(scene, region).keys
}

/// The values that the keys give to strokes at a frame.
pub fn strokes_at(scene: &Scene, of: &StrokesOf, frame: f64) -> StrokesKey {
    motion::stroke_key_at(&strokes_keys(scene, of), frame)
}

/// Inserts a key. A key at the same frame is replaced, but its ease stays.
fn put<K: Key>(keys: &mut Vec<K>, mut key: K) {
    let at = keys.partition_point(|other| other.frame() < key.frame());
    match keys.get_mut(at).filter(|old| old.frame() == key.frame()) {
        Some(old) => {
            key.set_ease(old.ease());
            *old = key;
        }
        None => keys.insert(at, key),
    }
}

/// A list of keys of any kind.
pub(super) trait KeyList {
    /// Moves the keys at these frames, or copies of them. A key that lands on another key replaces it.
    fn shift(&mut self, frames: &[f64], by: f64, copies: bool);
    fn delete(&mut self, frames: &[f64]);
    fn set_ease(&mut self, frames: &[f64], ease: Ease);
    /// Whether the list has no keys.
    fn is_bare(&self) -> bool;
}

impl<K: Key> KeyList for Vec<K> {
    fn shift(&mut self, frames: &[f64], by: f64, copies: bool) {
        let mut shifted: Vec<K> = self.iter().filter(|key| frames.contains(&key.frame())).cloned().collect();
        shifted.iter_mut().for_each(|key| key.set_frame(key.frame() + by));
        if !copies {
            self.delete(frames);
        }
        self.delete(&shifted.iter().map(Key::frame).collect::<Vec<_>>());
        for key in shifted {
            self.insert(self.partition_point(|other| other.frame() < key.frame()), key);
        }
    }

    fn delete(&mut self, frames: &[f64]) {
        self.retain(|key| !frames.contains(&key.frame()));
    }

    fn set_ease(&mut self, frames: &[f64], ease: Ease) {
        self.iter_mut().filter(|key| frames.contains(&key.frame())).for_each(|key| key.set_ease(ease));
    }

    fn is_bare(&self) -> bool {
        self.is_empty()
    }
}

pub(super) fn list<'a>(scene: &'a mut Scene, of: &KeyOf) -> Result<&'a mut dyn KeyList, Refusal> {
    Ok(match of {
        KeyOf::Camera => &mut scene.camera.keys,
        KeyOf::Object(name) => &mut unlocked_object(scene, name)?.keys,
        KeyOf::Light(name) => {
            let light = scene.lights.iter_mut().find(|light| light.name == *name);
            &mut light.ok_or_else(|| Refusal::unknown("light", name))?.keys
        }
        KeyOf::Background => &mut scene.background_keys,
        KeyOf::Strokes(of) => &mut settings(scene, of)?.keys,
    })
}

/// Groups the frames of keys by their owner. The owners are in the order in which they first appear.
pub(super) fn by_owner(keys: &[(KeyOf, f64)]) -> Vec<(&KeyOf, Vec<f64>)> {
    let mut owners: Vec<(&KeyOf, Vec<f64>)> = Vec::new();
    for (of, frame) in keys {
        match owners.iter_mut().find(|(other, _)| *other == of) {
            Some((_, frames)) => frames.push(*frame),
            None => owners.push((of, vec![*frame])),
        }
    }
    owners
}
