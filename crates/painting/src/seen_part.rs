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
        [a, b, c].into_iter().for_each(|corner| part.push(corner));
        part
    }

    fn none() -> Self {
        Self { corners: [DVec3::ZERO; MOST_CORNERS], count: 0 }
    }

    fn push(&mut self, corner: DVec3) {
        if let Some(next) = self.corners.get_mut(self.count) {
            *next = corner;
            self.count += 1;
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Its corners, in order round it; none if nothing is left.
    pub(crate) fn corners(&self) -> &[DVec3] {
        &self.corners[..self.count]
    }

    /// The same with all corners moved by a linear map.
    pub(crate) fn moved(&self, by: impl Fn(DVec3) -> DVec3) -> Self {
        Self { corners: self.corners.map(by), count: self.count }
    }

    /// Cuts off what is beyond a plane, where `beyond` is positive. `beyond` must be linear.
    pub(crate) fn cut(&mut self, beyond: impl Fn(DVec3) -> f64) {
        let heights = self.corners.map(beyond);
        if heights[..self.count].iter().all(|&height| height <= 0.0) {
            return;
        }
        let whole = std::mem::replace(self, Self::none());
        for corner in 0..whole.count {
            let next = (corner + 1) % whole.count;
            let [from, to] = [corner, next].map(|at| whole.corners[at]);
            let [height, next_height] = [corner, next].map(|at| heights[at]);
            if height <= 0.0 {
                self.push(from);
            }
            if (height > 0.0) != (next_height > 0.0) {
                self.push(from.lerp(to, height / (height - next_height)));
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
        // The corner at (1, 1) is cut off too.
        part.cut(|corner| corner.x + corner.y - 1.5);
        assert_eq!(part.corners().len(), 5);
        let farthest = part.corners().iter().map(|corner| corner.x + corner.y).fold(0.0, f64::max);
        assert!((farthest - 1.5).abs() < 1e-12);
        part.cut(|corner| 0.1 - corner.z);
        assert!(part.corners().is_empty());
    }
}
