//! How many particles an object needs when its scene does not say.

use glam::{DVec2, DVec3, Vec3};
use impasto_core::ScreenMap;
use impasto_core::sampling::Surface;
use impasto_core::screen_map::{area_px, facing};

/// Bounds of the number found.
const LEAST: f64 = 64.0;
const MOST: f64 = 400_000.0;

/// Faces looked at, at most.
const FACES: usize = 20_000;

/// A pose in which the object is seen, at the scene's own size.
pub(crate) struct Sighting {
    pub(crate) map: ScreenMap,
    pub(crate) half_size_px: DVec2,
    pub(crate) near: f64,
}

/// The count at which nine tenths of the picture of this surface, in its nearest sighting, get all the strokes that they
/// want. `wanted_per_px` gives the strokes per pixel wanted on a triangle.
pub(crate) fn find(
    surface: &Surface<'_>,
    sightings: &[Sighting],
    wanted_per_px: impl Fn(usize) -> f32,
) -> usize {
    let faces: Vec<(u32, bool, f64)> = surface.faces().collect();
    let stride = faces.len().div_ceil(FACES).max(1);
    let mut needed_per_area = 0.0f64;
    for sighting in sightings {
        let mut seen: Vec<(f64, f64)> = Vec::new();
        for &(triangle, flipped, area) in faces.iter().step_by(stride) {
            let [a, b, c] = surface.mesh().corners(triangle as usize).map(Vec3::as_dvec3);
            let across = (b - a).cross(c - a).normalize_or_zero();
            let normal: DVec3 = if flipped { -across } else { across };
            let center = (a + b + c) / 3.0;
            let inside = sighting.map.project(center).abs().cmplt(sighting.half_size_px * 1.1).all();
            if sighting.map.depth(center) <= sighting.near || !inside {
                continue;
            }
            let jacobian = sighting.map.jacobian(center);
            let px_per_area = area_px(jacobian, normal);
            if px_per_area.is_finite() && facing(jacobian, normal) > 0.0 {
                seen.push((px_per_area * f64::from(wanted_per_px(triangle as usize)), px_per_area * area));
            }
        }
        seen.sort_by(|a, b| a.0.total_cmp(&b.0));
        let total: f64 = seen.iter().map(|&(_, shown)| shown).sum();
        let mut sum = 0.0;
        for (needed, shown) in seen {
            sum += shown;
            if sum >= 0.9 * total {
                needed_per_area = needed_per_area.max(needed);
                break;
            }
        }
    }
    // A quarter more than a full supply, since the last ranks are still fading in at one.
    (needed_per_area * surface.area() * 1.25).clamp(LEAST, MOST).ceil() as usize
}
