//! The direction field of one body, which gives every particle its direction. It is solved on a few samples, from what
//! regions state and guides comb, and carried from the samples to the particles.

mod constraints;
mod guides;
mod inputs;
mod samples;

use std::sync::{Arc, OnceLock};

use glam::{DVec2, DVec3};
use impasto_core::direction::carry::{SolvedSample, Stencils};
use impasto_core::direction::field::{Constraint, FieldGraph};
use impasto_core::direction::singularities::{self, Singularity};
use impasto_core::direction::{Symmetry, tangent_axes};
use impasto_scene::document::{Direction, GuideMode, Seam};
use rayon::prelude::*;

use crate::references::SurfacePoint;
use crate::regions::BodyGuide;
use crate::stated::StatedDirection;
use inputs::SamplePoint;

pub(crate) use inputs::FieldInputs;
pub(crate) use samples::FieldSamples;

/// The field of a body, solved.
pub(crate) struct BodyField {
    inputs: Arc<FieldInputs>,
    symmetry: Symmetry,
    unguided: Arc<UnguidedField>,
    /// The directions of the samples, as unit complex numbers (`impasto_core::direction`).
    solved: Vec<DVec2>,
    /// The directions of the samples after the guides that smooth have changed them; `None` if no guide smooths.
    relaxed: Option<Vec<DVec2>>,
    /// How firmly each sample is held to its stated direction, 0..=1. Where all samples near a particle have 1, the
    /// particle takes the direction that is stated for it, as far as that is exact.
    anchors: Vec<f64>,
    /// Whether all anchors are 1. If so, a particle whose direction is stated exactly takes that direction.
    anchored: bool,
    /// Computed when first asked for.
    singularities: OnceLock<Vec<Singularity>>,
}

/// The samples near a particle.
#[derive(Clone, Copy)]
pub(crate) struct Near<'a> {
    /// The samples near each of several particles.
    pub(crate) stencils: &'a Stencils,
    /// The index of this particle among those of `stencils`.
    pub(crate) offset: usize,
}

/// The part of a field that does not depend on guides.
struct UnguidedField {
    points: Vec<SamplePoint>,
    /// The symmetry in which the points are encoded.
    symmetry: Symmetry,
    /// Computed when first needed.
    graph: OnceLock<FieldGraph>,
}

impl BodyField {
    /// Solves the field. `None` if none is needed: every direction is stated exactly and not left to combing guides or
    /// the curvature, all seams are hard, and no guide smooths. If only guides have changed since `before` was solved,
    /// what does not depend on guides is taken from it.
    pub(crate) fn solve(inputs: &Arc<FieldInputs>, before: Option<&Self>) -> Option<Self> {
        let only_guides_differ = |before: &&Self| {
            let guides = Arc::clone(&before.inputs.guides);
            FieldInputs { guides, ..FieldInputs::clone(inputs) } == *before.inputs
        };
        let unguided = before.filter(only_guides_differ).map_or_else(
            || {
                let symmetry = inputs.symmetry();
                let points = inputs.points(symmetry);
                Arc::new(UnguidedField { points, symmetry, graph: OnceLock::new() })
            },
            |before| Arc::clone(&before.unguided),
        );
        let points = &unguided.points;
        let combs = |guide: &&BodyGuide| guide.mode == GuideMode::Comb;
        let guided =
            |rule: usize| inputs.guides.iter().filter(combs).any(|guide| usize::from(guide.rule) == rule);
        let free: Vec<bool> = (0..inputs.rules.len())
            .map(|rule| match inputs.rules[rule].direction {
                Direction::Auto => guided(rule),
                Direction::Curvature(_) => true,
                _ => false,
            })
            .collect();
        let settled = |sample: &SamplePoint| sample.base.exact >= 1.0 && !free[sample.point.rule];
        let soft = inputs.used.iter().any(|&rule| inputs.rules[usize::from(rule)].seam != Seam::Hard);
        if !soft && !inputs.smooths() && points.iter().all(settled) {
            return None;
        }
        let graph = unguided.graph.get_or_init(|| inputs.graph(points));
        let symmetry = unguided.symmetry;
        let anchors = inputs.anchors(points, &free);
        let constraints: Vec<Constraint> = (0..points.len())
            .into_par_iter()
            .with_min_len(256)
            .map(|sample| inputs.constraint(&points[sample], anchors[sample], &free, symmetry))
            .collect();
        let constraints = inputs.with_curvature(graph, points, constraints, symmetry);
        let solved = graph.solve(symmetry, &constraints);
        let relaxed = inputs
            .smooths()
            .then(|| graph.relaxed(symmetry, &solved, &inputs.holds(points, &solved, symmetry)));
        let singularities = OnceLock::new();
        let anchored = anchors.iter().all(|&anchor| anchor >= 1.0);
        let inputs = Arc::clone(inputs);
        Some(Self { inputs, symmetry, unguided, solved, relaxed, anchors, anchored, singularities })
    }

    /// The singular points of the field, at which strokes have no direction.
    pub(crate) fn singularities(&self) -> &[Singularity] {
        let FieldSamples { positions, normals, .. } = &*self.inputs.samples;
        let shown = self.relaxed.as_deref().unwrap_or(&self.solved);
        self.singularities.get_or_init(|| {
            self.unguided.graph.get().map_or_else(Vec::new, |graph| {
                singularities::find(graph, positions, normals, shown, self.symmetry)
            })
        })
    }

    /// The direction of a particle: the field's direction mixed with the stated one, `base`. The more firmly the
    /// samples near it are held to their stated directions, and the more exact `base` is, the more `base` counts.
    pub(crate) fn direction(&self, near: Near<'_>, point: SurfacePoint, base: &StatedDirection) -> DVec3 {
        if self.anchored && base.exact >= 1.0 {
            return base.tangent;
        }
        let axes = tangent_axes(point.normal);
        let stated = self.symmetry.encode(base.tangent, axes);
        let Some((found, anchor)) = self.carried(&self.solved, near, point, stated) else {
            return base.tangent;
        };
        let hold = anchor * base.exact;
        if hold >= 1.0 - 1e-9 {
            return base.tangent;
        }
        let mixed = (found * (1.0 - hold) + stated * hold).try_normalize().unwrap_or(stated);
        self.tangent(mixed, axes, base)
    }

    /// The smoothed field's direction at a particle; `None` if no guide smooths, or no sample is near.
    pub(crate) fn relaxed(
        &self,
        near: Near<'_>,
        point: SurfacePoint,
        base: &StatedDirection,
    ) -> Option<DVec3> {
        let axes = tangent_axes(point.normal);
        let stated = self.symmetry.encode(base.tangent, axes);
        let (found, _) = self.carried(self.relaxed.as_ref()?, near, point, stated)?;
        Some(self.tangent(found, axes, base))
    }

    /// The tangent that a unit complex number stands for. A line has two opposite tangents: this is the one nearer to
    /// the stated direction.
    fn tangent(&self, number: DVec2, axes: [DVec3; 2], base: &StatedDirection) -> DVec3 {
        let tangent = self.symmetry.decode(number, axes);
        let is_opposite = self.symmetry == Symmetry::Lines && tangent.dot(base.tangent) < 0.0;
        if is_opposite { -tangent } else { tangent }
    }

    /// The field's direction at a particle, and how firmly the stated direction holds there (its *anchor*). Both are
    /// carried from the samples round it.
    fn carried(
        &self,
        solved: &[DVec2],
        near: Near<'_>,
        point: SurfacePoint,
        stated: DVec2,
    ) -> Option<(DVec2, f64)> {
        let inputs = &self.inputs;
        let sample = |index: usize| {
            let sample = &self.unguided.points[index];
            inputs.joined(sample.point, point).then(|| SolvedSample {
                position: inputs.samples.positions[index],
                normal: sample.point.normal,
                solved: solved[index],
                stated: sample.stated,
                anchor: self.anchors[index],
            })
        };
        let position = point.position.as_vec3();
        near.stencils.carry(near.offset, position, point.normal, stated, self.symmetry, sample)
    }
}
