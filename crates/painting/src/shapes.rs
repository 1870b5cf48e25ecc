//! How each body is deformed at a frame (joints, morphs, point caches), from the document and its shot.

use std::sync::Arc;

use glam::DAffine3;
use impasto_core::bending::{Bend, BendPose};
use impasto_scene::document::{Object, Scene};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::motion;

use crate::body_shape::{BodyNoise, BodyShape, FrameNoise};

/// What moves the vertices of every object at one frame, without noise: the pose of the joints and targets of its mesh
/// file (`None` where the shot gives none), its morph weight, and the frame of its point cache.
pub(crate) struct BodyShapes {
    bends: Vec<Option<BendPose>>,
    morphs: Vec<f64>,
    cache_frames: Vec<f64>,
}

/// The joints and morph targets in the mesh file of an object; `None` where it has none.
fn file_bend<'a>(loaded: &'a LoadedScene, object: &Object) -> Option<&'a Bend> {
    loaded.meshes.get(&object.mesh)?.bend.as_deref()
}

impl BodyShapes {
    pub(crate) fn at(scene: &Scene, frame: f64) -> Self {
        Self {
            bends: motion::bends_at(scene, frame),
            morphs: motion::morphs_at(scene, frame),
            cache_frames: motion::cache_frames_at(scene, frame),
        }
    }

    /// These shapes, but with the morph of each object at its largest value over all frames.
    pub(crate) fn morphed_farthest(mut self, scene: &Scene) -> Self {
        for (weight, object) in self.morphs.iter_mut().zip(&scene.objects) {
            *weight = motion::farthest_morph(object);
        }
        self
    }

    /// An upper bound on the number of joints and weights in the pose that [`BodyShapes::of`] gives an object. It is 0
    /// if the shot gives no pose and the morph weight is 0.
    pub(crate) fn numbers_of(&self, loaded: &LoadedScene, object: usize) -> usize {
        let numbers = |pose: &BendPose| pose.joints.len() + pose.weights.len();
        let in_file = || file_bend(loaded, &loaded.scene.objects[object]).map(|bend| &bend.rest);
        match (&self.bends[object], self.morphs[object] == 0.0) {
            (None, true) => 0,
            (None, false) => 1 + in_file().map_or(0, numbers),
            (Some(pose), _) => 1 + numbers(pose),
        }
    }

    /// How many joints and targets the shot states at this frame.
    pub(crate) fn numbers(&self) -> usize {
        self.bends.iter().flatten().map(|bend| bend.joints.len() + bend.weights.len()).sum()
    }

    /// The shape of one object, without noise.
    pub(crate) fn of(&self, loaded: &LoadedScene, object: usize) -> BodyShape {
        let stated = &loaded.scene.objects[object];
        let bend = file_bend(loaded, stated);
        let cache = stated.cache.as_ref().and_then(|name| loaded.caches.get(name));
        let cache_frame = cache.map(|cache| {
            let [first, last] = cache.frames();
            // `max` and `min` also bring NaN into the range.
            self.cache_frames[object].max(first).min(last)
        });
        let rest = bend.map_or_else(BendPose::default, |bend| bend.rest.clone());
        let mut pose = match bend {
            Some(_) => self.bends[object].clone().unwrap_or_else(|| rest.clone()),
            None => BendPose::default(),
        };
        let is_as_in_file = pose == rest && self.morphs[object] == 0.0;
        if stated.morph.is_some() {
            pose.weights.push(self.morphs[object] as f32);
        }
        let place = DAffine3::from_mat3(stated.model_from_file());
        pose.joints.iter_mut().for_each(|joint| *joint = place * *joint);
        BodyShape { pose: (!is_as_in_file).then(|| Arc::new(pose)), cache_frame, noise: None }
    }
}

/// The shape of every object at a frame.
pub(crate) fn shapes(loaded: &LoadedScene, noises: &[Option<Arc<BodyNoise>>], frame: f64) -> Vec<BodyShape> {
    let all = BodyShapes::at(&loaded.scene, frame);
    let noises = noises_at(&loaded.scene, noises, frame).into_iter().enumerate();
    noises.map(|(object, noise)| BodyShape { noise, ..all.of(loaded, object) }).collect()
}

pub(crate) fn noises_at(
    scene: &Scene,
    noises: &[Option<Arc<BodyNoise>>],
    frame: f64,
) -> Vec<Option<FrameNoise>> {
    if noises.iter().all(Option::is_none) {
        return vec![None; noises.len()];
    }
    let (poses, seconds) = (motion::poses_at(scene, frame), motion::seconds_at(scene, frame));
    let at = |(index, noise): (usize, &Option<Arc<BodyNoise>>)| {
        noise.as_ref().map(|noise| noise.at(seconds[index], poses[index]))
    };
    noises.iter().enumerate().map(at).collect()
}
