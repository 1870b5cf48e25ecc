//! Tells where everything in a shot is at a given time, and what else its animations change.
//!
//! An [`Animator`] is made once and holds the tracks in the order in which they are used; [`Animator::pose`] is a pure
//! function of the time. All is computed in `f64`.

use std::hash::BuildHasher;
use std::sync::Arc;

use foldhash::{HashMap, HashMapExt};
use glam::{DAffine3, DMat4, DQuat, DVec3};

use crate::animation::{
    CameraProperty, Interpolation, LightProperty, MaterialProperty, NodeProperty, Target, Track,
};
use crate::camera_light::{Lens, LightValues};
use crate::finding::{Finding, Severity};
use crate::material::MaterialValues;
use crate::node::{LocalTransform, Skin, Trs};
use crate::read_node::parents_first;
use crate::{Gltf, keys};

/// Which animations move the shot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Playing<'a> {
    /// All of them together. If two of them drive the same property, the first one counts.
    All,
    /// The one with this name; the first, if several have it.
    Named(&'a str),
    /// None: the shot as it rests.
    None,
}

/// Evaluates a shot at any time.
#[derive(Clone, Debug)]
pub struct Animator {
    /// Nodes, parents before children.
    order: Vec<usize>,
    parents: Vec<Option<usize>>,
    locals: Vec<LocalTransform>,
    is_in_scene: Vec<bool>,
    rest: Posed,
    clocks: Vec<Arc<Vec<f32>>>,
    tracks: Vec<Playable>,
    span_s: Option<[f32; 2]>,
}

/// A track and the index of its clock. A clock is the list of a track's key times; tracks with equal times share one.
#[derive(Clone, Debug)]
struct Playable {
    track: Track,
    clock: usize,
}

/// A shot at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Posed {
    /// From the space of each node to the world. All are finite: a node whose scales outgrow `f64` stands where its
    /// parent does. The mesh of a node with a skin stands elsewhere: see [`Self::world_from_bound`].
    pub world_from_node: Vec<DAffine3>,
    /// For each node: whether it is in the scene that is shown, and neither it nor a node above it is hidden.
    pub is_visible: Vec<bool>,
    /// For each node: the weights of its mesh's morph targets.
    pub weights: Vec<Vec<f32>>,
    /// What each camera sees. Cameras stand at the nodes that name them.
    pub lenses: Vec<Lens>,
    /// The numbers of each light.
    pub lights: Vec<LightValues>,
    /// The numbers of each material.
    pub materials: Vec<MaterialValues>,
    locals: Vec<LocalTransform>,
}

impl Posed {
    /// For each joint of a skin, the matrix into the world from the space in which the mesh was bound. A vertex stands
    /// at the weighted mean of where its joints put it, wherever the node of the mesh is.
    pub fn world_from_bound(&self, skin: &Skin) -> Vec<DAffine3> {
        let matrix_of = |(&joint, inverse_bind): (&usize, &glam::Mat4)| {
            self.world_from_node[joint] * DAffine3::from_mat4(inverse_bind.as_dmat4())
        };
        skin.joints.iter().zip(&skin.inverse_bind_matrices).map(matrix_of).collect()
    }

    /// World from view (−Z forward, Y up) for a camera or light at a node: the node's place and turn without its scale,
    /// which glTF ignores for cameras and lights.
    pub fn world_from_view(&self, node: usize) -> DMat4 {
        let world = self.world_from_node[node];
        let back = world.matrix3.z_axis.try_normalize().unwrap_or(DVec3::Z);
        let up = world.matrix3.y_axis;
        let up = (up - back * up.dot(back)).try_normalize().unwrap_or_else(|| back.any_orthonormal_vector());
        let right = up.cross(back);
        DMat4::from_cols(right.extend(0.0), up.extend(0.0), back.extend(0.0), world.translation.extend(1.0))
    }
}

impl Animator {
    /// Puts the tracks of a shot in order. Returns warnings about properties that two animations drive.
    ///
    /// # Errors
    /// No animation has the name. The error lists the names that there are.
    pub fn new(gltf: &Gltf, playing: Playing<'_>) -> Result<(Self, Vec<Finding>), Vec<String>> {
        let chosen: Vec<usize> = match playing {
            Playing::All => (0..gltf.animations.len()).collect(),
            Playing::None => Vec::new(),
            Playing::Named(name) => {
                let names =
                    || gltf.animations.iter().map(|animation| animation.name.clone()).collect::<Vec<_>>();
                vec![gltf.animations.iter().position(|animation| animation.name == name).ok_or_else(names)?]
            }
        };
        let mut animator = Self::at_rest(gltf);
        let mut warnings = Vec::new();
        let mut driver: HashMap<Target, usize> = HashMap::new();
        let mut clocks = Clocks::default();
        for index in chosen {
            let animation = &gltf.animations[index];
            for track in &animation.tracks {
                let first = *driver.entry(track.target).or_insert(index);
                if first != index {
                    warnings.push(driven_twice(gltf, [first, index], track));
                    continue;
                }
                let clock = clocks.index(&track.times_s);
                animator.tracks.push(Playable { track: track.clone(), clock });
            }
            if let Some(own) = animation.span_s() {
                let [start, end] = animator.span_s.unwrap_or(own);
                animator.span_s = Some([start.min(own[0]), end.max(own[1])]);
            }
        }
        animator.clocks = clocks.list;
        // Sorted, so that memory is read in the order of the nodes.
        animator.tracks.sort_by_key(|playable| match playable.track.target {
            Target::Node(node, _) => node,
            _ => usize::MAX,
        });
        Ok((animator, warnings))
    }

    /// The times of all keys, seconds; a time may come several times.
    pub fn key_times_s(&self) -> impl Iterator<Item = f32> + '_ {
        self.clocks.iter().flat_map(|clock| clock.iter().copied())
    }

    /// Whether something is hidden or shown over time.
    pub fn changes_visibility(&self) -> bool {
        let drives =
            |playable: &Playable| matches!(playable.track.target, Target::Node(_, NodeProperty::Visible));
        self.tracks.iter().any(drives)
    }

    fn at_rest(gltf: &Gltf) -> Self {
        let order = parents_first(&gltf.nodes);
        let parents: Vec<Option<usize>> = gltf.nodes.iter().map(|node| node.parent).collect();
        let mut is_in_scene = vec![false; gltf.nodes.len()];
        gltf.roots.iter().for_each(|&root| is_in_scene[root] = true);
        for &node in &order {
            is_in_scene[node] |= parents[node].is_some_and(|parent| is_in_scene[parent]);
        }
        let weights = gltf.nodes.iter().map(|node| {
            let of_mesh = || node.mesh.map_or(Vec::new(), |mesh| gltf.meshes[mesh].weights.clone());
            node.weights.clone().unwrap_or_else(of_mesh)
        });
        let rest = Posed {
            world_from_node: vec![DAffine3::IDENTITY; gltf.nodes.len()],
            is_visible: gltf.nodes.iter().map(|node| node.is_visible).collect(),
            weights: weights.collect(),
            lenses: gltf.cameras.iter().map(|camera| camera.lens).collect(),
            lights: gltf.lights.iter().map(|light| light.values).collect(),
            materials: gltf.materials.iter().map(|material| material.values).collect(),
            locals: Vec::new(),
        };
        let locals = gltf.nodes.iter().map(|node| node.local).collect();
        Self {
            order,
            parents,
            locals,
            is_in_scene,
            rest,
            clocks: Vec::new(),
            tracks: Vec::new(),
            span_s: None,
        }
    }

    /// The first and the last key time of the animations that play, seconds; `None` without tracks.
    pub fn span_s(&self) -> Option<[f32; 2]> {
        self.span_s
    }

    /// Which nodes move: those whose translation, rotation or scale a track drives, and those below them.
    pub fn moving_nodes(&self) -> Vec<bool> {
        let mut moves = vec![false; self.parents.len()];
        for playable in &self.tracks {
            if let Target::Node(
                node,
                NodeProperty::Translation | NodeProperty::Rotation | NodeProperty::Scale,
            ) = playable.track.target
            {
                moves[node] = true;
            }
        }
        for &node in &self.order {
            moves[node] |= self.parents[node].is_some_and(|parent| moves[parent]);
        }
        moves
    }

    /// The shot at a time, seconds. Before the first and after the last key of a track, what it drives stands still.
    /// NaN counts as before the first key.
    pub fn pose(&self, time_s: f64) -> Posed {
        let mut posed = Posed::default();
        self.pose_into(time_s, &mut posed);
        posed
    }

    /// As [`Self::pose`], but reuses the memory of `posed`.
    pub fn pose_into(&self, time_s: f64, posed: &mut Posed) {
        posed.clone_from_rest(&self.rest, &self.locals);
        let places: Vec<keys::Place> =
            self.clocks.iter().map(|clock| keys::Place::at(clock, time_s)).collect();
        for Playable { track, clock } in &self.tracks {
            posed.drive(track, places[*clock]);
        }
        posed.lenses.iter_mut().for_each(settle_lens);
        for &node in &self.order {
            let local = posed.locals[node].parent_from_local();
            let Some(parent) = self.parents[node] else {
                posed.world_from_node[node] = local;
                continue;
            };
            let parent_world = posed.world_from_node[parent];
            let world = parent_world * local;
            posed.world_from_node[node] = if world.is_finite() { world } else { parent_world };
            posed.is_visible[node] &= posed.is_visible[parent];
        }
        for (is_visible, is_in_scene) in posed.is_visible.iter_mut().zip(&self.is_in_scene) {
            *is_visible &= is_in_scene;
        }
    }
}

/// The distinct lists of key times. Exporters write one list for each track, and nearly all are equal. Because equal
/// lists are shared, a time's place among the keys is looked up once per list instead of once per track.
#[derive(Default)]
struct Clocks {
    list: Vec<Arc<Vec<f32>>>,
    by_address: HashMap<*const Vec<f32>, usize>,
    by_content: HashMap<u64, usize>,
}

impl Clocks {
    fn index(&mut self, times_s: &Arc<Vec<f32>>) -> usize {
        if let Some(&known) = self.by_address.get(&Arc::as_ptr(times_s)) {
            return known;
        }
        let bits: Vec<u32> = times_s.iter().map(|time_s| time_s.to_bits()).collect();
        let hash = self.by_content.hasher().hash_one(&bits);
        let index = match self.by_content.get(&hash) {
            Some(&known) if self.list[known] == *times_s => known,
            _ => {
                self.list.push(times_s.clone());
                self.by_content.insert(hash, self.list.len() - 1);
                self.list.len() - 1
            }
        };
        self.by_address.insert(Arc::as_ptr(times_s), index);
        index
    }
}

fn driven_twice(gltf: &Gltf, [first, second]: [usize; 2], track: &Track) -> Finding {
    let what = match track.target {
        Target::Node(node, property) => format!("{property:?} of node {:?}", gltf.nodes[node].name),
        other => format!("{other:?}"),
    };
    let names = [first, second].map(|index| match gltf.animations[index].name.as_str() {
        "" => format!("animation {index}"),
        name => format!("{name:?}"),
    });
    Finding {
        severity: Severity::Warning,
        pointer: format!("/animations/{second}/channels/{}", track.channel),
        message: format!("{} drives {what}, which {} drives already", names[1], names[0]),
        mend: "name the animation to play".into(),
    }
}

impl Posed {
    fn clone_from_rest(&mut self, rest: &Posed, locals: &[LocalTransform]) {
        self.world_from_node.clone_from(&rest.world_from_node);
        self.is_visible.clone_from(&rest.is_visible);
        self.weights.clone_from(&rest.weights);
        self.lenses.clone_from(&rest.lenses);
        self.lights.clone_from(&rest.lights);
        self.materials.clone_from(&rest.materials);
        self.locals.clear();
        self.locals.extend_from_slice(locals);
    }

    fn drive(&mut self, track: &Track, place: keys::Place) {
        match track.target {
            Target::Node(node, NodeProperty::Weights) => {
                for (index, weight) in self.weights[node].iter_mut().enumerate() {
                    *weight = place.number(track, index) as f32;
                }
            }
            Target::Node(node, NodeProperty::Visible) => {
                self.is_visible[node] = place.number(track, 0) != 0.0
            }
            Target::Node(node, property) => {
                if let LocalTransform::Trs(trs) = &mut self.locals[node] {
                    drive_trs(trs, property, track, place);
                }
            }
            Target::Camera(camera, property) => {
                drive_lens(&mut self.lenses[camera], property, place.number(track, 0))
            }
            Target::Light(light, property) => drive_light(&mut self.lights[light], property, track, place),
            Target::Material(material, property) => {
                drive_material(&mut self.materials[material], property, track, place);
            }
        }
    }
}

fn drive_trs(trs: &mut Trs, property: NodeProperty, track: &Track, place: keys::Place) {
    let vector = || DVec3::from(place.numbers::<3>(track));
    match property {
        NodeProperty::Translation => trs.translation = vector(),
        NodeProperty::Scale => trs.scale = vector(),
        NodeProperty::Rotation => trs.rotation = rotation(track, place),
        NodeProperty::Weights | NodeProperty::Visible => {}
    }
}

/// The rotation at a place. No key is zero, which was checked when the file was read. A spline may pass through zero
/// between two keys; there the rotation is that of the earlier key.
fn rotation(track: &Track, place: keys::Place) -> DQuat {
    let key = |key| DQuat::from_array(place.key::<4>(track, key)).normalize();
    match track.interpolation {
        Interpolation::Step => key(place.reached),
        Interpolation::Linear => match place.fraction() {
            0.0 => key(place.before),
            fraction => key(place.before).slerp(key(place.before + 1), fraction).normalize(),
        },
        Interpolation::CubicSpline => {
            let turned = DQuat::from_array(place.numbers::<4>(track));
            if turned.length() > 1e-9 { turned.normalize() } else { key(place.before) }
        }
    }
}

/// Sets a property of a camera. A field of view is clamped. Any other value that is out of range by itself is ignored.
/// Near and far are compared by [`settle_lens`].
fn drive_lens(lens: &mut Lens, property: CameraProperty, value: f64) {
    match (lens, property) {
        (Lens::Perspective { yfov_rad, .. }, CameraProperty::Yfov) => {
            *yfov_rad = value.clamp(1e-4, std::f64::consts::PI - 1e-4);
        }
        (Lens::Orthographic { xmag, .. }, CameraProperty::Xmag) if value != 0.0 => *xmag = value.abs(),
        (Lens::Orthographic { ymag, .. }, CameraProperty::Ymag) if value != 0.0 => *ymag = value.abs(),
        (Lens::Perspective { znear, .. }, CameraProperty::Znear) if value > 0.0 => *znear = value,
        (Lens::Orthographic { znear, .. }, CameraProperty::Znear) if value >= 0.0 => *znear = value,
        (Lens::Perspective { zfar, .. }, CameraProperty::Zfar) if value > 0.0 => *zfar = Some(value),
        (Lens::Orthographic { zfar, .. }, CameraProperty::Zfar) if value > 0.0 => *zfar = value,
        _ => {}
    }
}

/// Mends a far plane that is not behind the near plane: drops it in perspective, else puts it one unit behind the near
/// plane.
fn settle_lens(lens: &mut Lens) {
    match lens {
        Lens::Perspective { znear, zfar, .. } => *zfar = zfar.filter(|far| far > znear),
        Lens::Orthographic { znear, zfar, .. } => {
            if *zfar <= *znear {
                *zfar = *znear + 1.0;
            }
        }
    }
}

fn drive_light(light: &mut LightValues, property: LightProperty, track: &Track, place: keys::Place) {
    use std::f64::consts::FRAC_PI_2;
    let number = || place.number(track, 0);
    match property {
        LightProperty::Color => {
            light.color = place.numbers::<3>(track).map(|channel| channel.max(0.0) as f32)
        }
        LightProperty::Intensity => light.intensity = number().max(0.0),
        LightProperty::Range => light.range_m = Some(number()).filter(|&range| range > 0.0),
        LightProperty::InnerConeAngle => light.inner_cone_rad = number().clamp(0.0, FRAC_PI_2),
        LightProperty::OuterConeAngle => light.outer_cone_rad = number().clamp(1e-4, FRAC_PI_2),
    }
}

fn drive_material(
    material: &mut MaterialValues,
    property: MaterialProperty,
    track: &Track,
    place: keys::Place,
) {
    let unit = |number: f64| number.clamp(0.0, 1.0) as f32;
    match property {
        MaterialProperty::BaseColor => material.base_color = place.numbers::<4>(track).map(unit),
        MaterialProperty::Metallic => material.metallic = unit(place.number(track, 0)),
        MaterialProperty::Roughness => material.roughness = unit(place.number(track, 0)),
        MaterialProperty::EmissiveFactor => material.emissive_factor = place.numbers::<3>(track).map(unit),
        MaterialProperty::EmissiveStrength => {
            material.emissive_strength = place.number(track, 0).max(0.0) as f32;
        }
    }
}
