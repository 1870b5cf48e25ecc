//! Which axis of a model's file points up.

use glam::{DMat2, DVec2, DVec3};

use super::{MIRRORED, Samples, ramp};
use crate::document::Up;

/// The lowest part of a model that may carry it, as a share of its height.
const FOOT: f64 = 0.025;

/// A model would topple if the area that it stands on is less than the square of this share of its height.
const LEAST_SUPPORT: f64 = 0.06;

/// A model counts as not stable at all if its middle lies this far outside the area that it stands on, and as partly
/// stable if it lies less far outside. The unit is the square root of the area of the model's hull, seen from above.
const LEAN: f64 = 0.15;

/// An axis is surely up when its score is this much above the next best.
const SURE: f64 = 0.25;

/// How much a body counts as turned on a lathe: from not at all to fully, as the share of its samples whose normals
/// pass through one axis rises from the first value to the second.
const TURNED: [f64; 2] = [0.5, 0.75];

/// A normal passes through the axis if it comes this near to it, in diagonals of the model.
const THROUGH_AXIS: f64 = 0.03;

impl Samples {
    /// The axis that most likely points up, and whether another is almost as likely.
    pub(super) fn upright(&self) -> (Up, bool) {
        // Most files have Y up, then Z. The others need a clear reason.
        let habits =
            [(Up::Y, 0.5), (Up::Z, 0.1), (Up::X, -0.5), (Up::NegX, -0.5), (Up::NegY, -0.7), (Up::NegZ, -0.7)];
        let mirrors = self.mirrors();
        let lathes = [0, 1, 2].map(|axis| self.turned_on_a_lathe(axis));
        let mut scores = habits.map(|(up, habit)| {
            let turn = up.y_up_from_file();
            let in_file = (turn.transpose() * DVec3::Y).abs();
            let axis = [0, 1, 2].into_iter().find(|&axis| in_file[axis] > 0.5).unwrap_or(1);
            let others = [mirrors[(axis + 1) % 3], mirrors[(axis + 2) % 3]];
            // The mirror plane of a living thing or a vehicle is upright.
            let is_mirrored = others[0].max(others[1]) > MIRRORED;
            // Left and right are alike, front and back often are, top and bottom are not.
            let is_unlike = if is_mirrored {
                0.4 * ramp(others[0].min(others[1]) - mirrors[axis], [0.1, 0.4])
            } else {
                0.0
            };
            let mirrored = if is_mirrored { 0.5 } else { 0.0 };
            // Cups, bottles and lamps stand on their axis.
            let lathe = 0.6 * lathes[axis];
            (up, habit + self.turned(turn).stands() + mirrored + is_unlike + lathe)
        });
        scores.sort_by(|a, b| b.1.total_cmp(&a.1));
        (scores[0].0, scores[0].1 - scores[1].1 < SURE)
    }

    /// From 0 to 1, how much the body looks turned on a lathe about a line along this axis. It depends on how many
    /// samples have normals that pass through the line; they must lie on all sides of it. The line is found by least
    /// squares, where a normal has less weight the farther it passes from the line.
    fn turned_on_a_lathe(&self, axis: usize) -> f64 {
        let flat = |vector: &DVec3| DVec2::new(vector[(axis + 1) % 3], vector[(axis + 2) % 3]);
        let [low, high] = self.bounds();
        let diagonal = (high - low).length();
        // Each normal as a line n·x = d, with n the unit vector across it.
        let lines: Vec<(DVec2, f64)> = self
            .points
            .iter()
            .zip(&self.normals)
            .filter(|(_, normal)| flat(normal).length() > 0.3)
            .map(|(point, normal)| {
                let across = flat(normal).normalize().perp();
                (across, across.dot(flat(point)))
            })
            .collect();
        if lines.len() < 60 || diagonal.is_nan() || diagonal <= 0.0 {
            return 0.0;
        }
        let mut center = flat(&((low + high) / 2.0));
        for _ in 0..12 {
            let (mut sums, mut right) = (DMat2::ZERO, DVec2::ZERO);
            for &(across, at) in &lines {
                let miss = (across.dot(center) - at) / (0.02 * diagonal);
                let weight = 1.0 / (1.0 + miss * miss);
                sums += DMat2::from_cols(across * across.x, across * across.y) * weight;
                right += across * (at * weight);
            }
            if sums.determinant().abs() < 1e-9 * (sums.x_axis.x + sums.y_axis.y).powi(2) {
                return 0.0;
            }
            center = sums.inverse() * right;
        }
        let hits =
            lines.iter().filter(|(across, at)| (across.dot(center) - at).abs() < THROUGH_AXIS * diagonal);
        let mut sides = [0.0; 16];
        let mut count = 0.0;
        for (across, _) in hits {
            let turn = across.to_angle() / std::f64::consts::TAU;
            sides[(turn.rem_euclid(1.0) * 16.0) as usize % 16] += 1.0;
            count += 1.0;
        }
        let is_round = sides.iter().filter(|&&side| side > 0.3 * count / 16.0).count() >= 13;
        if is_round { ramp(count / self.points.len() as f64, TURNED) } else { 0.0 }
    }

    /// How well the model stands on its lowest part, as a score from −0.4 to 1.3. Flat feet, a flat bottom, a wide
    /// support and a middle above that support raise the score; standing on a point lowers it.
    fn stands(&self) -> f64 {
        let low = self.points.iter().map(|point| point.y).fold(f64::INFINITY, f64::min);
        let high = self.points.iter().map(|point| point.y).fold(f64::NEG_INFINITY, f64::max);
        let foot = low + FOOT * (high - low) + 0.3 * self.spacing;
        let on_floor = |point: &DVec3| [point.x, point.z];
        let standing = self.points.iter().zip(&self.normals).filter(|(point, _)| point.y <= foot);
        let flat = standing.clone().filter(|(_, normal)| normal.y < -0.9).count() as f64;
        // A thing that was made to stand has a flat underside; a figure that lies on its back does not.
        let bottom = low + 0.01 * (high - low);
        let cut = self.points.iter().zip(&self.face_normals);
        let cut = cut.filter(|(point, normal)| point.y <= bottom && normal.y < -0.985).count() as f64;
        let support = hull(standing.map(|(point, _)| on_floor(point)).collect());
        let shadow = hull(self.points.iter().map(on_floor).collect());
        let middle = self.points.iter().sum::<DVec3>() / self.points.len().max(1) as f64;
        // Samples do not tell exactly where a foot ends, so the score falls gradually.
        let past = outside(&support, on_floor(&middle)) / area(&shadow).sqrt().max(f64::MIN_POSITIVE);
        let stable = 0.3 - 0.3 * ramp(past, [0.0, LEAN]);
        let share = area(&support) / area(&shadow).max(f64::MIN_POSITIVE);
        let [flat, cut] = [flat, cut].map(|count| (20.0 * count / self.points.len().max(1) as f64).min(1.0));
        let finite = |value: f64| if value.is_finite() { value } else { 0.0 };
        let topples = area(&support).sqrt() < LEAST_SUPPORT * (high - low) && flat < 0.1;
        let topples = if topples { 0.4 } else { 0.0 };
        0.15 * flat + 0.45 * cut + 0.4 * finite(share).min(1.0) + stable - topples
    }
}

/// The convex hull, counter-clockwise (Andrew's monotone chain).
fn hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let mut chain: Vec<[f64; 2]> = Vec::new();
    let half = |chain: &mut Vec<[f64; 2]>, from: usize, point: [f64; 2]| {
        while chain.len() >= from + 2 && turn(chain[chain.len() - 2], chain[chain.len() - 1], point) <= 0.0 {
            chain.pop();
        }
        chain.push(point);
    };
    for &point in &points {
        half(&mut chain, 0, point);
    }
    let lower = chain.len() - 1;
    for &point in points.iter().rev().skip(1) {
        half(&mut chain, lower, point);
    }
    chain.pop();
    chain
}

fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn edges(hull: &[[f64; 2]]) -> impl Iterator<Item = ([f64; 2], [f64; 2])> {
    hull.iter().zip(hull.iter().cycle().skip(1)).map(|(&from, &to)| (from, to))
}

fn area(hull: &[[f64; 2]]) -> f64 {
    edges(hull).map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum::<f64>() / 2.0
}

/// How far outside of the hull a point lies; infinite for a hull without area.
fn outside(hull: &[[f64; 2]], point: [f64; 2]) -> f64 {
    if hull.len() < 3 {
        return f64::INFINITY;
    }
    if edges(hull).all(|(a, b)| turn(a, b, point) >= 0.0) {
        return 0.0;
    }
    let point = DVec2::from(point);
    let to_edge = |(a, b): ([f64; 2], [f64; 2])| {
        let (a, along) = (DVec2::from(a), DVec2::from(b) - DVec2::from(a));
        let share = (along.dot(point - a) / along.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        point.distance(a + along * share)
    };
    edges(hull).map(to_edge).fold(f64::INFINITY, f64::min)
}
