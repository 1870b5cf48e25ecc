//! The two built-in noise textures: coloured Gaussian noise for vertices, grey Perlin noise for surfaces.

use std::f64::consts::TAU;
use std::sync::{Arc, LazyLock};

use noise::{NoiseFn, Perlin};
use rayon::prelude::*;

use super::Tile;
use crate::hash;

/// Side of the Gaussian noise, texels.
const GAUSSIAN_SIDE: usize = 128;

/// Standard deviation of the Gaussian that smooths the white noise, texels.
const SMOOTHING: f64 = 4.0;

/// Side of the Perlin noise, texels.
const PERLIN_SIDE: usize = 256;

/// Cells per side of the coarsest octave, and how many octaves there are.
const CELLS: f64 = 4.0;
const OCTAVES: u32 = 5;

/// Standard deviation of the values of each noise; their mean is a half.
const DEVIATION: f64 = 0.17;

/// Coloured Gaussian noise: three independent channels, normally distributed about a half. It is smoothed, so that
/// neighbouring vertices move alike.
pub fn gaussian() -> Arc<Tile> {
    static TILE: LazyLock<Arc<Tile>> = LazyLock::new(|| {
        let channels = [0, 1, 2].map(|channel| levelled(smoothed(channel), |value| value));
        let texel = |index: usize| [channels[0][index], channels[1][index], channels[2][index], 1.0];
        let texels = (0..GAUSSIAN_SIDE * GAUSSIAN_SIDE).map(texel).collect();
        Arc::new(Tile::new([GAUSSIAN_SIDE; 2], texels))
    });
    Arc::clone(&TILE)
}

/// Grey Perlin noise of several octaves.
pub fn perlin() -> Arc<Tile> {
    static TILE: LazyLock<Arc<Tile>> = LazyLock::new(|| {
        let octaves: Vec<Perlin> = (0..OCTAVES).map(|octave| Perlin::new(17 + octave)).collect();
        // Sampled on a torus in four dimensions, so that the texture has no seam.
        let value = |index: usize| {
            let angle = |at: usize| TAU * (at as f64 + 0.5) / PERLIN_SIDE as f64;
            let (u, v) = (angle(index % PERLIN_SIDE).sin_cos(), angle(index / PERLIN_SIDE).sin_cos());
            let of_octave = |(octave, noise): (usize, &Perlin)| {
                let fineness = f64::from(1u32 << octave);
                let radius = CELLS * fineness / TAU;
                noise.get([u.0, u.1, v.0, v.1].map(|part| part * radius + 11.3)) / fineness
            };
            octaves.iter().enumerate().map(of_octave).sum::<f64>()
        };
        let values = (0..PERLIN_SIDE * PERLIN_SIDE).into_par_iter().map(value).collect();
        // The curve keeps values away from 0 and 1: layers of noise are multiplied, so a zero in one would hide all
        // others.
        let grey = levelled(values, |value| 0.5 * (2.0 * value).tanh());
        let texels = grey.into_iter().map(|grey| [grey, grey, grey, 1.0]).collect();
        Arc::new(Tile::new([PERLIN_SIDE; 2], texels))
    });
    Arc::clone(&TILE)
}

/// White noise, smoothed along rows and columns.
fn smoothed(channel: u32) -> Vec<f64> {
    let side = GAUSSIAN_SIDE;
    let white = |index: u32| f64::from(hash::normal(hash::combine(channel, hash::scramble(index))));
    let white: Vec<f64> = (0..(side * side) as u32).map(white).collect();
    let reach = (3.0 * SMOOTHING) as usize;
    let weight = |offset: usize| (-0.5 * (offset as f64 - reach as f64).powi(2) / SMOOTHING.powi(2)).exp();
    let weights: Vec<f64> = (0..=2 * reach).map(weight).collect();
    let along = |from: &[f64], step: usize| -> Vec<f64> {
        let value = |index: usize| {
            let (x, y) = (index % side, index / side);
            let at = |offset: usize| match step {
                1 => from[y * side + (x + offset + side - reach) % side],
                _ => from[(y + offset + side - reach) % side * side + x],
            };
            weights.iter().enumerate().map(|(offset, weight)| weight * at(offset)).sum()
        };
        (0..side * side).map(value).collect()
    };
    along(&along(&white, 1), side)
}

/// Scales and shifts the values to a mean of a half and a deviation of about [`DEVIATION`], clamped to 0..=1. `curve`
/// is applied after they are scaled, while their mean is still 0.
fn levelled(values: Vec<f64>, curve: impl Fn(f64) -> f64) -> Vec<f32> {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let deviation = (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt();
    let level = |value: f64| (0.5 + curve((value - mean) / deviation * DEVIATION)).clamp(0.0, 1.0) as f32;
    values.into_iter().map(level).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moments(tile: &Tile, channel: usize) -> [f64; 2] {
        let values: Vec<f64> = tile.texels().iter().map(|texel| f64::from(texel[channel])).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let square = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64;
        [mean, square.sqrt()]
    }

    #[test]
    fn noises_have_the_stated_mean_and_deviation() {
        for (tile, channels) in [(gaussian(), 3), (perlin(), 1)] {
            for channel in 0..channels {
                let [mean, deviation] = moments(&tile, channel);
                assert!(
                    (mean - 0.5).abs() < 0.005 && (deviation - DEVIATION).abs() < 0.02,
                    "{mean} {deviation}"
                );
            }
        }
    }

    #[test]
    fn gaussian_noise_has_independent_normal_channels_and_perlin_noise_is_grey() {
        let tile = gaussian();
        let count = tile.texels().len() as f64;
        let product = |texel: &[f32; 4]| f64::from(texel[0] - 0.5) * f64::from(texel[1] - 0.5);
        let correlation = tile.texels().iter().map(product).sum::<f64>() / count / DEVIATION.powi(2);
        assert!(correlation.abs() < 0.15, "{correlation}");
        let near = tile.texels().iter().filter(|texel| f64::from(texel[0] - 0.5).abs() < DEVIATION).count();
        assert!((near as f64 / count - 0.683).abs() < 0.04, "{near} within one deviation");
        assert!(perlin().texels().iter().all(|texel| texel[0] == texel[1] && texel[1] == texel[2]));
    }

    #[test]
    fn neither_has_a_seam() {
        for tile in [gaussian(), perlin()] {
            let [columns, rows] = tile.size();
            let step = |a: usize, b: usize| f64::from((tile.texels()[a][0] - tile.texels()[b][0]).abs());
            let mean = |steps: Vec<f64>| steps.iter().sum::<f64>() / steps.len() as f64;
            let inside = mean((0..rows).map(|y| step(y * columns + 40, y * columns + 41)).collect());
            let across = mean((0..rows).map(|y| step(y * columns, y * columns + columns - 1)).collect());
            assert!(across < 2.0 * inside, "{across} across the seam, {inside} elsewhere");
        }
    }
}
