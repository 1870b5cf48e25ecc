//! Where a frame lies between keys.

use std::ops::RangeInclusive;

use glam::DVec3;

use crate::document::Key;

/// The two keys round a frame, and the weight of the second after easing.
pub(crate) struct Span {
    pub(crate) left: usize,
    pub(crate) right: usize,
    /// 0 at the left key, 1 at the right one; outside 0..=1 where the ease overshoots.
    pub(crate) share: f64,
}

impl Span {
    /// The span at a frame; `None` without keys.
    pub(crate) fn at(keys: &[impl Key], frame: f64) -> Option<Self> {
        let last = keys.len().checked_sub(1)?;
        let right = keys.partition_point(|key| key.frame() <= frame);
        if right == 0 || right > last {
            let still = right.min(last);
            return Some(Self { left: still, right: still, share: 0.0 });
        }
        let (left_frame, ease) = (keys[right - 1].frame(), keys[right - 1].ease());
        let t = (frame - left_frame) / (keys[right].frame() - left_frame);
        Some(Self { left: right - 1, right, share: ease.share(t) })
    }

    /// A value between that of the left key and that of the right one; exactly `left` at share 0.
    pub(crate) fn mix(&self, left: f64, right: f64) -> f64 {
        left + (right - left) * self.share
    }

    /// As [`Span::mix`], but where the ease overshoots, the value is clamped to these limits.
    pub(crate) fn mix_within(&self, left: f64, right: f64, limits: RangeInclusive<f64>) -> f64 {
        let mixed = self.mix(left, right);
        if self.overshoots() { mixed.clamp(*limits.start(), *limits.end()) } else { mixed }
    }

    pub(crate) fn overshoots(&self) -> bool {
        !(0.0..=1.0).contains(&self.share)
    }

    pub(crate) fn mix_vec3(&self, left: [f64; 3], right: [f64; 3]) -> DVec3 {
        DVec3::from(left) + (DVec3::from(right) - DVec3::from(left)) * self.share
    }
}
