//! Measures whether strokes appear or vanish suddenly: M4, popping.

use crate::strokes::{MeasuredStroke, StrokeKey, StrokesByKey};

/// A larger step of alpha from one frame to the next is a pop.
const STEP: f64 = 0.2;

/// A stroke that moves by less than this, in pixels, stands still.
const STILL_PX: f64 = 1e-3;

/// The quad of a stroke is this many times as long and as wide as the stroke: it has room for ragged ends.
const QUAD: f64 = 1.0 / impasto_core::brush::FILL as f64;

/// What popped from one frame to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Popping {
    /// Area of the strokes whose alpha stepped by more than 0.2, over the area shown before:
    /// Σ a·\[|Δα| > 0.2\] / Σ a·α.
    pub share: f64,
    /// The largest step of alpha.
    pub largest_step: f64,
    /// The stroke that made it.
    pub worst: Option<StrokeKey>,
    /// How many strokes were compared.
    pub strokes: usize,
    /// How many of them popped.
    pub popped: usize,
}

/// Popping between two frames of one size. A stroke that is absent has an alpha of 0. A stroke that touches the
/// picture's border in either frame is left out: it enters or leaves, which is no pop.
pub fn popping(before: &StrokesByKey, after: &StrokesByKey, size_px: [u32; 2]) -> Popping {
    let carried_px = displacement_px(before, after);
    let mut found = Popping::default();
    let (mut popped, mut shown) = (0.0, 0.0);
    let only_after =
        after.iter().filter(|(key, _)| !before.contains_key(*key)).map(|(key, now)| (key, None, Some(now)));
    let others = before.iter().map(|(key, then)| (key, Some(then), after.get(key)));
    for (key, then, now) in others.chain(only_after) {
        // A stroke that is in one frame only may have crossed the border. We assume that it moved no farther than the
        // fastest stroke that is in both frames.
        let margin_px = if then.is_some() && now.is_some() { 0.0 } else { carried_px };
        if [then, now].into_iter().flatten().any(|stroke| touches_border(stroke, margin_px, size_px)) {
            continue;
        }
        let alpha = |stroke: Option<&MeasuredStroke>| stroke.map_or(0.0, |stroke| stroke.alpha);
        let area = |stroke: Option<&MeasuredStroke>| stroke.map_or(0.0, MeasuredStroke::area_px);
        let step = (alpha(then) - alpha(now)).abs();
        if step > found.largest_step {
            (found.largest_step, found.worst) = (step, Some(*key));
        }
        found.strokes += 1;
        if step > STEP {
            popped += area(then).max(area(now));
            found.popped += 1;
        }
        shown += area(then) * alpha(then);
    }
    found.share = if shown > 0.0 { popped / shown } else { 0.0 };
    found
}

pub(crate) fn touches_border(stroke: &MeasuredStroke, margin_px: f64, size_px: [u32; 2]) -> bool {
    let (sin, cos) = stroke.angle_rad.sin_cos();
    let half = |along: f64, across: f64| {
        0.5 * QUAD * (along.abs() * stroke.length_px + across.abs() * stroke.width_px) + margin_px + 1.0
    };
    let reach = [half(cos, sin), half(sin, cos)];
    [0, 1].into_iter().any(|axis| {
        let (at, side) = (stroke.center_px[axis], f64::from(size_px[axis]));
        at - reach[axis] < 0.0 || at + reach[axis] > side
    })
}

/// The largest distance that any stroke has moved, among those that are in both frames.
pub(crate) fn displacement_px(before: &StrokesByKey, after: &StrokesByKey) -> f64 {
    let moved = before.iter().filter_map(|(key, then)| {
        let now = after.get(key)?;
        Some(displacement(then, now))
    });
    moved.fold(0.0, f64::max)
}

fn displacement(then: &MeasuredStroke, now: &MeasuredStroke) -> f64 {
    let [dx, dy] = [0, 1].map(|axis| now.particle_px[axis] - then.particle_px[axis]);
    dx.hypot(dy)
}

/// The same strokes with their presence as alpha. They then count as if nothing hid them, and as if each layer were
/// painted everywhere. (In the picture, small strokes, for example, are painted only near detail.)
pub fn by_presence(strokes: &StrokesByKey) -> StrokesByKey {
    strokes.iter().map(|(key, stroke)| (*key, MeasuredStroke { alpha: stroke.presence, ..*stroke })).collect()
}

/// The strokes of the bodies that move in the picture between the two frames: strokes of still bodies would dilute the
/// share that pops.
pub fn of_moving_bodies(before: &StrokesByKey, after: &StrokesByKey) -> [StrokesByKey; 2] {
    let mut moving: Vec<u32> = before
        .iter()
        .filter(|(key, then)| after.get(*key).is_some_and(|now| displacement(then, now) > STILL_PX))
        .map(|(key, _)| key.body_id)
        .collect();
    moving.sort_unstable();
    moving.dedup();
    let moves = |key: &StrokeKey| moving.binary_search(&key.body_id).is_ok();
    [before, after].map(|strokes| {
        strokes.iter().filter(|(key, _)| moves(key)).map(|(key, stroke)| (*key, *stroke)).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::strokes::a_stroke;
    use impasto_painting::frame::LayerKind;

    fn strokes(alphas: &[(u32, f64, [f64; 2])]) -> StrokesByKey {
        let stroke = |&(particle, alpha, center_px): &(u32, f64, [f64; 2])| {
            let key = StrokeKey { body_id: 1, kind: LayerKind::Body, particle };
            (key, a_stroke(center_px, alpha, 0.5))
        };
        alphas.iter().map(stroke).collect()
    }

    #[test]
    fn steps_appearing_and_vanishing_are_pops_except_at_the_border() {
        let middle = [50.0, 50.0];
        let before = strokes(&[(0, 1.0, middle), (1, 1.0, middle), (2, 0.5, middle), (3, 1.0, [2.0, 50.0])]);
        let after = strokes(&[(0, 0.9, middle), (2, 0.1, middle), (4, 0.8, middle), (5, 1.0, [50.0, 99.0])]);
        let found = popping(&before, &after, [100, 100]);
        // 1 vanishes, 2 steps, 4 appears; 3 and 5 are at the border.
        assert_eq!((found.strokes, found.popped), (4, 3));
        assert!((found.share - 3.0 / 2.5).abs() < 1e-12);
        assert_eq!(found.largest_step, 1.0);
        assert_eq!(popping(&before, &before, [100, 100]).share, 0.0);
    }
}
