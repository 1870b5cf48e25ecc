//! Pictures of one channel, which the metrics sample, blur and search for fine detail. The top row comes first.

use impasto_gl_render::Picture;
use rayon::prelude::*;

/// A picture of one channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Plane {
    /// Width and height in pixels.
    pub size_px: [usize; 2],
    /// Row by row from the top.
    pub values: Vec<f32>,
}

impl Plane {
    /// A picture of this size, all of one value.
    pub fn filled(size_px: [usize; 2], value: f32) -> Self {
        Self { size_px, values: vec![value; size_px[0] * size_px[1]] }
    }

    /// A picture from a function of column and row.
    pub fn of(size_px: [usize; 2], value: impl Fn(usize, usize) -> f32) -> Self {
        let values = (0..size_px[0] * size_px[1]).map(|at| value(at % size_px[0], at / size_px[0]));
        Self { size_px, values: values.collect() }
    }

    /// Luma of the encoded bytes, 0..=255, weights of Rec. 709.
    pub fn luma(picture: &Picture) -> Self {
        let luma = |pixel: &[u8]| {
            0.2126 * f32::from(pixel[0]) + 0.7152 * f32::from(pixel[1]) + 0.0722 * f32::from(pixel[2])
        };
        Self {
            size_px: picture.size_px.map(|side| side as usize),
            values: picture.rgba8.chunks_exact(4).map(luma).collect(),
        }
    }

    /// The value of a pixel.
    pub fn at(&self, x: usize, y: usize) -> f32 {
        self.values[y * self.size_px[0] + x]
    }

    /// Bilinear value at a point (0, 0 is the centre of the first pixel, y down); `None` beyond the outermost centres.
    pub fn sample(&self, x: f64, y: f64) -> Option<f32> {
        let taps = Taps::new(self.size_px, x, y)?;
        Some(taps.mix(|index| self.values[index]))
    }

    /// Blurred by a Gaussian of this deviation within a mask: each value is the weighted mean of the pixels around it
    /// that are in the mask. 0 outside the mask.
    pub fn blurred_in(&self, mask: &[bool], sigma_px: f64) -> Self {
        let weights: Vec<f32> = mask.iter().map(|&known| f32::from(u8::from(known))).collect();
        let weighted = Self {
            size_px: self.size_px,
            values: self.values.iter().zip(&weights).map(|(value, weight)| value * weight).collect(),
        };
        let sums = weighted.blurred(sigma_px);
        let norms = Self { size_px: self.size_px, values: weights }.blurred(sigma_px);
        let mean = |((&sum, &norm), &known): ((&f32, &f32), &bool)| {
            if known && norm > 1e-6 { sum / norm } else { 0.0 }
        };
        Self {
            size_px: self.size_px,
            values: sums.values.iter().zip(&norms.values).zip(mask).map(mean).collect(),
        }
    }

    /// Blurred by a Gaussian of this deviation. Each pixel is averaged only with pixels of its own body.
    pub fn blurred_within(&self, body_ids: &[u32], sigma_px: f64) -> Self {
        let weights = gaussian(sigma_px);
        let [width, height] = self.size_px.map(|side| side as i64);
        let reach = weights.len() as i64 / 2;
        let mut values = self.values.clone();
        values.par_chunks_mut(self.size_px[0].max(1)).enumerate().for_each(|(y, row)| {
            for (x, value) in row.iter_mut().enumerate() {
                let own = body_ids[y * self.size_px[0] + x];
                let (mut sum, mut norm) = (0.0, 0.0);
                for (dy, of_row) in (-reach..=reach).zip(&weights) {
                    for (dx, of_column) in (-reach..=reach).zip(&weights) {
                        let (tap_x, tap_y) = (x as i64 + dx, y as i64 + dy);
                        if !(0..width).contains(&tap_x) || !(0..height).contains(&tap_y) {
                            continue;
                        }
                        let tap = (tap_y * width + tap_x) as usize;
                        if body_ids[tap] == own {
                            sum += of_row * of_column * self.values[tap];
                            norm += of_row * of_column;
                        }
                    }
                }
                *value = sum / norm;
            }
        });
        Self { size_px: self.size_px, values }
    }

    /// Blurred by a Gaussian of this deviation; pixels beyond the border count as 0.
    pub fn blurred(&self, sigma_px: f64) -> Self {
        let weights = gaussian(sigma_px);
        self.pass(&weights, [1, 0]).pass(&weights, [0, 1])
    }

    fn pass(&self, weights: &[f32], axis: [i64; 2]) -> Self {
        let [width, height] = self.size_px.map(|side| side as i64);
        let reach = weights.len() as i64 / 2;
        let mut values = vec![0.0f32; self.values.len()];
        values.par_chunks_mut(self.size_px[0].max(1)).enumerate().for_each(|(y, row)| {
            for (x, value) in row.iter_mut().enumerate() {
                let mut sum = 0.0;
                for (step, weight) in (-reach..=reach).zip(weights) {
                    let (tap_x, tap_y) = (x as i64 + step * axis[0], y as i64 + step * axis[1]);
                    if (0..width).contains(&tap_x) && (0..height).contains(&tap_y) {
                        sum += weight * self.at(tap_x as usize, tap_y as usize);
                    }
                }
                *value = sum;
            }
        });
        Self { size_px: self.size_px, values }
    }

    /// The picture minus its blur within a mask; 0 outside it.
    pub fn high_pass_in(&self, mask: &[bool], sigma_px: f64) -> Self {
        let coarse = self.blurred_in(mask, sigma_px);
        let fine = self.values.iter().zip(&coarse.values).zip(mask);
        let fine = fine.map(|((value, coarse), &known)| if known { value - coarse } else { 0.0 });
        Self { size_px: self.size_px, values: fine.collect() }
    }
}

/// Weights of a Gaussian out to three deviations; they sum to 1.
fn gaussian(sigma_px: f64) -> Vec<f32> {
    let reach = (3.0 * sigma_px).ceil().max(0.0) as i64;
    let weights: Vec<f64> =
        (-reach..=reach).map(|step| (-0.5 * (step as f64 / sigma_px.max(1e-9)).powi(2)).exp()).collect();
    let sum: f64 = weights.iter().sum();
    weights.iter().map(|weight| (weight / sum) as f32).collect()
}

/// The four pixels round a point, with their bilinear weights.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Taps {
    indices: [usize; 4],
    weights: [f32; 4],
}

impl Taps {
    /// The pixels round a point; `None` where one of them is off the picture.
    pub(crate) fn new([width, height]: [usize; 2], x: f64, y: f64) -> Option<Self> {
        // A point that lies beyond the border only by rounding is moved onto the border.
        let snapped = |at: f64, side: usize| {
            let last = side as f64 - 1.0;
            if at > -1e-6 && at < last + 1e-6 { at.clamp(0.0, last) } else { at }
        };
        let (x, y) = (snapped(x, width), snapped(y, height));
        let (left, top) = (x.floor(), y.floor());
        // A point in the last row or column has its taps there and in the row or column before.
        let (left, top) = (left.min(width as f64 - 2.0), top.min(height as f64 - 2.0));
        let (s, t) = (x - left, y - top);
        let inside = left >= 0.0 && top >= 0.0 && s <= 1.0 && t <= 1.0;
        if !inside {
            return None;
        }
        let first = top as usize * width + left as usize;
        let (s, t) = (s as f32, t as f32);
        Some(Self {
            indices: [first, first + 1, first + width, first + width + 1],
            weights: [(1.0 - s) * (1.0 - t), s * (1.0 - t), (1.0 - s) * t, s * t],
        })
    }

    pub(crate) fn mix(&self, value: impl Fn(usize) -> f32) -> f32 {
        self.indices.iter().zip(self.weights).map(|(&index, weight)| value(index) * weight).sum()
    }

    /// Whether `holds` is true for every pixel with a weight above 0.
    pub(crate) fn all(&self, holds: impl Fn(usize) -> bool) -> bool {
        self.indices.iter().zip(self.weights).all(|(&index, weight)| weight <= 0.0 || holds(index))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sampling_is_exact_on_a_ramp_and_ends_at_the_border() {
        let ramp = Plane::of([5, 4], |x, y| 2.0 * x as f32 + 3.0 * y as f32);
        assert_eq!(ramp.sample(1.25, 2.5), Some(10.0));
        assert_eq!(ramp.sample(4.0, 3.0), Some(17.0));
        assert_eq!(ramp.sample(-0.1, 0.0), None);
        assert_eq!(ramp.sample(4.1, 0.0), None);
    }

    #[test]
    fn a_blur_within_a_mask_keeps_a_constant() {
        let mask: Vec<bool> = (0..200).map(|index| index % 20 > 4).collect();
        let flat = Plane::filled([20, 10], 7.0);
        let blurred = flat.blurred_in(&mask, 2.0);
        for (value, known) in blurred.values.iter().zip(&mask) {
            assert!((value - if *known { 7.0 } else { 0.0 }).abs() < 1e-4);
        }
        assert!(flat.high_pass_in(&mask, 2.0).values.iter().all(|value| value.abs() < 1e-4));
    }

    #[test]
    fn a_gaussian_has_its_deviation() {
        let mut point = Plane::filled([41, 41], 0.0);
        point.values[20 * 41 + 20] = 1.0;
        let blurred = point.blurred(3.0);
        let variance: f32 = (0..41 * 41).map(|i| blurred.values[i] * ((i % 41) as f32 - 20.0).powi(2)).sum();
        assert!((variance - 9.0).abs() < 0.4, "{variance}");
    }
}
