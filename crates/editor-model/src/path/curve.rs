//! Smooths the path of the pointer: lays a centripetal Catmull-Rom curve (Barry and Goldman 1988; Yuksel, Schaefer and
//! Keyser 2011) through the places that the pointer reports, and walks it in equal steps.

use glam::DVec2;

use super::STEP_PX;

/// A curve through the reported points. It ends at the last point but one, because how it bends on the way to a point
/// depends on the point after that.
#[derive(Clone, Debug)]
pub(super) struct PointerCurve {
    /// The last points, at most three; neighbours are never at the same place.
    points: Vec<DVec2>,
    /// Length of the curve from the last step to where the walk ended.
    walked_px: f64,
}

/// Reports closer than this count as one.
const SAME_PX: f64 = 1e-3;

impl PointerCurve {
    pub(super) fn new(at_px: DVec2) -> Self {
        Self { points: vec![at_px], walked_px: 0.0 }
    }

    /// Takes a point; returns the steps on the piece of the curve that is final from now on.
    pub(super) fn move_to(&mut self, at_px: DVec2) -> Vec<DVec2> {
        if self.points.last().is_some_and(|last| last.distance(at_px) < SAME_PX) {
            return Vec::new();
        }
        self.points.push(at_px);
        match *self.points.as_slice() {
            [a, b, c] => self.walk([mirrored(c, a, b), a, b, c]),
            [a, b, c, d] => {
                self.points.remove(0);
                self.walk([a, b, c, d])
            }
            _ => Vec::new(),
        }
    }

    /// The steps to the last point, and that point.
    pub(super) fn finish(&mut self) -> Vec<DVec2> {
        let (end, mut steps) = match *self.points.as_slice() {
            [a, b] => (b, self.walk([a * 2.0 - b, a, b, b * 2.0 - a])),
            [a, b, c] => (c, self.walk([a, b, c, mirrored(a, b, c)])),
            _ => return Vec::new(),
        };
        steps.push(end);
        steps
    }

    /// Steps on the curve from `b` to `c`.
    fn walk(&mut self, [a, b, c, d]: [DVec2; 4]) -> Vec<DVec2> {
        let knot = |from: DVec2, to: DVec2| from.distance(to).sqrt().max(1e-9);
        let (ab, bc, cd) = (knot(a, b), knot(b, c), knot(c, d));
        let tangent = |[p, q, r]: [DVec2; 3], pq: f64, qr: f64| {
            ((q - p) / pq - (r - p) / (pq + qr) + (r - q) / qr) * bc
        };
        let (out, into) = (tangent([a, b, c], ab, bc), tangent([b, c, d], bc, cd));
        let at = |t: f64| {
            let (t2, t3) = (t * t, t * t * t);
            b * (2.0 * t3 - 3.0 * t2 + 1.0)
                + out * (t3 - 2.0 * t2 + t)
                + c * (3.0 * t2 - 2.0 * t3)
                + into * (t3 - t2)
        };
        let pieces = (b.distance(c) * 4.0 / STEP_PX).ceil().clamp(4.0, 65_536.0) as u32;
        let mut steps = Vec::new();
        let mut from = b;
        for piece in 1..=pieces {
            let to = at(f64::from(piece) / f64::from(pieces));
            let length = from.distance(to);
            let mut next = STEP_PX - self.walked_px;
            while next <= length {
                steps.push(from.lerp(to, next / length));
                next += STEP_PX;
            }
            self.walked_px = length - (next - STEP_PX);
            from = to;
        }
        steps
    }
}

/// Mirrors a point in the line that crosses the middle of `from` and `to` at a right angle. The image lies on the
/// circle through all three points, and stands in for a point that the curve lacks at its start or end.
fn mirrored(point: DVec2, from: DVec2, to: DVec2) -> DVec2 {
    let along = (to - from).normalize_or_zero();
    point - along * (2.0 * (point - (from + to) * 0.5).dot(along))
}
