//! What the direction field of a body depends on, and the field's samples with the directions that are stated there.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use impasto_core::direction::{Symmetry, tangent_axes};
use impasto_core::sampling::{PackedParticle, Particle};
use impasto_scene::document::{Direction, Seam};
use rayon::prelude::*;

use super::samples::FieldSamples;
use crate::amounts::BodyAmounts;
use crate::parts::BodyParts;
use crate::references::{BodyReferences, SurfacePoint};
use crate::regions::{BodyGuide, BodyRegions, RegionRule};
use crate::stated::{DirectionRules, StatedDirection, symmetry};

/// All that the field of a body depends on.
#[derive(Clone)]
pub(crate) struct FieldInputs {
    pub(crate) samples: Arc<FieldSamples>,
    pub(crate) references: Arc<BodyReferences>,
    pub(crate) regions: Arc<BodyRegions>,
    /// The rules that may show on the body.
    pub(crate) used: Arc<Vec<u16>>,
    pub(crate) guides: Arc<Vec<BodyGuide>>,
    /// The painted amounts; only flatness matters here.
    pub(crate) amounts: Arc<BodyAmounts>,
    /// All rules. Only their directions, senses, seams and flatness matter here.
    pub(crate) rules: Arc<Vec<RegionRule>>,
    pub(crate) parts: Arc<BodyParts>,
    /// Centre and length of the diagonal of the body's bounds, model space.
    pub(crate) extent: (DVec3, f64),
    pub(crate) orthographic: bool,
}

/// A sample of the field, with the direction that is stated there.
#[derive(Clone, Copy)]
pub(super) struct SamplePoint {
    pub(super) point: SurfacePoint,
    pub(super) base: StatedDirection,
    /// The stated direction, as a unit complex number in the body's symmetry (`impasto_core::direction`).
    pub(super) stated: DVec2,
}

impl PartialEq for FieldInputs {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.samples, &other.samples)
            && Arc::ptr_eq(&self.parts, &other.parts)
            && self.same_rules(other)
            && self.references == other.references
            && self.regions == other.regions
            && self.guides == other.guides
            && self.amounts.same_flatness(&other.amounts)
            && self.extent == other.extent
            && self.orthographic == other.orthographic
    }
}

impl FieldInputs {
    /// Whether a rule or a guide of the body may need a field; if none does, no field samples are made.
    pub(crate) fn may_be_needed(used: &[u16], rules: &[RegionRule], guides: &[BodyGuide]) -> bool {
        let needs = |rule: &RegionRule| {
            matches!(rule.direction, Direction::Angle(_) | Direction::Crossing(..) | Direction::Curvature(_))
                || rule.seam != Seam::Hard
        };
        !guides.is_empty() || used.iter().any(|&rule| needs(&rules[usize::from(rule)]))
    }

    /// Whether the body's rules are the same in everything that matters to the field.
    fn same_rules(&self, other: &Self) -> bool {
        self.used == other.used
            && self.rules.len() == other.rules.len()
            && self.used.iter().all(|&rule| {
                let (a, b) = (&self.rules[usize::from(rule)], &other.rules[usize::from(rule)]);
                (&a.direction, a.seam, a.sense, a.strokes.flatness)
                    == (&b.direction, b.seam, b.sense, b.strokes.flatness)
            })
    }

    /// The samples, each with the direction that is stated there.
    pub(super) fn points(&self, symmetry: Symmetry) -> Vec<SamplePoint> {
        let stated = DirectionRules {
            rules: &self.rules,
            automatic: self.parts.directions(self.references.own()),
            extent: self.extent,
        };
        let samples = self.samples.particles.par_iter().with_min_len(256);
        samples.map(|sample| self.point(sample, &stated, symmetry)).collect()
    }

    /// The symmetry of the whole body, in which all its samples are encoded: arrows only if all of them have arrows.
    pub(super) fn symmetry(&self) -> Symmetry {
        let samples = &self.samples.particles;
        let has_arrows = |sample: &Particle| {
            symmetry(&self.rules[usize::from(self.regions.of(sample))]) == Symmetry::Arrows
        };
        if !samples.is_empty() && samples.par_iter().all(has_arrows) {
            Symmetry::Arrows
        } else {
            Symmetry::Lines
        }
    }

    fn point(&self, sample: &Particle, stated: &DirectionRules<'_>, symmetry: Symmetry) -> SamplePoint {
        let rule = usize::from(self.regions.of(sample));
        let part = self.parts.of_triangle[sample.triangle as usize] as usize;
        let (position, normal) = (sample.position.as_dvec3(), sample.normal.as_dvec3());
        let point =
            SurfacePoint { place: PackedParticle::of(sample), position, height: 0.0, normal, rule, part };
        let views = self.references.views(point, |_| None);
        let base = stated.base(point, &views);
        let stated = symmetry.encode(base.tangent, tangent_axes(normal));
        SamplePoint { point, base, stated }
    }

    /// Whether the field runs on from one point to another.
    pub(super) fn joined(&self, a: SurfacePoint, b: SurfacePoint) -> bool {
        if a.part != b.part {
            return false;
        }
        // The upper one of two regions states the seam. The implicit region, whose rule is the last, lies under all
        // others.
        let height = |rule: usize| if rule + 1 == self.rules.len() { 0 } else { rule + 1 };
        let upper = if height(a.rule) > height(b.rule) { a.rule } else { b.rule };
        a.rule == b.rule || self.rules[upper].seam != Seam::Hard
    }
}
