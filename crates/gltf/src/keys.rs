//! Finds between which keys a time lies, and the values of tracks at that time.

use std::array;

use crate::animation::{Interpolation, Track};

/// A key counts as reached a little early, by at most this share of its time: a key at 100 s, 24 µs early. The reason
/// is that files round the times of frames to 32 bits, half of them upwards. Only stepped values depend on this.
const ROUNDED: f64 = 2.0 * f32::EPSILON as f64;

/// Where a time lies in a list of key times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    /// The key at or before the time; the first, if the time is before all.
    pub before: usize,
    /// The key whose value a stepped track has: `before`, or the next key if the time is less than that key's time only
    /// by rounding (see `ROUNDED`).
    pub reached: usize,
    /// From the key before to the one after, seconds; 0 at or beyond the ends.
    span_s: f64,
    /// How far the time is between them, 0..1; 0 at a key and beyond the ends.
    fraction: f64,
}

impl Place {
    /// The place of a time among increasing times; `times_s` is not empty.
    pub fn at(times_s: &[f32], time_s: f64) -> Self {
        let last = times_s.len().saturating_sub(1);
        let time = |key: usize| f64::from(times_s[key]);
        let at_end = |key: usize| Self { before: key, reached: key, span_s: 0.0, fraction: 0.0 };
        // NaN counts as before all keys.
        if last == 0 || time_s.is_nan() || time_s <= time(0) {
            return at_end(0);
        }
        if time_s >= time(last) {
            return at_end(last);
        }
        // Most tracks have a key per frame: then the first guess is right, or one beside it.
        let guess = (time_s - time(0)) / (time(last) - time(0)) * last as f64;
        let guess = (guess as usize).min(last - 1);
        let holds = |key: usize| key < last && time(key) <= time_s && time_s < time(key + 1);
        let near = [guess, guess.wrapping_sub(1), guess + 1];
        let searched = || times_s.partition_point(|&key_s| f64::from(key_s) <= time_s) - 1;
        let before = near.into_iter().find(|&key| holds(key)).unwrap_or_else(searched);
        let next = time(before + 1);
        let span_s = next - time(before);
        let reached = if next - time_s <= ROUNDED * next.abs() { before + 1 } else { before };
        Self { before, reached, span_s, fraction: (time_s - time(before)) / span_s }
    }

    pub fn fraction(self) -> f64 {
        self.fraction
    }

    /// The value of a key, without its tangents.
    pub fn key<const N: usize>(self, track: &Track, key: usize) -> [f64; N] {
        let (per_key, value) =
            if track.interpolation == Interpolation::CubicSpline { (3, 1) } else { (1, 0) };
        let start = (key * per_key + value) * track.width;
        array::from_fn(|axis| f64::from(track.values[start + axis]))
    }

    /// The first `N` numbers of the value at the time. Each is interpolated alone, so linear rotations cannot use this:
    /// they need a slerp.
    pub fn numbers<const N: usize>(self, track: &Track) -> [f64; N] {
        array::from_fn(|axis| self.number(track, axis))
    }

    /// One number of the value at the time.
    pub fn number(self, track: &Track, axis: usize) -> f64 {
        let part = |index: usize| f64::from(track.values[index * track.width + axis]);
        let (before, t) = (self.before, self.fraction);
        match track.interpolation {
            Interpolation::Step => part(self.reached),
            Interpolation::Linear if t == 0.0 => part(before),
            Interpolation::Linear => {
                let (from, to) = (part(before), part(before + 1));
                from + (to - from) * t
            }
            Interpolation::CubicSpline if t == 0.0 => part(3 * before + 1),
            Interpolation::CubicSpline => {
                let (from, out_tangent) = (part(3 * before + 1), part(3 * before + 2));
                let (in_tangent, to) = (part(3 * before + 3), part(3 * before + 4));
                let (t2, t3) = (t * t, t * t * t);
                (2.0 * t3 - 3.0 * t2 + 1.0) * from
                    + self.span_s * (t3 - 2.0 * t2 + t) * out_tangent
                    + (3.0 * t2 - 2.0 * t3) * to
                    + self.span_s * (t3 - t2) * in_tangent
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_at_their_own_frame_however_its_time_was_rounded() {
        for fps in [24.0, 25.0, 30.0, 30000.0 / 1001.0] {
            let times_s: Vec<f32> = (0..5000).map(|frame| (f64::from(frame) / fps) as f32).collect();
            let late = (1..4999).filter(|&frame| f64::from(times_s[frame]) > frame as f64 / fps).count();
            assert!(late > 100, "no time of {fps} frames a second is rounded upwards");
            for frame in 1..4999 {
                let at = |frame: f64| Place::at(&times_s, frame / fps).reached;
                assert_eq!([frame as f64, frame as f64 - 0.02].map(at), [frame, frame - 1], "{fps}");
            }
        }
    }
}
