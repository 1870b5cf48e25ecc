//! How many particles an object needs where the scene does not state it.

use glam::{DVec2, DVec3, Vec3};
use impasto_core::ScreenMap;
use impasto_core::sampling::Surface;
use impasto_core::screen_map::{area_px, facing};
use rayon::prelude::*;

/// The least and the greatest number that is found.
const LEAST: f64 = 64.0;
const MOST: f64 = 400_000.0;

/// At most this many faces are examined.
const FACES: usize = 20_000;

/// One view of the object, at the scene's own size.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Sighting {
    pub(crate) map: ScreenMap,
    pub(crate) half_size_px: DVec2,
    pub(crate) near: f64,
}

/// A face, with what its strokes need.
struct CountedFace<const LAYERS: usize> {
    center: DVec3,
    normal: DVec3,
    area: f64,
    /// Strokes wanted per pixel, of each layer.
    wanted_per_px: [f64; LAYERS],
}

/// For each layer, how many particles give nine tenths of the object's area in the picture all the strokes wanted
/// there, in the view that needs most. `wanted_per_px` gives the strokes per pixel wanted on a triangle.
pub(crate) fn find<const LAYERS: usize>(
    surface: &Surface<'_>,
    sightings: &[Sighting],
    wanted_per_px: impl Fn(usize, DVec3, DVec3) -> [f32; LAYERS],
) -> [usize; LAYERS] {
    let stride = surface.faces().count().div_ceil(FACES).max(1);
    let faces: Vec<CountedFace<LAYERS>> = surface
        .faces()
        .step_by(stride)
        .map(|(triangle, flipped, area)| {
            let [a, b, c] = surface.mesh().corners(triangle as usize).map(Vec3::as_dvec3);
            let across = (b - a).cross(c - a).normalize_or_zero();
            let (center, normal) = ((a + b + c) / 3.0, if flipped { -across } else { across });
            CountedFace {
                center,
                normal,
                area,
                wanted_per_px: wanted_per_px(triangle as usize, center, normal).map(f64::from),
            }
        })
        .collect();
    let most = |a: [f64; LAYERS], b: [f64; LAYERS]| std::array::from_fn(|layer| a[layer].max(b[layer]));
    let needed_per_area =
        sightings.par_iter().map(|sighting| needed_per_area(&faces, sighting)).reduce(|| [0.0; LAYERS], most);
    // A quarter more, since the highest ranks are only half present at just the number wanted.
    needed_per_area.map(|needed| (needed * surface.area() * 1.25).clamp(LEAST, MOST).ceil() as usize)
}

/// Particles needed per unit of surface in one view, by layer.
fn needed_per_area<const LAYERS: usize>(faces: &[CountedFace<LAYERS>], sighting: &Sighting) -> [f64; LAYERS] {
    let seen: Vec<(&CountedFace<LAYERS>, f64)> = faces
        .iter()
        .filter_map(|face| {
            let inside = sighting.map.project(face.center).abs().cmplt(sighting.half_size_px * 1.1).all();
            if sighting.map.depth(face.center) <= sighting.near || !inside {
                return None;
            }
            let jacobian = sighting.map.jacobian(face.center);
            let px_per_area = area_px(jacobian, face.normal);
            let faces_the_eye = px_per_area.is_finite() && facing(jacobian, face.normal) > 0.0;
            faces_the_eye.then_some((face, px_per_area))
        })
        .collect();
    let mut needed: Vec<(f64, f64)> = Vec::with_capacity(seen.len());
    std::array::from_fn(|layer| {
        needed.clear();
        needed.extend(
            seen.iter().map(|(face, px_per_area)| {
                (px_per_area * face.wanted_per_px[layer], px_per_area * face.area)
            }),
        );
        let total: f64 = needed.iter().map(|&(_, shown)| shown).sum();
        reached(&mut needed, 0.9 * total).unwrap_or(0.0)
    })
}

/// Weighted quantile: the least value such that the weights of all values up to it add up to `target`.
fn reached(mut values: &mut [(f64, f64)], target: f64) -> Option<f64> {
    const FEW: usize = 32;
    let order = |a: &(f64, f64), b: &(f64, f64)| a.0.total_cmp(&b.0);
    let mut sum = 0.0;
    while values.len() > FEW {
        let middle = values.len() / 2;
        values.select_nth_unstable_by(middle, order);
        let (lower, upper) = values.split_at_mut(middle + 1);
        let weight: f64 = lower.iter().map(|&(_, weight)| weight).sum();
        values = if sum + weight >= target {
            lower
        } else {
            sum += weight;
            upper
        };
    }
    values.sort_unstable_by(order);
    values.iter().find_map(|&(value, weight)| {
        sum += weight;
        (sum >= target).then_some(value)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use impasto_core::hash;

    #[test]
    fn a_value_is_reached_as_in_a_sorted_list() {
        for count in [0u32, 1, 31, 33, 500] {
            let random = |index: u32, which: u32| f64::from(hash::unit(hash::combine(index, which)));
            let mut values: Vec<(f64, f64)> = (0..count).map(|i| (random(i, 1), random(i, 2))).collect();
            let mut sorted = values.clone();
            sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
            let total: f64 = sorted.iter().map(|&(_, weight)| weight).sum();
            for share in [0.05, 0.5, 0.9] {
                let mut sum = 0.0;
                let expected = sorted.iter().find_map(|&(value, weight)| {
                    sum += weight;
                    (sum >= share * total).then_some(value)
                });
                assert_eq!(reached(&mut values, share * total), expected, "{count} {share}");
            }
        }
    }
}
