//! A smooth line through points of space: a centripetal Catmull-Rom spline, cut into equal steps.

use glam::DVec3;

/// How many points of the spline are found between two given points before it is cut into equal steps.
const FINE: usize = 24;

/// The spline through `points`, as `steps + 1` points at equal distances along it, both ends included. A point that is
/// not finite, or equal to the one before, is left out. The result is empty if fewer than two points are left or
/// `steps` is 0.
///
/// Centripetal Catmull-Rom (P. J. Barry and R. N. Goldman, A Recursive Evaluation Algorithm for a Class of Catmull-Rom
/// Splines, 1988): from one point to the next the parameter grows by the square root of their distance, so the line
/// makes no loop between them.
pub fn smooth_path(points: &[DVec3], steps: usize) -> Vec<DVec3> {
    let mut knots: Vec<DVec3> = Vec::with_capacity(points.len() + 2);
    for &point in points.iter().filter(|point| point.is_finite()) {
        if knots.last().is_none_or(|last| last.distance_squared(point) > 0.0) {
            knots.push(point);
        }
    }
    if knots.len() < 2 || steps == 0 {
        return Vec::new();
    }
    // The end pieces need a point beyond each end: the end's neighbour, mirrored at the end.
    let (first, last) = (knots[0] * 2.0 - knots[1], knots[knots.len() - 1] * 2.0 - knots[knots.len() - 2]);
    knots.insert(0, first);
    knots.push(last);
    let mut fine = vec![knots[1]];
    for four in knots.windows(4) {
        let piece = Piece::of([four[0], four[1], four[2], four[3]]);
        fine.extend((1..=FINE).map(|step| piece.at(step as f64 / FINE as f64)));
    }
    even(&fine, steps)
}

/// The piece of the spline between the second and the third of four points.
struct Piece {
    points: [DVec3; 4],
    times: [f64; 4],
}

impl Piece {
    fn of(points: [DVec3; 4]) -> Self {
        let step = |index: usize| points[index].distance(points[index + 1]).sqrt().max(1e-12);
        let (a, b, c) = (step(0), step(1), step(2));
        Self { points, times: [0.0, a, a + b, a + b + c] }
    }

    /// The point at a share of the way through the piece, 0..=1.
    fn at(&self, share: f64) -> DVec3 {
        let Self { points: p, times: t } = self;
        let time = t[1] + (t[2] - t[1]) * share;
        let mix = |a: DVec3, b: DVec3, from: f64, to: f64| a + (b - a) * ((time - from) / (to - from));
        let low = [0, 1, 2].map(|index| mix(p[index], p[index + 1], t[index], t[index + 1]));
        let middle = [0, 1].map(|index| mix(low[index], low[index + 1], t[index], t[index + 2]));
        mix(middle[0], middle[1], t[1], t[2])
    }
}

/// Resamples a line of points at equal steps.
fn even(line: &[DVec3], steps: usize) -> Vec<DVec3> {
    let mut along = vec![0.0];
    for pair in line.windows(2) {
        along.push(along[along.len() - 1] + pair[0].distance(pair[1]));
    }
    let whole = along[along.len() - 1];
    let at = |step: usize| {
        let wanted = whole * step as f64 / steps as f64;
        let next = along.partition_point(|&here| here < wanted).clamp(1, line.len() - 1);
        let (from, to) = (along[next - 1], along[next]);
        let share = if to > from { ((wanted - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
        line[next - 1].lerp(line[next], share)
    };
    (0..=steps).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_line_is_cut_into_equal_steps() {
        let points = [0.0, 1.0, 1.5, 4.0].map(|x| DVec3::new(x, 2.0 * x, -x));
        let path = smooth_path(&points, 8);
        assert_eq!(path.len(), 9);
        for (step, at) in path.iter().enumerate() {
            let x = 4.0 * step as f64 / 8.0;
            assert!((*at - DVec3::new(x, 2.0 * x, -x)).length() < 1e-9, "{step}: {at}");
        }
    }

    #[test]
    fn it_passes_through_its_points_and_does_not_loop() {
        let points = [DVec3::ZERO, DVec3::X, DVec3::new(1.05, 0.1, 0.0), DVec3::new(1.0, 2.0, 0.0)];
        let path = smooth_path(&points, 400);
        for point in points {
            let nearest = path.iter().map(|at| at.distance(point)).fold(f64::INFINITY, f64::min);
            assert!(nearest < 0.01, "{point}: {nearest}");
        }
        let steps: Vec<f64> = path.windows(2).map(|pair| pair[0].distance(pair[1])).collect();
        let (least, most) = steps.iter().fold((f64::MAX, 0.0f64), |(a, b), &step| (a.min(step), b.max(step)));
        assert!(most < 1.02 * least, "{least} {most}");
        for three in path.windows(3) {
            assert!((three[1] - three[0]).dot(three[2] - three[1]) > 0.0, "it turns back at {}", three[1]);
        }
    }

    #[test]
    fn without_two_places_there_is_no_line() {
        assert!(smooth_path(&[], 4).is_empty());
        assert!(smooth_path(&[DVec3::X, DVec3::X, DVec3::NAN], 4).is_empty());
    }
}
