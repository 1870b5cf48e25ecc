//! Smooths the path of the pointer: lays a centripetal Catmull-Rom curve (Barry and Goldman 1988; Yuksel, Schaefer and
//! Keyser 2011) through the places that the pointer reports, and walks it in equal steps.

use glam::DVec2;

use super::STEP_PX;

/// A curve through the reported points. It ends at the last point but one, because the piece that leads to a point
/// also depends on the next point.
#[derive(Clone, Debug)]
pub(super) struct PointerCurve {
    /// The last points, at most three; neighbours are never at the same place.
    points: Vec<Step>,
    /// Length of the curve from the last step to where the walk ended.
    walked_px: f64,
}

/// A place of the pointer, and how hard it presses there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Step {
    pub(super) at_px: DVec2,
    pub(super) pressure: f64,
}

/// Reports closer than this count as one.
const SAME_PX: f64 = 1e-3;

impl PointerCurve {
    pub(super) fn new(step: Step) -> Self {
        Self { points: vec![step], walked_px: 0.0 }
    }

    /// Takes the next point. Returns the steps on the piece of the curve that this point makes final.
    pub(super) fn move_to(&mut self, step: Step) -> Vec<Step> {
        if let Some(last) = self.points.last_mut()
            && last.at_px.distance(step.at_px) < SAME_PX
        {
            // While a pen is set down, its pressure rises without a movement.
            last.pressure = last.pressure.max(step.pressure);
            return Vec::new();
        }
        self.points.push(step);
        match *self.points.as_slice() {
            [a, b, c] => self.walk(mirrored(c.at_px, a.at_px, b.at_px), [a, b], c.at_px),
            [a, b, c, d] => {
                self.points.remove(0);
                self.walk(a.at_px, [b, c], d.at_px)
            }
            _ => Vec::new(),
        }
    }

    /// The steps to the last point, and that point.
    pub(super) fn finish(&mut self) -> Vec<Step> {
        let (end, mut steps) = match *self.points.as_slice() {
            [a, b] => (b, self.walk(a.at_px * 2.0 - b.at_px, [a, b], b.at_px * 2.0 - a.at_px)),
            [a, b, c] => (c, self.walk(a.at_px, [b, c], mirrored(a.at_px, b.at_px, c.at_px))),
            _ => return Vec::new(),
        };
        steps.push(end);
        steps
    }

    /// Steps on the curve between two points; `a` is the point before them, `d` the point after.
    fn walk(&mut self, a: DVec2, [first, second]: [Step; 2], d: DVec2) -> Vec<Step> {
        let (b, c) = (first.at_px, second.at_px);
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
                let share = (f64::from(piece - 1) + next / length) / f64::from(pieces);
                let pressure = first.pressure + (second.pressure - first.pressure) * share;
                steps.push(Step { at_px: from.lerp(to, next / length), pressure });
                next += STEP_PX;
            }
            self.walked_px = length - (next - STEP_PX);
            from = to;
        }
        steps
    }
}

/// Mirrors a point in the perpendicular bisector of `from` and `to`. The image lies on the circle through all three
/// points. It stands in for a point that the curve lacks at its start or end.
fn mirrored(point: DVec2, from: DVec2, to: DVec2) -> DVec2 {
    let along = (to - from).normalize_or_zero();
    point - along * (2.0 * (point - (from + to) * 0.5).dot(along))
}
