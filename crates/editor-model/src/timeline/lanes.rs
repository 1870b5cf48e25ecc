//! The lanes of the timeline: the keys of the camera, of each object, and of values that change over time.

use impasto_scene::document::{Ease, Key, Scene};

use crate::command::{KeyOf, StrokesOf};

/// A key: whose it is, and its frame.
pub type KeyAt = (KeyOf, f64);

/// A key in its lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LaneKey {
    /// Its frame.
    pub frame: f64,
    /// The ease from this key to the next.
    pub ease: Ease,
}

/// The keys of one thing, in the order of their frames.
#[derive(Clone, Debug, PartialEq)]
pub struct Lane {
    /// The owner of the keys.
    pub of: KeyOf,
    /// Whether the keys cannot be changed.
    pub locked: bool,
    /// Whether the owner is moved by the scene's shot. Then it has no keys of its own.
    pub of_shot: bool,
    /// The keys.
    pub keys: Vec<LaneKey>,
}

impl Lane {
    fn new(of: KeyOf, keys: &[impl Key]) -> Self {
        let keys = keys.iter().map(|key| LaneKey { frame: key.frame(), ease: key.ease() }).collect();
        Self { of, locked: false, of_shot: false, keys }
    }

    /// Whether there is a key at a frame.
    pub fn has(&self, frame: f64) -> bool {
        self.keys.iter().any(|key| key.frame == frame)
    }

    /// The key whose ease leads through a frame: the last one at or before it. `None` before the first key and from the
    /// last key on, where nothing moves.
    pub fn left_of(&self, frame: f64) -> Option<LaneKey> {
        let right = self.keys.partition_point(|key| key.frame <= frame);
        (right > 0 && right < self.keys.len()).then(|| self.keys[right - 1])
    }
}

/// A lane for the camera, then one for each object, in the order of the file. Then, only where there are keys, one for
/// each light, one for the background, one for the scene's strokes, and one for the strokes of each region.
pub fn lanes(scene: &Scene) -> Vec<Lane> {
    let camera = Lane { of_shot: scene.has_camera_of_shot(), ..Lane::new(KeyOf::Camera, &scene.camera.keys) };
    let objects = scene.objects.iter().map(|object| Lane {
        locked: object.locked,
        of_shot: scene.is_moved_by_shot(object),
        ..Lane::new(KeyOf::Object(object.name.clone()), &object.keys)
    });
    let lights = scene.lights.iter().map(|light| Lane::new(KeyOf::Light(light.name.clone()), &light.keys));
    let background = Lane::new(KeyOf::Background, &scene.background_keys);
    let strokes = Lane::new(KeyOf::Strokes(StrokesOf::Scene), &scene.strokes.keys);
    let regions = scene.regions.iter().map(|region| Lane {
        locked: region.locked,
        ..Lane::new(KeyOf::Strokes(StrokesOf::Region(region.name.clone())), &region.strokes.keys)
    });
    let values = lights.chain([background, strokes]).chain(regions).filter(|lane| !lane.keys.is_empty());
    [camera].into_iter().chain(objects).chain(values).collect()
}

/// The frames at which anything has a key, in order, each once.
pub fn keyed_frames(scene: &Scene) -> Vec<f64> {
    let mut frames: Vec<f64> =
        lanes(scene).iter().flat_map(|lane| lane.keys.iter().map(|key| key.frame)).collect();
    frames.sort_by(f64::total_cmp);
    frames.dedup();
    frames
}

/// The ease that a click changes this one to. Repeated clicks go through all named eases. `None` for a curve: it was
/// made by hand, so a click must not discard it.
pub fn next_ease(ease: Ease) -> Option<Ease> {
    Some(match ease {
        Ease::Smooth => Ease::Linear,
        Ease::Linear => Ease::Step,
        Ease::Step => Ease::In,
        Ease::In => Ease::Out,
        Ease::Out => Ease::Bounce,
        Ease::Bounce => Ease::Smooth,
        Ease::Curve(..) => return None,
    })
}

/// The eases to choose from, in the order of the menu. The last one is a curve: `now` (the ease that a key has already)
/// if that is a curve, else the usual curve.
pub fn eases(now: Option<Ease>) -> [Ease; 7] {
    let curve = now.filter(|now| matches!(now, Ease::Curve(..))).unwrap_or(Ease::USUAL_CURVE);
    [Ease::Smooth, Ease::Linear, Ease::Step, Ease::In, Ease::Out, Ease::Bounce, curve]
}
