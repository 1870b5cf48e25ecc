//! A shot: the objects, camera, lights, motion and frame range that a glTF file brings into a scene.
//!
//! Nothing of it is written into the scene file. [`Brought::enter`] adds it to the document in memory, so that code
//! that reads a document finds objects, lights and frames where they always are. Before the document is saved,
//! [`Brought::left`] takes out what comes from the shot alone. What moves is never turned into keys: [`crate::motion`]
//! asks the shot for each frame.

mod camera;
mod enter;
mod lights;

use std::collections::HashMap;
use std::fmt;
use std::path::Path;
use std::sync::Arc;

use glam::{DAffine3, DMat3};
use impasto_core::bending::BendPose;
use impasto_gltf::{Animator, Playing, Posed};

use crate::document::{Brought, Light, Lost, Object, Scene, Seen};
use crate::gltf::GltfFile;
use crate::mesh_format;
use crate::nearest::nearest;

/// What a glTF file brings into a scene.
pub struct Shot {
    file: Arc<GltfFile>,
    /// Where everything stands at any time.
    animator: Animator,
    /// The objects, in the order of the file's nodes.
    objects: Vec<ShotObject>,
    object_of_name: HashMap<String, usize>,
    /// The node of the camera that is looked through where no cut of the sidecar says otherwise.
    camera: Option<usize>,
    /// Whether the scene names a camera, even one that the file lacks. If so, the camera cuts of the sidecar are
    /// ignored.
    is_chosen: bool,
    /// The lights as they are at rest, each with its node; the ambient light has none.
    lights: Vec<(Light, Option<usize>)>,
    /// Factor from a light's intensity in the file to that in the scene.
    exposure: f64,
    /// The part of the ambient light's intensity that stands for light that surfaces reflect onto each other.
    around: f64,
    /// For each light of the file, a factor on the intensities of its keys.
    key_factors: Vec<f64>,
}

/// A node with a mesh.
#[derive(Debug)]
struct ShotObject {
    object: Object,
    node: usize,
    /// The inverse of the stretch (uneven scale and shear) that is applied to its mesh already.
    unstretched: DMat3,
}

/// What a scene chooses from a shot's file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Choice {
    /// The name of the node of the camera that is looked through. `None`: the camera of the sidecar's cuts, or else the
    /// one that sees the most objects.
    camera: Option<String>,
    /// The name of the animation that plays. `None`: all animations together.
    animation: Option<String>,
}

impl Choice {
    pub fn of(scene: &Scene) -> Self {
        Self { camera: scene.camera.of_shot.clone(), animation: scene.timeline.animation.clone() }
    }
}

/// The animation of this name; all of them if no name is given, or none has it. Adds to `odd` a message if none has it,
/// and a message for each thing that two animations move.
fn playing(file: &GltfFile, name: Option<&str>, odd: &mut Vec<[String; 2]>) -> Animator {
    let named = name.map_or(Playing::All, Playing::Named);
    let (animator, double) = Animator::new(&file.gltf, named).unwrap_or_else(|names| {
        let name = name.unwrap_or_default();
        let near = nearest(name, names.iter().map(String::as_str));
        let mend =
            near.map_or_else(|| format!("there are {names:?}"), |near| format!("did you mean {near:?}?"));
        odd.push([format!("there is no animation {name:?}: all play together"), mend]);
        Animator::new(&file.gltf, Playing::All).unwrap_or_else(|_| unreachable!("none is asked for by name"))
    });
    let mend = "choose one in the scene, as in timeline: (animation: …)";
    odd.extend(double.into_iter().map(|found| [found.to_string(), mend.to_owned()]));
    animator
}

impl Shot {
    /// The shot in a file that a scene calls `name`. Also returns what a user should know about the file, each as a
    /// message and what to do about it.
    pub(crate) fn new(file: Arc<GltfFile>, name: &str, choice: &Choice) -> (Self, Vec<[String; 2]>) {
        let mut odd = Vec::new();
        let animator = playing(&file, choice.animation.as_deref(), &mut odd);
        let hides = animator.changes_visibility();
        let mut objects = Vec::new();
        for (index, node) in file.gltf.nodes.iter().enumerate() {
            let shows = node.mesh.is_some_and(|mesh| !file.gltf.meshes[mesh].primitives.is_empty());
            if !shows || !file.is_in_scene(index) {
                continue;
            }
            let object = Object {
                hidden: !(hides || file.rest.is_visible[index]),
                cache: file.sidecar.caches.get(&node.name).map(|cache| name_beside(name, cache)),
                ..Object::new(node.name.clone(), mesh_format::name_of_node(name, &node.name))
            };
            objects.push(ShotObject { object, node: index, unstretched: file.stretch(index).inverse() });
        }
        let object_of_name =
            objects.iter().enumerate().map(|(index, object)| (object.object.name.clone(), index)).collect();
        let camera = camera::chosen(&file, &animator, choice.camera.as_deref(), &mut odd);
        let is_chosen = choice.camera.is_some();
        let (lights, key_factors) = (Vec::new(), vec![1.0; file.gltf.lights.len()]);
        let mut shot = Self {
            animator,
            objects,
            object_of_name,
            camera,
            is_chosen,
            lights,
            exposure: 1.0,
            around: 0.0,
            key_factors,
            file,
        };
        (shot.exposure, shot.around) = shot.found_exposure();
        shot.lights = shot.lights_at_rest();
        let cached = shot.file.sidecar.caches.keys();
        for name in cached.filter(|name| !shot.object_of_name.contains_key(*name)) {
            let message = format!("its sidecar has a point cache for {name:?}, and there is no such object");
            odd.push([message, "export the shot again".to_owned()]);
        }
        if !shot.has_lights() {
            let mend = "tick lights in the export dialog (in Blender, Punctual Lights)";
            odd.push(["there are no lights: it is lit from one side".to_owned(), mend.to_owned()]);
        }
        shot.mend_light_keys(&mut odd);
        (shot, odd)
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.file.path
    }

    /// The names of its objects.
    pub fn object_names(&self) -> impl Iterator<Item = &str> {
        self.objects.iter().map(|object| object.object.name.as_str())
    }

    /// Whether it has lights.
    pub fn has_lights(&self) -> bool {
        !self.lights.is_empty()
    }

    /// Frames per second at which all keys lie on whole frames; `None` if there are too few keys to tell, if no usual
    /// rate fits, or if the sidecar states the rate.
    pub(crate) fn rate_of_keys(&self) -> Option<f64> {
        if self.file.sidecar.fps.is_some() { None } else { rate_of(self.animator.key_times_s()) }
    }

    /// Frames per second, if the sidecar states them.
    fn stated_rate(&self) -> Option<f64> {
        self.file.sidecar.fps
    }

    /// The size of the picture in pixels, if the sidecar states it.
    pub fn size_px(&self) -> Option<[u32; 2]> {
        self.file.sidecar.size
    }

    /// Frames per second: the rate that the sidecar states, or the rate of the keys, or else 24.
    pub fn rate(&self) -> f64 {
        self.stated_rate().or_else(|| self.rate_of_keys()).unwrap_or(24.0)
    }

    /// The first and the last frame, at `fps` frames per second: those that the sidecar states, unless it also states a
    /// rate that is not `fps`. Otherwise those between which the shot moves (frame = time · fps).
    pub fn frames(&self, fps: f64) -> (i64, i64) {
        if let Some([first, last]) =
            self.file.sidecar.frames.filter(|_| self.stated_rate().is_none_or(|rate| rate == fps))
        {
            return (first, last);
        }
        let [first, last] = self.span_s().unwrap_or_default().map(|time_s| f64::from(time_s) * fps);
        // Times are rounded to 32 bits, so 1e-3 of a frame more or less than a whole one does not count.
        let last = (last - 1e-3).ceil().max(0.0) as i64;
        (((first + 1e-3).floor() as i64).min(last), last)
    }
}

/// Prints the path alone. Otherwise a printed scene would contain all the numbers of the file.
impl fmt::Debug for Shot {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_tuple("Shot").field(&self.file.path).finish()
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
        self.animator.span_s()
    }

    fn at(&self, time_s: f64) -> Posed {
        self.animator.pose(time_s)
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

    fn bends(&self, name: &str, mesh: &str) -> bool {
        let object = self.object_of_name.get(name).map(|&index| &self.objects[index]);
        object.is_some_and(|object| object.object.mesh == mesh && self.file.bends(object.node))
    }

    fn bend_of(&self, posed: &Posed, name: &str, mesh: &str) -> Option<BendPose> {
        let object = self.object_of_name.get(name).filter(|_| self.bends(name, mesh))?;
        Some(self.file.bend_pose(self.objects[*object].node, posed))
    }

    fn changes_visibility(&self) -> bool {
        self.animator.changes_visibility()
    }

    fn is_visible(&self, posed: &Posed, name: &str) -> bool {
        let object = self.object_of_name.get(name).map(|&index| &self.objects[index]);
        object.is_none_or(|object| posed.is_visible[object.node])
    }

    fn camera(&self, time_s: f64, size: (u32, u32)) -> Option<Seen> {
        self.seen(time_s, size)
    }

    fn in_collection(&self, collection: &str, object: &str) -> Option<bool> {
        self.file.sidecar.collections.get(collection).map(|names| names.contains(object))
    }

    fn exposure_stops(&self) -> f32 {
        self.file.sidecar.exposure_stops
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

/// How a scene names `file`, which lies beside the shot that the scene names `shot`.
fn name_beside(shot: &str, file: &str) -> String {
    match shot.rfind(['/', '\\']) {
        Some(end) => format!("{}{file}", &shot[..=end]),
        None => file.to_owned(),
    }
}

/// Frames per second at which all these times lie on whole frames; `None` if there are too few to tell, or no usual
/// rate fits.
fn rate_of(times_s: impl Iterator<Item = f32>) -> Option<f64> {
    const FEW: usize = 4;
    /// How far from a whole frame a key may be: times have 32 bits.
    const OFF: f64 = 2e-3;
    let ntsc = |rate: f64| rate * 1000.0 / 1001.0;
    // The commonest rate comes first, since the first that fits is taken.
    let rates = [24.0, 25.0, 30.0, 12.0, 15.0, 48.0, 50.0, 60.0, ntsc(24.0), ntsc(30.0)];
    let times_s: Vec<f64> = times_s.map(f64::from).collect();
    let is_whole = |frame: f64| (frame - frame.round()).abs() < OFF;
    let fits = |rate: &f64| times_s.iter().all(|time_s| is_whole(time_s * rate));
    rates.into_iter().find(fits).filter(|_| times_s.len() > FEW)
}

#[cfg(test)]
mod tests {
    use super::rate_of;

    #[test]
    fn keys_tell_the_rate() {
        let keys = |rate: f64, count: u32| (1..=count).map(move |frame| (f64::from(frame) / rate) as f32);
        for rate in [24.0, 25.0, 30.0, 60.0, 24_000.0 / 1001.0] {
            assert_eq!(rate_of(keys(rate, 2000)), Some(rate));
        }
        // Keys at whole seconds fit every whole rate; three keys are too few to tell; no film has 17 frames a second.
        assert_eq!(rate_of(keys(1.0, 9)), Some(24.0));
        assert_eq!(rate_of(keys(30.0, 3)), None);
        assert_eq!(rate_of(keys(17.0, 99)), None);
    }
}
