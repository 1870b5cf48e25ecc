//! The direction that a region states at a point, before any guide or field has a say.

use glam::{DVec2, DVec3};
use impasto_core::direction::{self, Symmetry};
use impasto_scene::document::{Direction, Sense};

use crate::references::{Views, shown_rad};
use crate::regions::RegionRule;

/// What rules and parts say about directions on one body.
pub(crate) struct Stated<'a> {
    pub(crate) rules: &'a [RegionRule],
    /// Of each part, where its rule says `Auto`.
    pub(crate) automatic: Vec<Direction>,
    /// Centre and length of the diagonal of the body's bounds, model space.
    pub(crate) extent: (DVec3, f64),
}

/// A stated direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Base {
    /// Unit, in the tangent plane.
    pub(crate) tangent: DVec3,
    /// 1 where it is stated outright; less where no reference faces the point and it is a guess.
    pub(crate) exact: f64,
    /// The same as an angle in the reference picture, radians.
    pub(crate) in_reference_rad: f64,
}

/// Where a point stands.
#[derive(Clone, Copy)]
pub(crate) struct Point {
    pub(crate) position: DVec3,
    pub(crate) normal: DVec3,
    pub(crate) rule: usize,
    pub(crate) part: usize,
}

/// How directions of a rule repeat.
pub(crate) fn symmetry(rule: &RegionRule) -> Symmetry {
    match rule.sense {
        Sense::Lines => Symmetry::Lines,
        Sense::Arrows => Symmetry::Arrows,
    }
}

impl Stated<'_> {
    /// The direction of a point; of two crossing families, the first.
    pub(crate) fn direction(&self, point: Point) -> &Direction {
        let stated = &self.rules[point.rule].direction;
        match stated {
            // The bend is the field's to find; what is automatic stands in for it where there is none.
            Direction::Auto | Direction::Curvature(_) => &self.automatic[point.part],
            _ => stated,
        }
    }

    pub(crate) fn base(&self, point: Point, views: &Views) -> Base {
        let Point { position, normal, .. } = point;
        let tangent = match *self.direction(point) {
            Direction::Around(axis) => {
                let (center, size) = self.extent;
                direction::around(DVec3::from(axis), normal, position - center, size)
            }
            Direction::Along(axis) => direction::towards(DVec3::from(axis), normal),
            Direction::Up => direction::towards(DVec3::Y, normal),
            Direction::Toward(target) => direction::toward(DVec3::from(target), position, normal),
            Direction::Auto | Direction::Angle(_) | Direction::Crossing(..) | Direction::Curvature(_) => {
                DVec3::ZERO
            }
        };
        let stated_rad = match *self.direction(point) {
            Direction::Angle(degrees) | Direction::Crossing(degrees, _) => degrees.to_radians(),
            _ => 0.0,
        };
        let is_angle = tangent == DVec3::ZERO;
        // A direction on the surface shows at another angle in each view; a stated angle is the same in all.
        let angle_in =
            |jacobian: [DVec3; 2]| if is_angle { stated_rad } else { shown_rad(tangent, jacobian) };
        let symmetry = symmetry(&self.rules[point.rule]);
        let unseen = if is_angle {
            let (sin, cos) = stated_rad.sin_cos();
            views.rolled_axes[0] * cos + views.rolled_axes[1] * sin
        } else {
            tangent
        };
        let mut z = symmetry.encode(unseen, views.axes);
        let mut whole = None;
        for seen in views.seen.iter().rev().flatten() {
            let here = views.tangent_at(angle_in(seen.jacobian), seen.jacobian);
            whole = (seen.share >= 1.0).then_some(here);
            let there = symmetry.encode(here, views.axes);
            let mixed: DVec2 = there * seen.share + z * (1.0 - seen.share);
            z = mixed.try_normalize().unwrap_or(there);
        }
        let in_reference_rad = angle_in(views.jacobian);
        Base {
            // Through no number and back where one reference says it all: to the last bit.
            tangent: whole.unwrap_or_else(|| symmetry.decode(z, views.axes)),
            exact: if is_angle { views.share() } else { 1.0 },
            in_reference_rad: if in_reference_rad.is_finite() { in_reference_rad } else { 0.0 },
        }
    }

    /// Whether the surface faces along the axis that the direction of a point is stated by, within 26 degrees; for a stated
    /// angle, along the world's up, which the guess about unseen surfaces goes by.
    pub(crate) fn is_pole(&self, point: Point, up_in_model: DVec3) -> bool {
        const COSINE: f64 = 0.9;
        let axis = match *self.direction(point) {
            Direction::Around(axis) | Direction::Along(axis) => DVec3::from(axis),
            Direction::Up => DVec3::Y,
            Direction::Toward(target) => DVec3::from(target) - point.position,
            Direction::Auto | Direction::Angle(_) | Direction::Crossing(..) | Direction::Curvature(_) => {
                up_in_model
            }
        };
        axis.normalize_or_zero().dot(point.normal).abs() > COSINE
    }
}
