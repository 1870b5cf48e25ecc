//! Strokes whose size in the picture follows that of their surface (`size_follow`).

use glam::DVec3;
use impasto_core::ScreenMap;

/// A stroke grows at most this many times, and shrinks at most to the inverse.
pub(crate) const MOST_GROWTH: f32 = 64.0;

/// The factor on a stroke's stated size: m^γ. m is the pixels that a unit of length on the surface fills now over those
/// that it fills in the reference picture, γ the region's `size_follow`.
pub(crate) fn growth(m: f64, follow: f64) -> f64 {
    let grown = m.powf(follow);
    if grown.is_finite() { grown.clamp(1.0 / f64::from(MOST_GROWTH), f64::from(MOST_GROWTH)) } else { 1.0 }
}

/// The pixels that a unit of length fills where the projection divides by `w`. A `w` below `near` counts as `near`.
pub(crate) fn px_per_unit(map: &ScreenMap, w: f64, near: f64) -> f64 {
    map.row_x.truncate().length() / w.max(near)
}

/// How the strokes on an object that stays at rest follow its size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Following {
    /// The reference, in which strokes have their stated size.
    map: ScreenMap,
    near: f64,
    /// The least and the greatest γ on the object.
    follow: [f64; 2],
}

impl Following {
    /// The reference is given by its map and its near plane, `follow` are the least and the greatest γ.
    pub(crate) fn new(map: ScreenMap, near: f64, follow: [f64; 2]) -> Self {
        Self { map, near, follow }
    }

    /// The least and the greatest growth of strokes in a sphere where a unit of length now fills between `now[0]` and
    /// `now[1]` pixels.
    pub(crate) fn growth_in(&self, center: DVec3, radius: f64, now: [f64; 2]) -> [f64; 2] {
        let w = self.map.row_w.dot(center.extend(1.0));
        let apart = self.map.row_w.truncate().length() * radius;
        let [fewest, most] = [w + apart, w - apart].map(|w| px_per_unit(&self.map, w, self.near));
        let [least_m, most_m] = [now[0] / most, now[1] / fewest];
        let [least, greatest] = self.follow;
        [
            growth(least_m, if least_m < 1.0 { greatest } else { least }),
            growth(most_m, if most_m < 1.0 { least } else { greatest }),
        ]
    }
}

#[cfg(test)]
mod tests {
    use glam::DAffine3;
    use impasto_core::hash;
    use impasto_core::screen_map::PixelLens;

    use super::*;

    /// Points of spheres, some of them round the reference's eye, seen by another camera.
    #[test]
    fn no_stroke_of_a_sphere_grows_beyond_its_bounds() {
        let map = |eye: DVec3| {
            let view = glam::dcamera::rh::view::look_at_mat4(eye, DVec3::new(0.2, 0.1, 0.0), DVec3::Y);
            ScreenMap::new(view, DAffine3::IDENTITY, PixelLens::Perspective { focal_px: 400.0 })
        };
        let chance = |index: u32, which: u32| f64::from(hash::unit(hash::combine(index, which)));
        let at = |index: u32, first: u32| {
            DVec3::from_array([0, 1, 2].map(|axis| chance(index, first + axis) - 0.5))
        };
        let (near, mut asked) = (0.05, 0);
        for index in 0..2000 {
            let (reference, now) = (map(at(index, 0) * 12.0), map(at(index, 3) * 12.0));
            let of_rules = [chance(index, 6), chance(index, 7)];
            let follow = [of_rules[0].min(of_rules[1]), of_rules[0].max(of_rules[1])];
            let following = Following { map: reference, near, follow };
            let (center, radius) = (at(index, 8) * 6.0, 2.0 * chance(index, 11));
            let w = |map: &ScreenMap, at: DVec3| map.row_w.dot(at.extend(1.0));
            let apart = now.row_w.truncate().length() * radius;
            let of_now = [apart, -apart].map(|apart| px_per_unit(&now, w(&now, center) + apart, near));
            let [least, most] = following.growth_in(center, radius, of_now);
            for point in 0..20 {
                let point = center
                    + at(index, 20 + 3 * point).normalize_or_zero() * radius * chance(index, 90 + point);
                if w(&now, point) < near {
                    continue;
                }
                let m = px_per_unit(&now, w(&now, point), near)
                    / px_per_unit(&reference, w(&reference, point), near);
                asked += 1;
                for follow in of_rules {
                    let grown = growth(m, follow);
                    assert!(
                        least <= grown * 1.000_001 && grown <= most * 1.000_001,
                        "{least} {grown} {most}"
                    );
                }
            }
        }
        assert!(asked > 10_000, "{asked}");
    }
}
