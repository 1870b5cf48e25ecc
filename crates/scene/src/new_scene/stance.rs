//! How an unknown model stands: which of its axes points up, and from which side it is best seen.

mod upright;

use glam::{DMat3, DVec3};
use impasto_core::sampling::{self, Particle, Surface};
use impasto_core::shells::{self, Side};

use super::axes::Axes;
use super::scheme;
use crate::document::Up;
use crate::mesh_file::MeshFile;

/// Number of samples of a model's surface by which its stance is judged.
const SAMPLES: usize = 1500;

/// A sample has a mirror image if another sample lies this close to the mirrored place, in spacings of the samples.
const MIRRORED_WITHIN: f64 = 1.3;

/// A plane mirrors the model if more than this share of the samples have a mirror image.
const MIRRORED: f64 = 0.8;

/// Three quarters from the front, slightly from above.
const USUAL_VIEW: DVec3 = DVec3::new(0.5, 0.27, 0.9);

/// How high above the model's middle the eye of the best view is, divided by its horizontal distance. The first value
/// is for models at most 0.6 times as high as wide, the second for models at least 1.6 times as high as wide. A low
/// thing is seen from above, a tall one from the front.
const RISES: [f64; 2] = [0.38, 0.18];

/// Light usually comes from the left. It comes from the right if light from the left would reach less than this share
/// of the surface that faces the eye, and light from the right would reach more.
const LEAST_LIT: f64 = 0.36;

/// Weight of a triangle's back in a view; its front has weight 1.
const BACK: f64 = 0.25;

/// How a model stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stance {
    /// Which axis of the file points up.
    pub up: Up,
    /// The direction from the upright model to the eye.
    pub view: DVec3,
    /// Whether another axis could as well be up.
    pub up_is_unsure: bool,
    /// To which side of the picture the light goes: 1 to the right, as usual, or −1.
    pub light_goes: f64,
}

/// From which side a model is seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ViewFrom {
    /// Three quarters from the front. The side that shows the most detail is taken as the front.
    #[default]
    Auto,
    /// From +Z of the upright model.
    Front,
    /// From −Z.
    Back,
    /// From −X.
    Left,
    /// From +X.
    Right,
    /// From +Z, +X and a little above.
    ThreeQuarter,
    /// From above.
    Top,
}

/// Samples of a model's surface. [`Samples::of`] gives them in the axes of the file.
pub(super) struct Samples {
    points: Vec<DVec3>,
    normals: Vec<DVec3>,
    /// Normals of the triangles that the samples lie on. Even a box with smooth normals has flat sides.
    face_normals: Vec<DVec3>,
    /// Whether each sample lies on the back of a sheet. A closed shell that is inside out has no backs.
    flipped: Vec<bool>,
    spacing: f64,
}

impl Samples {
    pub fn of(mesh: &MeshFile) -> Self {
        let sides = shells::sides(&mesh.mesh);
        let surface = Surface::with_sides(&mesh.mesh, &sides, |_| true);
        let particles = sampling::samples(&surface, SAMPLES, 1);
        Self {
            points: particles.iter().map(|particle| particle.position.as_dvec3()).collect(),
            normals: particles.iter().map(|particle| particle.normal.as_dvec3()).collect(),
            face_normals: particles.iter().map(|particle| face_normal(mesh, particle)).collect(),
            flipped: particles
                .iter()
                .map(|particle| particle.flipped && sides[particle.triangle as usize] == Side::Both)
                .collect(),
            spacing: sampling::hexagonal_spacing(surface.area(), particles.len().max(1)),
        }
    }

    fn turned(&self, turn: DMat3) -> Self {
        let turned = |vectors: &[DVec3]| vectors.iter().map(|&vector| turn * vector).collect();
        Self {
            points: turned(&self.points),
            normals: turned(&self.normals),
            face_normals: turned(&self.face_normals),
            flipped: self.flipped.clone(),
            spacing: self.spacing,
        }
    }

    /// `up` and `view` are what the user states. The samples decide what the user leaves open.
    pub fn stance(&self, up: Option<Up>, view: ViewFrom) -> Stance {
        let (found, up_is_unsure) = match up {
            Some(up) => (up, false),
            // A flat thing has no feet: it stays as it is.
            None if self.is_flat() => (Up::Y, false),
            None => self.upright(),
        };
        let upright = self.turned(found.y_up_from_file());
        let usual = || if self.points.is_empty() { USUAL_VIEW } else { upright.best_view() };
        let view = view.direction().unwrap_or_else(usual);
        let light_goes = if upright.lit_share(view, 1.0) < LEAST_LIT
            && upright.lit_share(view, -1.0) > upright.lit_share(view, 1.0)
        {
            -1.0
        } else {
            1.0
        };
        Stance { up: found, view, up_is_unsure, light_goes }
    }

    /// The share of the surface facing the eye that is lit by a light that goes to this side.
    fn lit_share(&self, view: DVec3, light_goes: f64) -> f64 {
        let axes = Axes::looking_from(view);
        let to_light = -axes.to_world(scheme::from_sun(light_goes)).normalize();
        let (mut lit, mut seen) = (0.0, 0.0);
        for normal in &self.normals {
            let facing = normal.dot(axes.back).max(0.0);
            seen += facing;
            if normal.dot(to_light) > 0.15 {
                lit += facing;
            }
        }
        if seen > 0.0 { lit / seen } else { 1.0 }
    }

    /// Whether the model has hardly any extent along one of its axes.
    fn is_flat(&self) -> bool {
        let [low, high] = self.bounds();
        let size = high - low;
        self.points.is_empty() || size.min_element() < 0.02 * size.max_element()
    }

    /// For each axis, the share of samples whose mirror image across the middle plane lies on the surface too.
    fn mirrors(&self) -> [f64; 3] {
        let [low, high] = self.bounds();
        let middle = (low + high) / 2.0;
        let reach_sq = (MIRRORED_WITHIN * self.spacing).powi(2);
        std::array::from_fn(|axis| {
            let mirrored = |point: &&DVec3| {
                let mut image = **point;
                image[axis] = 2.0 * middle[axis] - image[axis];
                self.points.iter().any(|other| other.distance_squared(image) < reach_sq)
            };
            self.points.iter().filter(mirrored).count() as f64 / self.points.len().max(1) as f64
        })
    }

    /// The three-quarter view that shows the most bent surface, see [`Self::form_seen`]. The front of a model with a
    /// mirror plane is sought along that plane.
    fn best_view(&self) -> DVec3 {
        let (bent, lean) = (self.bent(), self.lean());
        let mirrors = self.mirrors();
        let [x, z] = [mirrors[0], mirrors[2]];
        // The plane that mirrors much better than the other tells which axis points forward.
        let along_z = x > MIRRORED && x > z + 0.06;
        let along_x = z > MIRRORED && z > x + 0.06;
        let [low, high] = self.bounds();
        let size = high - low;
        // A thing without a mirror plane was probably modelled to be seen from +Z.
        let front = if along_x || along_z { 1.06 } else { 1.3 };
        let tall = (size.y / size.x.max(size.z).max(f64::MIN_POSITIVE) - 0.6).clamp(0.0, 1.0);
        let rise = RISES[0] + (RISES[1] - RISES[0]) * tall;
        let head = 0.35 * ramp(size.y / size.x.max(size.z).max(f64::MIN_POSITIVE), [0.25, 0.4]);
        let mut best = (f64::NEG_INFINITY, USUAL_VIEW);
        for forward in [DVec3::Z, DVec3::NEG_Z, DVec3::X, DVec3::NEG_X] {
            if (along_z && forward.x != 0.0) || (along_x && forward.z != 0.0) {
                continue;
            }
            let right = DVec3::Y.cross(forward);
            // A long thing is seen more from its side.
            let length = forward.abs().dot(size) / right.abs().dot(size).max(f64::MIN_POSITIVE);
            let yaw = (29.0 + (60.0 * (length - 1.0)).clamp(0.0, 34.0)).to_radians();
            let views =
                [1.0, -1.0].map(|side| forward * yaw.cos() + right * (side * yaw.sin()) + DVec3::Y * rise);
            let mut seen = views.map(|view| self.form_seen(view.normalize(), &bent));
            if along_z || along_x {
                // Both sides look the same: a difference is only noise of the samples.
                seen = [(seen[0] + seen[1]) / 2.0; 2];
            }
            // A head is high and at the front. A flat thing, such as an aircraft, has a high tail instead, so there the
            // lean does not count. +Z is favoured, because it is the front in most files.
            let ahead = 1.0 + head * lean.dot(forward).clamp(-1.0, 1.0);
            let usual = ahead * if forward == DVec3::Z { front } else { 1.0 };
            for (view, worth) in views.into_iter().zip([seen[0] * usual * 1.03, seen[1] * usual]) {
                if worth > best.0 {
                    best = (worth, view);
                }
            }
        }
        best.1
    }

    /// Least and greatest corner of the box round the samples.
    fn bounds(&self) -> [DVec3; 2] {
        let low = self.points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        [low, self.points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max)]
    }

    /// Horizontal offset of the model's upper third from its middle, in halves of the larger horizontal extent.
    fn lean(&self) -> DVec3 {
        let [low, high] = self.bounds();
        let middle = (low + high) / 2.0;
        let (mut sum, mut count) = (DVec3::ZERO, 0.0);
        for point in self.points.iter().filter(|point| point.y > low.y + 0.67 * (high.y - low.y)) {
            sum += *point - middle;
            count += 1.0;
        }
        let reach = 0.5 * (high.x - low.x).max(high.z - low.z);
        let lean = (sum / f64::max(count, 1.0) / reach).with_y(0.0);
        if lean.is_finite() { lean } else { DVec3::ZERO }
    }

    /// How much the surface bends at each sample: the mean of 1 − n·n' over the samples near it. The other side of a
    /// sheet without thickness does not count.
    fn bent(&self) -> Vec<f64> {
        let behind = |at: &DVec3, normal: &DVec3, (other_at, other): (&DVec3, &DVec3)| {
            normal.dot(*other) < -0.9 && normal.dot(*other_at - *at).abs() < 0.1 * self.spacing
        };
        let reach_sq = (2.5 * self.spacing).powi(2);
        let of = |(at, normal): (&DVec3, &DVec3)| {
            let near = self
                .points
                .iter()
                .zip(&self.normals)
                .filter(|(other, _)| at.distance_squared(**other) < reach_sq)
                .filter(|other| !behind(at, normal, *other));
            let (mut sum, mut count) = (0.0, 0.0);
            for (_, other) in near {
                sum += 1.0 - normal.dot(*other);
                count += 1.0;
            }
            sum / f64::max(count, 1.0)
        };
        self.points.iter().zip(&self.normals).map(of).collect()
    }

    /// How much bent surface an eye in this direction sees. Backs of triangles count little, for example those of a
    /// room seen from outside. In each cell of the picture, samples behind the foremost are hidden.
    fn form_seen(&self, towards_eye: DVec3, bent: &[f64]) -> f64 {
        let right = DVec3::Y.cross(towards_eye).normalize_or(DVec3::X);
        let up = towards_eye.cross(right);
        let cell = 1.5 * self.spacing;
        let at = |point: &DVec3| {
            [(right.dot(*point) / cell).floor() as i64, (up.dot(*point) / cell).floor() as i64]
        };
        let mut foremost = std::collections::HashMap::new();
        for point in &self.points {
            let depth = foremost.entry(at(point)).or_insert(f64::NEG_INFINITY);
            *depth = f64::max(*depth, towards_eye.dot(*point));
        }
        let seen = |(point, normal): (&DVec3, &DVec3)| {
            let shows = towards_eye.dot(*point) > foremost[&at(point)] - 2.0 * cell;
            if shows { normal.dot(towards_eye).max(0.0) } else { 0.0 }
        };
        self.points
            .iter()
            .zip(&self.normals)
            .zip(bent)
            .zip(&self.flipped)
            .map(|((sample, bent), &is_back)| seen(sample) * (0.05 + bent) * if is_back { BACK } else { 1.0 })
            .sum()
    }
}

impl ViewFrom {
    /// All, with their names on the command line.
    pub const ALL: [(&'static str, Self); 7] = [
        ("auto", Self::Auto),
        ("front", Self::Front),
        ("back", Self::Back),
        ("left", Self::Left),
        ("right", Self::Right),
        ("three-quarter", Self::ThreeQuarter),
        ("top", Self::Top),
    ];

    /// The direction from the upright model to the eye; `None` for [`Self::Auto`].
    fn direction(self) -> Option<DVec3> {
        match self {
            Self::Auto => None,
            Self::Front => Some(DVec3::new(0.0, 0.16, 1.0)),
            Self::Back => Some(DVec3::new(0.0, 0.16, -1.0)),
            Self::Left => Some(DVec3::new(-1.0, 0.16, 0.0)),
            Self::Right => Some(DVec3::new(1.0, 0.16, 0.0)),
            Self::ThreeQuarter => Some(USUAL_VIEW),
            Self::Top => Some(DVec3::new(0.0, 1.0, 0.18)),
        }
    }
}

/// The normal of the triangle that a sample lies on, turned to the same side as the sample's own normal.
fn face_normal(mesh: &MeshFile, sample: &Particle) -> DVec3 {
    let own = sample.normal.as_dvec3();
    let [a, b, c] = mesh.mesh.corners(sample.triangle as usize).map(|corner| corner.as_dvec3());
    let normal = (b - a).cross(c - a).normalize_or(own);
    if normal.dot(own) < 0.0 { -normal } else { normal }
}

/// 0 up to the first bound, 1 from the second on, and linear between them.
fn ramp(value: f64, [from, to]: [f64; 2]) -> f64 {
    ((value - from) / (to - from)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests;
