//! Between which keys a time lies, and the values there.

use std::array;

use crate::animation::{Interpolation, Track};

/// A time among the keys of a clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    /// The key at or before the time; the first, if the time is before all.
    pub before: usize,
    /// From the key before to the one after, seconds; 0 at or beyond the ends.
    span_s: f64,
    /// How far the time is between them, 0..1; 0 at a key and beyond the ends.
    fraction: f64,
}

impl Place {
    /// The place of a time among increasing times, of which there is at least one.
    pub fn at(times_s: &[f32], time_s: f64) -> Self {
        let last = times_s.len().saturating_sub(1);
        let time = |key: usize| f64::from(times_s[key]);
        // A time that is no number counts as before all.
        if last == 0 || time_s.is_nan() || time_s <= time(0) {
            return Self { before: 0, span_s: 0.0, fraction: 0.0 };
        }
        if time_s >= time(last) {
            return Self { before: last, span_s: 0.0, fraction: 0.0 };
        }
        // Most tracks have a key per frame: then the first guess is right, or one beside it.
        let guess = (time_s - time(0)) / (time(last) - time(0)) * last as f64;
        let guess = (guess as usize).min(last - 1);
        let holds = |key: usize| key < last && time(key) <= time_s && time_s < time(key + 1);
        let near = [guess, guess.wrapping_sub(1), guess + 1];
        let searched = || times_s.partition_point(|&key_s| f64::from(key_s) <= time_s) - 1;
        let before = near.into_iter().find(|&key| holds(key)).unwrap_or_else(searched);
        let span_s = time(before + 1) - time(before);
        Self { before, span_s, fraction: (time_s - time(before)) / span_s }
    }

    /// How far the time is between its keys: 0 at a key and beyond the ends.
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

    /// `N` numbers of the value at the time, each by itself.
    pub fn numbers<const N: usize>(self, track: &Track) -> [f64; N] {
        array::from_fn(|axis| self.number(track, axis))
    }

    /// One number of the value at the time.
    pub fn number(self, track: &Track, axis: usize) -> f64 {
        let part = |index: usize| f64::from(track.values[index * track.width + axis]);
        let (before, t) = (self.before, self.fraction);
        match track.interpolation {
            Interpolation::Step => part(before),
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
