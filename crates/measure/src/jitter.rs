//! Measures whether strokes tremble: M10, angular jitter.

use impasto_core::angle::wrap_pi;

/// |wrap(θ₊ − 2θ + θ₋)|: the angular acceleration over three neighbouring frames, degrees per frame squared.
pub fn acceleration_deg([before, now, after]: [f64; 3]) -> f64 {
    wrap_pi(wrap_pi(after - now) - wrap_pi(now - before)).abs().to_degrees()
}

/// The angular acceleration of many strokes, drawn and expected.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jitter {
    /// Mean acceleration of the strokes as drawn, degrees per frame squared.
    pub drawn_deg: f64,
    /// Mean acceleration of the angles that they should have, degrees per frame squared.
    pub analytic_deg: f64,
    /// How many triples of angles the means are taken over.
    pub triples: usize,
}

/// The acceleration that rounding to single precision alone gives in a steady motion, degrees per frame squared.
const FLOOR_DEG: f64 = 2e-3;

impl Jitter {
    /// From triples of angles drawn in three neighbouring frames, each with the triple of angles expected there.
    pub fn of(triples: impl Iterator<Item = ([f64; 3], [f64; 3])>) -> Self {
        let (mut drawn, mut analytic, mut count) = (0.0, 0.0, 0usize);
        for (found, expected) in triples {
            drawn += acceleration_deg(found);
            analytic += acceleration_deg(expected);
            count += 1;
        }
        let mean = |sum: f64| sum / count.max(1) as f64;
        Self { drawn_deg: mean(drawn), analytic_deg: mean(analytic), triples: count }
    }

    /// How much more the strokes accelerate than expected, as a share of the expected acceleration. The expected
    /// acceleration counts as at least what rounding alone gives.
    pub fn excess(&self) -> f64 {
        let expected = self.analytic_deg.max(FLOOR_DEG);
        (self.drawn_deg - expected).max(0.0) / expected
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steady_turning_does_not_tremble_and_noise_does() {
        // Across the wrap at half a turn.
        assert!(acceleration_deg([3.0, 3.1, 3.2 - std::f64::consts::TAU]) < 1e-9);
        assert!(acceleration_deg([0.1, 0.2, 0.3]) < 1e-9);
        assert!((acceleration_deg([0.0, 0.0, 0.1]) - 0.1f64.to_degrees()).abs() < 1e-9);
        let curve = |t: f64| 0.02 * t * t;
        let steady = (0..50).map(|t| [0, 1, 2].map(|step| curve(f64::from(t + step))));
        let jitter = Jitter::of(steady.clone().map(|triple| (triple, triple)));
        assert_eq!((jitter.excess(), jitter.triples), (0.0, 50));
        let noisy = steady.map(|triple| ([triple[0], triple[1] + 0.1, triple[2]], triple));
        assert!(Jitter::of(noisy).excess() > 0.5);
    }
}
