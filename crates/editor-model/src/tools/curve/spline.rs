//! Finds a smooth curve through points of a surface, for guides that are drawn as curves: a Catmull-Rom spline whose
//! points are projected onto the surface.

use glam::DVec3;

use crate::path::PathPoint;

/// The most steps between two points.
const MOST_STEPS: f64 = 64.0;

/// Points about `step` (model units) apart on a curve through all of `points`. `onto` projects a position with its
/// normal onto the surface.
pub(super) fn through(
    points: &[PathPoint],
    step: f64,
    onto: &mut dyn FnMut(DVec3, DVec3) -> PathPoint,
) -> Vec<PathPoint> {
    let Some(first) = points.first() else { return Vec::new() };
    let at = |index: isize| {
        let last = points.len() as isize - 1;
        let inside = |index: isize| points[index.clamp(0, last) as usize].position;
        // Beyond an end, the first or last piece is continued straight on.
        match index {
            before if before < 0 => inside(0) * 2.0 - inside(1),
            after if after > last => inside(last) * 2.0 - inside(last - 1),
            within => inside(within),
        }
    };
    let mut curve = vec![*first];
    for (index, pair) in points.windows(2).enumerate() {
        let [a, b, c, d] = [-1, 0, 1, 2].map(|offset| at(index as isize + offset));
        let steps = (b.distance(c) / step).ceil().clamp(1.0, MOST_STEPS);
        for taken in 1..steps as u32 {
            let t = f64::from(taken) / steps;
            let (t2, t3) = (t * t, t * t * t);
            let position = (b * 2.0
                + (c - a) * t
                + (a * 2.0 - b * 5.0 + c * 4.0 - d) * t2
                + (b * 3.0 - a - c * 3.0 + d) * t3)
                * 0.5;
            let normal = pair[0].normal.lerp(pair[1].normal, t).normalize_or(pair[0].normal);
            curve.push(onto(position, normal));
        }
        curve.push(pair[1]);
    }
    curve
}
