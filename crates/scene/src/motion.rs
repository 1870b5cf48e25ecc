//! Evaluates keyframes: camera, objects, lights, strokes and background at any frame, as pure functions of the document
//! and the frame.

mod span;
mod values;

use std::collections::HashMap;

use glam::{DAffine3, DMat3, DMat4, DVec2, DVec3, EulerRot};
use impasto_core::bending::BendPose;
use impasto_gltf::Posed;

use crate::document::{Brought, CameraKey, Lens, Object, ObjectKey, Reference, Scale, Scene};
use crate::limits;
use span::Span;

pub use values::{background_at, light_at, lights_at, stroke_key_at};

/// The camera at one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraPose {
    /// The eye, world space.
    pub eye: DVec3,
    /// What it looks at, world space.
    pub target: DVec3,
    /// Turn of the camera about its gaze, radians in (−π, π], counter-clockwise as seen from behind the camera.
    pub roll_rad: f64,
    /// Shift of the lens: added to positions in the picture, in half heights of the picture, Y up.
    pub shift: DVec2,
    /// The lens, with the field of view of this frame.
    pub lens: Lens,
}

impl CameraPose {
    /// The camera with this matrix (world from view, without scale). It looks along −Z, and Y is up.
    fn of_matrix(world_from_view: DMat4, lens: Lens, shift: DVec2) -> Self {
        let eye = world_from_view.w_axis.truncate();
        let [up, back] = [world_from_view.y_axis, world_from_view.z_axis].map(|axis| axis.truncate());
        let unrolled = Self { eye, target: eye - back, roll_rad: 0.0, shift, lens };
        // Where the camera's up points in a view without roll. If it points straight up, there is no roll; if it points
        // to the left, the camera is turned counter-clockwise.
        let up = unrolled.view_from_world().transform_vector3(up);
        Self { roll_rad: (-up.x).atan2(up.y), ..unrolled }
    }

    /// World space to view space: right-handed, looking down −Z, Y up.
    ///
    /// The camera turns counter-clockwise by `roll_rad`, so a thing at the screen angle φ without roll shows at
    /// φ − roll. `check` refuses a gaze along the Y axis; for such a pose Z is used as up, so that the matrix is always
    /// finite.
    pub fn view_from_world(&self) -> DMat4 {
        let gaze = (self.target - self.eye).try_normalize().unwrap_or(DVec3::NEG_Z);
        let up = if gaze.cross(DVec3::Y).length_squared() > 1e-20 { DVec3::Y } else { DVec3::Z };
        let unrolled_from_world = glam::dcamera::rh::view::look_to_mat4(self.eye, gaze, up);
        DMat4::from_rotation_z(-self.roll_rad) * unrolled_from_world
    }
}

/// The camera at a frame; the frame may lie between two whole ones. The camera stands still before the first and after
/// the last key.
///
/// Eye, target, roll and field of view are interpolated as numbers, with the `ease` of the earlier key. A key without a
/// field of view keeps that of the key before it. Until a key states a field of view, the lens's own holds. Without
/// keys, the shot's camera is used, if the shot has one.
pub fn camera_at(scene: &Scene, frame: f64) -> CameraPose {
    let keys = &scene.camera.keys;
    if keys.is_empty()
        && let Some(shot) = &scene.stage.shot
        && let Some(seen) = shot.camera(frame / scene.timeline.fps, scene.size)
    {
        return CameraPose::of_matrix(seen.world_from_view, seen.lens, seen.shift);
    }
    let span = Span::at(keys, frame);
    let Some(span) = span else {
        return CameraPose {
            eye: DVec3::Z,
            target: DVec3::ZERO,
            roll_rad: 0.0,
            shift: DVec2::ZERO,
            lens: scene.camera.lens.clone(),
        };
    };
    let (left, right) = (&keys[span.left], &keys[span.right]);
    let lens = match scene.camera.lens {
        Lens::Perspective { fov_y_deg, near, far } => {
            let fov_at = |index: usize| fov_y_deg_at_key(&keys[..=index]).unwrap_or(fov_y_deg);
            let mixed = span.mix_within(fov_at(span.left), fov_at(span.right), limits::FOV_Y_DEG);
            Lens::Perspective { fov_y_deg: mixed, near, far }
        }
        Lens::Orthographic { .. } => scene.camera.lens.clone(),
    };
    CameraPose {
        eye: span.mix_vec3(left.eye, right.eye),
        target: span.mix_vec3(left.target, right.target),
        roll_rad: wrap_deg(span.mix(left.roll_deg, right.roll_deg)).to_radians(),
        shift: DVec2::ZERO,
        lens,
    }
}

/// The camera of a reference, and the frame whose object poses it uses.
pub fn referred_to(scene: &Scene, reference: &Reference) -> (CameraPose, f64) {
    match *reference {
        Reference::Frame(frame) => (camera_at(scene, frame as f64), frame as f64),
        Reference::View { eye, target, roll_deg, fov_y_deg, frame } => {
            let lens = match camera_at(scene, frame as f64).lens {
                Lens::Perspective { fov_y_deg: usual, near, far } => {
                    Lens::Perspective { fov_y_deg: fov_y_deg.unwrap_or(usual), near, far }
                }
                lens @ Lens::Orthographic { .. } => lens,
            };
            let roll_rad = wrap_deg(roll_deg).to_radians();
            (
                CameraPose {
                    eye: DVec3::from(eye),
                    target: DVec3::from(target),
                    roll_rad,
                    shift: DVec2::ZERO,
                    lens,
                },
                frame as f64,
            )
        }
    }
}

/// The field of view in force at the last of these keys, degrees.
fn fov_y_deg_at_key(keys: &[CameraKey]) -> Option<f64> {
    keys.iter().rev().find_map(|key| key.fov_y_deg)
}

/// `world_from_model` of every object, in the order of the file: rotation, translation and scale. Keys are in the space
/// of the parent, which may come later in the file; a pose of the shot is in world space already.
///
/// Takes time and memory proportional to the number of objects and follows chains of any depth. An unknown parent, or
/// one that closes a cycle, counts as none (`check` refuses both).
pub fn poses_at(scene: &Scene, frame: f64) -> Vec<DAffine3> {
    let objects = &scene.objects;
    let mut parents = parent_indices(objects);
    let mut of_shot = ShotPoses::default();
    let mut pose = |(object, parent): (&Object, &mut Option<usize>)| {
        let held = held_frame(scene, object, frame);
        let brought = of_shot.pose_in_world(scene, object, held);
        if brought.is_some() {
            *parent = None;
        }
        brought.unwrap_or_else(|| pose_in_parent(&object.keys, held))
    };
    let mut poses: Vec<DAffine3> = objects.iter().zip(&mut parents).map(&mut pose).collect();
    for index in parents_first(&parents) {
        if let Some(parent) = parents[index] {
            poses[index] = poses[parent] * poses[index];
        }
    }
    poses
}

/// For each object, whether it is hidden at a frame: by the document, or by the shot.
pub fn hidden_at(scene: &Scene, frame: f64) -> Vec<bool> {
    let shot = scene.stage.shot.as_ref().filter(|shot| shot.changes_visibility());
    let of_shot = shot.map(|shot| (shot, shot.at(frame / scene.timeline.fps)));
    let is_shown =
        |object: &Object| of_shot.as_ref().is_none_or(|(shot, posed)| shot.is_visible(posed, &object.name));
    scene.objects.iter().map(|object| object.hidden || !is_shown(object)).collect()
}

/// The poses of a shot at the frames that were asked for, each evaluated once.
#[derive(Default)]
struct ShotPoses {
    at_frames: Vec<(f64, Posed)>,
}

impl ShotPoses {
    /// World from model of an object without keys of its own, at a frame; `None` where no shot moves it.
    fn pose_in_world(&mut self, scene: &Scene, object: &Object, frame: f64) -> Option<DAffine3> {
        let shot = scene
            .stage
            .shot
            .as_ref()
            .filter(|shot| object.keys.is_empty() && shot.has_object(&object.name))?;
        shot.pose_of(self.at(scene, &**shot, frame), &object.name)
    }

    fn at(&mut self, scene: &Scene, shot: &dyn Brought, frame: f64) -> &Posed {
        let known = self.at_frames.iter().position(|(other, _)| *other == frame);
        let index = known.unwrap_or_else(|| {
            self.at_frames.push((frame, shot.at(frame / scene.timeline.fps)));
            self.at_frames.len() - 1
        });
        &self.at_frames[index].1
    }
}

/// How the shot bends every object by joints and shape keys, in the order of the file; `None` for objects that it does
/// not bend. The shot bends an object even if the object has keys of its own.
pub fn bends_at(scene: &Scene, frame: f64) -> Vec<Option<BendPose>> {
    let Some(shot) = &scene.stage.shot else { return vec![None; scene.objects.len()] };
    let mut of_shot = ShotPoses::default();
    let bend = |object: &Object| {
        if !shot.bends(&object.name, &object.mesh) {
            return None;
        }
        let posed = of_shot.at(scene, &**shot, held_frame(scene, object, frame));
        shot.bend_of(posed, &object.name, &object.mesh)
    };
    scene.objects.iter().map(bend).collect()
}

/// Whether joints, shape keys, a morph or a point cache may bend an object.
pub fn bends(scene: &Scene, object: &Object) -> bool {
    let by_shot = scene.stage.shot.as_ref().is_some_and(|shot| shot.bends(&object.name, &object.mesh));
    by_shot || object.cache.is_some() || object.morph.is_some()
}

/// For each object, in the order of the file, the frame at which its point cache is sampled: the frame whose pose the
/// object holds.
pub fn cache_frames_at(scene: &Scene, frame: f64) -> Vec<f64> {
    scene.objects.iter().map(|object| held_frame(scene, object, frame)).collect()
}

/// The morph weight of every object, in the order of the file: 0 is its own mesh, 1 its morph target.
pub fn morphs_at(scene: &Scene, frame: f64) -> Vec<f64> {
    let weight = |object: &Object| {
        let span = Span::at(&object.keys, held_frame(scene, object, frame));
        let at = |index: usize| object.keys[index].morph;
        span.map_or(0.0, |span| span.mix_within(at(span.left), at(span.right), 0.0..=1.0))
    };
    scene.objects.iter().map(weight).collect()
}

/// The greatest morph weight that the keys of an object give it at any frame.
pub fn farthest_morph(object: &Object) -> f64 {
    let pairs = object.keys.windows(2).flat_map(|pair| {
        let between =
            |share| Span { left: 0, right: 1, share }.mix_within(pair[0].morph, pair[1].morph, 0.0..=1.0);
        pair[0].ease.reach().map(between)
    });
    object.keys.iter().map(|key| key.morph).chain(pairs).fold(0.0, f64::max)
}

/// The time of every object in seconds since frame 0, in the order of the file. An object that holds its pose holds its
/// time too.
pub fn seconds_at(scene: &Scene, frame: f64) -> Vec<f64> {
    scene.objects.iter().map(|object| held_frame(scene, object, frame) / scene.timeline.fps).collect()
}

/// The frame whose pose an object shows: with `hold`, the last frame in which its pose changed.
fn held_frame(scene: &Scene, object: &Object, frame: f64) -> f64 {
    let first = scene.timeline.first as f64;
    match object.hold {
        0 | 1 => frame,
        hold => first + ((frame - first) / f64::from(hold)).floor() * f64::from(hold),
    }
}

/// For each object, the index of its parent. If several objects have the parent's name, the first one is taken. A
/// parent that closes a cycle is left out.
pub(crate) fn parent_indices(objects: &[Object]) -> Vec<Option<usize>> {
    if objects.iter().all(|object| object.parent.is_none()) {
        return vec![None; objects.len()];
    }
    let mut index_of_name = HashMap::with_capacity(objects.len());
    for (index, object) in objects.iter().enumerate() {
        index_of_name.entry(object.name.as_str()).or_insert(index);
    }
    let find = |object: &Object| object.parent.as_deref().and_then(|name| index_of_name.get(name).copied());
    let mut parents: Vec<Option<usize>> = objects.iter().map(find).collect();
    for index in cycle_closers(&parents) {
        parents[index] = None;
    }
    parents
}

/// One object of every cycle of parents, each cycle once, in the order of the file.
pub(crate) fn cycle_closers(parents: &[Option<usize>]) -> Vec<usize> {
    // For each object, the start of the walk that visited it first. A walk that meets itself has found a cycle.
    let mut walk_of = vec![usize::MAX; parents.len()];
    let mut closers = Vec::new();
    for start in 0..parents.len() {
        let mut at = start;
        while walk_of[at] == usize::MAX {
            walk_of[at] = start;
            match parents[at] {
                Some(parent) if walk_of[parent] == start => closers.push(parent),
                Some(parent) => at = parent,
                None => break,
            }
        }
    }
    closers.sort_unstable();
    closers
}

/// An order in which every parent comes before its children. `parents` has no cycles.
fn parents_first(parents: &[Option<usize>]) -> Vec<usize> {
    let mut order = Vec::with_capacity(parents.len());
    let mut placed = vec![false; parents.len()];
    let mut chain = Vec::new();
    for start in 0..parents.len() {
        let mut at = Some(start);
        while let Some(index) = at.filter(|&index| !placed[index]) {
            placed[index] = true;
            chain.push(index);
            at = parents[index];
        }
        order.extend(chain.drain(..).rev());
    }
    order
}

/// The pose that keys give at a frame; the identity without keys.
fn pose_in_parent(keys: &[ObjectKey], frame: f64) -> DAffine3 {
    let Some(span) = Span::at(keys, frame) else {
        return DAffine3::IDENTITY;
    };
    let (left, right) = (&keys[span.left], &keys[span.right]);
    let rotation = rotation_from_euler_deg(span.mix_vec3(left.rotation_deg, right.rotation_deg));
    let scale = scale_between(&span, left, right);
    // An even scale needs no product of matrices.
    let [x, y, z] = scale.0;
    let matrix = if x == y && y == z { rotation * x } else { rotation * scale.matrix() };
    DAffine3::from_mat3_translation(matrix, span.mix_vec3(left.translation, right.translation))
}

/// The scale between two keys; where the ease overshoots, it is clamped to [`limits::KEY_SCALE`].
fn scale_between(span: &Span, left: &ObjectKey, right: &ObjectKey) -> Scale {
    let (left, right) = (left.scale.0, right.scale.0);
    Scale(std::array::from_fn(|axis| span.mix_within(left[axis], right[axis], limits::KEY_SCALE)))
}

/// An object's pose at a frame as a key, in its parent's space; in world space if the shot moves it.
pub fn key_at(scene: &Scene, object: &Object, frame: f64) -> ObjectKey {
    let held = held_frame(scene, object, frame);
    let Some(span) = Span::at(&object.keys, held) else {
        let brought = ShotPoses::default().pose_in_world(scene, object, held);
        return brought.map_or(ObjectKey::at(frame), |pose| key_of_pose(pose, frame));
    };
    let (left, right) = (&object.keys[span.left], &object.keys[span.right]);
    ObjectKey {
        frame,
        translation: span.mix_vec3(left.translation, right.translation).to_array(),
        rotation_deg: span.mix_vec3(left.rotation_deg, right.rotation_deg).to_array(),
        scale: scale_between(&span, left, right),
        morph: span.mix_within(left.morph, right.morph, 0.0..=1.0),
        ease: left.ease,
    }
}

/// A pose as a key at a frame. Shear and mirroring are lost. A mirrored or flattened pose loses its rotation too. The
/// scale is clamped to [`limits::KEY_SCALE`].
pub fn key_of_pose(pose: DAffine3, frame: f64) -> ObjectKey {
    let [x, y, z] = [pose.matrix3.x_axis, pose.matrix3.y_axis, pose.matrix3.z_axis];
    let scale = DVec3::new(x.length(), y.length(), z.length());
    let axes = DMat3::from_cols(x / scale.x, y / scale.y, z / scale.z);
    let rotation = if axes.is_finite() && axes.determinant() > 0.0 { axes } else { DMat3::IDENTITY };
    let even = scale.max_element() - scale.min_element() < 1e-9 * scale.max_element();
    let [least, most] = [limits::KEY_SCALE.start(), limits::KEY_SCALE.end()].map(|&end| DVec3::splat(end));
    let scale = if even { DVec3::splat(pose.matrix3.determinant().abs().cbrt()) } else { scale };
    ObjectKey {
        translation: pose.translation.to_array(),
        rotation_deg: euler_deg_from_rotation(rotation).to_array(),
        scale: Scale(scale.clamp(least, most).to_array()),
        ..ObjectKey::at(frame)
    }
}

/// The rotation of Euler angles in degrees: about X first, then Y, then Z (R = Rz·Ry·Rx).
pub fn rotation_from_euler_deg(angles_deg: DVec3) -> DMat3 {
    let (sin_x, cos_x) = sin_cos_deg(angles_deg.x);
    let (sin_y, cos_y) = sin_cos_deg(angles_deg.y);
    let (sin_z, cos_z) = sin_cos_deg(angles_deg.z);
    let about_x = DMat3::from_cols(DVec3::X, DVec3::new(0.0, cos_x, sin_x), DVec3::new(0.0, -sin_x, cos_x));
    let about_y = DMat3::from_cols(DVec3::new(cos_y, 0.0, -sin_y), DVec3::Y, DVec3::new(sin_y, 0.0, cos_y));
    let about_z = DMat3::from_cols(DVec3::new(cos_z, sin_z, 0.0), DVec3::new(-sin_z, cos_z, 0.0), DVec3::Z);
    about_z * (about_y * about_x)
}

/// The Euler angles in degrees from which [`rotation_from_euler_deg`] makes this rotation. If the angle about Y is ±90,
/// one of the other two angles is arbitrary; it is set to 0.
pub fn euler_deg_from_rotation(rotation: DMat3) -> DVec3 {
    let (z, y, x) = rotation.to_euler(EulerRot::ZYX);
    DVec3::new(x, y, z).map(f64::to_degrees)
}

/// The same angle in (−180, 180], without rounding: 360 gives exactly 0, so that loops close bit for bit.
fn wrap_deg(angle_deg: f64) -> f64 {
    let within_a_turn = angle_deg % 360.0;
    if within_a_turn > 180.0 {
        within_a_turn - 360.0
    } else if within_a_turn <= -180.0 {
        within_a_turn + 360.0
    } else {
        within_a_turn
    }
}

/// Sine and cosine of degrees, exact at multiples of 90.
fn sin_cos_deg(angle_deg: f64) -> (f64, f64) {
    let wrapped_deg = wrap_deg(angle_deg);
    if wrapped_deg == 0.0 {
        (0.0, 1.0)
    } else if wrapped_deg == 90.0 {
        (1.0, 0.0)
    } else if wrapped_deg == 180.0 {
        (0.0, -1.0)
    } else if wrapped_deg == -90.0 {
        (-1.0, 0.0)
    } else {
        wrapped_deg.to_radians().sin_cos()
    }
}

#[cfg(test)]
mod shot_tests;
#[cfg(test)]
mod tests;
