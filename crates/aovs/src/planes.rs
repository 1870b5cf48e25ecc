//! Planes of values, one for each channel, found pixel by pixel on all cores.

use rayon::prelude::*;

/// How many pixels are found in one go.
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
