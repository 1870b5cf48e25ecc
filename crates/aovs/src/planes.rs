//! Planes of values, one for each channel, found pixel by pixel on all cores.

use rayon::prelude::*;

/// How many pixels one task handles.
const RUN: usize = 4096;

/// `count` planes; `find` sets the values of a pixel, which are 0 before.
pub(crate) fn planes<T: Copy + Default + Send + Sync>(
    pixels: usize,
    count: usize,
    find: impl Fn(usize, &mut [T]) + Sync,
) -> Vec<Vec<T>> {
    let mut planes = vec![vec![T::default(); pixels]; count];
    let mut runs: Vec<Vec<&mut [T]>> = Vec::new();
    for plane in &mut planes {
        for (run, part) in plane.chunks_mut(RUN).enumerate() {
            match runs.get_mut(run) {
                Some(parts) => parts.push(part),
                None => runs.push(vec![part]),
            }
        }
    }
    runs.into_par_iter().enumerate().for_each(|(run, mut parts)| {
        let mut values = vec![T::default(); count];
        for index in 0..parts[0].len() {
            values.fill(T::default());
            find(run * RUN + index, &mut values);
            for (part, value) in parts.iter_mut().zip(&values) {
                part[index] = *value;
            }
        }
    });
    planes
}

/// Rounds to a multiple of a step (a power of two). The last bits are noise, and files without them compress better.
pub(crate) fn in_steps(value: f32, step: f32) -> f32 {
    (value / step).round() * step
}

/// Rounds to 17 significant bits; the error is less than one part in 100,000.
pub(crate) fn short(value: f32) -> f32 {
    const DROPPED: u32 = 7;
    let bits = value.to_bits();
    f32::from_bits((bits + (1 << (DROPPED - 1))) & !((1 << DROPPED) - 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shortened_numbers_are_near_and_whole_ones_stay() {
        for value in [1e10, -1e10, 0.0, 1.0, -3.0, 123.456, -0.000_765, 16.000_001] {
            assert!((short(value) - value).abs() <= value.abs() * 8e-6, "{value}");
        }
        assert_eq!([short(0.0), short(2.0), short(-1.5)], [0.0, 2.0, -1.5]);
        assert_eq!(in_steps(0.7, 0.25), 0.75);
    }

    #[test]
    fn each_pixel_gets_its_own_values_in_every_plane() {
        let planes = planes(10_000, 3, |pixel, values: &mut [u32]| {
            values[0] = pixel as u32;
            values[2] = 2 * pixel as u32;
        });
        assert!(
            (0..10_000).all(|pixel| planes[0][pixel] == pixel as u32 && planes[2][pixel] == 2 * pixel as u32)
        );
        assert!(planes[1].iter().all(|&value| value == 0));
    }
}
