//! Makes the texture of the paper: a tile that repeats, with clouds of pulp, random fibres, and fine grain (tooth).

use impasto_core::hash;
use impasto_core::presence::smoothstep;

/// Side of the tile in texels. At the scene's own size, a texel covers one pixel.
pub(super) const SIDE: u32 = 512;

/// How many fibres a tile has.
const FIBRES: u32 = 1100;
/// How long fibres are at least and at most, in texels.
const LENGTH: [f32; 2] = [14.0, 90.0];

/// The tile, four bytes a texel, bottom row first. The first three channels are clouds, fibres and tooth, each with a
/// mean of 128.
pub(super) fn tile() -> Vec<u8> {
    let side = SIDE as usize;
    let noise = |at: usize| {
        let (x, y) = (at % side, at / side);
        let share = [x as f32 / side as f32, y as f32 / side as f32];
        let cloud = octaves(1, share, &[(4, 0.5), (8, 0.3), (16, 0.2)]);
        let tooth = octaves(2, share, &[(128, 0.45), (256, 0.35)]) + 0.2 * lattice(3, x as u32, y as u32);
        [1.5 * cloud, 1.2 * tooth]
    };
    let [clouds, teeth]: [Vec<f32>; 2] =
        [0, 1].map(|which| (0..side * side).map(|at| noise(at)[which]).collect());
    let [clouds, fibres, teeth] = [clouds, fibres(), teeth].map(centred);
    let byte = |value: f32| (128.0 + 127.0 * value.clamp(-1.0, 0.99)).round() as u8;
    (0..side * side).flat_map(|at| [byte(clouds[at]), byte(fibres[at]), byte(teeth[at]), 255]).collect()
}

/// The same values minus their mean.
fn centred(values: Vec<f32>) -> Vec<f32> {
    let mean = values.iter().sum::<f32>() / values.len() as f32;
    values.into_iter().map(|value| value - mean).collect()
}

/// The random number at a lattice point, −1..1.
fn lattice(which: u32, x: u32, y: u32) -> f32 {
    hash::unit(hash::combine(hash::combine(which, x), y)) * 2.0 - 1.0
}

/// A sum of smooth noises that repeat with the tile; each part has a number of cells per side and a weight.
fn octaves(which: u32, at: [f32; 2], parts: &[(u32, f32)]) -> f32 {
    let one = |cells: u32| {
        let [u, v] = at.map(|at| at * cells as f32);
        let (column, row) = (u.floor(), v.floor());
        let corner = |dx: u32, dy: u32| {
            lattice(which + cells, (column as u32 + dx) % cells, (row as u32 + dy) % cells)
        };
        let (fx, fy) = (smoothstep(u - column), smoothstep(v - row));
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        mix(mix(corner(0, 0), corner(1, 0), fx), mix(corner(0, 1), corner(1, 1), fx), fy)
    };
    parts.iter().map(|&(cells, share)| share * one(cells)).sum()
}

/// Curved fibres all over the tile, some lighter than the pulp and some darker.
fn fibres() -> Vec<f32> {
    let side = SIDE as usize;
    let mut values = vec![0.0f32; side * side];
    for fibre in 0..FIBRES {
        let random = |which: u32| hash::unit(hash::combine(hash::combine(0xf1b, fibre), which));
        let (mut x, mut y) = (random(1) * side as f32, random(2) * side as f32);
        let mut angle_rad = random(3) * std::f32::consts::TAU;
        let turn_rad = (random(4) - 0.5) * 0.09;
        let length = LENGTH[0] + (LENGTH[1] - LENGTH[0]) * random(5).powi(3);
        let strength = (random(6) - 0.42) * 0.9;
        let steps = length as u32;
        for step in 0..steps {
            let along = (step as f32 + 0.5) / steps as f32;
            let there = strength * (4.0 * along * (1.0 - along)).sqrt();
            add_spot(&mut values, [x, y], there);
            (x, y) = (x + angle_rad.cos(), y + angle_rad.sin());
            angle_rad += turn_rad;
        }
    }
    values
}

/// Adds to the four texels around a point, more to the nearer ones.
fn add_spot(values: &mut [f32], [x, y]: [f32; 2], strength: f32) {
    let side = SIDE as i32;
    let (left, below) = (x.floor(), y.floor());
    for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
        let (cx, cy) = ((left as i32 + dx).rem_euclid(side), (below as i32 + dy).rem_euclid(side));
        let share = (1.0 - (x - left - dx as f32).abs()) * (1.0 - (y - below - dy as f32).abs());
        values[(cy * side + cx) as usize] += strength * share;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tile_repeats_and_neither_darkens_nor_lightens_the_paper() {
        let tile = tile();
        let side = SIDE as usize;
        let texel =
            |x: usize, y: usize, channel: usize| f32::from(tile[(y * side + x) * 4 + channel]) - 128.0;
        for channel in 0..3 {
            let sum: f32 = (0..side * side).map(|index| texel(index % side, index / side, channel)).sum();
            let mean = sum / (side * side) as f32;
            assert!(mean.abs() < 1.5, "channel {channel}: {mean}");
            let step = |x: usize| -> f32 {
                (0..side).map(|y| (texel(x, y, channel) - texel((x + 1) % side, y, channel)).abs()).sum()
            };
            let largest = (0..side - 1).map(step).fold(0.0f32, f32::max);
            assert!(step(side - 1) <= largest, "{} at the border, {largest} inside", step(side - 1));
        }
    }
}
