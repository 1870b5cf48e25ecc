//! M15, chatter: of all strokes in all frames, the share whose lightness goes to and fro from frame to frame.

use std::collections::BTreeMap;

use impasto_painting::frame::LayerKind;

use crate::strokes::{StrokeKey, StrokesByKey};

/// A reversal is counted if luma (0..1) goes one way by more than this, and then back by more than this.
const REVERSAL: f64 = 0.02;

/// Strokes with less alpha than this are left out, because they are hardly seen.
const LEAST_ALPHA: f64 = 0.25;

/// Where something was found, to be looked up in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Frame of the shot.
    pub frame: f64,
    /// Pixels from the picture's upper left.
    pub at_px: [f64; 2],
    /// The stroke; `None` where a pixel was found.
    pub stroke: Option<StrokeKey>,
    /// How large it was: a reversal of luma (0..1), a step of alpha, or a second difference of luma (levels of 255).
    pub amount: f64,
}

/// How often something happens to strokes over a shot. The unit is the stroke-frame: one stroke in one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Share {
    /// Stroke-frames in which it happened.
    pub found: f64,
    /// All stroke-frames.
    pub of: usize,
}

impl Share {
    /// What was found as a share of all; 0 where there was nothing.
    pub fn share(&self) -> f64 {
        self.found / self.of.max(1) as f64
    }

    /// Adds one stroke-frame; `found` is 1 if something happened to the stroke in it, else 0.
    pub fn count(&mut self, found: f64) {
        self.found += found;
        self.of += 1;
    }
}

/// Chatter over a shot, by body and layer.
#[derive(Clone, Debug, Default)]
pub struct Chatter {
    /// Stroke-frames and reversals of each coat, which is one layer of one body.
    pub by_coat: BTreeMap<(u32, LayerKind), Share>,
    /// The largest reversal.
    pub worst: Option<Place>,
}

impl Chatter {
    /// Adds three neighbouring frames; `frame` is the number of the middle one, `height_px` the picture's height.
    pub fn add(&mut self, frame: f64, [first, middle, last]: [&StrokesByKey; 3], height_px: f64) {
        for (key, now) in middle {
            let (Some(before), Some(after)) = (first.get(key), last.get(key)) else { continue };
            if [before, now, after].iter().any(|stroke| stroke.alpha < LEAST_ALPHA) {
                continue;
            }
            let (step, next) = (now.luma - before.luma, after.luma - now.luma);
            let back = if step * next < 0.0 { step.abs().min(next.abs()) } else { 0.0 };
            let reverses = back > REVERSAL;
            self.by_coat.entry((key.body_id, key.kind)).or_default().count(f64::from(u8::from(reverses)));
            if reverses && self.worst.is_none_or(|worst| back > worst.amount) {
                let at_px = [now.center_px[0], height_px - now.center_px[1]];
                self.worst = Some(Place { frame, at_px, stroke: Some(*key), amount: back });
            }
        }
    }

    /// All coats together.
    pub fn whole(&self) -> Share {
        self.by_coat.values().fold(Share::default(), |sum, share| Share {
            found: sum.found + share.found,
            of: sum.of + share.of,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::strokes::a_stroke;

    #[test]
    fn only_what_goes_to_and_fro_is_chatter() {
        let frame = |lumas: [f64; 4]| -> StrokesByKey {
            let key = |particle| StrokeKey { body_id: 1, kind: LayerKind::Accents, particle };
            (0u32..)
                .zip(lumas)
                .map(|(particle, luma)| (key(particle), a_stroke([9.0, 7.0], 1.0, luma)))
                .collect()
        };
        // One gets lighter all the time, one goes back by little, one trembles by little, one chatters.
        let frames = [[0.1, 0.5, 0.5, 0.4], [0.2, 0.6, 0.51, 0.6], [0.4, 0.59, 0.5, 0.45]].map(frame);
        let mut found = Chatter::default();
        found.add(3.0, frames.each_ref(), 20.0);
        assert_eq!(found.whole(), Share { found: 1.0, of: 4 });
        let worst = found.worst.unwrap();
        assert_eq!((worst.frame, worst.at_px, worst.stroke.unwrap().particle), (3.0, [9.0, 13.0], 3));
        assert!((worst.amount - 0.15).abs() < 1e-12);
    }
}
