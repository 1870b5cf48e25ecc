//! Limbs: rounded, tapering, bending bodies as distance fields, and a soft blend of two of them.

use glam::DVec3;

/// One place along a limb.
#[derive(Clone, Copy, Debug)]
struct Station {
    /// Middle of the section.
    at: DVec3,
    /// Half the section's size: in the plane of X and Y, and along Z.
    half: [f64; 2],
}

/// A limb: elliptic sections along a smooth curve that lies more or less in a plane Z = constant.
pub struct Limb {
    stations: Vec<Station>,
    low: DVec3,
    high: DVec3,
}

impl Limb {
    /// The limb through at least two sections. Each is
    /// `[x, y, z, half its size in the plane of X and Y, half its size along Z]`.
    pub fn through(sections: &[[f64; 5]]) -> Self {
        const STEPS: usize = 4;
        let last = sections.len() - 1;
        let knot = |index: usize| sections[index.min(last)];
        let mut stations = Vec::new();
        for span in 0..last {
            let around = [knot(span.saturating_sub(1)), knot(span), knot(span + 1), knot(span + 2)];
            let steps = if span + 1 == last { STEPS + 1 } else { STEPS };
            stations.extend((0..steps).map(|step| station(&around, step as f64 / STEPS as f64)));
        }
        let reach = |s: &Station| DVec3::splat(s.half[0].max(s.half[1]));
        let low = stations.iter().fold(DVec3::INFINITY, |low, s| low.min(s.at - reach(s)));
        let high = stations.iter().fold(DVec3::NEG_INFINITY, |high, s| high.max(s.at + reach(s)));
        Self { stations, low, high }
    }

    /// The same limb on the other side of the plane Z = 0.
    pub fn mirrored(&self) -> Self {
        let flip = DVec3::new(1.0, 1.0, -1.0);
        let stations = self.stations.iter().map(|s| Station { at: s.at * flip, ..*s }).collect();
        let (low, high) = (self.low * flip, self.high * flip);
        Self { stations, low: low.min(high), high: low.max(high) }
    }

    /// The same limb, thicker by `by` all round.
    pub fn swollen(&self, by: f64) -> Self {
        let stations =
            self.stations.iter().map(|s| Station { half: s.half.map(|half| half + by), ..*s }).collect();
        Self { stations, low: self.low - by, high: self.high + by }
    }

    /// About how far a point lies from the limb's skin, negative inside. Far away it is only a lower bound.
    pub fn distance(&self, point: DVec3) -> f64 {
        let to_box = (point - point.clamp(self.low, self.high)).length();
        if to_box > 0.2 {
            return to_box;
        }
        self.stations.windows(2).map(|pair| to_cone(point, pair)).fold(f64::INFINITY, f64::min)
    }
}

/// A place of the Catmull-Rom curve between the second and the third of four sections.
fn station([before, start, end, after]: &[[f64; 5]; 4], t: f64) -> Station {
    let value = |v: usize| {
        let (b, s, e, a) = (before[v], start[v], end[v], after[v]);
        s + 0.5 * t * (e - b + t * (2.0 * b - 5.0 * s + 4.0 * e - a + t * (3.0 * s - b - 3.0 * e + a)))
    };
    Station { at: DVec3::new(value(0), value(1), value(2)), half: [value(3), value(4)] }
}

/// About how far a point lies from the piece of a limb between two stations.
fn to_cone(point: DVec3, pair: &[Station]) -> f64 {
    let (from, to) = (&pair[0], &pair[1]);
    let along = to.at - from.at;
    let share = ((point - from.at).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    let away = point - from.at.lerp(to.at, share);
    let half = [0, 1].map(|side| from.half[side] + (to.half[side] - from.half[side]) * share);
    let along = along.normalize();
    let across = (DVec3::Z - along * along.z).normalize();
    let away = DVec3::new(away.dot(along), away.dot(across.cross(along)), away.dot(across));
    let size = DVec3::new(half[0].min(half[1]), half[0], half[1]);
    // The distance from an ellipsoid to first order (Inigo Quilez, "Ellipsoid SDF").
    let scaled = (away / size).length();
    let slope = (away / (size * size)).length();
    if slope > 0.0 { scaled * (scaled - 1.0) / slope } else { -size.min_element() }
}

/// The smaller of two distances, with the crease between the two bodies filled over about `width`.
pub fn blend(a: f64, b: f64, width: f64) -> f64 {
    let near = (1.0 - (a - b).abs() / width).max(0.0);
    a.min(b) - 0.25 * width * near * near
}
