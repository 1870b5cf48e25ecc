//! Chooses the size of drafts: as large as can be drawn fast enough for a smooth drag.

/// All drafts of one job together should take at most this many seconds. At fifteen jobs a second, that leaves about 12
/// ms of each for preparing.
const BUDGET_S: f64 = 0.055;
/// Drafts come in steps of a twentieth of the exact picture's width and height, rounded to pixels. With so few sizes,
/// render targets seldom have to be made again.
const STEPS: u32 = 20;
/// The smallest draft, in these steps: 0.35 of each side.
const LEAST: u32 = 7;
/// The first draft, in these steps: half of each side.
const FIRST: u32 = 10;

/// Chooses the size of the next drafts from how long the drafts of the last job took.
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
    /// The size of a draft for a picture of `size_px`: at least one pixel a side, and no larger than the picture.
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

    /// Whether exact pictures are drawn so quickly that drafts are not needed.
    pub(super) fn is_needless(exact_s: Option<f64>) -> bool {
        exact_s.is_some_and(|seconds| seconds < 0.5 * BUDGET_S)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The share of the picture's width that drafts get after each of 40 drafts. A draft takes `fixed_s` seconds, plus
    /// a time in proportion to its pixels: `whole_s` seconds at full size.
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
