//! The part of a triangle that lies inside a view.

use glam::DVec3;

/// A triangle has three corners, and each of the five planes round a view may add one.
const MOST_CORNERS: usize = 8;

/// A triangle, or what planes have left of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeenPart {
    corners: [DVec3; MOST_CORNERS],
    count: usize,
}

impl SeenPart {
    pub(crate) fn of_triangle([a, b, c]: [DVec3; 3]) -> Self {
        let mut part = Self::none();
        part.corners[..3].copy_from_slice(&[a, b, c]);
        part.count = 3;
        part
    }

    fn none() -> Self {
        Self { corners: [DVec3::ZERO; MOST_CORNERS], count: 0 }
    }

    /// Adds a corner, if there is place for one. Returns whether there was.
    fn push(&mut self, corner: DVec3) -> bool {
        let Some(next) = self.corners.get_mut(self.count) else { return false };
        *next = corner;
        self.count += 1;
        true
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Its corners, in order round it; none if nothing is left.
    pub(crate) fn corners(&self) -> &[DVec3] {
        &self.corners[..self.count]
    }

    /// The same with all corners moved by an affine map.
    pub(crate) fn moved(&self, by: impl Fn(DVec3) -> DVec3) -> Self {
        Self { corners: self.corners.map(by), count: self.count }
    }

    /// Cuts off what is beyond a plane, where `beyond` is positive. `beyond` must be affine. Corners that are not
    /// numbers stay.
    pub(crate) fn cut(&mut self, beyond: impl Fn(DVec3) -> f64) {
        let heights = self.corners.map(beyond);
        if !heights[..self.count].iter().any(|&height| height > 0.0) {
            return;
        }
        let whole = std::mem::replace(self, Self::none());
        for corner in 0..whole.count {
            let next = (corner + 1) % whole.count;
            let [from, to] = [corner, next].map(|at| whole.corners[at]);
            let [height, next_height] = [corner, next].map(|at| heights[at]);
            let stays = height.is_nan() || height <= 0.0;
            let is_crossed = (height > 0.0) != (next_height > 0.0);
            let crossing = || from.lerp(to, height / (height - next_height));
            if stays && !self.push(from) || is_crossed && !self.push(crossing()) {
                // Rounding has made the polygon concave. It stays uncut: too large a part does no harm.
                *self = whole;
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_leave_what_is_on_their_near_side() {
        let [a, b, c] = [DVec3::ZERO, DVec3::X * 2.0, DVec3::Y * 2.0];
        let mut part = SeenPart::of_triangle([a, b, c]);
        part.cut(|corner| corner.x - 3.0);
        assert_eq!(part.corners(), [a, b, c]);
        part.cut(|corner| corner.x - 1.0);
        assert_eq!(part.corners(), [a, DVec3::X, DVec3::new(1.0, 1.0, 0.0), c]);
        part.cut(|corner| corner.x + corner.y - 1.5);
        assert_eq!(part.corners(), [a, DVec3::X, DVec3::new(1.0, 0.5, 0.0), DVec3::Y * 1.5]);
        part.cut(|corner| corner.y - corner.x - 1.0);
        assert_eq!(part.corners().len(), 5);
        part.cut(|corner| 0.1 - corner.z);
        assert!(part.corners().is_empty());
    }

    /// If a corner that is no number were dropped, a place that may be in view could be left without particles.
    #[test]
    fn corners_that_are_no_numbers_stay_and_too_many_corners_leave_all() {
        let mut part = SeenPart::of_triangle([DVec3::ZERO, DVec3::X, DVec3::NAN]);
        part.cut(|corner| corner.x - 0.5);
        assert!(part.corners().iter().any(|corner| corner.is_nan()));
        // To cut off every second one of eight corners would leave twelve, more than there is place for.
        let corner = |at: usize| DVec3::new((at as f64).cos(), (at as f64).sin(), (at % 2) as f64);
        let mut part = SeenPart { corners: std::array::from_fn(corner), count: MOST_CORNERS };
        part.cut(|corner| corner.z - 0.5);
        assert_eq!(part.corners(), std::array::from_fn::<_, MOST_CORNERS, _>(corner));
    }
}
