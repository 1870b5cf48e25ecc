//! The canvas: a tile of woven linen that repeats, with height and slopes.

use impasto_core::hash;
use impasto_core::presence::smoothstep;

/// Side of the tile in texels. At the scene's own size, a texel covers one pixel.
pub(super) const SIDE: u32 = 288;

/// Distance from one thread to the next, pixels: 80 threads in a tile.
const PITCH_PX: f32 = 3.6;

/// How much threads differ in thickness: a standard deviation, as a share of the mean.
const THREAD_JITTER: f32 = 0.18;
/// How far threads stray from a straight line, in units of [`PITCH_PX`].
const WANDER: f32 = 0.35;

/// How often a thread strays and returns in one tile.
const WANDER_CYCLES: u32 = 3;

/// The tile, bottom row first, four bytes a texel: height above the mean, slope in x and slope in y (both per texel),
/// unused. The bytes 0..255 stand for −1..1.
pub(super) fn tile() -> Vec<u8> {
    let side = SIDE as usize;
    let heights: Vec<f32> = (0..side * side).map(|index| height(index % side, index / side)).collect();
    let mean = heights.iter().sum::<f32>() / heights.len() as f32;
    let at = |x: usize, y: usize| heights[(y % side) * side + x % side];
    let byte = |value: f32| ((value * 0.5 + 0.5).clamp(0.0, 1.0) * 255.0).round() as u8;
    (0..side * side)
        .flat_map(|index| {
            let (x, y) = (index % side, index / side);
            let slope_x = 0.5 * (at(x + 1, y) - at(x + side - 1, y));
            let slope_y = 0.5 * (at(x, y + 1) - at(x, y + side - 1));
            [byte(at(x, y) - mean), byte(slope_x), byte(slope_y), 255]
        })
        .collect()
}

/// Height of the threads, which go over and under each other; about 0..1.
fn height(x: usize, y: usize) -> f32 {
    let (x, y) = (x as f32 + 0.5, y as f32 + 0.5);
    let threads = (SIDE as f32 / PITCH_PX).round();
    let (warp_at, weft_at) = (x / PITCH_PX + wander(1, x, y), y / PITCH_PX + wander(2, x, y));
    let thread = |at: f32, which: u32| {
        let number = at.floor().rem_euclid(threads) as u32;
        let thickness = 1.0 + THREAD_JITTER * hash::normal(hash::combine(which, number));
        let across = 2.0 * (at - at.floor()) - 1.0;
        (1.0 - (across / thickness.clamp(0.6, 1.4)).powi(2)).max(0.0).sqrt()
    };
    // Each thread goes over one crossing thread and under the next.
    let over = 0.5
        + 0.5
            * (std::f32::consts::PI * (warp_at - 0.5)).sin()
            * (std::f32::consts::PI * (weft_at - 0.5)).sin();
    let (warp, weft) = (thread(warp_at, 3) * (0.35 + 0.65 * over), thread(weft_at, 4) * (1.0 - 0.65 * over));
    warp.max(weft)
}

/// How far a thread strays here, in units of [`PITCH_PX`]; repeats with the tile.
fn wander(which: u32, x: f32, y: f32) -> f32 {
    let scale = WANDER_CYCLES as f32 / SIDE as f32;
    let (u, v) = (x * scale, y * scale);
    let (column, row) = (u.floor(), v.floor());
    let lattice = |dx: u32, dy: u32| {
        let cell = (column as u32 + dx) % WANDER_CYCLES + ((row as u32 + dy) % WANDER_CYCLES) * WANDER_CYCLES;
        hash::unit(hash::combine(which, cell)) * 2.0 - 1.0
    };
    let (fx, fy) = (smoothstep(u - column), smoothstep(v - row));
    let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
    WANDER * mix(mix(lattice(0, 0), lattice(1, 0), fx), mix(lattice(0, 1), lattice(1, 1), fx), fy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tile_repeats_and_has_no_slope_on_the_whole() {
        let tile = tile();
        let side = SIDE as usize;
        let texel =
            |x: usize, y: usize, channel: usize| f32::from(tile[(y * side + x) * 4 + channel]) - 127.5;
        for channel in 0..3 {
            let mean = (0..side * side).map(|index| texel(index % side, index / side, channel)).sum::<f32>()
                / (side * side) as f32;
            assert!(mean.abs() < 1.0, "channel {channel}: {mean}");
        }
        let step = |x: usize| -> f32 {
            (0..side).map(|y| (texel(x, y, 0) - texel((x + 1) % side, y, 0)).abs()).sum()
        };
        let largest = (0..side - 1).map(step).fold(0.0f32, f32::max);
        assert!(step(side - 1) <= largest, "{} at the border, {largest} inside", step(side - 1));
    }
}
