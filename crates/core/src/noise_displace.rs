//! Moves vertices by a noise texture (Hong and Park 2021), and holds the built-in noise textures.
//!
//! ```text
//! position ─▶ lookup: S·v·NV + (t, t) ─▶ tile: N, repeated ─▶ v + (saturate(N) − ½)·NS
//! ```
//!
//! v is the vertex, S the body's pose if the noise stands still in the world (else the identity), NV how often the
//! texture repeats per unit of length, t how far the noise has travelled, N the noise, and NS the scale of the
//! displacement.

mod built_in;
mod tile;

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec2, DVec3, DVec4};

use crate::cofactors::cofactors;

pub use built_in::{gaussian, perlin};
pub use tile::Tile;

/// Seconds in which the noise travels by one length of its texture, as in Unity, where `_Time.x` is seconds / 20.
pub const SECONDS_PER_TILE: f64 = 20.0;

/// The directions along which a vertex is moved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Along {
    /// Along X by the noise's red channel, along Y by green, along Z by blue.
    #[default]
    Channels,
    /// Along the normal, by the red channel.
    Normal,
}

/// How the vertices of a body are moved.
#[derive(Clone, Debug)]
pub struct VertexNoise {
    /// The noise, N.
    pub tile: Arc<Tile>,
    /// NS: displacement from the lowest noise to the highest, model units.
    pub scale: f64,
    /// The directions along which the vertices are moved.
    pub along: Along,
    /// Whether normals are those of the moved surface, so that the light shows the displacement.
    pub moves_normals: bool,
}

impl PartialEq for VertexNoise {
    fn eq(&self, other: &Self) -> bool {
        (Arc::ptr_eq(&self.tile, &other.tile) || self.tile == other.tile)
            && (self.scale, self.along, self.moves_normals) == (other.scale, other.along, other.moves_normals)
    }
}

/// Turns a position in model space into coordinates in the noise texture (which has a length of 1) at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lookup {
    /// Rows of a 2×4 matrix.
    pub rows: [DVec4; 2],
}

impl Lookup {
    /// `S·v·NV` plus `shift`, where NV is `value`. S is `world_from_model`, or the identity where the noise moves with
    /// the body. Whole lengths of the texture are dropped from what is added to every vertex (`shift` and the
    /// translation of S), so that bodies far away are as exact as near ones.
    pub fn new(value: [f64; 2], world_from_model: Option<DAffine3>, shift: DVec2) -> Self {
        let space = world_from_model.unwrap_or(DAffine3::IDENTITY);
        let row = |axis: usize| {
            let linear = space.matrix3.row(axis) * value[axis];
            linear.extend((space.translation[axis] * value[axis] + shift[axis]).rem_euclid(1.0))
        };
        Self { rows: [row(0), row(1)] }
    }

    /// The texture coordinates of a point.
    pub fn at(&self, position: DVec3) -> DVec2 {
        let position = position.extend(1.0);
        DVec2::new(self.rows[0].dot(position), self.rows[1].dot(position))
    }
}

/// How far the noise has travelled, in lengths of the texture. Without a period it travels along X by Unity's
/// `_Time.x`. With a period it travels round a circle at the same speed, at first along X, and is back after the
/// period, to the bit.
pub fn travelled(seconds: f64, period_secs: Option<f64>) -> DVec2 {
    let Some(period_secs) = period_secs else { return DVec2::new(seconds / SECONDS_PER_TILE, 0.0) };
    let radius = period_secs / SECONDS_PER_TILE / std::f64::consts::TAU;
    let (sin, cos) = ((seconds / period_secs).rem_euclid(1.0) * std::f64::consts::TAU).sin_cos();
    DVec2::new(sin, 1.0 - cos) * radius
}

/// The shift of the vertices' lookup. Without a period it is `(t, t)`: what [`travelled`] gives, turned by 45 degrees
/// and scaled by √2. The circle of a noise with a period is turned and scaled in the same way.
pub fn vertex_shift(travelled: DVec2) -> DVec2 {
    DVec2::new(travelled.x - travelled.y, travelled.x + travelled.y)
}

impl VertexNoise {
    /// Where a point of the surface is moved to.
    pub fn displaced(&self, position: DVec3, normal: DVec3, lookup: &Lookup) -> DVec3 {
        let noise = self.centred(lookup.at(position));
        position
            + match self.along {
                Along::Channels => noise * self.scale,
                Along::Normal => normal.normalize_or_zero() * (noise.x * self.scale),
            }
    }

    /// The unit normal of the moved surface: `cof(F) n`, where F is the derivative of [`VertexNoise::displaced`], taken
    /// over two texels. With [`Along::Normal`], the curvature that the surface has at rest is neglected.
    pub fn displaced_normal(&self, position: DVec3, normal: DVec3, lookup: &Lookup) -> DVec3 {
        let normal = normal.normalize_or_zero();
        let at = lookup.at(position);
        let step = self.tile.texel();
        let slope = |step: DVec2| {
            let rise = (self.centred(at + step) - self.centred(at - step)) * self.scale;
            rise / (2.0 * (step.x + step.y))
        };
        let (along_u, along_v) = (slope(DVec2::new(step.x, 0.0)), slope(DVec2::new(0.0, step.y)));
        let [u, v] = lookup.rows.map(|row| row.truncate());
        let (along_u, along_v) = match self.along {
            Along::Channels => (along_u, along_v),
            Along::Normal => (normal * along_u.x, normal * along_v.x),
        };
        // F = 1 + ∂d/∂u ⊗ ∇u + ∂d/∂v ⊗ ∇v, where d is the displacement.
        let column = |axis: usize| DVec3::AXES[axis] + along_u * u[axis] + along_v * v[axis];
        let moved = DMat3::from_cols(column(0), column(1), column(2));
        (cofactors(moved) * normal).normalize_or(normal)
    }

    /// `saturate(N) − ½`.
    fn centred(&self, at: DVec2) -> DVec3 {
        let [r, g, b, _] = self.tile.sample(at);
        DVec3::new(r, g, b).clamp(DVec3::ZERO, DVec3::ONE) - 0.5
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(along: Along) -> VertexNoise {
        VertexNoise { tile: gaussian(), scale: 0.3, along, moves_normals: true }
    }

    #[test]
    fn a_period_closes_and_begins_at_the_usual_speed() {
        for period_secs in [0.5, 3.0, 40.0] {
            let at = |seconds: f64| travelled(seconds, Some(period_secs));
            assert_eq!(at(0.0), at(period_secs));
            assert_eq!(at(0.25 * period_secs), at(7.25 * period_secs));
            let step = 1e-6 * period_secs;
            let speed = (at(step) - at(0.0)) / step * SECONDS_PER_TILE;
            assert!((speed - DVec2::X).length() < 1e-4, "{speed}");
        }
        assert_eq!(travelled(5.0, None), DVec2::new(0.25, 0.0));
        assert_eq!(vertex_shift(DVec2::new(0.25, 0.0)), DVec2::splat(0.25));
    }

    #[test]
    fn the_lookup_is_as_exact_far_away_as_near() {
        let near = Lookup::new([0.5, 0.5], Some(DAffine3::from_translation(DVec3::X)), DVec2::ZERO);
        let far = DAffine3::from_translation(DVec3::new(2e6 + 1.0, 0.0, 0.0));
        let far = Lookup::new([0.5, 0.5], Some(far), DVec2::ZERO);
        assert_eq!(near, far);
    }

    #[test]
    fn displaced_normals_are_those_of_the_displaced_surface() {
        // A plane, which has no curvature of its own.
        let lookup = Lookup::new([0.31, 0.27], None, DVec2::new(0.13, 0.4));
        for along in [Along::Channels, Along::Normal] {
            let noise = noise(along);
            let step = 1.0 / 128.0 / 0.3;
            let mut worst = 0.0_f64;
            for index in 0..500 {
                let at = DVec3::new(f64::from(index) * 0.0137, f64::from(index) * 0.0071 - 2.0, 0.3);
                let moved = |by: DVec3| noise.displaced(at + by, DVec3::Z, &lookup);
                let along_x = moved(DVec3::X * step) - moved(DVec3::X * -step);
                let along_y = moved(DVec3::Y * step) - moved(DVec3::Y * -step);
                let expected = along_x.cross(along_y).normalize();
                let found = noise.displaced_normal(at, DVec3::Z, &lookup);
                worst = worst.max(expected.angle_between(found).to_degrees());
            }
            assert!(worst < 2.0, "{along:?}: off by {worst} degrees");
        }
    }

    /// Noise that is a linear ramp shears the whole surface alike, so that the normal is known exactly.
    #[test]
    fn displaced_normals_of_a_ramp_hold_along_every_axis() {
        const SIDE: usize = 64;
        let rise = [[0.9, -0.3, 0.7], [0.2, 0.8, -0.6]];
        let texel = |index: usize| {
            let at = [index % SIDE, index / SIDE].map(|texel| (texel as f64 + 0.5) / SIDE as f64 - 0.5);
            let channel = |channel: usize| 0.5 + (rise[0][channel] * at[0] + rise[1][channel] * at[1]) * 0.6;
            [channel(0) as f32, channel(1) as f32, channel(2) as f32, 1.0]
        };
        let tile = Arc::new(Tile::new([SIDE; 2], (0..SIDE * SIDE).map(texel).collect()));
        let noise = VertexNoise { tile, scale: 1.5, along: Along::Channels, moves_normals: true };
        // Turned, so that a step along any axis of the model is a step in the texture; and shifted to the texture's
        // middle.
        let turned = DAffine3::from_rotation_x(0.7) * DAffine3::from_rotation_y(-0.5);
        let lookup = Lookup::new([0.3, 0.4], Some(turned), DVec2::splat(0.5));
        let moved = |at: DVec3| noise.displaced(at, DVec3::Z, &lookup);
        for normal in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(0.6, -0.3, 0.8).normalize()] {
            let along = normal.any_orthonormal_vector();
            let across = normal.cross(along);
            let edge = |axis: DVec3| moved(axis * 0.3) - moved(axis * -0.3);
            let expected = edge(along).cross(edge(across)).normalize();
            let found = noise.displaced_normal(DVec3::splat(0.02), normal, &lookup);
            let off = expected.angle_between(found).to_degrees();
            assert!(off < 0.01, "the displaced normal of {normal} is off by {off} degrees");
            assert!(normal.angle_between(found) > 0.1, "{normal} is not turned: nothing is tested");
        }
    }
}
