//! New scenes: for a bare mesh, with a camera that frames it, a warm sun, a cool sky and a backdrop; and an empty one.

mod add;

use std::path::Path;

use glam::DVec3;

use crate::built_in_mesh;
use crate::document::{
    Camera, CameraKey, Color, Direction, Ease, Lens, Light, LightKind, Object, ObjectKey, Region, Scale,
    Scene, Selector, StrokeSettings, Timeline,
};
use crate::mesh_file::MeshFile;

pub use add::{REGION_COLORS, add_mesh, regions_of};

/// Vertical field of view, degrees: narrow enough not to distort forms.
const FOV_Y_DEG: f64 = 35.0;

/// Share of the picture that stays free at each border.
const MARGIN: f64 = 0.08;

/// Size of the backdrop, as a multiple of the diagonal of the mesh; with this it fills the picture.
const BACKDROP_SCALE: f64 = 3.0;
const BACKDROP_NAME: &str = "backdrop";

/// Width and height in pixels.
const SIZE_PX: (u32, u32) = (1280, 720);

/// A scene with one object before a backdrop, framed with a margin of 8 % whatever its size and position.
///
/// The object comes first and is named after the file. Its mesh is the file's bare name, so the scene belongs into the
/// same folder. An open mesh that shows its back to the usual viewpoint is seen from the other side; if that is from
/// below, there is no backdrop, since its floor would hide the mesh.
pub fn for_mesh(path: &Path, mesh: &MeshFile) -> Scene {
    let name = object_name(path);
    let view = View::of(mesh);
    let mesh_name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
    let mut objects = vec![Object::new(name.clone(), mesh_name)];
    let mut regions = Vec::new();
    if view.axes.back.y > 0.0 {
        let backdrop_name = if name == BACKDROP_NAME { "wall" } else { BACKDROP_NAME };
        objects.push(view.backdrop(backdrop_name));
        regions.push(Region {
            direction: Direction::Crossing(-58.0, 4.0),
            strokes: StrokeSettings { scale: Some(2.0), color_jitter: Some(0.7), ..Default::default() },
            ..Region::new(backdrop_name, Selector::Object(backdrop_name.to_owned()))
        });
    }
    Scene {
        version: Scene::VERSION,
        size: SIZE_PX,
        seed: 0,
        background: Color::default(),
        timeline: Timeline::default(),
        reference: Default::default(),
        further_references: Vec::new(),
        camera: view.camera(),
        lights: view.axes.lights(),
        objects,
        // Smaller strokes than usual: an unknown model may have much fine detail.
        strokes: StrokeSettings { scale: Some(0.7), ..Default::default() },
        regions,
        style: Default::default(),
    }
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
    Scene {
        version: Scene::VERSION,
        size: SIZE_PX,
        seed: 0,
        background: Color::default(),
        timeline: Timeline::default(),
        reference: Default::default(),
        further_references: Vec::new(),
        camera: Camera { lens: Lens::default(), keys: vec![key] },
        lights: Axes::looking_from(eye - target).lights(),
        objects: Vec::new(),
        strokes: StrokeSettings::default(),
        regions: Vec::new(),
        style: Default::default(),
    }
}

fn object_name(path: &Path) -> String {
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().replace(char::is_control, " "));
    stem.map(|stem| stem.trim().to_owned())
        .filter(|stem| !stem.is_empty())
        .unwrap_or_else(|| "model".to_owned())
}

/// A camera pose that frames a mesh.
#[derive(Debug)]
struct View {
    eye: DVec3,
    target: DVec3,
    near: f64,
    far: f64,
    axes: Axes,
    /// The middle of the underside of the mesh's bounds, world space.
    foot: DVec3,
    /// The diagonal of the mesh's bounds.
    size: f64,
}

/// The camera's axes in world space, unit vectors.
#[derive(Clone, Copy, Debug)]
struct Axes {
    right: DVec3,
    up: DVec3,
    /// From the target to the eye.
    back: DVec3,
}

impl Axes {
    fn looking_from(back: DVec3) -> Self {
        let back = back.normalize();
        let right = DVec3::Y.cross(back).normalize();
        Self { right, up: back.cross(right), back }
    }

    /// World space to camera space, without translation.
    fn to_camera(self, vector: DVec3) -> DVec3 {
        DVec3::new(self.right.dot(vector), self.up.dot(vector), self.back.dot(vector))
    }

    /// A sun from the upper left front as seen in the picture, and a sky.
    fn lights(self) -> Vec<Light> {
        let from_sun = round_to(self.to_world(DVec3::new(0.6, -0.75, -0.55)), 1e-3);
        let light = |name: &str, kind, hex: &str, intensity| Light {
            name: name.to_owned(),
            kind,
            direction: None,
            position: None,
            color: Color::from_hex(hex).unwrap_or_default(),
            ground: None,
            intensity,
        };
        let sun =
            Light { direction: Some(from_sun.to_array()), ..light("sun", LightKind::Sun, "#fff1dc", 2.2) };
        vec![sun, light("sky", LightKind::Ambient, "#b9c8dc", 0.6)]
    }

    /// Camera space to world space, without translation.
    fn to_world(self, vector: DVec3) -> DVec3 {
        self.right * vector.x + self.up * vector.y + self.back * vector.z
    }
}

impl View {
    fn of(mesh: &MeshFile) -> Self {
        let (low, high) = mesh.mesh.bounds().unwrap_or_default();
        let (low, high) = (low.as_dvec3(), high.as_dvec3());
        let center = (low + high) / 2.0;
        // A mesh that is one point still gets a camera.
        let size = (high - low).length();
        let size = if size > 0.0 && size.is_finite() { size } else { 1.0 };
        let axes = Axes::looking_from(viewpoint(mesh));
        let points = used_points(mesh).map(|point| axes.to_camera(point - center) / size);
        let framing = Framing::of(points);
        let round = |point: DVec3| round_to(center + point * size, size * 1e-4);
        let eye_in_camera = framing.eye;
        let target_in_camera = eye_in_camera.with_z(0.0);
        Self {
            eye: round(axes.to_world(eye_in_camera)),
            target: round(axes.to_world(target_in_camera)),
            near: significant(framing.nearest * size * 0.5),
            far: significant((framing.farthest + BACKDROP_SCALE) * size * 2.0),
            axes,
            foot: DVec3::new(center.x, low.y, center.z),
            size,
        }
    }

    fn camera(&self) -> Camera {
        Camera {
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

    /// A floor under the mesh and a wall behind it, turned to the eye.
    fn backdrop(&self, name: &str) -> Object {
        let yaw_deg = self.axes.back.x.atan2(self.axes.back.z).to_degrees();
        // A little below, so that a flat mesh lies on it.
        let below = self.foot - DVec3::Y * (0.002 * self.size);
        Object {
            scale: Scale([significant(BACKDROP_SCALE * self.size); 3]),
            keys: vec![ObjectKey {
                translation: round_to(below, self.size * 1e-4).to_array(),
                rotation_deg: [0.0, round_at(yaw_deg, -1), 0.0],
                ..ObjectKey::at(0.0)
            }],
            ..Object::new(name, built_in_mesh::BACKDROP)
        }
    }
}

/// The direction from the mesh to the eye: three quarters from the front, slightly from above. An open mesh that would
/// show its back is seen from the side that shows the most of its front.
fn viewpoint(mesh: &MeshFile) -> DVec3 {
    const USUAL: DVec3 = DVec3::new(0.5, 0.27, 0.9);
    let mut area_vector = DVec3::ZERO;
    let mut area = 0.0;
    for triangle in 0..mesh.mesh.triangles.len() {
        let [a, b, c] = mesh.mesh.corners(triangle).map(|corner| corner.as_dvec3());
        let normal = (b - a).cross(c - a);
        area_vector += normal;
        area += normal.length();
    }
    let openness = area_vector / area;
    let is_open = openness.length() > 0.25;
    if !is_open || openness.dot(USUAL) > 0.0 {
        return USUAL;
    }
    let signs = [1.0, -1.0];
    let sides = signs.iter().flat_map(|&x| signs.map(|z| DVec3::new(x, 1.0, z)));
    let from_below = signs.iter().flat_map(|&x| signs.map(|z| DVec3::new(x, -1.0, z)));
    let views = sides.chain(from_below).map(|sign| USUAL * sign);
    views.fold(USUAL, |best, view| if view.dot(openness) > best.dot(openness) + 1e-6 { view } else { best })
}

fn used_points(mesh: &MeshFile) -> impl Iterator<Item = DVec3> {
    mesh.mesh.triangles.iter().flatten().map(|&vertex| mesh.mesh.positions[vertex as usize].as_dvec3())
}

/// The nearest eye that sees all points inside the margin. In camera space, from the mesh's centre, in lengths of its
/// diagonal.
#[derive(Debug)]
struct Framing {
    eye: DVec3,
    /// Least and greatest depth of a point.
    nearest: f64,
    farthest: f64,
}

impl Framing {
    /// A point is inside where |x − eye.x| ≤ t·(eye.z − z), with t the slope of the picture's border less the margin.
    /// So the maxima of x + t·z and −x + t·z over all points give the nearest eye; likewise for y.
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
        // A mesh that is almost a point is seen from a small distance.
        let distance = distance.max(depth.1 + 0.05);
        let eye = DVec3::new((right - left) / 2.0, (top - bottom) / 2.0, distance);
        Self { eye, nearest: distance - depth.1, farthest: distance - depth.0 }
    }
}

/// Rounds to multiples of a power of ten that is at most `step`, so that a person can read the numbers.
fn round_to(vector: DVec3, step: f64) -> DVec3 {
    vector.map(|component| round_at(component, step.log10().floor() as i32))
}

/// Two significant digits.
fn significant(value: f64) -> f64 {
    round_at(value, value.abs().max(f64::MIN_POSITIVE).log10().floor() as i32 - 1)
}

/// Rounds at a decimal place. Dividing by a whole power of ten gives the float nearest to the decimal number.
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
