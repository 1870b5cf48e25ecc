//! Random numbers as pure functions of integers, so that a particle always looks the same.

/// Permutes 32 bits so that neighbouring inputs give unrelated outputs (PCG's RXS-M-XS step; O'Neill 2014).
#[inline(always)]
pub fn scramble(value: u32) -> u32 {
    let state = value.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// Joins two hashes into one; the order matters.
#[inline(always)]
pub fn combine(first: u32, second: u32) -> u32 {
    scramble(first.rotate_left(5) ^ scramble(second ^ 0x9e37_79b9))
}

/// Hash of a name (FNV-1a, then scrambled).
pub fn of_name(name: &str) -> u32 {
    scramble(name.bytes().fold(0x811c_9dc5, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193)))
}

/// A number in 0..1 from the upper 24 bits of a hash.
#[inline(always)]
pub fn unit(hash: u32) -> f32 {
    (hash >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// A number of mean 0 and standard deviation 1 from a hash. It is made from the sum of four uniform numbers, so it lies
/// within ±[`MOST_NORMAL`].
#[inline]
pub fn normal(hash: u32) -> f32 {
    let sum: f32 = (0..4).map(|index| unit(combine(hash, index))).sum();
    (sum - 2.0) * (0.5 * MOST_NORMAL)
}

/// The most that [`normal`] gives: √12.
pub const MOST_NORMAL: f32 = 3.464_101_6;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_has_mean_0_and_deviation_1() {
        let count = 100_000u32;
        let values: Vec<f64> = (0..count).map(|index| f64::from(normal(scramble(index)))).collect();
        let mean = values.iter().sum::<f64>() / f64::from(count);
        let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / f64::from(count);
        assert!(mean.abs() < 0.01, "mean {mean}");
        assert!((variance - 1.0).abs() < 0.02, "variance {variance}");
        assert!(values.iter().all(|value| value.abs() <= f64::from(MOST_NORMAL)));
    }

    #[test]
    fn neighbouring_inputs_fill_the_unit_interval_evenly() {
        let mut buckets = [0u32; 64];
        for index in 0..64_000 {
            buckets[(unit(combine(7, index)) * 64.0) as usize] += 1;
        }
        // χ² with 63 degrees of freedom: 99.9 % of true random sequences stay under 104.
        let chi_squared: f64 =
            buckets.iter().map(|&count| (f64::from(count) - 1000.0).powi(2) / 1000.0).sum();
        assert!(chi_squared < 104.0, "χ² = {chi_squared}");
    }
}
