//! Angles in the picture: wrapping, and an arctangent that a compiler can run on many lanes at once.

use std::f32::consts::{FRAC_PI_2, PI};

/// Wraps an angle in radians into (−π, π].
#[inline]
pub fn wrap_pi(angle_rad: f64) -> f64 {
    let turn = std::f64::consts::TAU;
    let wrapped = angle_rad - turn * (angle_rad / turn).round();
    if wrapped <= -std::f64::consts::PI { wrapped + turn } else { wrapped }
}

/// Wraps an angle between undirected lines into [−π/2, π/2).
pub fn wrap_half_pi(angle_rad: f64) -> f64 {
    let half_turn = std::f64::consts::PI;
    angle_rad - half_turn * (angle_rad / half_turn + 0.5).floor()
}

/// `y.atan2(x)` without branches, to 3e-7 rad; 0 at the origin.
///
/// Takes the series of Abramowitz and Stegun 4.4.49 at the smaller of |y/x| and |x/y|, then moves the result to its
/// octant.
#[inline(always)]
pub fn atan2(y: f32, x: f32) -> f32 {
    let (x_abs, y_abs) = (x.abs(), y.abs());
    let ratio = x_abs.min(y_abs) / x_abs.max(y_abs).max(f32::MIN_POSITIVE);
    let s = ratio * ratio;
    let mut series = 0.002_866_225_7;
    series = series * s - 0.016_165_737;
    series = series * s + 0.042_909_614;
    series = series * s - 0.075_289_64;
    series = series * s + 0.106_562_64;
    series = series * s - 0.142_089;
    series = series * s + 0.199_935_5;
    series = series * s - 0.333_331_45;
    series = series * s + 1.0;
    let octant = ratio * series;
    let quadrant = if y_abs > x_abs { FRAC_PI_2 - octant } else { octant };
    let half = if x < 0.0 { PI - quadrant } else { quadrant };
    if y < 0.0 { -half } else { half }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn atan2_agrees_with_the_library_all_round() {
        for step in 0..=100_000 {
            let angle = (f64::from(step) / 50_000.0 - 1.0) * std::f64::consts::PI;
            for radius in [1e-12, 1.0, 3e8] {
                let (y, x) = ((angle.sin() * radius) as f32, (angle.cos() * radius) as f32);
                let expected = f64::from(y).atan2(f64::from(x));
                let error = wrap_pi(f64::from(atan2(y, x)) - expected).abs();
                assert!(error < 3e-7, "atan2({y}, {x}) is off by {error}");
            }
        }
        assert_eq!(atan2(0.0, 0.0), 0.0);
    }

    #[test]
    fn wrapping_keeps_the_direction() {
        for angle in [-9.0, -3.2, -0.1, 0.0, 1.0, 3.15, 100.0] {
            assert!((wrap_pi(angle).sin() - angle.sin()).abs() < 1e-12);
            assert!(wrap_pi(angle) > -std::f64::consts::PI && wrap_pi(angle) <= std::f64::consts::PI);
            assert!(((2.0 * wrap_half_pi(angle)).sin() - (2.0 * angle).sin()).abs() < 1e-12);
            assert!(wrap_half_pi(angle).abs() <= std::f64::consts::FRAC_PI_2);
        }
    }
}
