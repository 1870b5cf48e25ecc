//! Makes new scenes: for a mesh, for a shot, or empty. A mesh is set upright, lit from one side, and framed with the
//! beginning of its shadow.

mod add;
mod axes;
mod framing;
mod ground;
mod of_shot;
mod scheme;
mod stance;

use std::path::Path;

use glam::DVec3;

use crate::document::{
    Camera, CameraKey, Color, Ease, Lens, Light, LightKind, MaterialOverride, Object, Reference, Scene,
    StrokeSettings, Timeline, Up,
};
use crate::gltf;
use crate::mesh_file::MeshFile;
use axes::Axes;
use framing::View;
use scheme::Scheme;
use stance::Samples;

pub use add::{REGION_COLORS, add_mesh, regions_of};
pub use ground::{Ground, NoGround};
pub use of_shot::for_shot;
pub use stance::ViewFrom;

/// Width and height of a new picture.
const SIZE_PX: (u32, u32) = (1280, 720);

/// A model without colours shines a little, as glazed clay does.
const GLOSS: f64 = 0.15;

/// A model with more groups than this keeps one colour.
const MOST_COLORED_GROUPS: usize = 12;

/// How a model is placed in its new scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Placing {
    /// Which axis of its file points up; `None` to find out.
    pub up: Option<Up>,
    /// From which side it is seen.
    pub view: ViewFrom,
    /// What it stands on.
    pub ground: Ground,
}

/// A new scene for a model.
#[derive(Clone, Debug, PartialEq)]
pub struct NewScene {
    /// The scene.
    pub scene: Scene,
    /// Whether another axis could just as well be up, so that a person should check.
    pub up_is_unsure: bool,
}

/// A scene with one model in front of a ground. A tenth of the picture stays free at each border, whatever the model's
/// size and position.
///
/// The model is the first object and is named after the file. But if it has no colours and from 2 to 12 groups, each
/// group is an object with the group's name, and the first of these is the parent of the others. Objects name the mesh
/// by its bare file name, so the scene must lie in the same folder. A model without colours gets one, chosen by its
/// name. With [`ViewFrom::Auto`], an open mesh that would show its back is seen from the side that shows most of its
/// front; if that is from below, there is no ground, since the floor would hide the mesh.
pub fn for_mesh(path: &Path, mesh: &MeshFile, placing: Placing) -> NewScene {
    let name = object_name(path);
    let name_hash = scheme::name_hash(&name);
    // glTF states that Y is up.
    let up = placing.up.or_else(|| gltf::is_gltf(path).then_some(Up::Y));
    let stance = Samples::of(mesh).stance(up, placing.view);
    let view = View::of(mesh, stance, placing.view == ViewFrom::Auto);
    let scheme = Scheme::of(&[mesh], name_hash);
    let mesh_name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
    let mut objects = objects_of(&name, &mesh_name, mesh, &scheme);
    for object in &mut objects {
        object.up = stance.up;
    }
    let taken: Vec<&str> = objects.iter().map(|object| object.name.as_str()).collect();
    // A floor would hide a model that is seen from below.
    let ground = if view.footing.axes.back.y > 0.0 { placing.ground } else { Ground::Plain };
    let laid = ground.lay(&view.footing, &scheme, &taken, name_hash);
    objects.extend(laid.object);
    let scene = Scene {
        seed: name_hash % 1000,
        background: laid.background,
        camera: view.camera(),
        lights: scheme.lights(view.footing.axes, view.footing.light_goes),
        objects,
        // Smaller strokes than usual: an unknown model may have much fine detail.
        strokes: StrokeSettings { scale: Some(0.7), ..Default::default() },
        regions: laid.regions,
        ..bare()
    };
    NewScene { scene, up_is_unsure: stance.up_is_unsure }
}

/// The model as one object. A model without colours becomes one object for each group, if it has from 2 to
/// [`MOST_COLORED_GROUPS`] groups.
fn objects_of(name: &str, mesh_name: &str, mesh: &MeshFile, scheme: &Scheme) -> Vec<Object> {
    let colored = |object: Object, color: Color| Object {
        material: Some(MaterialOverride { color: Some(color), gloss: Some(GLOSS), ..Default::default() }),
        ..object
    };
    let whole = Object::new(name, mesh_name);
    let Some(body) = scheme.body else { return vec![whole] };
    let groups = add::used_groups(mesh);
    if !(2..=MOST_COLORED_GROUPS).contains(&groups.len()) {
        return vec![colored(whole, Scheme::of_group(body, 0))];
    }
    let mut objects: Vec<Object> = Vec::new();
    for (index, group) in groups.into_iter().enumerate() {
        let taken = objects.iter().map(|object| object.name.as_str()).collect();
        let object = Object {
            group: Some(mesh.groups[group].clone()),
            parent: objects.first().map(|first: &Object| first.name.clone()),
            ..Object::new(add::object_name_of_group(&mesh.groups[group], name, &taken), mesh_name)
        };
        objects.push(colored(object, Scheme::of_group(body, index)));
    }
    objects
}

/// A scene with a camera, a sun and a sky, but no objects. An object about 1 high at the origin fills its picture.
pub fn empty() -> Scene {
    let (eye, target) = (DVec3::new(1.2, 1.15, 2.2), DVec3::new(0.0, 0.5, 0.0));
    let key = CameraKey {
        frame: 0.0,
        eye: eye.to_array(),
        target: target.to_array(),
        roll_deg: 0.0,
        fov_y_deg: None,
        ease: Ease::default(),
    };
    let from_sun = round_to(Axes::looking_from(eye - target).to_world(DVec3::new(0.6, -0.75, -0.55)), 1e-3);
    let sun = Light { direction: Some(from_sun.to_array()), ..light("sun", LightKind::Sun, "#fff1dc", 2.2) };
    Scene {
        camera: Camera { of_shot: None, lens: Lens::default(), keys: vec![key] },
        lights: vec![sun, light("sky", LightKind::Ambient, "#b9c8dc", 0.6)],
        ..bare()
    }
}

/// A light of this colour, without a direction or a position.
fn light(name: &str, kind: LightKind, hex: &str, intensity: f64) -> Light {
    Light { color: Color::from_hex(hex).unwrap_or_default(), intensity, ..Light::new(name, kind) }
}

/// A scene with nothing in it; its camera has no key.
fn bare() -> Scene {
    Scene {
        version: Scene::VERSION,
        size: SIZE_PX,
        seed: 0,
        background: Color::default(),
        background_keys: Vec::new(),
        exposure: 0.0,
        shot: None,
        stage: Default::default(),
        timeline: Timeline::default(),
        reference: Reference::default(),
        further_references: Vec::new(),
        camera: Camera { of_shot: None, lens: Lens::default(), keys: Vec::new() },
        lights: Vec::new(),
        objects: Vec::new(),
        strokes: StrokeSettings::default(),
        regions: Vec::new(),
        touches: Vec::new(),
        style: Default::default(),
        aovs: Vec::new(),
    }
}

fn object_name(path: &Path) -> String {
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().replace(char::is_control, " "));
    stem.map(|stem| stem.trim().to_owned())
        .filter(|stem| !stem.is_empty())
        .unwrap_or_else(|| "model".to_owned())
}

/// Rounds to multiples of the largest power of ten up to `step`, so that a person can read the numbers.
fn round_to(vector: DVec3, step: f64) -> DVec3 {
    vector.map(|component| round_at(component, step.log10().floor() as i32))
}

/// Rounds to two significant digits.
fn significant(value: f64) -> f64 {
    round_at(value, value.abs().max(f64::MIN_POSITIVE).log10().floor() as i32 - 1)
}

/// Rounds to a multiple of 10 to the power `exponent`. Dividing by a whole power of ten gives the float nearest to the
/// decimal number.
fn round_at(value: f64, exponent: i32) -> f64 {
    let rounded = if exponent < 0 {
        let scale = 10_f64.powi(-exponent);
        (value * scale).round() / scale
    } else {
        let scale = 10_f64.powi(exponent);
        (value / scale).round() * scale
    };
    // Not −0, which looks odd in a file.
    if rounded == 0.0 { 0.0 } else { rounded }
}

#[cfg(test)]
mod tests;
