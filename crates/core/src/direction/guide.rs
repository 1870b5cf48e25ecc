//! Guides: gestures on a surface that comb the strokes near them.

use glam::DVec3;

/// A polyline on a surface, in model space, and how it combs the strokes near it.
#[derive(Clone, Debug, PartialEq)]
pub struct Guide {
    /// At least two points; no two consecutive ones coincide.
    points: Vec<Corner>,
    /// How far the guide reaches, model units.
    radius: f64,
    /// How far strokes on the guide follow it, 0..=1.
    strength: f64,
    falloff: Falloff,
    /// Centre and radius of a ball round the points.
    ball: (DVec3, f64),
}

/// How the strength of a guide falls off with the distance r. R is the guide's reach: see [`Guide::influence`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Falloff {
    /// (1 − (r/R)²)².
    Smooth,
    /// 1 − r/R.
    Linear,
    /// 1 up to R.
    Flat,
}

/// A point of a guide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuidePoint {
    /// Where, model space.
    pub position: DVec3,
    /// Normal of the surface there; need not be of length 1.
    pub normal: DVec3,
    /// How far strokes are turned from the gesture's line, radians, counter-clockwise in the view that it was drawn in.
    pub turn_rad: f64,
}

/// A point with the tangent of the line there.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Corner {
    position: DVec3,
    normal: DVec3,
    turn_rad: f64,
    /// Unit, along the gesture: the tangent of the arc through this point and its neighbours.
    along: DVec3,
}

/// What a guide asks of the strokes at a point of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Influence {
    /// Strength times falloff, 0..=1; lowered where the surface faces another way than at the guide.
    pub weight: f64,
    /// Unit vector along the gesture. It is not projected onto the surface.
    pub along: DVec3,
    /// How far strokes are turned from `along`, radians, counter-clockwise in the view that the guide was drawn in.
    pub turn_rad: f64,
}

/// A guide has no effect where the cosine between the surface's normal and the guide's is below `NO_EFFECT_COS`, and
/// full effect where the cosine is at least `FULL_EFFECT_COS`.
const NO_EFFECT_COS: f64 = 0.1;
const FULL_EFFECT_COS: f64 = 0.4;

impl Guide {
    /// A guide through points. A point that coincides with the one before is left out; `None` if fewer than two are
    /// left.
    pub fn new(
        points: impl Iterator<Item = GuidePoint>,
        radius: f64,
        strength: f64,
        falloff: Falloff,
    ) -> Option<Self> {
        let mut kept: Vec<Corner> = Vec::new();
        for GuidePoint { position, normal, turn_rad } in points {
            let normal = normal.normalize_or(DVec3::Y);
            if kept.last().is_none_or(|last| (last.position - position).length_squared() > 0.0) {
                kept.push(Corner { position, normal, turn_rad, along: DVec3::ZERO });
            }
        }
        if kept.len() < 2 {
            return None;
        }
        let pieces: Vec<DVec3> = kept.windows(2).map(|pair| pair[1].position - pair[0].position).collect();
        for (index, point) in kept.iter_mut().enumerate() {
            let before = pieces[index.saturating_sub(1)];
            let after = pieces[index.min(pieces.len() - 1)];
            // The shorter piece counts more, because its direction is nearer to the tangent.
            let (unit_before, unit_after) = (before.normalize_or_zero(), after.normalize_or_zero());
            let mean = unit_before * after.length() + unit_after * before.length();
            point.along = mean.try_normalize().unwrap_or(unit_after);
        }
        let low = kept.iter().fold(DVec3::INFINITY, |low, point| low.min(point.position));
        let high = kept.iter().fold(DVec3::NEG_INFINITY, |high, point| high.max(point.position));
        let ball = ((low + high) * 0.5, (high - low).length() * 0.5);
        Some(Self { points: kept, radius, strength, falloff, ball })
    }

    /// The influence on a point with this unit normal, if any. The guide reaches as far as its radius, and at least
    /// as far as `least_reach`.
    pub fn influence(&self, position: DVec3, normal: DVec3, least_reach: f64) -> Option<Influence> {
        let reach = self.radius.max(least_reach);
        if position.distance(self.ball.0) > self.ball.1 + reach {
            return None;
        }
        let mut nearest: Option<(f64, &Corner, &Corner, f64)> = None;
        for pair in self.points.windows(2) {
            let (a, b) = (&pair[0], &pair[1]);
            let piece = b.position - a.position;
            let t = ((position - a.position).dot(piece) / piece.length_squared()).clamp(0.0, 1.0);
            let distance_sq = (a.position + piece * t - position).length_squared();
            if distance_sq < nearest.map_or(reach * reach, |(least, ..)| least) {
                nearest = Some((distance_sq, a, b, t));
            }
        }
        let (distance_sq, a, b, t) = nearest?;
        let (along, own_normal) = (a.along.lerp(b.along, t), a.normal.lerp(b.normal, t));
        let r = distance_sq.sqrt() / reach;
        let falloff = match self.falloff {
            Falloff::Smooth => (1.0 - r * r).powi(2),
            Falloff::Linear => 1.0 - r,
            Falloff::Flat => 1.0,
        };
        let facing = own_normal.normalize_or_zero().dot(normal);
        let facing = (facing - NO_EFFECT_COS) / (FULL_EFFECT_COS - NO_EFFECT_COS);
        let weight = self.strength * falloff * facing.clamp(0.0, 1.0);
        (weight > 0.0).then(|| Influence {
            weight,
            along: along.normalize_or_zero(),
            turn_rad: a.turn_rad + (b.turn_rad - a.turn_rad) * t,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn guide(falloff: Falloff) -> Guide {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]];
        let point =
            |at: [f64; 3]| GuidePoint { position: DVec3::from(at), normal: DVec3::Z, turn_rad: at[0] };
        Guide::new(points.into_iter().map(point), 0.5, 0.8, falloff).unwrap()
    }

    #[test]
    fn strength_falls_off_to_the_radius_and_never_reaches_the_other_side() {
        let at = |falloff: Falloff, y: f64| {
            guide(falloff).influence(DVec3::new(0.5, y, 0.0), DVec3::Z, 0.0).map(|found| found.weight)
        };
        assert!((at(Falloff::Smooth, -0.25).unwrap() - 0.8 * 0.75f64.powi(2)).abs() < 1e-12);
        assert!((at(Falloff::Linear, -0.25).unwrap() - 0.4).abs() < 1e-12);
        assert!((at(Falloff::Flat, -0.49).unwrap() - 0.8).abs() < 1e-12);
        assert_eq!(at(Falloff::Flat, -0.51), None);
        let behind = guide(Falloff::Smooth).influence(DVec3::new(0.5, 0.0, 0.0), DVec3::NEG_Z, 0.0);
        assert_eq!(behind, None);
    }

    #[test]
    fn direction_and_turn_are_interpolated_between_points() {
        let along = |x: f64, y: f64| {
            guide(Falloff::Flat).influence(DVec3::new(x, y, 0.0), DVec3::Z, 0.0).unwrap().along
        };
        assert!((along(0.0, 0.1) - DVec3::X).length() < 1e-9);
        assert!((along(1.0, 1.0) - DVec3::Y).length() < 1e-9);
        assert!((along(1.1, -0.1) - DVec3::new(1.0, 1.0, 0.0).normalize()).length() < 1e-9);
        let turn =
            |x: f64| guide(Falloff::Flat).influence(DVec3::new(x, 0.1, 0.0), DVec3::Z, 0.0).unwrap().turn_rad;
        assert!((turn(0.3) - 0.3).abs() < 1e-12 && turn(-0.2) == 0.0);
        let point = GuidePoint { position: DVec3::ZERO, normal: DVec3::Z, turn_rad: 0.0 };
        assert!(Guide::new([point; 3].into_iter(), 1.0, 1.0, Falloff::Flat).is_none());
    }
}
