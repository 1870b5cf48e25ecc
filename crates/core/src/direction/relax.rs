//! Solves some samples of a finished field again, so that they blend smoothly into the rest.

use std::collections::VecDeque;

use glam::DVec2;

use super::Symmetry;
use super::field::{Constraint, FieldGraph};

/// Where a blended complex number is shorter than this, there is a tear: opposite directions meet and nearly cancel.
/// If it were only normalised, the field would jump there from one direction to the other instead of turning.
const TORN: f64 = 0.5;

/// Greatest weight of the constraint that decides which way round the field turns at a tear, in units of one
/// neighbour's weight.
const LEAD: f64 = 0.5;

/// Conjugate gradients stop after `MOST_STEPS` steps, or when the residual has fallen to `RESIDUAL` of the first one.
const MOST_STEPS: usize = 400;
const RESIDUAL: f64 = 1e-6;

/// How often the turns between neighbours are evened out.
const ROUNDS: usize = 3;

impl FieldGraph {
    /// Solves some samples of the field `solved` again: the free ones, which have an entry in `holds`. Each is pulled
    /// by the constraint in its entry and by its neighbours. All other samples stay as they are.
    ///
    /// Where free samples lie between two fixed parts of the field, the turn from the directions of one part to those
    /// of the other is spread evenly over them. If the two parts have opposite directions, all free samples turn the
    /// same way round. The same inputs give the same bits.
    pub fn relaxed(&self, symmetry: Symmetry, solved: &[DVec2], holds: &[Option<Constraint>]) -> Vec<DVec2> {
        let free = FreeSamples::new(self, symmetry, holds);
        let mut field = solved.to_vec();
        let blend = free.blend(&field, &vec![None; free.inner.len()]);
        let leads = free.leads(&field, &blend);
        let blend = if leads.iter().any(Option::is_some) { free.blend(&field, &leads) } else { blend };
        for (&sample, blended) in free.inner.iter().zip(&blend) {
            field[sample] = blended.try_normalize().unwrap_or(field[sample]);
        }
        for _ in 0..ROUNDS {
            free.even_out(&mut field);
        }
        field
    }
}

/// The free samples of a field and their edges.
struct FreeSamples {
    /// The free samples, as indices into the field; the arrays below are in the same order.
    inner: Vec<usize>,
    /// The constraint that pulls each sample.
    hold: Vec<Constraint>,
    /// The edges of each sample.
    ties: Vec<Vec<Tie>>,
}

struct Tie {
    to: usize,
    /// The index of `to` among the free samples; `None` if it is fixed.
    inner: Option<usize>,
    weight: f64,
    /// ρ of the edge: turns the direction at `to` into the frame of the sample that has the edge.
    turn: DVec2,
}

impl FreeSamples {
    fn new(graph: &FieldGraph, symmetry: Symmetry, holds: &[Option<Constraint>]) -> Self {
        let mut inner_index = vec![None; holds.len()];
        let (mut inner, mut hold) = (Vec::new(), Vec::new());
        for (sample, held) in holds.iter().enumerate() {
            if let Some(held) = held {
                inner_index[sample] = Some(inner.len());
                inner.push(sample);
                hold.push(*held);
            }
        }
        let tie = |(to, weight, transport_rad): (usize, f64, f64)| Tie {
            to,
            inner: inner_index[to],
            weight,
            turn: symmetry.turn(transport_rad),
        };
        let ties = inner.iter().map(|&sample| graph.ties(sample).map(tie).collect()).collect();
        Self { inner, hold, ties }
    }

    /// For each free sample, the complex number that fits its neighbours and constraints best, not yet normalised.
    fn blend(&self, field: &[DVec2], leads: &[Option<Constraint>]) -> Vec<DVec2> {
        let mut firm = Vec::with_capacity(self.inner.len());
        let mut pull = Vec::with_capacity(self.inner.len());
        for (index, hold) in self.hold.iter().enumerate() {
            let to_fixed = self.ties[index].iter().filter(|tie| tie.inner.is_none());
            let outside: DVec2 = to_fixed.map(|tie| tie.turn.rotate(field[tie.to]) * tie.weight).sum();
            let lead = leads[index].unwrap_or(Constraint { target: DVec2::ZERO, weight: 0.0 });
            firm.push(hold.weight + lead.weight);
            pull.push(hold.target * hold.weight + lead.target * lead.weight + outside);
        }
        let start = self.inner.iter().map(|&sample| field[sample]).collect();
        self.solve(start, &firm, &pull, |tie, there| tie.turn.rotate(there))
    }

    /// For each sample of a tear, a constraint that decides which way round the field turns there; `None` for others.
    ///
    /// From one side of a tear to the other, the blended numbers change along a line in the complex plane, for instance
    /// from 1 through nearly 0 to −1. The target is the unit number perpendicular to this line (here i or −i), through
    /// which the field then turns. It is on the same side of the line all over the tear: the side that makes the turn
    /// shorter.
    fn leads(&self, field: &[DVec2], blend: &[DVec2]) -> Vec<Option<Constraint>> {
        let torn = |index: usize| blend[index].length() < TORN;
        let at = |tie: &Tie| tie.inner.map_or(field[tie.to], |inner| blend[inner]);
        let across = |index: usize| -> Option<DVec2> {
            let change = |tie: &Tie| tie.turn.rotate(at(tie)) - blend[index];
            // Squared, so that a change and its opposite count as the same.
            let squares = self.ties[index].iter().map(|tie| change(tie).rotate(change(tie)) * tie.weight);
            let along = DVec2::from_angle(squares.sum::<DVec2>().try_normalize()?.to_angle() * 0.5);
            Some(along.perp())
        };
        let mut found: Vec<Option<DVec2>> = vec![None; blend.len()];
        for first in 0..blend.len() {
            if !torn(first) || found[first].is_some() {
                continue;
            }
            let Some(start) = across(first) else { continue };
            found[first] = Some(start);
            let (mut tear, mut open) = (vec![first], VecDeque::from([(first, start)]));
            while let Some((index, way)) = open.pop_front() {
                for tie in &self.ties[index] {
                    let Some(next) = tie.inner.filter(|&next| torn(next) && found[next].is_none()) else {
                        continue;
                    };
                    let Some(own) = across(next) else { continue };
                    let here = tie.turn.rotate(own);
                    let own = if here.dot(way) < 0.0 { -own } else { own };
                    found[next] = Some(own);
                    tear.push(next);
                    open.push_back((next, own));
                }
            }
            let shorter: f64 = tear.iter().filter_map(|&i| Some(found[i]?.dot(blend[i]))).sum();
            if shorter < 0.0 {
                tear.iter().for_each(|&index| found[index] = found[index].map(|way| -way));
            }
        }
        let lead = |(way, blended): (Option<DVec2>, &DVec2)| {
            way.map(|target| Constraint { target, weight: LEAD * (1.0 - blended.length()).powi(2) })
        };
        found.into_iter().zip(blend).map(lead).collect()
    }

    /// Turns every free sample so that a sum is least: that of the squared angles between neighbours, and between free
    /// samples and the targets of their constraints, each times its weight.
    fn even_out(&self, field: &mut [DVec2]) {
        let angle = |from: DVec2, to: DVec2| DVec2::new(from.x, -from.y).rotate(to).to_angle();
        let mut firm = Vec::with_capacity(self.inner.len());
        let mut pull = Vec::with_capacity(self.inner.len());
        for (index, &sample) in self.inner.iter().enumerate() {
            let (own, hold) = (field[sample], &self.hold[index]);
            let ties = self.ties[index].iter();
            let turns: f64 = ties.map(|tie| angle(own, tie.turn.rotate(field[tie.to])) * tie.weight).sum();
            firm.push(hold.weight);
            pull.push(DVec2::new(turns + angle(own, hold.target) * hold.weight, 0.0));
        }
        let start = vec![DVec2::ZERO; self.inner.len()];
        let turned = self.solve(start, &firm, &pull, |_, there| there);
        for (&sample, turn) in self.inner.iter().zip(turned) {
            field[sample] = DVec2::from_angle(turn.x).rotate(field[sample]).normalize_or(field[sample]);
        }
    }

    /// Solves (firm + Σ w) x − Σ w ρ x' = pull for the number x of each free sample, by conjugate gradients from
    /// `start`. The first Σ runs over all neighbours of the sample, the second over the free ones, whose numbers are
    /// x'. `carried` applies ρ. Terms are added in a fixed order, so the same inputs give the same bits.
    fn solve(
        &self,
        start: Vec<DVec2>,
        firm: &[f64],
        pull: &[DVec2],
        carried: impl Fn(&Tie, DVec2) -> DVec2,
    ) -> Vec<DVec2> {
        let count = start.len();
        let diagonal: Vec<f64> = (0..count)
            .map(|index| firm[index] + self.ties[index].iter().map(|tie| tie.weight).sum::<f64>())
            .collect();
        let apply = |x: &[DVec2]| -> Vec<DVec2> {
            (0..count)
                .map(|index| {
                    let ties = self.ties[index].iter();
                    let near = ties.filter_map(|tie| Some(carried(tie, x[tie.inner?]) * tie.weight));
                    x[index] * diagonal[index] - near.sum::<DVec2>()
                })
                .collect()
        };
        let dot = |a: &[DVec2], b: &[DVec2]| a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum::<f64>();
        let scaled = |residual: &[DVec2]| -> Vec<DVec2> {
            residual.iter().zip(&diagonal).map(|(r, d)| *r / d.max(f64::MIN_POSITIVE)).collect()
        };
        let mut x = start;
        let mut residual: Vec<DVec2> = apply(&x).iter().zip(pull).map(|(ax, b)| *b - *ax).collect();
        let mut z = scaled(&residual);
        let mut direction = z.clone();
        let mut rz = dot(&residual, &z);
        let enough = rz * RESIDUAL * RESIDUAL;
        for _ in 0..MOST_STEPS {
            if rz <= enough || !rz.is_finite() || rz <= 0.0 {
                break;
            }
            let applied = apply(&direction);
            let step = rz / dot(&direction, &applied);
            if !step.is_finite() {
                break;
            }
            for index in 0..count {
                x[index] += direction[index] * step;
                residual[index] -= applied[index] * step;
            }
            z = scaled(&residual);
            let next = dot(&residual, &z);
            let share = next / rz;
            for index in 0..count {
                direction[index] = z[index] + direction[index] * share;
            }
            rz = next;
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    /// Relaxes a plane of 30 by 30 samples, and returns the angles along its middle row, in degrees. At first its left
    /// half is at 0 degrees and its right half at `angle_deg`; 10 columns on either side of the seam are free.
    fn middle_row(symmetry: Symmetry, angle_deg: f64) -> Vec<f64> {
        let positions: Vec<Vec3> =
            (0..900).map(|i| Vec3::new((i % 30) as f32, (i / 30) as f32, 0.0)).collect();
        let graph = FieldGraph::new(&positions, &vec![Vec3::Z; 900], 1.0, |_, _| true);
        let right = |i: usize| i % 30 >= 15;
        let turn = symmetry.turn(angle_deg.to_radians());
        let solved: Vec<DVec2> = (0..900).map(|i| if right(i) { turn } else { DVec2::X }).collect();
        let hold = |i: usize| Constraint { target: solved[i], weight: 1e-6 };
        let holds: Vec<Option<Constraint>> =
            (0..900).map(|i| (5..25).contains(&(i % 30)).then(|| hold(i))).collect();
        let relaxed = graph.relaxed(symmetry, &solved, &holds);
        for i in 0..900 {
            assert!(holds[i].is_some() || relaxed[i] == solved[i], "the fixed sample {i} moved");
        }
        (0..30).map(|i| relaxed[15 * 30 + i].to_angle() / symmetry.power()).map(f64::to_degrees).collect()
    }

    #[test]
    fn a_seam_is_spread_evenly_whatever_its_angle() {
        for symmetry in [Symmetry::Lines, Symmetry::Arrows] {
            let opposite = 180.0 / symmetry.power();
            for angle_deg in [7.0, 30.0, 0.5 * opposite, 0.9 * opposite, opposite] {
                let row = middle_row(symmetry, angle_deg);
                let wrap = |step: f64| (step + opposite).rem_euclid(2.0 * opposite) - opposite;
                let steps: Vec<f64> = row.windows(2).map(|pair| wrap(pair[1] - pair[0])).collect();
                let largest = steps.iter().map(|step| step.abs()).fold(0.0, f64::max);
                let total: f64 = steps.iter().sum();
                assert!((total.abs() - angle_deg).abs() < 1e-3, "{symmetry:?} {angle_deg}: in all {total}");
                // Twenty-one steps share the turn.
                assert!(largest < angle_deg / 21.0 * 1.5, "{symmetry:?} {angle_deg}: {largest}");
            }
        }
    }
}
