//! Finds the direction of streaks in a picture by structure tensors, to measure whether strokes turned as they should.

use crate::plane::Plane;
use crate::turning::place_before;

/// Second moments of the gradient as complex numbers `(Jxx − Jyy) + 2i Jxy`, whose argument is twice the gradient's
/// angle (Y up).
#[derive(Clone, Debug, PartialEq)]
pub struct Tensors {
    /// Real parts.
    pub real: Plane,
    /// Imaginary parts.
    pub imaginary: Plane,
}

impl Tensors {
    /// The tensors of every pixel, from Scharr's derivative (0 along the border), averaged over a Gaussian of this
    /// deviation.
    pub fn of(plane: &Plane, sigma_px: f64) -> Self {
        let [width, height] = plane.size_px;
        let gradient = |x: usize, y: usize| {
            let at = |dx: usize, dy: usize| plane.at(x + dx - 1, y + dy - 1);
            let gx = 3.0 * (at(2, 0) - at(0, 0)) + 10.0 * (at(2, 1) - at(0, 1)) + 3.0 * (at(2, 2) - at(0, 2));
            let gy = 3.0 * (at(0, 0) - at(0, 2)) + 10.0 * (at(1, 0) - at(1, 2)) + 3.0 * (at(2, 0) - at(2, 2));
            [gx, gy]
        };
        let inside = |x: usize, y: usize| x > 0 && y > 0 && x + 1 < width && y + 1 < height;
        let part = |value: fn([f32; 2]) -> f32| {
            Plane::of(plane.size_px, |x, y| if inside(x, y) { value(gradient(x, y)) } else { 0.0 })
                .blurred(sigma_px)
        };
        Self { real: part(|[gx, gy]| gx * gx - gy * gy), imaginary: part(|[gx, gy]| 2.0 * gx * gy) }
    }
}

/// How far the streaks of `turned` are off on average. They should be the streaks of `straight`, turned
/// counter-clockwise by `angle_rad`. The error is `½ arg Σ conj(T₀ e^{2iφ}) T_φ`, radians in (−π/2, π/2], with T₀ from
/// `straight`, T_φ from `turned` and φ = `angle_rad`. Also returns over how many pixels of the mask it was taken.
pub fn error_rad(straight: &Tensors, turned: &Tensors, angle_rad: f64, mask: &[bool]) -> (f64, usize) {
    let size_px = turned.real.size_px;
    let (sin, cos) = (2.0 * angle_rad).sin_cos();
    let (mut real, mut imaginary, mut pixels) = (0.0, 0.0, 0);
    for (index, _) in mask.iter().enumerate().filter(|(_, inside)| **inside) {
        let place = [index % size_px[0], index / size_px[0]];
        let [x, y] = place_before(size_px, angle_rad, place);
        let (Some(re), Some(im)) = (straight.real.sample(x, y), straight.imaginary.sample(x, y)) else {
            continue;
        };
        let (re, im) = (f64::from(re), f64::from(im));
        let expected = (re * cos - im * sin, re * sin + im * cos);
        let found = (f64::from(turned.real.values[index]), f64::from(turned.imaginary.values[index]));
        real += expected.0 * found.0 + expected.1 * found.1;
        imaginary += expected.0 * found.1 - expected.1 * found.0;
        pixels += 1;
    }
    (0.5 * imaginary.atan2(real), pixels)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::turning::disk;

    fn stripes(angle_rad: f64) -> Plane {
        let (sin, cos) = angle_rad.sin_cos();
        Plane::of([96, 96], |x, y| {
            let (x, y) = (x as f64 - 47.5, 47.5 - y as f64);
            ((0.4 * (x * cos + y * sin)).sin() * 100.0) as f32
        })
    }

    #[test]
    fn the_error_is_the_angle_between_the_stripes() {
        let mask = disk([96, 96], 0.8);
        let straight = Tensors::of(&stripes(0.3), 1.5);
        for (turn, off) in [(0.0, 0.0), (0.5, 0.0), (0.5, 0.1), (2.4, -0.2)] {
            let turned = Tensors::of(&stripes(0.3 + turn + off), 1.5);
            let (error, pixels) = error_rad(&straight, &turned, turn, &mask);
            assert!(pixels > 4000);
            assert!((error - off).abs() < 0.01, "turned by {turn}: {error} for {off}");
        }
    }
}
