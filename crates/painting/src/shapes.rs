//! The shapes of all bodies at a frame, from what the document and its shot say.

use std::sync::Arc;

use glam::DAffine3;
use impasto_core::bending::{Bend, BendPose};
use impasto_scene::document::{Object, Scene};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::motion;

use crate::body_shape::{BodyNoise, BodyShape, FrameNoise};

/// What moves the vertices of every object at one frame, without noise: the pose of the joints and targets of its mesh
/// file (`None` where the shot gives none), its morph weight, and the frame of its point cache.
pub(crate) struct BodyShapes<'a> {
    loaded: &'a LoadedScene,
    bends: Vec<Option<BendPose>>,
    morphs: Vec<f64>,
    cache_frames: Vec<f64>,
}

/// The joints and morph targets in the mesh file of an object; `None` where it has none.
pub(crate) fn file_bend<'a>(loaded: &'a LoadedScene, object: &Object) -> Option<&'a Bend> {
    loaded.meshes.get(&object.mesh)?.bend.as_deref()
}

impl<'a> BodyShapes<'a> {
    pub(crate) fn at(loaded: &'a LoadedScene, frame: f64) -> Self {
        let scene = &loaded.scene;
        Self {
            loaded,
            bends: motion::bends_at(scene, frame),
            morphs: motion::morphs_at(scene, frame),
            cache_frames: motion::cache_frames_at(scene, frame),
        }
    }

    /// These shapes, but with the morph of each object at its largest value over all frames.
    pub(crate) fn morphed_farthest(mut self) -> Self {
        for (weight, object) in self.morphs.iter_mut().zip(&self.loaded.scene.objects) {
            *weight = motion::farthest_morph(object);
        }
        self
    }

    /// The shape of one object, without noise. `bend` is its [`file_bend`].
    pub(crate) fn of(&self, object: usize, bend: Option<&Bend>) -> BodyShape {
        let stated = &self.loaded.scene.objects[object];
        let cache = stated.cache.as_ref().and_then(|name| self.loaded.caches.get(name));
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
    let all = BodyShapes::at(loaded, frame);
    let objects = loaded.scene.objects.iter().enumerate();
    let shape = |((index, object), noise): ((usize, &Object), Option<FrameNoise>)| BodyShape {
        noise,
        ..all.of(index, file_bend(loaded, object))
    };
    objects.zip(noises_at(&loaded.scene, noises, frame)).map(shape).collect()
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
