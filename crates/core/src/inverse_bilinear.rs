//! Where a point lies in a quadrilateral: the inverse of bilinear interpolation.
//!
//! For a point p and the corners p₀ to p₃, let q = p − p₀, b₁ = p₁ − p₀, b₂ = p₂ − p₀, b₃ = p₀ − p₁ − p₂ + p₃ (how far
//! the quad is from a parallelogram), and the wedge a∧b = a.x b.y − a.y b.x. Then p = p₀ + b₁u + b₂v + b₃uv gives
//!
//! ```text
//! A v² + B v + C = 0,   A = b₂∧b₃,   B = b₃∧q − b₁∧b₂,   C = b₁∧q
//! v = 2C / (−B + s √(B² − 4AC)),   u = (q − b₂v) / (b₁ + b₃v)
//! ```
//!
//! s is the sign of the quad's area; on a convex quad b₁∧b₂ has the same sign. This form of the root also holds where
//! A is 0 (the sides p₀p₂ and p₁p₃ are parallel), and for either winding. Where the two terms of its denominator have
//! opposite signs, and so might cancel, the same root is computed as (−B − s √(B² − 4AC)) / 2A. u follows from X or
//! from Y, whichever has the larger denominator. `crates/gl-render/shaders/shared/inverse_bilinear.glsl` computes the
//! same in 32 bits.

use glam::DVec2;

/// The coordinates that [`inverse_bilinear`] gives are clamped to ± this.
pub const FARTHEST: f64 = 1e4;

/// The point at (u, v) of a quad whose corners are at (0, 0), (1, 0), (0, 1) and (1, 1), in this order.
pub fn bilinear(at: DVec2, [p0, p1, p2, p3]: [DVec2; 4]) -> DVec2 {
    p0.lerp(p1, at.x).lerp(p2.lerp(p3, at.x), at.y)
}

/// (u, v) of a point in a quad whose corners are at (0, 0), (1, 0), (0, 1) and (1, 1), in this order, wound either way.
/// Inside the quad both are within 0..=1.
///
/// The bilinear map of a concave quad folds over itself, so two (u, v) may lead to one point. A point inside gets the
/// one in the part of the map that is not turned over: the map's Jacobian there has the sign of the quad's area. Points
/// that no (u, v) reaches, points far outside, and quads without area give numbers without meaning: at most
/// [`FARTHEST`] from 0 and never NaN, for coordinates up to 1e30.
pub fn inverse_bilinear(point: DVec2, [p0, p1, p2, p3]: [DVec2; 4]) -> DVec2 {
    let (q, b1, b2, b3) = (point - p0, p1 - p0, p2 - p0, p0 - p1 - p2 + p3);
    let a = b2.perp_dot(b3);
    let b = b3.perp_dot(q) - b1.perp_dot(b2);
    let c = b1.perp_dot(q);
    let sign = if (p3 - p0).perp_dot(p2 - p1) < 0.0 { -1.0 } else { 1.0 };
    let root = sign * (b * b - 4.0 * a * c).max(0.0).sqrt();
    let v = if sign * b > 0.0 { ratio(-b - root, 2.0 * a) } else { ratio(2.0 * c, root - b) };
    let (over, under) = (q - b2 * v, b1 + b3 * v);
    let u = if under.x.abs() > under.y.abs() { ratio(over.x, under.x) } else { ratio(over.y, under.y) };
    DVec2::new(u, v)
}

/// over / under, at most [`FARTHEST`] from 0; 0 / 0 is 0.
fn ratio(over: f64, under: f64) -> f64 {
    if over.abs() < under.abs() * FARTHEST {
        over / under
    } else if over == 0.0 {
        0.0
    } else {
        FARTHEST.copysign(over) * 1.0_f64.copysign(under)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_undoes_bilinear_interpolation_in_any_convex_quad() {
        let quads = [
            [[0.0, 0.0], [3.0, 0.0], [0.0, 2.0], [3.0, 2.0]],
            [[1.0, 1.0], [4.0, 2.0], [0.0, 3.0], [3.5, 5.0]],
            [[-1.0, 0.0], [1.0, 0.0], [-2.0, 4.0], [2.0, 4.0]],
        ];
        for quad in quads.map(|corners| corners.map(DVec2::from_array)) {
            // The quad, and the same quad wound the other way: its second and third corner are exchanged.
            let [p0, p1, p2, p3] = quad;
            for quad in [quad, [p0, p2, p1, p3]] {
                for at in [[0.0, 0.0], [0.25, 0.5], [0.7, 0.1], [1.0, 0.4], [0.3, 1.0]].map(DVec2::from_array)
                {
                    let found = inverse_bilinear(bilinear(at, quad), quad);
                    assert!(found.abs_diff_eq(at, 1e-12), "{found} for {at} in {quad:?}");
                }
            }
        }
    }

    #[test]
    fn without_area_it_is_bounded_and_never_nan() {
        assert_eq!([ratio(0.0, 0.0), ratio(1.0, 0.0), ratio(-1.0, 0.0)], [0.0, FARTHEST, -FARTHEST]);
        assert_eq!([ratio(1.0, -1e-9), ratio(6.0, -3.0)], [-FARTHEST, -2.0]);
        let point = inverse_bilinear(DVec2::new(5.0, -3.0), [DVec2::ZERO; 4]);
        assert!(point.abs().max_element() <= FARTHEST, "{point}");
    }
}
