//! A shot: what a glTF file brings into a scene, its objects, camera, lights, motion and frame range.
//!
//! Nothing of it is written into the scene file. [`Shot::enter`] adds it to the document in memory, so that all who read a document
//! find objects, lights and frames where they always are; [`left`] takes out again what the document only has from the shot, before it
//! is saved. What moves is never turned into keys: [`crate::motion`] asks the shot for each frame.

mod camera;
mod enter;
mod lights;

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use glam::{DAffine3, DMat3};
use impasto_gltf::Posed;

use crate::document::{Light, Object, Timeline};
use crate::gltf::GltfFile;
use crate::mesh_format;

pub use enter::left;

/// A glTF file on a scene's stage.
#[derive(Debug)]
pub struct Shot {
    file: Arc<GltfFile>,
    /// The objects, in the order of the file's nodes.
    objects: Vec<ShotObject>,
    object_of_name: HashMap<String, usize>,
    /// The node of the camera that is looked through: the first that shows.
    camera: Option<usize>,
    /// The lights as they are at rest, each with its node; the soft light all around has none.
    lights: Vec<(Light, Option<usize>)>,
    /// Our intensity of a light over that of the file.
    exposure: f64,
}

/// A node with a mesh.
#[derive(Debug)]
struct ShotObject {
    object: Object,
    node: usize,
    /// Undoes the stretch that its mesh has already.
    unstretched: DMat3,
}

/// The shot of a scene, if it has one. Equal only to itself: what the file holds is not compared.
#[derive(Clone, Debug, Default)]
pub struct Stage {
    shot: Option<Arc<Shot>>,
    /// What the document states for objects that the shot does not have any more.
    lost: Arc<Vec<Object>>,
}

impl PartialEq for Stage {
    fn eq(&self, other: &Self) -> bool {
        match (&self.shot, &other.shot) {
            (Some(own), Some(other)) => Arc::ptr_eq(own, other),
            (own, other) => own.is_none() && other.is_none(),
        }
    }
}

impl Stage {
    /// The shot.
    pub fn shot(&self) -> Option<&Shot> {
        self.shot.as_deref()
    }

    pub(crate) fn shared(&self) -> Option<&Arc<Shot>> {
        self.shot.as_ref()
    }
}

impl Shot {
    /// The shot in a file that a scene names so.
    pub(crate) fn new(file: Arc<GltfFile>, name: &str) -> Self {
        let mut objects = Vec::new();
        for (index, node) in file.gltf.nodes.iter().enumerate() {
            let shows = node.mesh.is_some_and(|mesh| !file.gltf.meshes[mesh].primitives.is_empty());
            if !shows || !file.is_in_scene(index) {
                continue;
            }
            let object = Object {
                hidden: !file.rest.is_visible[index],
                ..Object::new(node.name.clone(), mesh_format::name_of_node(name, &node.name))
            };
            objects.push(ShotObject { object, node: index, unstretched: file.stretch(index).inverse() });
        }
        let object_of_name =
            objects.iter().enumerate().map(|(index, object)| (object.object.name.clone(), index)).collect();
        let camera = (0..file.gltf.nodes.len())
            .find(|&node| file.gltf.nodes[node].camera.is_some() && file.is_in_scene(node));
        let mut shot = Self { objects, object_of_name, camera, lights: Vec::new(), exposure: 1.0, file };
        shot.exposure = shot.found_exposure();
        shot.lights = shot.lights_at_rest();
        shot
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.file.path
    }

    /// Whether it has a camera to look through.
    pub fn has_camera(&self) -> bool {
        self.camera.is_some()
    }

    /// Whether it has lights.
    pub fn has_lights(&self) -> bool {
        !self.lights.is_empty()
    }

    /// The first and the last time of its animations, seconds; `None` where nothing moves.
    pub fn span_s(&self) -> Option<[f32; 2]> {
        self.file.animator.span_s()
    }

    /// The frames in which it moves, at this rate: frame = time · rate.
    pub fn timeline(&self, fps: f64) -> Timeline {
        let [first, last] = self.span_s().unwrap_or_default().map(|time_s| f64::from(time_s) * fps);
        // What rounding of times to 32 bits leaves over is no frame.
        let last = (last - 1e-3).ceil().max(0.0) as i64;
        Timeline { fps, first: ((first + 1e-3).floor() as i64).min(last), last }
    }

    /// Whether it brings this object.
    pub fn has_object(&self, name: &str) -> bool {
        self.object_of_name.contains_key(name)
    }

    /// Where everything stands at a time.
    pub(crate) fn at(&self, time_s: f64) -> Posed {
        self.file.animator.pose(time_s)
    }

    /// World from model of an object; `None` if the shot does not bring it.
    pub(crate) fn pose_of(&self, posed: &Posed, name: &str) -> Option<DAffine3> {
        let object = &self.objects[*self.object_of_name.get(name)?];
        // A skinned mesh stands where its joints put it.
        if self.file.gltf.nodes[object.node].skin.is_some() {
            return Some(DAffine3::IDENTITY);
        }
        let world = posed.world_from_node[object.node];
        Some(DAffine3 { matrix3: world.matrix3 * object.unstretched, translation: world.translation })
    }
}
