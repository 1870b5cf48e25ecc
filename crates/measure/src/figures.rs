//! Summaries of many numbers: count, mean, median, 95th percentile and largest.

use serde::Serialize;

/// A summary of many numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// How many there were.
    pub count: usize,
    /// Their mean; 0 where there are none.
    pub mean: f64,
    /// Half of them are at most this.
    pub median: f64,
    /// 19 of 20 are at most this.
    pub p95: f64,
    /// The largest.
    pub max: f64,
}

impl Spread {
    /// Summarises these numbers, in any order. NaN counts as the largest.
    pub fn of(mut values: Vec<f64>) -> Self {
        if values.is_empty() {
            return Self::default();
        }
        values.sort_by(f64::total_cmp);
        let count = values.len();
        let at = |share: f64| values[((count - 1) as f64 * share).round() as usize];
        let mean = values.iter().sum::<f64>() / count as f64;
        Self { count, mean, median: at(0.5), p95: at(0.95), max: values[count - 1] }
    }
}

/// Standard deviation over mean; 0 for fewer than two numbers.
pub fn coefficient_of_variation(values: &[f64]) -> f64 {
    if values.len() < 2 {
        return 0.0;
    }
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count;
    variance.sqrt() / mean.abs().max(f64::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_of_known_numbers() {
        let spread = Spread::of((1..=100).rev().map(f64::from).collect());
        assert_eq!((spread.count, spread.mean, spread.p95, spread.max), (100, 50.5, 95.0, 100.0));
        assert_eq!(Spread::of(Vec::new()).count, 0);
        assert!(Spread::of(vec![1.0, f64::NAN]).max.is_nan());
        assert_eq!(coefficient_of_variation(&[2.0, 2.0, 2.0]), 0.0);
        assert!((coefficient_of_variation(&[1.0, 3.0]) - 0.5).abs() < 1e-12);
    }
}
