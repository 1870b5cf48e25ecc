//! An endless, even, random sequence of particles: what dart throwing throws.

use super::{Particle, Surface, barycentric};
use crate::hash;

/// The sequence: its `i`th particle depends on the surface, the seed and `i` alone. `surface` must have a face.
pub(super) fn candidates<'a>(surface: &'a Surface<'a>, seed: u32) -> impl Fn(u32) -> Particle + Sync + 'a {
    let guide = guide_table(&surface.area_up_to);
    move |index| candidate(surface, &guide, hash::combine(seed, index))
}

fn candidate(surface: &Surface<'_>, guide: &[u32], seed: u32) -> Particle {
    // 53 random bits, so that a speck beside a huge face still has its share.
    let high = f64::from(hash::combine(seed, 0)) / 4_294_967_296.0;
    let low = f64::from(hash::combine(seed, 1) >> 11) / 9_007_199_254_740_992.0;
    let target = (high + low) * surface.area();
    let bucket = ((high * (guide.len() - 1) as f64) as usize).min(guide.len() - 2);
    let (from, to) = (guide[bucket] as usize, guide[bucket + 1] as usize + 1);
    let to = to.min(surface.faces.len());
    let face = from + surface.area_up_to[from..to].partition_point(|&sum| sum <= target);
    let place = barycentric(hash::unit(hash::combine(seed, 2)), hash::unit(hash::combine(seed, 3)));
    surface.particle(face.min(surface.faces.len() - 1), place)
}

/// For each of as many equal steps of area as there are faces, the face that the step begins in.
fn guide_table(area_up_to: &[f64]) -> Vec<u32> {
    let steps = area_up_to.len();
    let total = area_up_to[steps - 1];
    let mut face = 0;
    (0..=steps)
        .map(|step| {
            let area = total * step as f64 / steps as f64;
            while face + 1 < steps && area_up_to[face] <= area {
                face += 1;
            }
            face as u32
        })
        .collect()
}
