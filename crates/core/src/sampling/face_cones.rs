//! A cone of normals for each face. For most pairs of particles, the cones of their faces alone tell whether both are
//! on the same side of the surface.

use glam::Vec3;

use super::{Face, Surface};

/// Larger than the error that rounding makes in unit vectors and in interpolation between them.
const MARGIN: f32 = 1e-3;

/// For each face, a cone that holds the interpolated normals of all its points.
pub(super) struct FaceCones {
    cones: Vec<Cone>,
}

#[derive(Clone, Copy)]
struct Cone {
    axis: Vec3,
    /// Sine of half the opening angle, plus a margin; above 1 where the cone decides nothing.
    spread: f32,
    /// Whether the dot product of any two normals of the face is positive.
    even: bool,
}

impl FaceCones {
    pub(super) fn new(surface: &Surface<'_>) -> Self {
        Self { cones: surface.faces.iter().map(|face| Cone::of(surface, face)).collect() }
    }

    /// The sign of the dot product of a normal of the first face and a normal of the second: `true` if it is always
    /// positive, `false` if it is always negative. `None` if it may depend on the points.
    #[inline(always)]
    pub(super) fn same_side(&self, first: u32, second: u32) -> Option<bool> {
        let alike = first == second;
        let first = &self.cones[first as usize];
        if alike && first.even {
            return Some(true);
        }
        let second = &self.cones[second as usize];
        let product = first.axis.dot(second.axis);
        // With half angles a and b, the sign is sure where the product exceeds sin(a + b), which is <= sin a + sin b.
        let unsure = first.spread + second.spread;
        if product > unsure {
            Some(true)
        } else if product < -unsure {
            Some(false)
        } else {
            None
        }
    }
}

impl Cone {
    const UNSURE: Self = Self { axis: Vec3::ZERO, spread: 2.0, even: false };

    fn of(surface: &Surface<'_>, face: &Face) -> Self {
        let corners = surface.mesh.triangles[face.triangle as usize];
        let [a, b, c] = corners.map(|vertex| surface.mesh.positions[vertex as usize]);
        let mut normals = corners.map(|vertex| surface.mesh.normals[vertex as usize]);
        let across = (b - a).cross(c - a);
        let Some(across) = (if face.flipped { -across } else { across }).try_normalize() else {
            return Self::UNSURE;
        };
        // A particle's normal is flipped to the particle's side of the triangle. Here all three corners flip, or none
        // does; faces of which only some corners would have to flip are refused below.
        if normals.iter().all(|normal| normal.dot(across) < 0.0) {
            normals = normals.map(|normal| -normal);
        }
        let axis = normals.iter().sum::<Vec3>().normalize_or_zero();
        let fine = |normal: &Vec3| {
            let unit = (normal.length_squared() - 1.0).abs() < MARGIN;
            unit && normal.dot(across) > 0.01 && normal.dot(axis) > 0.5
        };
        if !normals.iter().all(fine) {
            return Self::UNSURE;
        }
        let sine = normals.iter().map(|normal| normal.cross(axis).length()).fold(0.0, f32::max);
        let [a, b, c] = normals;
        Self { axis, spread: sine + MARGIN, even: a.dot(b).min(b.dot(c)).min(c.dot(a)) > MARGIN }
    }
}
