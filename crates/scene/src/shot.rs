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
    /// For each light of the file, a factor on the intensities of its keys.
    key_factors: Vec<f64>,
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
    /// The shot in a file that a scene names so, seen by its camera of the name that is given, or by its first. Also returns what a
    /// user should know of the file: each what is odd, and the mend.
    pub(crate) fn new(file: Arc<GltfFile>, name: &str, camera: Option<&str>) -> (Self, Vec<[String; 2]>) {
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
        let mut odd = Vec::new();
        let camera = camera::chosen(&file, camera, &mut odd);
        let (lights, key_factors) = (Vec::new(), vec![1.0; file.gltf.lights.len()]);
        let mut shot = Self { objects, object_of_name, camera, lights, exposure: 1.0, key_factors, file };
        shot.exposure = shot.found_exposure();
        shot.lights = shot.lights_at_rest();
        shot.mend_light_keys(&mut odd);
        shot.tell_what_bends(&mut odd);
        (shot, odd)
    }

    /// Says what bends in the file and does not here.
    fn tell_what_bends(&self, odd: &mut Vec<[String; 2]>) {
        let (nodes, meshes) = (&self.file.gltf.nodes, &self.file.gltf.meshes);
        let bends = |object: &&ShotObject| {
            let node = &nodes[object.node];
            node.skin.is_some() || node.mesh.is_some_and(|mesh| meshes[mesh].target_count > 0)
        };
        let bending: Vec<&str> =
            self.objects.iter().filter(bends).map(|object| object.object.name.as_str()).collect();
        if let Some(first) = bending.first() {
            let message = match bending.len() {
                1 => format!("{first} bends by joints or shape keys, and shows as it rests"),
                many => format!(
                    "{many} objects bend by joints or shape keys, {first:?} the first of them, and show as they rest"
                ),
            };
            odd.push([message, "only what moves as a whole moves here yet".to_owned()]);
        }
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.file.path
    }

    /// Whether it has lights.
    pub fn has_lights(&self) -> bool {
        !self.lights.is_empty()
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

    fn span_s(&self) -> Option<[f32; 2]> {
        self.file.animator.span_s()
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
