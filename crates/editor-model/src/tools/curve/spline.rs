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

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;

    /// Beyond its ends a curve goes straight on. So a curve through evenly spaced points of a line is evenly spaced.
    #[test]
    fn through_points_of_a_line_it_is_that_line() {
        let at = |x: f64| PathPoint {
            at_px: DVec2::ZERO,
            position: DVec3::new(x, 2.0 * x, 1.0),
            normal: DVec3::Z,
            pressure: 1.0,
        };
        let mut flat = |position: DVec3, normal: DVec3| PathPoint { position, normal, ..at(0.0) };
        for points in [vec![at(0.0), at(1.0)], vec![at(0.0), at(1.0), at(2.0)]] {
            let length = points[0].position.distance(points[points.len() - 1].position);
            let curve = through(&points, length / 12.0, &mut flat);
            assert_eq!(curve.len(), 13);
            for (index, point) in curve.iter().enumerate() {
                let wanted = at((points.len() - 1) as f64 * index as f64 / 12.0).position;
                assert!(point.position.abs_diff_eq(wanted, 1e-9), "{index}: {}", point.position);
            }
        }
    }
}
