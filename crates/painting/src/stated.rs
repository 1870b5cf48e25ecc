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
}

/// Where a point stands.
#[derive(Clone, Copy)]
pub(crate) struct Point {
    pub(crate) position: DVec3,
    pub(crate) normal: DVec3,
    pub(crate) rule: usize,
    pub(crate) part: usize,
}

/// What is stated at a point: a direction on the surface shows at another angle in each view, an angle is the same in all.
enum Line {
    OnSurface(DVec3),
    /// Radians.
    Shown(f64),
}

impl Line {
    fn angle_in(&self, jacobian: [DVec3; 2]) -> f64 {
        match *self {
            Self::OnSurface(tangent) => shown_rad(tangent, jacobian),
            Self::Shown(angle_rad) => angle_rad,
        }
    }

    /// The tangent where no reference sees the point.
    fn unseen(&self, views: &Views) -> DVec3 {
        match *self {
            Self::OnSurface(tangent) => tangent,
            Self::Shown(angle_rad) => {
                let (sin, cos) = angle_rad.sin_cos();
                views.rolled_axes[0] * cos + views.rolled_axes[1] * sin
            }
        }
    }
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
        let line = self.line(point);
        let symmetry = symmetry(&self.rules[point.rule]);
        let is_angle = matches!(line, Line::Shown(_));
        let (mut z, mut whole) = (None, None);
        let mut left = views.seen.iter().flatten().count();
        for seen in views.seen.iter().rev().flatten() {
            left -= 1;
            let here = views.tangent_at(line.angle_in(seen.jacobian), seen.jacobian);
            if left == 0 && seen.share >= 1.0 {
                whole = Some(here);
                break;
            }
            let there = symmetry.encode(here, views.axes);
            let unseen = z.unwrap_or_else(|| symmetry.encode(line.unseen(views), views.axes));
            let mixed: DVec2 = there * seen.share + unseen * (1.0 - seen.share);
            z = Some(mixed.try_normalize().unwrap_or(there));
        }
        Base {
            // Through no number and back where one reference says it all: to the last bit.
            tangent: whole.unwrap_or_else(|| {
                let z = z.unwrap_or_else(|| symmetry.encode(line.unseen(views), views.axes));
                symmetry.decode(z, views.axes)
            }),
            exact: if is_angle { views.share() } else { 1.0 },
        }
    }

    /// The stated direction as an angle in the reference picture of the point's rule, radians.
    pub(crate) fn in_reference_rad(&self, point: Point, views: &Views) -> f64 {
        let angle_rad = self.line(point).angle_in(views.jacobian);
        if angle_rad.is_finite() { angle_rad } else { 0.0 }
    }

    fn line(&self, point: Point) -> Line {
        let Point { position, normal, .. } = point;
        let tangent = match *self.direction(point) {
            Direction::Around(axis) => {
                let (center, size) = self.extent;
                direction::around(DVec3::from(axis), normal, position - center, size)
            }
            Direction::Along(axis) => direction::towards(DVec3::from(axis), normal),
            Direction::Up => direction::towards(DVec3::Y, normal),
            Direction::Toward(target) => direction::towards_point(DVec3::from(target), position, normal),
            Direction::Angle(degrees) | Direction::Crossing(degrees, _) => {
                return Line::Shown(degrees.to_radians());
            }
            Direction::Auto | Direction::Curvature(_) => DVec3::ZERO,
        };
        if tangent == DVec3::ZERO { Line::Shown(0.0) } else { Line::OnSurface(tangent) }
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
