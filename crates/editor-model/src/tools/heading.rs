//! Tells the tools the heading of the pointer: its direction over the last pixels, and whether it moves or rests.

use std::collections::VecDeque;

use glam::DVec2;

/// The direction is taken over this distance.
const BACK_PX: f64 = 12.0;
/// The pointer is moving if it has covered `BACK_PX` in this time.
const RECENT_SECS: f64 = 0.15;
/// A pointer that has been still for this long rests.
pub(crate) const REST_SECS: f64 = 0.4;

#[derive(Clone, Debug, Default)]
pub(super) struct Heading {
    /// Positions and times, the newest first.
    trail: VecDeque<(DVec2, f64)>,
}

impl Heading {
    pub(super) fn follow(&mut self, at_px: DVec2, at_secs: f64) {
        if !at_px.is_finite() || self.trail.front().is_some_and(|&(last, _)| last.distance(at_px) < 0.5) {
            return;
        }
        self.trail.push_front((at_px, at_secs));
        // Keeps only as much as the direction and the speed need.
        let mut length = 0.0;
        let mut keep = 1;
        for (newer, older) in self.trail.iter().zip(self.trail.iter().skip(1)) {
            if length >= BACK_PX && at_secs - older.1 > RECENT_SECS {
                break;
            }
            length += newer.0.distance(older.0);
            keep += 1;
        }
        self.trail.truncate(keep);
    }

    /// The direction over the last 12 px, unit, Y down. `None` before the pointer has moved that far.
    pub(super) fn along(&self) -> Option<DVec2> {
        let &(last, _) = self.trail.front()?;
        let mut length = 0.0;
        for ((newer, _), (older, _)) in self.trail.iter().zip(self.trail.iter().skip(1)) {
            length += newer.distance(*older);
            if length >= BACK_PX {
                return (last - *older).try_normalize();
            }
        }
        None
    }

    /// Whether the pointer moved at least 12 px in the last 150 ms.
    pub(super) fn is_moving(&self, at_secs: f64) -> bool {
        let recent: Vec<DVec2> = self
            .trail
            .iter()
            .take_while(|(_, then)| at_secs - then <= RECENT_SECS)
            .map(|(at, _)| *at)
            .collect();
        recent.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f64>() >= BACK_PX
    }

    /// Whether the pointer has not moved for 400 ms.
    pub(super) fn rests(&self, at_secs: f64) -> bool {
        self.trail.front().is_none_or(|&(_, then)| at_secs - then >= REST_SECS)
    }

    pub(super) fn forget(&mut self) {
        self.trail.clear();
    }
}
