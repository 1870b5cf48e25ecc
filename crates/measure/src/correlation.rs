//! Normalised cross-correlation: do two patterns agree?

/// Normalised cross-correlation of pairs of numbers, −1..=1 (0 if one side is constant), and how many pairs there were.
pub fn normalized(pairs: impl Iterator<Item = (f32, f32)>) -> (f64, usize) {
    let (mut count, mut a_sum, mut b_sum) = (0usize, 0.0, 0.0);
    let (mut aa, mut bb, mut ab) = (0.0, 0.0, 0.0);
    for (a, b) in pairs {
        let (a, b) = (f64::from(a), f64::from(b));
        count += 1;
        (a_sum, b_sum) = (a_sum + a, b_sum + b);
        (aa, bb, ab) = (aa + a * a, bb + b * b, ab + a * b);
    }
    let n = count.max(1) as f64;
    let covariance = ab - a_sum * b_sum / n;
    let variances = (aa - a_sum * a_sum / n).max(0.0) * (bb - b_sum * b_sum / n).max(0.0);
    let correlation = if variances > 0.0 { covariance / variances.sqrt() } else { 0.0 };
    (correlation, count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_opposite_and_unrelated_patterns_give_1_minus_1_and_0() {
        let wave =
            |shift: f32| (0..400).map(move |step| (step as f32 * 0.1 * std::f32::consts::PI + shift).sin());
        assert!((normalized(wave(0.0).zip(wave(0.0).map(|v| 3.0 * v + 7.0))).0 - 1.0).abs() < 1e-6);
        assert!((normalized(wave(0.0).zip(wave(0.0).map(|v| -v))).0 + 1.0).abs() < 1e-6);
        let (across, count) = normalized(wave(0.0).zip(wave(std::f32::consts::FRAC_PI_2)));
        assert!(across.abs() < 1e-3 && count == 400, "{across}");
        assert_eq!(normalized(std::iter::empty()), (0.0, 0));
    }
}
