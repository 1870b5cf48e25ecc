//! Directions on a surface, as tangents in model space: stated ones, guides, and the field that joins them.
//!
//! A direction at a point is stored as the complex number `e^{inα}`. α is its angle in the [`tangent_axes`] of the
//! normal, and n comes from the field's [`Symmetry`]: 1 for arrows, 2 for lines. With n = 2 both ends of a line give
//! the same number, so that lines can be averaged.

use glam::{DVec2, DVec3};

pub mod carry;
pub mod curvature;
pub mod field;
pub mod guide;
mod relax;
pub mod singularities;

/// Which directions count as equal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetry {
    /// Only a direction and itself: n = 1.
    Arrows,
    /// A direction and its opposite too: n = 2.
    Lines,
}

impl Symmetry {
    /// The power n.
    pub fn power(self) -> f64 {
        match self {
            Self::Arrows => 1.0,
            Self::Lines => 2.0,
        }
    }

    /// The complex number of a tangent in these axes; zero for a zero tangent.
    pub fn encode(self, tangent: DVec3, [right, above]: [DVec3; 2]) -> DVec2 {
        let z = DVec2::new(tangent.dot(right), tangent.dot(above)).normalize_or_zero();
        match self {
            Self::Arrows => z,
            Self::Lines => z.rotate(z),
        }
    }

    /// The unit tangent of a complex number in these axes; zero for zero. Of the two ends of a line it gives the one
    /// within a quarter turn of the first axis.
    pub fn decode(self, z: DVec2, [right, above]: [DVec3; 2]) -> DVec3 {
        if z.length_squared() < 1e-24 {
            return DVec3::ZERO;
        }
        let (sin, cos) = (z.to_angle() / self.power()).sin_cos();
        right * cos + above * sin
    }

    /// `e^{inα}` for a turn by α.
    pub fn turn(self, angle_rad: f64) -> DVec2 {
        DVec2::from_angle(self.power() * angle_rad)
    }
}

/// Two unit tangents that make a right-handed frame with a unit normal (Duff et al. 2017). They depend on the normal
/// alone.
pub fn tangent_axes(normal: DVec3) -> [DVec3; 2] {
    let sign = 1f64.copysign(normal.z);
    let a = -1.0 / (sign + normal.z);
    let b = normal.x * normal.y * a;
    let right = DVec3::new(1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x);
    let above = DVec3::new(b, sign + normal.y * normal.y * a, -normal.y);
    [right, above]
}

/// What parallel transport adds to a tangent's angle in its [`tangent_axes`]: the angle at `to` is the angle at `from`
/// plus this. Parallel transport is the least rotation that takes one normal to the other.
pub fn transport_rad(from: DVec3, to: DVec3) -> f64 {
    let [right_from, _] = tangent_axes(from);
    let [right_to, above_to] = tangent_axes(to);
    let axis = from.cross(to);
    let cos = from.dot(to);
    // Rodrigues' formula for an axis of length sin, where (1 − cos) / sin² = 1 / (1 + cos). Opposite normals have no
    // least rotation: there the tangent stays.
    let carried = if cos > -1.0 + 1e-9 {
        right_from * cos + axis.cross(right_from) + axis * (axis.dot(right_from) / (1.0 + cos))
    } else {
        right_from
    };
    carried.dot(above_to).atan2(carried.dot(right_to))
}

/// The direction from a point on the surface towards the point `target`, along the surface. Unit, or zero where
/// `target` lies on the line of the normal.
pub fn towards_point(target: DVec3, position: DVec3, normal: DVec3) -> DVec3 {
    along_surface((target - position).normalize_or_zero(), normal)
}

/// The least angle between two directions, radians: up to π for arrows, π/2 for lines.
#[cfg(test)]
fn angle_between(symmetry: Symmetry, a: DVec3, b: DVec3) -> f64 {
    let angle = a.angle_between(b);
    match symmetry {
        Symmetry::Lines if angle > std::f64::consts::FRAC_PI_2 => std::f64::consts::PI - angle,
        _ => angle,
    }
}

/// The direction round an axis, along the surface; unit, or zero where it is undefined.
///
/// It is mostly `axis × normal`, which suits bent and off-centre parts too. Where the surface faces along the axis
/// (the cap of a log) that vanishes, and the direction goes round the body's centre instead. `from_center` is the
/// point minus that centre, `size` the size of the body.
pub fn around(axis: DVec3, normal: DVec3, from_center: DVec3, size: f64) -> DVec3 {
    let axis = axis.normalize_or_zero();
    let round_part = axis.cross(normal);
    let round_center = axis.cross(from_center) / size.max(f64::MIN_POSITIVE);
    let direction = round_part + round_center * (1.0 - round_part.length()).max(0.0).powi(2) * 0.5;
    along_surface(direction, normal)
}

/// The direction towards `up`, along the surface; unit, or zero where the surface faces straight up or down.
pub fn towards(up: DVec3, normal: DVec3) -> DVec3 {
    along_surface(up, normal)
}

fn along_surface(direction: DVec3, normal: DVec3) -> DVec3 {
    (direction - normal * normal.dot(direction)).normalize_or_zero()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn around_goes_round_a_cylinder_and_its_cap() {
        let side = around(DVec3::Y, DVec3::X, DVec3::new(1.0, 0.3, 0.0), 2.0);
        assert!((side - DVec3::NEG_Z).length() < 1e-12);
        let cap = around(DVec3::Y, DVec3::Y, DVec3::new(0.5, 1.0, 0.0), 2.0);
        assert!((cap - DVec3::NEG_Z).length() < 1e-12);
        // The upright handle of a jug, beside the axis: the direction goes round the handle, not round the jug.
        let handle = around(DVec3::Y, DVec3::Z, DVec3::new(0.8, 0.5, 0.05), 2.0);
        assert!((handle - DVec3::X).length() < 1e-2, "{handle}");
    }

    #[test]
    fn tangent_axes_are_right_handed_and_a_direction_survives_encoding() {
        for normal in [DVec3::Z, DVec3::NEG_Z, DVec3::new(0.3, -0.5, -0.2), DVec3::new(-1.0, 2.0, 0.7)] {
            let normal = normal.normalize();
            let axes = tangent_axes(normal);
            assert!((axes[0].cross(axes[1]) - normal).length() < 1e-12);
            for degrees in [7.0f64, 30.0, 137.0, -77.0] {
                let (sin, cos) = degrees.to_radians().sin_cos();
                let tangent = axes[0] * cos + axes[1] * sin;
                for symmetry in [Symmetry::Arrows, Symmetry::Lines] {
                    let back = symmetry.decode(symmetry.encode(tangent, axes), axes);
                    assert!(angle_between(symmetry, back, tangent) < 1e-7, "{symmetry:?} {degrees}");
                }
                let ends = [tangent, -tangent].map(|end| Symmetry::Lines.encode(end, axes));
                assert!((ends[0] - ends[1]).length() < 1e-12);
            }
        }
    }

    #[test]
    fn transport_is_the_least_rotation() {
        let (from, to) = (DVec3::Z, DVec3::new(0.5, 0.3, 0.6).normalize());
        // The axis of the rotation is a tangent of both, and stays as it is.
        let axis = from.cross(to).normalize();
        let angle = |normal: DVec3| {
            let [right, above] = tangent_axes(normal);
            axis.dot(above).atan2(axis.dot(right))
        };
        let error = crate::angle::wrap_pi(angle(from) + transport_rad(from, to) - angle(to));
        assert!(error.abs() < 1e-12, "{error}");
        assert_eq!(transport_rad(from, from), 0.0);
    }

    #[test]
    fn up_is_tangent() {
        let normal = DVec3::new(0.6, 0.0, 0.8);
        assert!((towards(DVec3::Y, normal) - DVec3::Y).length() < 1e-12);
        assert_eq!(towards(DVec3::Y, DVec3::Y), DVec3::ZERO);
    }
}
