//! Smooth noise in space, fixed for ever: what makes strokes swing, colours drift and edges get lost, slowly over a
//! surface.

use glam::DVec3;

use crate::hash;

/// Two octaves of value noise, mean 0 and standard deviation about 1, one cycle a unit.
pub fn slow(seed: u32, at: DVec3) -> f32 {
    // A point between lattice points in every octave.
    let second = at * 2.03 + DVec3::splat(17.3);
    (value(seed, at) + 0.5 * value(hash::scramble(seed), second)) * 4.9
}

/// Value noise around 0, −0.5..0.5.
fn value(seed: u32, at: DVec3) -> f32 {
    let cell = at.floor();
    let t = (at - cell).as_vec3();
    let t = t * t * (3.0 - 2.0 * t);
    let [x, y, z] = cell.to_array().map(|value| value as i64 as u32);
    let corner = |dx: u32, dy: u32, dz: u32| {
        let key = hash::combine(hash::combine(x.wrapping_add(dx), y.wrapping_add(dy)), z.wrapping_add(dz));
        hash::unit(hash::combine(seed, key)) - 0.5
    };
    let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
    let edge = |dy: u32, dz: u32| mix(corner(0, dy, dz), corner(1, dy, dz), t.x);
    mix(mix(edge(0, 0), edge(1, 0), t.y), mix(edge(0, 1), edge(1, 1), t.y), t.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slow_noise_has_mean_0_and_deviation_about_1() {
        let values: Vec<f64> = (0..20_000)
            .map(|index| {
                let at =
                    [0, 1, 2].map(|axis| f64::from(hash::unit(hash::combine(index, axis))) * 300.0 - 150.0);
                f64::from(slow(5, DVec3::from(at)))
            })
            .collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let deviation =
            (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64).sqrt();
        assert!(mean.abs() < 0.05 && (0.8..1.2).contains(&deviation), "mean {mean}, deviation {deviation}");
    }

    #[test]
    fn near_points_have_near_values() {
        for index in 0..1000 {
            let at = DVec3::new(f64::from(index) * 0.37 - 90.0, -3.1, f64::from(index) * 0.11);
            assert!((slow(1, at) - slow(1, at + DVec3::splat(0.001))).abs() < 0.05);
            assert_ne!(slow(1, at), slow(2, at));
        }
    }
}
