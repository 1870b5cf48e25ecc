//! Commands on objects, lights and cameras: importing, moving, turning, scaling, materials, lens.

use std::path::Path;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};
use impasto_scene::document::{
    CameraKey, Dab, Direction, Lens, Light, LightKey, LightKind, MaterialOverride, Object, ObjectKey, Patch,
    Scene, Seed, Selector, Up,
};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::mesh_file::MeshFile;
use impasto_scene::motion::{self, CameraPose};
use impasto_scene::new_scene::{self, Placing};

use super::keys::KeyedValue;
use super::material::set_material;
use super::region::in_file;
use super::time::Time;
use super::{Command, Done, counted, finite, moved_by_shot, object_mut, posable_object, unlocked_object};
use crate::euler::{self, tidy};
use crate::names;
use crate::refusal::Refusal;
use crate::selection::{Item, Selection};

/// A move, turn and uniform scaling of whole motions (objects with all their keys), in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shift {
    /// Where each point of the world goes: a rotation, a uniform scale above 0 and a translation.
    pub world_from_world: DAffine3,
    /// The shift of a child is converted to its parent's space with the parent's pose at this frame.
    pub frame: f64,
}

/// One number of an object's pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PoseField {
    /// Translation along an axis: 0, 1, 2 for X, Y, Z.
    Move(usize),
    /// Euler angle about an axis, degrees.
    Turn(usize),
    /// The scale factor; if the scale is uneven, the geometric mean of its factors.
    Scale,
}

/// Objects, lights and cameras, and their poses.
#[derive(Clone, Debug, PartialEq)]
pub enum Arrange {
    /// Adds an object for a mesh file, with regions for its groups or materials, and selects it.
    Import {
        /// The mesh's path, relative to the scene's folder.
        mesh: String,
        /// What the file holds.
        file: Arc<MeshFile>,
    },
    /// Gives an object another mesh.
    ReplaceMesh {
        /// The object.
        object: String,
        /// The mesh's path, relative to the scene's folder.
        mesh: String,
    },
    /// Moves, turns and scales objects with all their keys; children follow.
    ShiftMotion {
        /// The objects.
        objects: Vec<String>,
        /// The move, turn and scaling.
        shift: Shift,
        /// What was done, in words: *Move*.
        verb: &'static str,
    },
    /// Stretches an object along its own axes, with what is painted on it.
    Stretch {
        /// The object.
        object: String,
        /// Factors, none 0.
        factors: DVec3,
    },
    /// Sets one number of an object's pose at a frame. All its keys shift, or scale, along.
    SetPoseField {
        /// The object.
        object: String,
        /// The frame.
        frame: f64,
        /// Which number.
        field: PoseField,
        /// Its new value; degrees for turns.
        value: f64,
    },
    /// Turns upright a mesh that was made with Z up, or turns it back.
    TurnUpright(String),
    /// Scales an object so that the longest side of its mesh has this length, in units of the object's own space.
    ScaleTo(String, f64),
    /// Sets or removes the material override of an object.
    SetMaterial(String, Option<MaterialOverride>),
    /// Sets the number of particles of an object; `None` computes it from the coverage.
    SetParticles(String, Option<u64>),
    /// Adds a light of a kind at one point of the world, aimed at another.
    AddLight {
        /// Its kind.
        kind: LightKind,
        /// Where a point light or a spot stands, and where the sun comes from.
        at: DVec3,
        /// What it shines on.
        toward: DVec3,
    },
    /// Changes a light.
    SetLight {
        /// Its name.
        name: String,
        /// Its new values; the name stays.
        light: Light,
        /// What changed, in words: *brighter*.
        what: String,
    },
    /// Sets the lens of the shot. Also removes the fields of view from the camera's keys, unless only the near and
    /// far depths change.
    SetLens(Lens),
    /// Gives the shot's camera this pose at a frame, by shifting all its keys. If both lenses are orthographic, the
    /// camera also takes the height of the pose's lens.
    SetCamera {
        /// The frame.
        frame: f64,
        /// The pose.
        pose: CameraPose,
    },
}

impl Arrange {
    pub(super) fn edit(&self, scene: &mut Scene, before: &LoadedScene) -> Result<Done, Refusal> {
        match self {
            Self::Import { mesh, file } => import(scene, before, mesh, file),
            Self::ReplaceMesh { object, mesh } => {
                unlocked_object(scene, object)?.mesh.clone_from(mesh);
                let name = mesh.rsplit(['/', '\\']).next().unwrap_or(mesh);
                Ok(Done::new(format!("Use {name}")))
            }
            Self::ShiftMotion { objects, shift, verb } => {
                shift_motion(scene, objects, shift)?;
                Ok(Done::new(format!("{verb} {}", counted(objects, "objects"))))
            }
            Self::Stretch { object, factors } => {
                if factors.to_array().iter().any(|factor| !factor.is_finite() || factor.abs() < 1e-6) {
                    return Err(Refusal::new("A size is a number above 0"));
                }
                let edited = unlocked_object(scene, object)?;
                let stretched = DVec3::from(edited.scale.0) * *factors;
                edited.scale.0 = stretched.map(tidy).to_array();
                carry_along(scene, object, DMat3::from_diagonal(*factors));
                Ok(Done::new(format!("Scale {object}")))
            }
            Self::SetPoseField { object, frame, field, value } => {
                set_pose_field(scene, object, *frame, *field, finite(*value)?)
            }
            Self::TurnUpright(name) => {
                let object = unlocked_object(scene, name)?;
                let (old, old_up) = (object.model_from_file(), object.up);
                object.up = if old_up == Up::Y { Up::Z } else { Up::Y };
                // Each axis of the file keeps its factor: the factors are turned with the axes, without their signs.
                let new_from_old = object.up.y_up_from_file() * old_up.y_up_from_file().transpose();
                let factors = new_from_old * DVec3::from(object.scale.0);
                object.scale.0 = factors.abs().to_array();
                let turn = object.model_from_file() * old.inverse();
                carry_along(scene, name, turn);
                Ok(Done::new(format!("Turn {name} upright")))
            }
            Self::ScaleTo(name, length) => {
                if !length.is_finite() || *length <= 0.0 {
                    return Err(Refusal::new("A size is a number above 0"));
                }
                let object = unlocked_object(scene, name)?;
                let file = before.meshes.get(&object.mesh);
                let (low, high) = file.and_then(|file| file.mesh.bounds()).unwrap_or_default();
                let size = object.model_from_file() * (high - low).as_dvec3();
                let factor = length / size.abs().max_element();
                if !factor.is_finite() {
                    return Err(Refusal::new(format!("{name} is a single point")));
                }
                object.scale.0 = object.scale.0.map(|side| tidy(side * factor));
                carry_along(scene, name, DMat3::from_diagonal(DVec3::splat(factor)));
                Ok(Done::new(format!("Scale {name}")))
            }
            Self::SetMaterial(name, material) => set_material(scene, name, material.clone()),
            Self::SetParticles(name, count) => {
                unlocked_object(scene, name)?.particles = *count;
                Ok(Done::new(format!("Particles of {name}")))
            }
            Self::AddLight { kind, at, toward } => Ok(add_light(scene, *kind, *at, *toward)),
            Self::SetLight { name, light, what } => {
                let known = scene.lights.iter_mut().find(|light| light.name == *name);
                let known = known.ok_or_else(|| Refusal::unknown("light", name))?;
                *known = Light {
                    name: name.clone(),
                    color: in_file(light.color),
                    ground: light.ground.map(in_file),
                    ..light.clone()
                };
                let words = if what.is_empty() { String::new() } else { format!(" {what}") };
                let mut capital = name.clone();
                if let Some(first) = capital.get_mut(0..1) {
                    first.make_ascii_uppercase();
                }
                Ok(Done::new(format!("{capital}{words}")))
            }
            Self::SetLens(lens) => {
                // What the picture holds: an angle or a height.
                let holds = |lens: &Lens| match lens {
                    Lens::Perspective { fov_y_deg, .. } => (Some(*fov_y_deg), None),
                    Lens::Orthographic { height, .. } => (None, Some(*height)),
                };
                let old = &scene.camera.lens;
                let depths_alone = lens != old && holds(old) == holds(lens);
                let is_of_a_kind = std::mem::discriminant(lens) == std::mem::discriminant(old);
                scene.camera.lens = lens.clone();
                // A field of view in a key would hide the one that was just set.
                for key in scene.camera.keys.iter_mut().filter(|_| !depths_alone) {
                    key.fov_y_deg = None;
                }
                Ok(Done::new(match lens {
                    _ if depths_alone => "Set near and far",
                    _ if !is_of_a_kind => "Set projection",
                    Lens::Perspective { .. } => "Set field of view",
                    Lens::Orthographic { .. } => "Set view height",
                }))
            }
            Self::SetCamera { frame, pose } => {
                set_camera(scene, *frame, pose)?;
                Ok(Done::new("Camera to this view").selecting(Selection::only(Item::Camera)))
            }
        }
    }
}

fn import(scene: &mut Scene, before: &LoadedScene, mesh: &str, file: &MeshFile) -> Result<Done, Refusal> {
    if mesh.trim().is_empty() {
        return Err(Refusal::new("That file has no name"));
    }
    // The camera frames the first object of a scene, if nobody has moved the camera.
    if scene.objects.is_empty() && scene.camera == new_scene::empty().camera {
        scene.camera = {
            let placing = Placing { up: Some(Up::Y), ..Placing::default() };
            new_scene::for_mesh(Path::new(mesh), file, placing).scene.camera
        };
    }
    let name = new_scene::add_mesh(scene, mesh, file, &before.meshes);
    let file_name = mesh.rsplit(['/', '\\']).next().unwrap_or(mesh);
    Ok(Done::new(format!("Import {file_name}")).selecting(Selection::only(Item::Object(name))))
}

fn shift_motion(scene: &mut Scene, objects: &[String], shift: &Shift) -> Result<(), Refusal> {
    if !shift.world_from_world.is_finite() || shift.world_from_world.matrix3.determinant() < 1e-18 {
        return Err(Refusal::new("A size is a number above 0"));
    }
    let poses = motion::poses_at(scene, shift.frame);
    for name in objects {
        let index = scene.objects.iter().position(|object| object.name == *name);
        let index = index.ok_or_else(|| Refusal::unknown("object", name))?;
        if has_ancestor_among(scene, index, objects) {
            continue;
        }
        let parent = scene.objects[index].parent.as_deref();
        let parent = parent.and_then(|parent| scene.objects.iter().position(|other| other.name == parent));
        let world_from_parent = parent.map_or(DAffine3::IDENTITY, |parent| poses[parent]);
        let in_parent = world_from_parent.inverse() * shift.world_from_world * world_from_parent;
        let object = posable_object(scene, name)?;
        if object.keys.is_empty() {
            object.keys.push(ObjectKey::at(0.0));
        }
        let factor = in_parent.matrix3.determinant().cbrt();
        let turn = in_parent.matrix3 * (1.0 / factor);
        for key in &mut object.keys {
            key.translation = in_parent.transform_point3(DVec3::from(key.translation)).map(tidy).to_array();
            if !turn.abs_diff_eq(DMat3::IDENTITY, 1e-12) {
                key.rotation_deg = euler::degrees(turn * euler::matrix(key.rotation_deg), key.rotation_deg);
            }
            key.scale = key.scale.times(factor, tidy);
        }
    }
    Ok(())
}

/// Whether an ancestor of the object with this index is among `objects`.
fn has_ancestor_among(scene: &Scene, index: usize, objects: &[String]) -> bool {
    let mut above = scene.objects[index].parent.as_deref();
    for _ in 0..scene.objects.len() {
        let Some(name) = above else { return false };
        if objects.iter().any(|object| object == name) {
            return true;
        }
        let parent = scene.objects.iter().find(|object| object.name == name);
        above = parent.and_then(|parent| parent.parent.as_deref());
    }
    false
}

/// Converts what is stated in an object's own space (guides, dabs, directions, touches) when that space changes.
fn carry_along(scene: &mut Scene, object: &str, new_from_old: DMat3) {
    let normal_matrix = new_from_old.inverse().transpose();
    let point = |at: &mut [f64; 3]| *at = (new_from_old * DVec3::from(*at)).map(tidy).to_array();
    let normal = |n: &mut [f64; 3]| {
        *n = (normal_matrix * DVec3::from(*n)).normalize_or(DVec3::from(*n)).map(tidy).to_array();
    };
    let factor = new_from_old.determinant().abs().cbrt();
    for region in &mut scene.regions {
        let is_its_own = region.on.object() == Some(object);
        if is_its_own {
            carry_selector(&mut region.on, factor, &point, &normal);
            match &mut region.direction {
                Direction::Toward(at) | Direction::Along(at) | Direction::Around(at) => point(at),
                _ => {}
            }
        }
        for amount in &mut region.amounts {
            let is_on_it = amount.object.as_deref() == Some(object) || amount.object.is_none() && is_its_own;
            for dab in amount.dabs.iter_mut().filter(|_| is_on_it) {
                point(&mut dab.at);
                normal(&mut dab.normal);
                dab.radius *= factor;
            }
        }
        for guide in &mut region.guides {
            if guide.object.as_deref() != Some(object) && !(guide.object.is_none() && is_its_own) {
                continue;
            }
            for at in &mut guide.points {
                point(&mut at.at);
                normal(&mut at.normal);
            }
            if let Some(view) = &mut guide.view {
                point(&mut view.eye);
                point(&mut view.target);
            }
            guide.radius *= factor;
        }
    }
    for touch in scene.touches.iter_mut().filter(|touch| touch.on == object) {
        for place in &mut touch.points {
            point(&mut place.at);
            normal(&mut place.normal);
        }
    }
}

fn carry_selector(
    selector: &mut Selector,
    factor: f64,
    point: &impl Fn(&mut [f64; 3]),
    normal: &impl Fn(&mut [f64; 3]),
) {
    let carry_dabs = |dabs: &mut [Dab]| {
        for dab in dabs {
            point(&mut dab.at);
            normal(&mut dab.normal);
            dab.radius *= factor;
        }
    };
    let carry_seed = |seed: &mut Seed| {
        point(&mut seed.at);
        normal(&mut seed.normal);
    };
    match selector {
        Selector::Dabs(_, dabs) => carry_dabs(dabs),
        Selector::Flood(_, seed, _) => carry_seed(seed),
        Selector::Several(_, patches) => {
            for patch in patches {
                match patch {
                    Patch::Dabs(dabs) => carry_dabs(dabs),
                    Patch::Flood(seed, _) => carry_seed(seed),
                    Patch::Whole | Patch::Group(_) | Patch::Material(_) => {}
                }
            }
        }
        Selector::Everything
        | Selector::Object(_)
        | Selector::Collection(_)
        | Selector::EachMaterial(_)
        | Selector::Group(..)
        | Selector::Material(..) => {}
    }
}

fn set_pose_field(
    scene: &mut Scene,
    name: &str,
    frame: f64,
    field: PoseField,
    value: f64,
) -> Result<Done, Refusal> {
    let now = motion::key_at(scene, object_mut(&mut scene.clone(), name)?, frame);
    let object: &mut Object = posable_object(scene, name)?;
    if object.keys.is_empty() {
        object.keys.push(ObjectKey::at(0.0));
    }
    const AXES: [&str; 3] = ["X", "Y", "Z"];
    let what = match field {
        PoseField::Move(axis) => {
            let by = value - now.translation[axis];
            object.keys.iter_mut().for_each(|key| key.translation[axis] = tidy(key.translation[axis] + by));
            AXES[axis].to_owned()
        }
        PoseField::Turn(axis) => {
            let by = value - now.rotation_deg[axis];
            object.keys.iter_mut().for_each(|key| key.rotation_deg[axis] = tidy(key.rotation_deg[axis] + by));
            format!("turn {}", AXES[axis])
        }
        PoseField::Scale => {
            if value <= 0.0 {
                return Err(Refusal::new("A size is a number above 0"));
            }
            let factor = value / now.scale.mean();
            object.keys.iter_mut().for_each(|key| key.scale = key.scale.times(factor, tidy));
            "scale".to_owned()
        }
    };
    Ok(Done::new(format!("Set {name} {what}")))
}

fn add_light(scene: &mut Scene, kind: LightKind, at: DVec3, toward: DVec3) -> Done {
    let wanted = match kind {
        LightKind::Sun => "sun",
        LightKind::Point => "lamp",
        LightKind::Spot => "spot",
        LightKind::Ambient => "sky",
    };
    let name = names::unique(wanted, scene.lights.iter().map(|light| light.name.as_str()));
    let round = |vector: DVec3| vector.map(|v| (v * 1e4).round() / 1e4).to_array();
    let light = Light {
        direction: matches!(kind, LightKind::Sun | LightKind::Spot)
            .then(|| round((toward - at).normalize_or(DVec3::new(0.4, -0.8, -0.45)))),
        position: matches!(kind, LightKind::Point | LightKind::Spot).then(|| round(at)),
        intensity: if kind == LightKind::Ambient { 0.5 } else { 1.5 },
        ..Light::new(name.clone(), kind)
    };
    scene.lights.push(light);
    Done::new(format!("Add {name}")).selecting(Selection::only(Item::Light(name)))
}

/// The command that gives a light the values of `stated`: as a key at the frame of `stated` if the light has keys, else
/// for the whole shot. `what` says in words what changed. `None` if there is no such light.
pub fn set_light(scene: &Scene, name: &str, stated: LightKey, what: &str) -> Option<Command> {
    let light = scene.lights.iter().find(|light| light.name == name)?;
    if !light.keys.is_empty() {
        let frame = stated.frame;
        return Some(Command::Time(Time::PutValue(KeyedValue::Light(name.to_owned(), stated), frame)));
    }
    let light = Light {
        intensity: stated.intensity.unwrap_or(light.intensity),
        color: stated.color.unwrap_or(light.color),
        ground: stated.ground.or(light.ground),
        direction: stated.direction.or(light.direction),
        position: stated.position.or(light.position),
        ..light.clone()
    };
    Some(Command::Arrange(Arrange::SetLight { name: name.to_owned(), light, what: what.to_owned() }))
}

fn set_camera(scene: &mut Scene, frame: f64, pose: &CameraPose) -> Result<(), Refusal> {
    if scene.has_camera_of_shot() {
        return Err(moved_by_shot(scene, "the camera"));
    }
    let now = motion::camera_at(scene, frame);
    let [eye_by, target_by] = [pose.eye - now.eye, pose.target - now.target];
    let roll_by = (pose.roll_rad - now.roll_rad).to_degrees();
    if scene.camera.keys.is_empty() {
        let [eye, target] = [now.eye, now.target].map(|at| at.to_array());
        let ease = Default::default();
        scene.camera.keys.push(CameraKey { frame, eye, target, roll_deg: 0.0, fov_y_deg: None, ease });
    }
    for key in &mut scene.camera.keys {
        key.eye = (DVec3::from(key.eye) + eye_by).map(tidy).to_array();
        key.target = (DVec3::from(key.target) + target_by).map(tidy).to_array();
        key.roll_deg = tidy(key.roll_deg + roll_by);
    }
    if let (Lens::Orthographic { height: of_shot, .. }, Lens::Orthographic { height, .. }) =
        (&mut scene.camera.lens, &pose.lens)
    {
        *of_shot = tidy(*height);
    }
    Ok(())
}
