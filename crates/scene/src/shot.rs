//! A shot: what a glTF file brings into a scene, its objects, camera, lights, motion and frame range.
//!
//! Nothing of it is written into the scene file. [`Brought::enter`] adds it to the document in memory, so that all who read a document
//! find objects, lights and frames where they always are; [`Brought::left`] takes out again what the document only has from the shot, before it
//! is saved. What moves is never turned into keys: [`crate::motion`] asks the shot for each frame.

mod camera;
mod enter;
mod lights;

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DMat4};
use impasto_gltf::Posed;

use crate::document::{Brought, Lens, Light, Lost, Object, Scene, Timeline};
use crate::gltf::GltfFile;
use crate::mesh_format;

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
}

impl Brought for Shot {
    fn has_camera(&self) -> bool {
        self.camera.is_some()
    }

    fn has_object(&self, name: &str) -> bool {
        self.object_of_name.contains_key(name)
    }

    fn at(&self, time_s: f64) -> Posed {
        self.file.animator.pose(time_s)
    }

    fn pose_of(&self, posed: &Posed, name: &str) -> Option<DAffine3> {
        let object = &self.objects[*self.object_of_name.get(name)?];
        // A skinned mesh stands where its joints put it.
        if self.file.gltf.nodes[object.node].skin.is_some() {
            return Some(DAffine3::IDENTITY);
        }
        let world = posed.world_from_node[object.node];
        Some(DAffine3 { matrix3: world.matrix3 * object.unstretched, translation: world.translation })
    }

    fn camera(&self, posed: &Posed, size: (u32, u32)) -> Option<(DMat4, Lens)> {
        let node = self.camera?;
        let camera = self.file.gltf.nodes[node].camera?;
        Some((posed.world_from_view(node), camera::lens_in(posed.lenses[camera], size)))
    }

    fn light(&self, light: &Light, posed: &Posed) -> Light {
        self.light_at(light, posed)
    }

    fn enter(self: Arc<Self>, scene: &mut Scene) -> Vec<Lost> {
        enter::enter(self, scene)
    }

    fn left(&self, scene: &Scene) -> Scene {
        enter::left(self, scene)
    }
}
