//! The gizmo: the handles of an object in a view, where they are drawn and which one the pointer is on. Their size on
//! the screen is constant.

use glam::{DAffine3, DMat3, DVec2, DVec3};

use crate::picking::View;
use crate::session::Axes;
use crate::transform::{Axis, Constraint, Operation, axes_of};

#[cfg(test)]
mod tests;

/// Length of an axis handle, pixels.
const ARM_PX: f64 = 90.0;
/// Radius of the ring that turns about the gaze, pixels.
const SCREEN_RING_PX: f64 = 1.5 * ARM_PX;
/// Offset of a plane's square along both axes of the plane, and width of the square, as shares of the arm's length.
const SQUARE: [f64; 2] = [0.3, 0.16];
/// Distance within which the pointer is on a handle, pixels.
const REACH_PX: f64 = 12.0;
/// Radius of the dot in the middle, pixels.
const CENTRE_PX: f64 = 10.0;
/// An arm that points nearly at the eye appears short. It is left out if it appears at less than this share of its
/// length, and a square if it appears at less than this share of its area.
const LEAST_SHOWN: f64 = 0.15;
const RING_PIECES: usize = 64;

/// One handle.
#[derive(Clone, Debug, PartialEq)]
pub struct Handle {
    /// What a drag of it is constrained to.
    pub constraint: Constraint,
    /// What a drag of it does to the object.
    pub operation: Operation,
    /// How it is drawn.
    pub shape: HandleShape,
    /// Larger is farther from the eye: draw those first.
    pub depth: f64,
}

/// How a handle is drawn, pixels of the viewport.
#[derive(Clone, Debug, PartialEq)]
pub enum HandleShape {
    /// A line with a tip (an arrow, or a box for scaling) and its letter.
    Arm {
        /// Where the object's origin appears.
        from_px: DVec2,
        /// The tip.
        to_px: DVec2,
        /// X, Y or Z, beyond the tip.
        letter: char,
    },
    /// A filled square that stands for a plane.
    Square {
        /// Its corners in order.
        corners_px: [DVec2; 4],
    },
    /// A ring that turns the object when dragged. Of a ring about an axis, only the half that faces the eye is shown. A
    /// ring about the gaze is whole.
    Ring {
        /// Points of the line.
        points_px: Vec<DVec2>,
    },
    /// The dot in the middle.
    Centre {
        /// Where its middle is.
        at_px: DVec2,
    },
}

/// The handles of one object.
#[derive(Clone, Debug, PartialEq)]
pub struct Gizmo {
    handles: Vec<Handle>,
}

impl Gizmo {
    /// The handles of an operation on an object; none if its origin is nearer than the near plane.
    pub fn new(operation: Operation, space: Axes, world_from_model: DAffine3, view: &View) -> Self {
        let origin = world_from_model.translation;
        let Some(centre_px) = view.project(origin).filter(|at_px| at_px.is_finite()) else {
            return Self { handles: Vec::new() };
        };
        let placement = Placement {
            axes: axes_of(space, world_from_model, view),
            unit: 1.0 / view.px_per_unit(origin),
            origin,
            centre_px,
            view,
        };
        let mut handles = match operation {
            Operation::Turn => placement.rings(),
            Operation::Move | Operation::Scale => placement.arms(operation),
        };
        handles.sort_by(|a, b| b.depth.total_cmp(&a.depth));
        Self { handles }
    }

    /// All handles, the farthest first.
    pub fn handles(&self) -> &[Handle] {
        &self.handles
    }

    /// The handle under the pointer, if any. The dot goes before squares, squares before arms, arms before rings. Among
    /// handles of one kind, the one closest to the pointer is taken.
    pub fn hit(&self, at_px: DVec2) -> Option<&Handle> {
        let rank = |handle: &Handle| match handle.shape {
            HandleShape::Centre { .. } => 0,
            HandleShape::Square { .. } => 1,
            HandleShape::Arm { .. } => 2,
            HandleShape::Ring { .. } => 3,
        };
        let near = self.handles.iter().filter_map(|handle| Some((handle, handle.shape.gap_px(at_px)?)));
        near.min_by(|(a, near_a), (b, near_b)| rank(a).cmp(&rank(b)).then(near_a.total_cmp(near_b)))
            .map(|(handle, _)| handle)
    }
}

impl HandleShape {
    /// How far a pointer is from the handle; `None` out of reach.
    fn gap_px(&self, at_px: DVec2) -> Option<f64> {
        let gap = match self {
            // The dot is hit only inside its own circle, not within `REACH_PX` of it.
            Self::Centre { at_px: centre } => centre.distance(at_px) + REACH_PX - CENTRE_PX,
            Self::Arm { from_px, to_px, .. } => off_px(at_px, *from_px, *to_px),
            Self::Square { corners_px } => {
                let [a, b, c, d] = *corners_px;
                let side = |from: DVec2, to: DVec2| (to - from).perp_dot(at_px - from);
                let sides = [side(a, b), side(b, c), side(c, d), side(d, a)];
                let inside = sides.iter().all(|&s| s >= 0.0) || sides.iter().all(|&s| s <= 0.0);
                if inside { 0.0 } else { f64::INFINITY }
            }
            Self::Ring { points_px } => {
                points_px.windows(2).map(|pair| off_px(at_px, pair[0], pair[1])).fold(f64::INFINITY, f64::min)
            }
        };
        (gap <= REACH_PX).then_some(gap)
    }
}

/// Distance from a point to a line segment, pixels.
pub(crate) fn off_px(at_px: DVec2, from_px: DVec2, to_px: DVec2) -> f64 {
    let piece = to_px - from_px;
    let t = ((at_px - from_px).dot(piece) / piece.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (from_px + piece * t).distance(at_px)
}

struct Placement<'a> {
    /// The axes of the handles in the world, unit columns.
    axes: DMat3,
    /// Size of a pixel at `origin`, in world units.
    unit: f64,
    origin: DVec3,
    centre_px: DVec2,
    view: &'a View,
}

impl Placement<'_> {
    /// Where the point at `arms` (arm lengths along the axes) appears. There is no perspective, so that handles keep
    /// their shape everywhere in the picture.
    fn px(&self, arms: DVec3) -> DVec2 {
        let [right, up, _] = self.view.axes();
        let at = self.axes * arms * ARM_PX;
        self.centre_px + DVec2::new(at.dot(right), -at.dot(up))
    }

    fn depth(&self, arms: DVec3) -> f64 {
        self.view.depth(self.origin + self.axes * arms * ARM_PX * self.unit)
    }

    fn arms(&self, operation: Operation) -> Vec<Handle> {
        let mut handles = vec![Handle {
            constraint: Constraint::None,
            operation,
            shape: HandleShape::Centre { at_px: self.centre_px },
            depth: self.depth(DVec3::ZERO),
        }];
        for axis in Axis::ALL {
            let tip = axis.unit();
            let shown = self.px(tip).distance(self.centre_px) / ARM_PX;
            if shown >= LEAST_SHOWN {
                let shape =
                    HandleShape::Arm { from_px: self.centre_px, to_px: self.px(tip), letter: axis.letter() };
                handles.push(Handle {
                    constraint: Constraint::Axis(axis),
                    operation,
                    shape,
                    depth: self.depth(tip),
                });
            }
            let [first, second] = axis.others().map(Axis::unit);
            let [from, width] = SQUARE;
            let corner = |a: f64, b: f64| self.px(first * (from + a * width) + second * (from + b * width));
            let corners_px = [corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)];
            let area = (corners_px[1] - corners_px[0]).perp_dot(corners_px[3] - corners_px[0]).abs();
            if area >= LEAST_SHOWN * (width * ARM_PX).powi(2) {
                handles.push(Handle {
                    constraint: Constraint::Plane(axis),
                    operation,
                    shape: HandleShape::Square { corners_px },
                    depth: self.depth((first + second) * from),
                });
            }
        }
        handles
    }

    fn rings(&self) -> Vec<Handle> {
        let around = |first: DVec2, second: DVec2, radius: f64, from: f64, turn: f64| -> Vec<DVec2> {
            (0..=RING_PIECES)
                .map(|piece| {
                    let angle = from + turn * piece as f64 / RING_PIECES as f64;
                    self.centre_px + (first * angle.cos() + second * angle.sin()) * radius
                })
                .collect()
        };
        let ring = |constraint: Constraint, points_px: Vec<DVec2>, depth: f64| Handle {
            constraint,
            operation: Operation::Turn,
            shape: HandleShape::Ring { points_px },
            depth,
        };
        let whole = around(DVec2::X, DVec2::NEG_Y, SCREEN_RING_PX, 0.0, std::f64::consts::TAU);
        let here = self.depth(DVec3::ZERO);
        let mut rings = vec![ring(Constraint::None, whole, here)];
        let [right, up, gaze] = self.view.axes();
        for axis in Axis::ALL {
            let normal = self.axes * axis.unit();
            // A ring shows as an ellipse. The half that faces the eye runs from one end of the ellipse's long axis to
            // the other.
            let side = normal.cross(gaze).try_normalize();
            let (side, toward, turn) = match side {
                Some(side) => (side, side.cross(normal), std::f64::consts::PI),
                None => (right, up, std::f64::consts::TAU),
            };
            let toward = if toward.dot(gaze) > 0.0 { -toward } else { toward };
            let [first, second] = [side, toward].map(|v| DVec2::new(v.dot(right), -v.dot(up)));
            let points_px = around(first, second, ARM_PX, 0.0, turn);
            rings.push(ring(Constraint::Axis(axis), points_px, here - 0.5 * ARM_PX * self.unit));
        }
        rings
    }
}
