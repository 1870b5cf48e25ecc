//! How values move from one key to the next.

use serde::{Deserialize, Serialize};

/// How a value moves from one key to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
pub enum Ease {
    /// Holds until the next key.
    Step,
    /// At a constant rate.
    #[default]
    Linear,
    /// Starts and ends at rest.
    Smooth,
    /// Starts at rest, and gets ever faster.
    In,
    /// Starts fast, and comes to rest.
    Out,
    /// Falls to the next key like a ball, and bounces back from it three times, lower each time.
    Bounce,
    /// A cubic Bézier curve from (0, 0) to (1, 1) with these two handles, like `cubic-bezier` in CSS: `x` is the share
    /// of the time that has passed, and `y` how far the value has come. A handle's `x` is from 0 to 1, its `y` from -2
    /// to 3. Where the curve goes below 0 or above 1, places and rotations overshoot, while sizes, colours and
    /// strengths stop at the limits of their fields.
    Curve([f64; 2], [f64; 2]),
}

impl Ease {
    /// The curve that is offered first for a key without a curve: `ease` of CSS.
    pub const USUAL_CURVE: Self = Self::Curve([0.25, 0.1], [0.25, 1.0]);

    /// How far the value has come: 0 at the key, 1 at the next one. `time` is the time since the key, as a share of the
    /// time between the two keys. The result is exactly 0 up to time 0, and exactly 1 from time 1 on. Only
    /// [`Ease::Curve`] leaves the range from 0 to 1.
    pub fn share(self, time: f64) -> f64 {
        if time <= 0.0 {
            return 0.0;
        }
        if time >= 1.0 {
            return 1.0;
        }
        match self {
            Self::Step => 0.0,
            Self::Linear => time,
            Self::Smooth => time * time * (3.0 - 2.0 * time),
            Self::In => time * time,
            Self::Out => time * (2.0 - time),
            Self::Bounce => bounced(time),
            Self::Curve(first, second) => {
                let part = part_at(time, first[0], second[0]);
                bezier(part, first[1], second[1])
            }
        }
    }

    /// The least and the greatest value that [`Ease::share`] can return.
    pub fn reach(self) -> [f64; 2] {
        let Self::Curve([_, first], [_, second]) = self else { return [0.0, 1.0] };
        // The curve turns where its slope is zero. A third of the slope of `bezier` at `part` = s is a·s² + b·s + c.
        let (a, b, c) = (1.0 + 3.0 * (first - second), 2.0 * (second - 2.0 * first), first);
        let root = (b * b - 4.0 * a * c).max(0.0).sqrt();
        let turns =
            if a.abs() < 1e-12 { [-c / b, 0.0] } else { [(-b - root) / (2.0 * a), (-b + root) / (2.0 * a)] };
        let inside = turns.into_iter().filter(|part| (0.0..=1.0).contains(part));
        inside
            .map(|part| bezier(part, first, second))
            .fold([0.0, 1.0], |[least, most], share| [f64::min(least, share), f64::max(most, share)])
    }

    /// The two handles of the [`Ease::Curve`] that equals this ease. No curve equals `Step` or `Bounce`: they get the
    /// handles of `Linear` and `Out`.
    pub fn handles(self) -> [[f64; 2]; 2] {
        const THIRD: f64 = 1.0 / 3.0;
        match self {
            Self::Linear | Self::Step => [[THIRD, THIRD], [2.0 * THIRD, 2.0 * THIRD]],
            Self::Smooth => [[THIRD, 0.0], [2.0 * THIRD, 1.0]],
            Self::In => [[THIRD, 0.0], [2.0 * THIRD, THIRD]],
            Self::Out | Self::Bounce => [[THIRD, 2.0 * THIRD], [2.0 * THIRD, 1.0]],
            Self::Curve(first, second) => [first, second],
        }
    }
}

/// How far a ball has fallen: 0 where it is let go, 1 on the floor. It bounces to 1/4, 1/16 and 1/64 of its first
/// height. Gravity stays the same, so the bounces take 1, 1/2 and 1/4 of the time of the first fall (R. Penner,
/// *Motion, Tweening and Easing*, 2002).
fn bounced(time: f64) -> f64 {
    // Time in units of the first fall; the whole takes 1 + 1 + 1/2 + 1/4 of them.
    let falls = 2.75 * time;
    let (middle, height) = match falls {
        ..1.0 => (0.0, 1.0),
        ..2.0 => (1.5, 0.25),
        ..2.5 => (2.25, 0.0625),
        _ => (2.625, 0.015_625),
    };
    (1.0 - height + (falls - middle) * (falls - middle)).min(1.0)
}

/// One coordinate of a cubic Bézier curve at the parameter `part`. It is 0 and 1 at the curve's ends, and `first` and
/// `second` at its handles.
fn bezier(part: f64, first: f64, second: f64) -> f64 {
    let rest = 1.0 - part;
    part * (3.0 * rest * (rest * first + part * second) + part * part)
}

/// The derivative of [`bezier`] with respect to `part`.
fn bezier_slope(part: f64, first: f64, second: f64) -> f64 {
    let rest = 1.0 - part;
    3.0 * (rest * rest * first + 2.0 * rest * part * (second - first) + part * part * (1.0 - second))
}

/// The parameter of the curve at which its `x` equals `time`. Newton's method finds it between two bounds, `low` and
/// `high`, which close in on it.
fn part_at(time: f64, first_x: f64, second_x: f64) -> f64 {
    const MOST_STEPS: usize = 80;
    let (mut low, mut high, mut part) = (0.0, 1.0, time);
    for step in 0..MOST_STEPS {
        let off = bezier(part, first_x, second_x) - time;
        if off == 0.0 || high - low <= f64::EPSILON {
            break;
        }
        if off < 0.0 {
            low = part
        } else {
            high = part
        }
        let newton = part - off / bezier_slope(part, first_x, second_x);
        // Where Newton's step would leave the bounds, or 12 steps have not been enough, the interval between the bounds
        // is halved instead.
        let next = if step < 12 && newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if next == part {
            break;
        }
        part = next;
    }
    part
}

#[cfg(test)]
mod tests;
