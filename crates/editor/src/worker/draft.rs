//! Chooses the size of drafts: as large as can be drawn fast enough for a smooth drag.

/// All drafts of a job together should take no longer than this, seconds: fifteen a second, with some time left to
/// prepare.
const BUDGET_S: f64 = 0.055;
/// The sides of a draft are a whole number of twentieths of the exact picture's: with so few sizes, render targets are
/// seldom made anew.
const STEPS: u32 = 20;
/// The smallest draft: a share of 0.35.
const LEAST: u32 = 7;
/// The first draft: a share of 0.5.
const FIRST: u32 = 10;

/// Chooses the size of the next draft by what the last one took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DraftSize {
    steps: u32,
}

impl Default for DraftSize {
    fn default() -> Self {
        Self { steps: FIRST }
    }
}

impl DraftSize {
    /// The size of a draft of a picture of this size, at least one pixel.
    pub(super) fn of(&self, size_px: [u32; 2]) -> [u32; 2] {
        size_px.map(|side| ((f64::from(side) * self.share()).round() as u32).clamp(1, side.max(1)))
    }

    /// Adapts the size to the time that all drafts of a job took.
    pub(super) fn took(&mut self, seconds: f64) {
        let ideal = f64::from(self.steps) * (BUDGET_S / seconds.max(1e-4)).sqrt();
        let steps = ((ideal + 1e-6) as u32).clamp(LEAST, STEPS);
        // It grows only with a margin, else it would swing between two sizes.
        if steps < self.steps || ideal > f64::from(self.steps) + 1.5 {
            self.steps = steps;
        }
    }

    fn share(&self) -> f64 {
        f64::from(self.steps) / f64::from(STEPS)
    }

    /// Whether exact pictures are so quick that drafts are not needed.
    pub(super) fn is_needless(exact_s: Option<f64>) -> bool {
        exact_s.is_some_and(|seconds| seconds < 0.5 * BUDGET_S)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The shares of 40 drafts, with a driver that takes a fixed time plus a time in proportion to the pixels.
    fn settled(whole_s: f64, fixed_s: f64) -> Vec<f64> {
        let mut size = DraftSize::default();
        (0..40)
            .map(|_| {
                size.took(fixed_s + whole_s * size.share() * size.share());
                size.share()
            })
            .collect()
    }

    #[test]
    fn it_settles_and_keeps_the_rate_where_that_can_be() {
        for (whole_s, fixed_s) in [(0.2, 0.01), (0.1, 0.0), (0.15, 0.03)] {
            let shares = settled(whole_s, fixed_s);
            let last = shares[39];
            assert!(shares[20..].iter().all(|&share| share == last), "{shares:?}");
            assert!(fixed_s + whole_s * last * last <= BUDGET_S * 1.02, "{whole_s} {fixed_s}: {last}");
            assert!(last > 0.35, "{whole_s} {fixed_s}: {last}");
        }
        assert_eq!(settled(5.0, 0.0)[39], 0.35);
        assert_eq!(settled(0.001, 0.0)[39], 1.0);
    }

    #[test]
    fn a_draft_has_pixels_and_never_more_than_the_picture() {
        assert_eq!(DraftSize { steps: LEAST }.of([1, 2]), [1, 1]);
        assert_eq!(DraftSize { steps: STEPS }.of([950, 650]), [950, 650]);
    }
}
