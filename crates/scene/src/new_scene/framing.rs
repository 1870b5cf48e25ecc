//! Where the camera of a new scene stands, so that the model and the beginning of its shadow fill the picture.

use glam::{DMat3, DVec3};

use super::axes::Axes;
use super::stance::Stance;
use super::{SIZE_PX, round_at, round_to, significant};
use crate::built_in_mesh;
use crate::document::{Camera, CameraKey, Ease, Lens, Object, ObjectKey, Scale};
use crate::mesh_file::MeshFile;

/// Vertical field of view, degrees: narrow enough not to distort forms.
const FOV_Y_DEG: f64 = 35.0;

/// Share of the picture that stays free at each border.
const MARGIN: f64 = 0.1;

/// Scale of the backdrop, in diagonals of the mesh: large enough to fill the picture.
const BACKDROP_SCALE: f64 = 3.0;

/// Scale of a patch of floor, and how far its middle lies to the side where the shadow falls, in diagonals of the mesh.
const PATCH_SCALE: f64 = 0.52;
const PATCH_SHIFT: f64 = 0.14;

/// Length of the shadow on the floor, divided by the height of what casts it, and the share of that length that is
/// framed with the model. The end of a long shadow may leave the picture.
const SHADOW_SLOPE: f64 = 1.2;
const FRAMED_SHADOW: f64 = 0.3;

/// A camera pose that frames a mesh.
#[derive(Debug)]
pub(super) struct View {
    eye: DVec3,
    target: DVec3,
    near: f64,
    far: f64,
    pub footing: Footing,
}

/// Where a ground lies, and how it is turned.
#[derive(Clone, Copy, Debug)]
pub(super) struct Footing {
    pub axes: Axes,
    /// The middle of the model's underside, world space.
    pub foot: DVec3,
    /// The diagonal of the model's bounds.
    pub size: f64,
    /// 1 if the sun's light goes to the right of the picture, −1 if it goes to the left.
    pub light_goes: f64,
}

impl View {
    /// The view of a mesh in this stance. With `may_turn`, an open mesh that would show its back is seen from the side
    /// that shows the most of its front.
    pub fn of(mesh: &MeshFile, stance: Stance, may_turn: bool) -> Self {
        let turn = stance.up.y_up_from_file();
        let points: Vec<DVec3> = used_points(mesh).map(|point| turn * point).collect();
        let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let (low, high) = if points.is_empty() { (DVec3::ZERO, DVec3::ZERO) } else { (low, high) };
        let center = (low + high) / 2.0;
        let size = diagonal(low, high);
        let axes = Axes::looking_from(if may_turn { facing(mesh, turn, stance.view) } else { stance.view });
        let along_floor = (axes.right - DVec3::Y * axes.right.y).normalize_or_zero();
        let shadow = |point: &DVec3| {
            let rise = point.y - low.y;
            *point - DVec3::Y * rise + along_floor * (stance.light_goes * rise * SHADOW_SLOPE * FRAMED_SHADOW)
        };
        let has_floor = axes.back.y > 0.0;
        let framed = points.iter().copied().chain(points.iter().filter(|_| has_floor).map(shadow));
        let framing = Framing::of(framed.map(|point| axes.to_camera(point - center) / size));
        let round = |point: DVec3| round_to(center + point * size, size * 1e-4);
        let eye_in_camera = framing.eye;
        let target_in_camera = eye_in_camera.with_z(0.0);
        let eye_height = axes.to_world(eye_in_camera).y + (center.y - low.y) / size;
        let nearest = framing.nearest.min(floor_depth(axes, eye_height));
        Self {
            eye: round(axes.to_world(eye_in_camera)),
            target: round(axes.to_world(target_in_camera)),
            near: significant(nearest * size * 0.5),
            far: significant((framing.farthest + BACKDROP_SCALE) * size * 2.0),
            footing: Footing::of_bounds(low, high, axes, stance.light_goes),
        }
    }

    pub fn camera(&self) -> Camera {
        Camera {
            of_shot: None,
            lens: Lens::Perspective { fov_y_deg: FOV_Y_DEG, near: self.near, far: self.far },
            keys: vec![CameraKey {
                frame: 0.0,
                eye: self.eye.to_array(),
                target: self.target.to_array(),
                roll_deg: 0.0,
                fov_y_deg: None,
                ease: Ease::default(),
            }],
        }
    }
}

impl Footing {
    /// The footing under a model with these bounds, world space.
    pub fn of_bounds(low: DVec3, high: DVec3, axes: Axes, light_goes: f64) -> Self {
        let center = (low + high) / 2.0;
        Self { axes, foot: center.with_y(low.y), size: diagonal(low, high), light_goes }
    }

    /// A floor under the mesh and a wall behind it, turned to the eye.
    pub fn backdrop(&self, name: &str) -> Object {
        self.under_the_mesh(Object::new(name, built_in_mesh::BACKDROP), BACKDROP_SCALE, 0.0)
    }

    /// A round piece of floor under the mesh and its shadow.
    pub fn patch(&self, name: &str) -> Object {
        self.under_the_mesh(Object::new(name, built_in_mesh::PATCH), PATCH_SCALE, PATCH_SHIFT)
    }

    /// Places `object` under the mesh. `scale` and `shift` are in diagonals of the mesh; the shift is to the side where
    /// the light goes.
    fn under_the_mesh(&self, object: Object, scale: f64, shift: f64) -> Object {
        let yaw_deg = self.axes.back.x.atan2(self.axes.back.z).to_degrees();
        let right = self.axes.right.with_y(0.0).normalize_or_zero();
        // A little below the mesh, so that a flat mesh lies on it.
        let at = self.foot - DVec3::Y * (0.002 * self.size) + right * (shift * self.light_goes * self.size);
        Object {
            scale: Scale([significant(scale * self.size); 3]),
            keys: vec![ObjectKey {
                translation: round_to(at, self.size * 1e-4).to_array(),
                rotation_deg: [0.0, round_at(yaw_deg, -1), 0.0],
                ..ObjectKey::at(0.0)
            }],
            ..object
        }
    }
}

/// The diagonal of a box; 1 for a mesh that is a single point, so that it still gets a camera and a ground.
fn diagonal(low: DVec3, high: DVec3) -> f64 {
    let size = (high - low).length();
    if size > 0.0 && size.is_finite() { size } else { 1.0 }
}

/// The depth at which the lower border of the picture meets the floor, for an eye at this height over the floor;
/// infinite if they do not meet.
fn floor_depth(axes: Axes, eye_height: f64) -> f64 {
    let fall = axes.back.y + (FOV_Y_DEG.to_radians() / 2.0).tan() * axes.up.y;
    if fall > 0.0 && eye_height > 0.0 { eye_height / fall } else { f64::INFINITY }
}

/// The direction from the mesh to the eye: `usual`, unless the mesh is open and would show its back there.
fn facing(mesh: &MeshFile, turn: DMat3, usual: DVec3) -> DVec3 {
    let mut area_vector = DVec3::ZERO;
    let mut area = 0.0;
    for triangle in 0..mesh.mesh.triangles.len() {
        let [a, b, c] = mesh.mesh.corners(triangle).map(|corner| turn * corner.as_dvec3());
        let normal = (b - a).cross(c - a);
        area_vector += normal;
        area += normal.length();
    }
    let openness = area_vector / area;
    let is_open = openness.length() > 0.25;
    if !is_open || openness.dot(usual) > 0.0 {
        return usual;
    }
    let signs = [1.0, -1.0];
    let sides = signs.iter().flat_map(|&x| signs.map(|z| DVec3::new(x, 1.0, z)));
    let from_below = signs.iter().flat_map(|&x| signs.map(|z| DVec3::new(x, -1.0, z)));
    let views = sides.chain(from_below).map(|sign| usual * sign);
    views.fold(usual, |best, view| if view.dot(openness) > best.dot(openness) + 1e-6 { view } else { best })
}

pub(super) fn used_points(mesh: &MeshFile) -> impl Iterator<Item = DVec3> {
    mesh.mesh.triangles.iter().flatten().map(|&vertex| mesh.mesh.positions[vertex as usize].as_dvec3())
}

/// The nearest eye that sees all points inside the margin. All lengths are in diagonals of the mesh.
#[derive(Debug)]
struct Framing {
    /// From the mesh's centre, along the camera's axes.
    eye: DVec3,
    /// Least and greatest depth of a point, from the eye.
    nearest: f64,
    farthest: f64,
}

impl Framing {
    /// A point is inside where |x − eye.x| ≤ t·(eye.z − z), with t the slope of the ray along the margin's inner
    /// border. So the maxima of x + t·z and −x + t·z over all points give the nearest eye; likewise for y.
    fn of(points: impl Iterator<Item = DVec3>) -> Self {
        let slope_y = (FOV_Y_DEG.to_radians() / 2.0).tan() * (1.0 - 2.0 * MARGIN);
        let slope_x = slope_y * f64::from(SIZE_PX.0) / f64::from(SIZE_PX.1);
        let mut reach = [f64::NEG_INFINITY; 4];
        let mut depth = (f64::INFINITY, f64::NEG_INFINITY);
        for point in points {
            let reaches = [
                point.x + slope_x * point.z,
                -point.x + slope_x * point.z,
                point.y + slope_y * point.z,
                -point.y + slope_y * point.z,
            ];
            reach = std::array::from_fn(|side| reach[side].max(reaches[side]));
            depth = (depth.0.min(point.z), depth.1.max(point.z));
        }
        if !depth.0.is_finite() {
            (reach, depth) = ([0.0; 4], (0.0, 0.0));
        }
        let [right, left, top, bottom] = reach;
        let distance = ((right + left) / (2.0 * slope_x)).max((top + bottom) / (2.0 * slope_y));
        // The eye stays a little in front of the nearest point, even if the mesh is a single point.
        let distance = distance.max(depth.1 + 0.05);
        let eye = DVec3::new((right - left) / 2.0, (top - bottom) / 2.0, distance);
        Self { eye, nearest: distance - depth.1, farthest: distance - depth.0 }
    }
}
