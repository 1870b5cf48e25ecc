//! Sorts points in Morton order, so that searches and gathers find their data in the cache. kiddo and rstar are queried
//! in this order. Where our solve races against gathers, all contenders store their particles in this order.

use glam::Vec3;
use rayon::prelude::*;

/// Spreads the low ten bits to every third bit.
fn spread(bits: u32) -> u32 {
    let mut bits = bits & 0x3ff;
    bits = (bits | (bits << 16)) & 0x0300_00ff;
    bits = (bits | (bits << 8)) & 0x0300_f00f;
    bits = (bits | (bits << 4)) & 0x030c_30c3;
    (bits | (bits << 2)) & 0x0924_9249
}

/// The indices of the points in Morton order.
pub fn order(points: &[Vec3]) -> Vec<u32> {
    let low = points.iter().copied().fold(Vec3::INFINITY, Vec3::min);
    let high = points.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
    let scale = 1023.0 / (high - low).max_element().max(f32::MIN_POSITIVE);
    let mut keys: Vec<u64> = points
        .par_iter()
        .enumerate()
        .map(|(index, &point)| {
            let [x, y, z] = ((point - low) * scale).to_array().map(|cell| spread(cell as u32));
            u64::from(x | (y << 1) | (z << 2)) << 32 | index as u64
        })
        .collect();
    keys.par_sort_unstable();
    keys.into_par_iter().map(|key| key as u32).collect()
}
