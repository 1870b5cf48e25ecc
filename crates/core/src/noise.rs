//! Slow (low-frequency) noise in space: over a surface it gradually turns strokes, shifts colours, and changes how far
//! strokes overrun edges.

use glam::{DVec3, Vec3};

use crate::hash;
use crate::wide::{Wide, widest};

/// Two octaves of value noise at each point, with mean 0 and a standard deviation of about 1. The first octave has one
/// lattice cell per unit, the second about two. `noise` must be as long as `at`.
pub fn slow(seed: u32, at: &[DVec3], noise: &mut [f32]) {
    widest(Slow { seed, at, noise });
}

struct Slow<'a> {
    seed: u32,
    at: &'a [DVec3],
    noise: &'a mut [f32],
}

impl Wide for Slow<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let second_seed = hash::scramble(self.seed);
        for (noise, &at) in self.noise.iter_mut().zip(self.at) {
            // Shifted, so that the lattices of the two octaves do not coincide at the origin.
            let second = at * 2.03 + DVec3::splat(17.3);
            // 4.9 brings the standard deviation to about 1.
            *noise = (value(self.seed, at) + 0.5 * value(second_seed, second)) * 4.9;
        }
    }
}

/// Value noise around 0, −0.5..0.5.
#[inline(always)]
fn value(seed: u32, at: DVec3) -> f32 {
    let cell = at.floor();
    let t: Vec3 = (at - cell).as_vec3();
    let t = t * t * (3.0 - 2.0 * t);
    let [x, y, z] = cell.to_array().map(|value| value as i64 as u32);
    // The eight corners side by side: x changes fastest.
    let mut corners = [0.0f32; 8];
    for (corner, value) in corners.iter_mut().enumerate() {
        let [dx, dy, dz] = [corner as u32 & 1, corner as u32 >> 1 & 1, corner as u32 >> 2];
        let key = hash::combine(hash::combine(x.wrapping_add(dx), y.wrapping_add(dy)), z.wrapping_add(dz));
        *value = hash::unit(hash::combine(seed, key)) - 0.5;
    }
    let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
    let edge = |first: usize| mix(corners[first], corners[first + 1], t.x);
    mix(mix(edge(0), edge(2), t.y), mix(edge(4), edge(6), t.y), t.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slow_noise_has_mean_0_and_deviation_about_1() {
        let at = |index: u32| {
            [0, 1, 2].map(|axis| f64::from(hash::unit(hash::combine(index, axis))) * 300.0 - 150.0)
        };
        let places: Vec<DVec3> = (0..20_000).map(|index| DVec3::from(at(index))).collect();
        let mut noise = vec![0.0; places.len()];
        slow(5, &places, &mut noise);
        let values: Vec<f64> = noise.into_iter().map(f64::from).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let deviation =
            (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64).sqrt();
        assert!(mean.abs() < 0.05 && (0.8..1.2).contains(&deviation), "mean {mean}, deviation {deviation}");
    }

    #[test]
    fn wide_code_gives_the_same_bits() {
        let places: Vec<DVec3> =
            (0..500).map(|i| DVec3::new(f64::from(i) * -0.71, 0.3, 1e6 / f64::from(i + 1))).collect();
        let (mut wide, mut plain) = (vec![0.0; 500], vec![0.0; 500]);
        slow(9, &places, &mut wide);
        Slow { seed: 9, at: &places, noise: &mut plain }.run();
        assert_eq!(wide, plain);
    }

    #[test]
    fn near_points_have_near_values() {
        for index in 0..1000 {
            let at = DVec3::new(f64::from(index) * 0.37 - 90.0, -3.1, f64::from(index) * 0.11);
            let places = [at, at + DVec3::splat(0.001)];
            let (mut noise, mut other) = ([0.0; 2], [0.0; 2]);
            slow(1, &places, &mut noise);
            slow(2, &places, &mut other);
            assert!((noise[0] - noise[1]).abs() < 0.05);
            assert_ne!(noise[0], other[0]);
        }
    }
}
