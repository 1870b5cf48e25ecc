//! Finds what pulls at each sample of the direction field: its stated direction, the guides, the curvature.

use impasto_core::direction::field::{Constraint, FieldGraph};
use impasto_core::direction::{Symmetry, curvature, tangent_axes};
use impasto_scene::document::{Bend, Direction, GuideMode, Seam};
use rayon::prelude::*;

use super::guides::FIRM;
use super::inputs::{FieldInputs, SamplePoint};
use super::samples::FieldSamples;

/// Where no reference faces the surface, the stated direction is a guess. It pulls so weakly that a direction that is
/// known wins over the guesses round it, as far away as about this share of the body's size.
const GUESS_REACH: f64 = 0.25;

/// How firmly all neighbours of a sample together pull at it.
const NEIGHBOURS: f64 = 8.0;

/// How firmly the stated direction pulls where guides, the curvature or a soft seam decide instead.
const FAINT: f64 = 1e-6;

/// A guide acts on samples up to at least this many spacings away, since it may be narrower than the gap between
/// samples.
const LEAST_REACH_SPACINGS: f64 = 1.2;

impl FieldInputs {
    /// The samples, joined where the field runs on from one to the other.
    pub(super) fn graph(&self, points: &[SamplePoint]) -> FieldGraph {
        let FieldSamples { positions, normals, spacing, .. } = &*self.samples;
        FieldGraph::new(positions, normals, *spacing, |a, b| self.joined(points[a].point, points[b].point))
    }

    /// How firmly each sample is held to its stated direction, 0..=1. It is 0 where the sample's rule is `free`, since
    /// guides or the curvature decide there. It falls to 0 towards a soft seam.
    pub(super) fn anchors(&self, points: &[SamplePoint], free: &[bool]) -> Vec<f64> {
        let reach_of = |rule: usize| match self.rules[rule].seam {
            Seam::Soft(distance) => distance,
            Seam::Hard => 0.0,
        };
        let widest = self.used.iter().map(|&rule| reach_of(usize::from(rule))).fold(0.0, f64::max);
        let plain = |sample: &SamplePoint| if free[sample.point.rule] { 0.0 } else { 1.0 };
        if widest == 0.0 {
            return points.iter().map(plain).collect();
        }
        points
            .par_iter()
            .with_min_len(64)
            .map(|sample| {
                let own = sample.point;
                let to_seam = points
                    .iter()
                    .filter(|other| other.point.rule != own.rule && self.joined(own, other.point))
                    .filter(|other| other.point.normal.dot(own.normal) > 0.0)
                    .map(|other| {
                        let reach = reach_of(own.rule).max(reach_of(other.point.rule));
                        // Half the spacing is taken off, since the border lies between the two samples.
                        let distance = own.position.distance(other.point.position);
                        (distance - 0.5 * self.samples.spacing).max(0.0) / reach.max(f64::MIN_POSITIVE)
                    })
                    .fold(1.0, f64::min);
                plain(sample) * to_seam * to_seam * (3.0 - 2.0 * to_seam)
            })
            .collect()
    }

    /// What pulls at one sample, except the curvature.
    pub(super) fn constraint(
        &self,
        sample: &SamplePoint,
        anchor: f64,
        free: &[bool],
        symmetry: Symmetry,
    ) -> Constraint {
        let spacings = GUESS_REACH * self.extent.1 / self.samples.spacing;
        let guess = NEIGHBOURS / (spacings * spacings).max(1.0);
        let weakest = if free[sample.point.rule] || anchor < 1.0 { FAINT } else { guess };
        // Inside a soft seam the stated direction pulls little, so that the field joins the two sides.
        let mut weight = weakest + FIRM * anchor.powi(12) * sample.base.exact.powi(2);
        let mut target = sample.stated;
        let views = || self.references.views(sample.point, |_| None);
        for guide in self.guides_of(sample.point.rule).filter(|guide| guide.mode == GuideMode::Comb) {
            let least = LEAST_REACH_SPACINGS * self.samples.spacing;
            let Some(found) = guide.guide.influence(sample.point.position, sample.point.normal, least) else {
                continue;
            };
            let tangent = self.combed(guide, found, sample.point, &views());
            let there = symmetry.encode(tangent, tangent_axes(sample.point.normal));
            let pull = FIRM * found.weight;
            target = (target * weight + there * pull).try_normalize().unwrap_or(there);
            weight = weight.max(pull);
        }
        Constraint { target, weight }
    }

    /// Where a rule asks for the curvature, a principal direction replaces every constraint that pulls less than it
    /// does. The more the two principal curvatures differ, the stronger it pulls.
    pub(super) fn with_curvature(
        &self,
        graph: &FieldGraph,
        points: &[SamplePoint],
        mut constraints: Vec<Constraint>,
        symmetry: Symmetry,
    ) -> Vec<Constraint> {
        let FieldSamples { positions, normals, spacing, .. } = &*self.samples;
        let bends = |sample: &SamplePoint| match self.rules[sample.point.rule].direction {
            Direction::Curvature(bend) => Some(bend),
            _ => None,
        };
        constraints.par_iter_mut().enumerate().with_min_len(256).for_each(|(sample, constraint)| {
            let Some(bend) = bends(&points[sample]) else { return };
            let normal = normals[sample].as_dvec3();
            let neighbours = graph.neighbours(sample).map(|other| {
                let offset = (positions[other] - positions[sample]).as_dvec3();
                (offset, normals[other].as_dvec3())
            });
            let Some(found) = curvature::principal(normal, neighbours) else { return };
            let [most, least] = found.curvatures.map(f64::abs);
            let direction = match bend {
                Bend::Max => found.directions[0],
                Bend::Min => found.directions[1],
            };
            // Over one spacing, normals turn by some angle in each principal direction. The pull grows with the
            // difference of the two angles.
            let pull = 30.0 * ((most - least) * spacing).clamp(0.0, 0.5);
            if pull > constraint.weight {
                let target = symmetry.encode(direction, tangent_axes(normal));
                *constraint = Constraint { target, weight: pull };
            }
        });
        constraints
    }
}
