//! The direction that a region states at a point, before guides and the field change it.

use glam::{DVec2, DVec3};
use impasto_core::direction::{self, Symmetry};
use impasto_scene::document::{Direction, Sense};

use crate::references::{SurfacePoint, Views, shown_rad};
use crate::regions::RegionRule;

/// The directions that the rules state on one body.
pub(crate) struct DirectionRules<'a> {
    pub(crate) rules: &'a [RegionRule],
    /// For each part, its direction where the rule states none outright (`Auto` or `Curvature`).
    pub(crate) automatic: Vec<Direction>,
    /// Centre of the body's bounds and length of their diagonal, model space.
    pub(crate) extent: (DVec3, f64),
}

/// The stated direction at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StatedDirection {
    /// Unit, in the tangent plane.
    pub(crate) tangent: DVec3,
    /// 1 where the direction is certain. Less for an angle in the picture where no reference faces the point well:
    /// there the direction is partly guessed.
    pub(crate) exact: f64,
}

/// What is stated at a point.
enum Line {
    /// A direction on the surface, which shows at a different angle in each view.
    OnSurface(DVec3),
    /// An angle in the picture, radians, the same in every view.
    Shown(f64),
}

impl Line {
    /// The line's angle in a view, radians.
    fn angle_in(&self, jacobian: [DVec3; 2]) -> f64 {
        match *self {
            Self::OnSurface(tangent) => shown_rad(tangent, jacobian),
            Self::Shown(angle_rad) => angle_rad,
        }
    }

    /// The tangent on surfaces that no reference sees.
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

/// Which directions of a rule count as equal.
pub(crate) fn symmetry(rule: &RegionRule) -> Symmetry {
    match rule.sense {
        Sense::Lines => Symmetry::Lines,
        Sense::Arrows => Symmetry::Arrows,
    }
}

impl DirectionRules<'_> {
    /// The direction that the rule of a point states; the part's automatic one where the rule leaves it open.
    pub(crate) fn direction(&self, point: SurfacePoint) -> &Direction {
        let stated = &self.rules[point.rule].direction;
        match stated {
            // The field finds the curvature; where there is no field, the automatic direction stands in.
            Direction::Auto | Direction::Curvature(_) => &self.automatic[point.part],
            _ => stated,
        }
    }

    /// The stated direction at a point, from the references in `views` that face it.
    pub(crate) fn base(&self, point: SurfacePoint, views: &Views) -> StatedDirection {
        let line = self.line(point);
        let symmetry = symmetry(&self.rules[point.rule]);
        let is_angle = matches!(line, Line::Shown(_));
        let (mut z, mut whole) = (None, None);
        let mut left = views.facing.iter().flatten().count();
        for reference in views.facing.iter().rev().flatten() {
            left -= 1;
            let here = views.tangent_at(line.angle_in(reference.jacobian), reference.jacobian);
            if left == 0 && reference.share >= 1.0 {
                whole = Some(here);
                break;
            }
            let there = symmetry.encode(here, views.axes);
            let unseen = z.unwrap_or_else(|| symmetry.encode(line.unseen(views), views.axes));
            let mixed: DVec2 = there * reference.share + unseen * (1.0 - reference.share);
            z = Some(mixed.try_normalize().unwrap_or(there));
        }
        StatedDirection {
            // Where a single reference states the whole direction, its tangent is taken unmixed, exact to the last bit.
            tangent: whole.unwrap_or_else(|| {
                let z = z.unwrap_or_else(|| symmetry.encode(line.unseen(views), views.axes));
                symmetry.decode(z, views.axes)
            }),
            exact: if is_angle { views.share() } else { 1.0 },
        }
    }

    /// The stated direction as an angle in the reference picture of the point's rule, radians.
    pub(crate) fn in_reference_rad(&self, point: SurfacePoint, views: &Views) -> f64 {
        let angle_rad = self.line(point).angle_in(views.jacobian);
        if angle_rad.is_finite() { angle_rad } else { 0.0 }
    }

    fn line(&self, point: SurfacePoint) -> Line {
        let SurfacePoint { position, normal, .. } = point;
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

    /// Whether the surface normal at a point is within 26 degrees of the axis that the stated direction refers to. A
    /// stated angle has no such axis, so the world's up is taken: on surfaces that no reference sees, directions are
    /// guessed from it.
    pub(crate) fn is_pole(&self, point: SurfacePoint, up_in_model: DVec3) -> bool {
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
