//! The reference lift: what is baked per particle so that a frame needs no neighbours and no other frame.
//!
//! A lift is a 3×2 matrix N (model units per reference pixel). With J the Jacobian of the current view, `A = J N` is
//! the local screen map from the reference picture to the current one. The stroke turns by the polar angle of A,
//! `φ(A) = atan2(A₂₁ − A₁₂, A₁₁ + A₂₂)`. (This is Horn's similarity, source paper eq. 1–2, for neighbours spread evenly
//! all round.) `N' = N R(θ₀)` includes the stroke's base angle θ₀, so `φ(J N')` is the stroke's own angle.

use glam::{DVec2, DVec3};

/// N or N', by columns, each in model space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lift {
    /// The step on the surface that is one pixel along x in the reference picture; in N', one pixel along the stroke.
    pub along: DVec3,
    /// The step that is one pixel along y; in N', one pixel across the stroke, to its left.
    pub across: DVec3,
}

/// A screen map A (2×2), by rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelMap2 {
    /// First row: A₁₁, A₁₂.
    pub x: DVec2,
    /// Second row: A₂₁, A₂₂.
    pub y: DVec2,
}

impl Lift {
    /// The tangent solver: `B (J B)⁻¹`, where B is any basis of the plane that has this normal. `None` where the
    /// reference sees the surface edge-on, from behind (`n·(j_x × j_y) ≤ 0`), or not at all.
    pub fn tangent(reference_jacobian: [DVec3; 2], normal: DVec3) -> Option<Self> {
        let [jx, jy] = reference_jacobian;
        // In closed form: with m = j_x × j_y, the columns are j_y × n and n × j_x over n·m.
        let area = normal.dot(jx.cross(jy));
        let lift = Self { along: jy.cross(normal) / area, across: normal.cross(jx) / area };
        (area > 0.0 && lift.along.is_finite() && lift.across.is_finite()).then_some(lift)
    }

    /// The lift of a virtual reference: a camera that looks straight at the surface. Its up is `up` projected on the
    /// tangent plane; then it is rolled by `roll_rad`. It sees `px_per_unit` pixels per model unit.
    pub fn facing_view(normal: DVec3, up: DVec3, roll_rad: f64, px_per_unit: f64) -> Self {
        let [right, above] = turntable_axes(normal, up);
        let (sin, cos) = roll_rad.sin_cos();
        let scale = 1.0 / px_per_unit;
        Self { along: (right * cos + above * sin) * scale, across: (above * cos - right * sin) * scale }
    }

    /// Horn's estimate over neighbours (source paper eq. 2): `Σ d pᵀ / Σ|p|²`. Here d is a neighbour's offset in
    /// model space, and p is the same offset in pixels of the reference picture. In any view, φ(J N) is exactly the
    /// angle of the paper's sum with each neighbour weighted by `z_neighbour / z_stroke`. The estimate is doubled, so
    /// that it maps the reference to about itself, as `tangent` does. `None` with fewer than three neighbours, or where
    /// Σ|p|² is at most 0.25 px².
    pub fn horn(offsets: impl Iterator<Item = (DVec3, DVec2)>) -> Option<Self> {
        let (mut along, mut across, mut sum, mut count) = (DVec3::ZERO, DVec3::ZERO, 0.0, 0);
        for (d, p) in offsets {
            along += d * p.x;
            across += d * p.y;
            sum += p.length_squared();
            count += 1;
        }
        let lift = Self { along: along * (2.0 / sum), across: across * (2.0 / sum) };
        (count >= 3 && sum > 0.25 && lift.along.is_finite() && lift.across.is_finite()).then_some(lift)
    }

    /// `N R(θ)`: the first column, which lay along the reference picture's x, then lies at this angle to it.
    #[inline]
    pub fn turned(self, angle_rad: f64) -> Self {
        let (sin, cos) = angle_rad.sin_cos();
        Self { along: self.along * cos + self.across * sin, across: self.across * cos - self.along * sin }
    }

    /// `(1 − t)·self + t·other`, with `other` flipped if its opposite is nearer to `self` as seen through `jacobian`.
    pub fn blended(self, other: Self, t: f64, jacobian: [DVec3; 2]) -> Self {
        let (here, there) = (self.map(jacobian).turn(), other.map(jacobian).turn());
        let t_signed = if here.dot(there) < 0.0 { -t } else { t };
        Self {
            along: self.along * (1.0 - t) + other.along * t_signed,
            across: self.across * (1.0 - t) + other.across * t_signed,
        }
    }

    /// `A = J N`.
    #[inline]
    pub fn map(self, [jx, jy]: [DVec3; 2]) -> PixelMap2 {
        PixelMap2 {
            x: DVec2::new(jx.dot(self.along), jx.dot(self.across)),
            y: DVec2::new(jy.dot(self.along), jy.dot(self.across)),
        }
    }
}

impl PixelMap2 {
    /// The rotation-and-scale part as a complex number: `(A₁₁ + A₂₂, A₂₁ − A₁₂)`.
    pub fn turn(self) -> DVec2 {
        DVec2::new(self.x.x + self.y.y, self.y.x - self.x.y)
    }

    /// φ(A) in radians, (−π, π].
    pub fn angle_rad(self) -> f64 {
        let turn = self.turn();
        turn.y.atan2(turn.x)
    }

    /// The angle of a stroke of this flatness F, radians: `arg(F·e^{iφ} + (1 − F)·A e₁/|A e₁|)`. With F = 1 the stroke
    /// turns by the paper's similarity, with 0 it follows the surface.
    pub fn shown_rad(self, flatness: f64) -> f64 {
        if flatness >= 1.0 {
            return self.angle_rad();
        }
        let wrapped = DVec2::new(self.x.x, self.y.x).normalize_or_zero();
        (self.turn().normalize_or_zero() * flatness + wrapped * (1.0 - flatness)).to_angle()
    }

    /// κ, the trust, in 0..=1: how much of the map is rotation and uniform scaling. It is at least 1/√2 for any map
    /// that does not mirror, and 0 for a zero map.
    #[inline]
    pub fn kappa(self) -> f64 {
        let size = self.x.length_squared() + self.y.length_squared();
        if size > 0.0 { self.turn().length() / (2.0 * size).sqrt() } else { 0.0 }
    }
}

/// Right and up axes of a camera that looks straight at a surface; its up is `up` projected on the tangent plane. Where
/// the surface faces straight up or down, a fixed direction stands in for `up`.
pub fn turntable_axes(normal: DVec3, up: DVec3) -> [DVec3; 2] {
    let projected = up - normal * normal.dot(up);
    let above = if projected.length_squared() > 1e-12 {
        projected.normalize()
    } else {
        // As when a person looks down on a table: what is farther away is up. From below, what is nearer is up.
        let away = if normal.dot(up) > 0.0 { 1.0 } else { -1.0 };
        let forward = if up.z.abs() < 0.9 { DVec3::NEG_Z } else { DVec3::Y } * away;
        (forward - normal * normal.dot(forward)).normalize_or(DVec3::X)
    };
    [above.cross(normal), above]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::angle::wrap_pi;

    const JACOBIAN: [DVec3; 2] = [DVec3::new(200.0, 10.0, -40.0), DVec3::new(5.0, 180.0, 60.0)];

    #[test]
    fn tangent_maps_the_reference_to_itself_and_stays_in_the_plane() {
        let normal = DVec3::new(0.3, -0.2, 0.9).normalize();
        let lift = Lift::tangent(JACOBIAN, normal).unwrap();
        let map = lift.map(JACOBIAN);
        assert!((map.x - DVec2::X).length() < 1e-12 && (map.y - DVec2::Y).length() < 1e-12);
        assert!(lift.along.dot(normal).abs() < 1e-15 && lift.across.dot(normal).abs() < 1e-15);
        assert!(Lift::tangent(JACOBIAN, -normal).is_none());
        assert!((map.kappa() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_base_angle_is_added_whatever_the_map() {
        let normal = DVec3::new(0.3, -0.2, 0.9).normalize();
        let lift = Lift::tangent(JACOBIAN, normal).unwrap();
        let elsewhere = [DVec3::new(-30.0, 90.0, 12.0), DVec3::new(-140.0, -20.0, 33.0)];
        for base in [-2.0, 0.1, 0.6, 3.0] {
            let turned = lift.turned(base).map(elsewhere).angle_rad();
            assert!(wrap_pi(turned - lift.map(elsewhere).angle_rad() - base).abs() < 1e-12);
        }
    }

    #[test]
    fn facing_view_sees_its_own_base_angle() {
        let (normal, up) = (DVec3::new(0.1, 0.4, 0.8).normalize(), DVec3::Y);
        for roll in [0.0, 0.5, -2.0] {
            let lift = Lift::facing_view(normal, up, roll, 150.0);
            let [right, above] = turntable_axes(normal, up);
            assert!((right.cross(above) - normal).length() < 1e-12);
            // A camera rolled by `roll` has its axes turned; seen by it, the lift is the identity.
            let camera_x = (right * roll.cos() + above * roll.sin()) * 150.0;
            let camera_y = (above * roll.cos() - right * roll.sin()) * 150.0;
            let map = lift.map([camera_x, camera_y]);
            assert!((map.x - DVec2::X).length() < 1e-12 && (map.y - DVec2::Y).length() < 1e-12);
        }
    }

    #[test]
    fn a_blend_of_near_lifts_is_their_weighted_mean() {
        let lift = Lift { along: DVec3::new(1.0, 2.0, 3.0), across: DVec3::new(-2.0, 1.0, 0.5) };
        let other = Lift { along: DVec3::new(1.5, 1.0, 3.0), across: DVec3::new(-1.0, 1.0, 1.5) };
        let blend = lift.blended(other, 0.25, JACOBIAN);
        assert!((blend.along - DVec3::new(1.125, 1.75, 3.0)).length() < 1e-12, "{}", blend.along);
        assert!((blend.across - DVec3::new(-1.75, 1.0, 0.75)).length() < 1e-12, "{}", blend.across);
    }

    /// Seen from above, what is farther away is up; seen from below, what is nearer is up. So both views have the same
    /// right axis.
    #[test]
    fn a_surface_that_faces_straight_up_or_down_has_fixed_axes() {
        let close = |found: [DVec3; 2], wanted: [DVec3; 2]| {
            assert!((found[0] - wanted[0]).length() + (found[1] - wanted[1]).length() < 1e-12, "{found:?}");
        };
        close(turntable_axes(DVec3::Y, DVec3::Y), [DVec3::X, DVec3::NEG_Z]);
        close(turntable_axes(DVec3::NEG_Y, DVec3::Y), [DVec3::X, DVec3::Z]);
        // Where up is along Z, away is along Y.
        close(turntable_axes(DVec3::Z, DVec3::Z), [DVec3::X, DVec3::Y]);
    }

    #[test]
    fn a_blend_takes_the_nearer_of_two_opposite_lines() {
        let normal = DVec3::new(0.3, -0.2, 0.9).normalize();
        let lift = Lift::tangent(JACOBIAN, normal).unwrap();
        let other = lift.turned(std::f64::consts::PI + 0.2);
        let blend = lift.blended(other, 0.5, JACOBIAN).map(JACOBIAN).angle_rad();
        assert!((blend - 0.1).abs() < 1e-3, "{blend}");
    }
}
