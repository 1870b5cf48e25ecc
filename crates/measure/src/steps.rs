//! M16, steps: counts the visible strokes that appear or vanish from one frame to the next. Also measures for how many
//! frames highlights last.

use std::collections::BTreeMap;

use impasto_gl_render::ReferencePixels;
use impasto_painting::frame::LayerKind;

use crate::chatter::{Place, Share};
use crate::popping::{displacement_px, touches_border};
use crate::strokes::{MeasuredStroke, StrokeKey, StrokesByKey};

/// A stroke steps if its change of alpha from one frame to the next, times the share of the stroke that is visible,
/// exceeds this.
const STEP: f64 = 0.35;

/// A surface hides a stroke if it is nearer to the eye than the stroke's nearest end, by more than this share of the
/// stroke's depth.
const NEARER: f64 = 0.01;

/// If the cosine between the normal of a stroke's surface and the direction to the eye is smaller than this, this value
/// is taken instead.
const LEAST_FACING: f64 = 0.2;

/// Fainter strokes are not painted.
const LEAST_ALPHA: f64 = 0.004;

/// A frame as this measure needs it.
#[derive(Clone, Copy)]
pub struct Shown<'a> {
    /// Its strokes as drawn.
    pub strokes: &'a StrokesByKey,
    /// Body and depth of every pixel.
    pub reference: &'a ReferencePixels,
    /// World units that a pixel spans at depth 1; 0 with parallel rays, so that slant is ignored there.
    pub units_per_px_at_1: f64,
}

/// Steps over a shot.
#[derive(Clone, Debug, Default)]
pub struct Steps {
    /// Stroke-frames and steps, by layer.
    pub by_layer: BTreeMap<LayerKind, Share>,
    /// Stroke-frames and steps, by body.
    pub by_body: BTreeMap<u32, Share>,
    /// The largest step.
    pub worst: Option<Place>,
    /// For each highlight that came within the shot and was not seen to go: how many frames it has lasted.
    living: BTreeMap<StrokeKey, usize>,
    /// For each highlight that came and went within the shot: how many frames it lasted.
    lives: Vec<f64>,
}

impl Steps {
    /// Adds two neighbouring frames of one size; `frame` is the number of the second.
    pub fn add(&mut self, frame: f64, before: Shown<'_>, after: Shown<'_>, size_px: [u32; 2]) {
        let carried_px = displacement_px(before.strokes, after.strokes);
        let came = after.strokes.iter().filter(|(key, _)| !before.strokes.contains_key(*key));
        let pairs = before.strokes.iter().map(|(key, then)| (key, Some(then), after.strokes.get(key)));
        for (key, then, now) in pairs.chain(came.map(|(key, now)| (key, None, Some(now)))) {
            let alpha = |stroke: Option<&MeasuredStroke>| stroke.map_or(0.0, |stroke| stroke.alpha);
            let margin_px = if then.is_some() && now.is_some() { 0.0 } else { carried_px };
            let ends = [then, now];
            if ends.into_iter().flatten().any(|stroke| touches_border(stroke, margin_px, size_px))
                || alpha(then).max(alpha(now)) <= LEAST_ALPHA
            {
                continue;
            }
            let change = (alpha(then) - alpha(now)).abs();
            let mut step = change;
            if change > STEP {
                let seen = |stroke: Option<&MeasuredStroke>, shown: Shown<'_>| {
                    stroke.map_or(1.0, |stroke| visible_share(key, stroke, shown, size_px))
                };
                step *= seen(then, before).min(seen(now, after));
            }
            let found = f64::from(u8::from(step > STEP));
            self.by_layer.entry(key.kind).or_default().count(found);
            self.by_body.entry(key.body_id).or_default().count(found);
            if found > 0.0 && self.worst.is_none_or(|worst| step > worst.amount) {
                let at = now.or(then).map_or([0.0; 2], |stroke| stroke.center_px);
                let at_px = [at[0], f64::from(size_px[1]) - at[1]];
                self.worst = Some(Place { frame, at_px, stroke: Some(*key), amount: step });
            }
            if key.kind == LayerKind::Lights {
                self.live(key, ends.map(|stroke| alpha(stroke) > LEAST_ALPHA));
            }
        }
    }

    /// Counts the frames of a highlight; the pair says whether it is there before and after.
    fn live(&mut self, key: &StrokeKey, there: [bool; 2]) {
        match there {
            [false, true] => _ = self.living.insert(*key, 1),
            [true, true] => {
                if let Some(frames) = self.living.get_mut(key) {
                    *frames += 1;
                }
            }
            [true, false] => self.lives.extend(self.living.remove(key).map(|frames| frames as f64)),
            [false, false] => {}
        }
    }

    /// How many steps there were.
    pub fn count(&self) -> f64 {
        self.by_layer.values().map(|share| share.found).sum()
    }

    /// For each highlight that came within the shot: how many frames it lasted. A highlight that is still there at the
    /// end, or that left at the picture's border, counts with its frames so far.
    pub fn lives_of_highlights(&self) -> Vec<f64> {
        self.lives.iter().copied().chain(self.living.values().map(|&frames| frames as f64)).collect()
    }
}

/// The share of a stroke's area where its own body shows, and not a nearer part of that body.
fn visible_share(key: &StrokeKey, stroke: &MeasuredStroke, shown: Shown<'_>, size_px: [u32; 2]) -> f64 {
    let reference = shown.reference;
    let facing = stroke.facing.clamp(LEAST_FACING, 1.0);
    // How much nearer the stroke's near end is than its centre on a slanting surface, as a share of the depth.
    let slant = shown.units_per_px_at_1 * 0.5 * stroke.length_px * (1.0 / (facing * facing) - 1.0).sqrt();
    let nearest = stroke.depth * (1.0 - NEARER - slant);
    let (sin, cos) = stroke.angle_rad.sin_cos();
    let [width, height] = size_px.map(f64::from);
    let (mut seen, mut of) = (0, 0);
    for index in 0..21 {
        let along = (f64::from(index % 7) - 3.0) / 7.0 * stroke.length_px;
        let across = (f64::from(index / 7) - 1.0) / 3.0 * stroke.width_px;
        let x = stroke.center_px[0] + cos * along - sin * across;
        let y = height - (stroke.center_px[1] + sin * along + cos * across);
        if !(0.0..width).contains(&x) || !(0.0..height).contains(&y) {
            continue;
        }
        let pixel = y as usize * size_px[0] as usize + x as usize;
        let own = reference.body_id[pixel] == key.body_id;
        of += 1;
        seen += u32::from(own && f64::from(reference.depth[pixel]) > nearest);
    }
    f64::from(seen) / f64::from(of.max(1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::strokes::a_stroke;

    fn key(kind: LayerKind, particle: u32) -> StrokeKey {
        StrokeKey { body_id: 1, kind, particle }
    }

    #[test]
    fn a_step_counts_where_it_is_seen() {
        let size_px = [100, 100];
        let mut reference = ReferencePixels { depth: vec![1.0; 10_000], body_id: vec![1; 10_000] };
        // Something stands before the lower half of the picture.
        reference.body_id[5000..].fill(2);
        let strokes = |alpha: f64| -> StrokesByKey {
            let at = [[30.0, 80.0], [60.0, 20.0], [70.0, 80.0]];
            let alphas = [alpha, alpha, 0.5 + 0.3 * alpha];
            (0u32..)
                .zip(at.into_iter().zip(alphas))
                .map(|(particle, (at, alpha))| (key(LayerKind::Body, particle), a_stroke(at, alpha, 0.5)))
                .collect()
        };
        let [before, after] = [strokes(0.0), strokes(1.0)];
        let mut found = Steps::default();
        let shown = |strokes| Shown { strokes, reference: &reference, units_per_px_at_1: 0.0 };
        found.add(1.0, shown(&before), shown(&after), size_px);
        assert_eq!(found.by_layer[&LayerKind::Body], Share { found: 1.0, of: 3 });
        assert_eq!(found.worst.unwrap().at_px, [30.0, 20.0]);
    }

    #[test]
    fn highlights_are_counted_by_how_long_they_live() {
        let reference = ReferencePixels { depth: vec![1.0; 10_000], body_id: vec![1; 10_000] };
        let frame = |alphas: [f64; 3]| -> StrokesByKey {
            (0u32..)
                .zip(alphas)
                .map(|(particle, alpha)| (key(LayerKind::Lights, particle), a_stroke([50.0; 2], alpha, 0.5)))
                .collect()
        };
        // One is there at the beginning, one lives for two frames, and one is still there at the end.
        let frames = [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [0.0, 0.0, 1.0]].map(frame);
        let mut found = Steps::default();
        for (number, pair) in frames.windows(2).enumerate() {
            let [before, after] =
                [0, 1].map(|at| Shown { strokes: &pair[at], reference: &reference, units_per_px_at_1: 0.0 });
            found.add(number as f64, before, after, [100, 100]);
        }
        let mut lives = found.lives_of_highlights();
        lives.sort_by(f64::total_cmp);
        assert_eq!(lives, [2.0, 2.0]);
    }
}
