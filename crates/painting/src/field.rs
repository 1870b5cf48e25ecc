//! The direction field of one body: what regions state and guides comb, joined over few samples and carried to every
//! particle.

mod samples;

use std::sync::{Arc, OnceLock};

use glam::{DAffine3, DMat4, DVec2, DVec3};
use impasto_core::ScreenMap;
use impasto_core::angle::wrap_pi;
use impasto_core::direction::carry::{SolvedSample, Stencils};
use impasto_core::direction::curvature;
use impasto_core::direction::field::{Constraint, FieldGraph};
use impasto_core::direction::guide::Influence;
use impasto_core::direction::singularities::{self, Singularity};
use impasto_core::direction::{Symmetry, tangent_axes};
use impasto_core::sampling::Particle;
use impasto_core::screen_map::{PixelLens, facing};
use impasto_scene::document::{Direction, GuideMode, Seam};
use rayon::prelude::*;

use crate::parts::BodyParts;
use crate::references::{BodyReferences, Views, shown_rad};
use crate::regions::{BodyGuide, BodyRegions, RegionRule};
use crate::smooth;
use crate::stated::{Base, Point, Stated, symmetry};

pub(crate) use samples::FieldSamples;

/// Firmness, in units of one neighbour, of what is stated outright and of a guide's own line.
pub(crate) const FIRM: f64 = 300.0;

/// Firmness of guesses about what no reference faces: they hold a quarter of the body's size away from what is known.
const GUESS_REACH: f64 = 0.25;
const NEIGHBOURS: f64 = 8.0;

/// Firmness of the automatic direction where guides rule.
const FAINT: f64 = 1e-6;

/// A guide that is narrower than this many spacings of the samples still reaches that far for them.
const LEAST_REACH_SPACINGS: f64 = 1.2;

/// All that the field of a body depends on.
#[derive(Clone)]
pub(crate) struct FieldInputs {
    pub(crate) samples: Arc<FieldSamples>,
    pub(crate) references: Arc<BodyReferences>,
    pub(crate) regions: Arc<BodyRegions>,
    /// The rules that may show on the body.
    pub(crate) used: Arc<Vec<u16>>,
    pub(crate) guides: Arc<Vec<BodyGuide>>,
    /// Directions and seams of all rules.
    pub(crate) rules: Arc<Vec<RegionRule>>,
    pub(crate) parts: Arc<BodyParts>,
    pub(crate) extent: (DVec3, f64),
    /// Whether rays are parallel.
    pub(crate) orthographic: bool,
}

/// The field of a body, solved.
pub(crate) struct BodyField {
    inputs: FieldInputs,
    symmetry: Symmetry,
    ground: Arc<FieldGround>,
    solved: Vec<DVec2>,
    /// The same after the guides that smooth; none where there is none.
    relaxed: Option<Vec<DVec2>>,
    anchors: Vec<f64>,
    /// Whether what is stated holds wholly at every sample, so that no point that is stated outright need ask.
    anchored: bool,
    /// Found when they are first asked for.
    singularities: OnceLock<Vec<Singularity>>,
}

/// What of a field does not depend on guides.
struct FieldGround {
    points: Vec<SamplePoint>,
    /// Made where a field is needed.
    graph: OnceLock<FieldGraph>,
}

#[derive(Clone, Copy)]
pub(crate) struct SamplePoint {
    pub(crate) point: Point,
    base: Base,
    /// The stated direction in the axes of the normal.
    stated: DVec2,
}

impl PartialEq for FieldInputs {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.samples, &other.samples)
            && Arc::ptr_eq(&self.parts, &other.parts)
            && self.same_rules(other)
            && self.references == other.references
            && self.regions == other.regions
            && self.guides == other.guides
            && self.extent == other.extent
            && self.orthographic == other.orthographic
    }
}

impl FieldInputs {
    /// Whether any rule of the body may need a field; where not, nothing is sampled.
    pub(crate) fn may_be_needed(used: &[u16], rules: &[RegionRule], guides: &[BodyGuide]) -> bool {
        let needs = |rule: &RegionRule| {
            matches!(rule.direction, Direction::Angle(_) | Direction::Crossing(..) | Direction::Curvature(_))
                || rule.seam != Seam::Hard
        };
        !guides.is_empty() || used.iter().any(|&rule| needs(&rules[usize::from(rule)]))
    }

    /// Whether directions and seams of the body's rules are the same.
    fn same_rules(&self, other: &Self) -> bool {
        self.used == other.used
            && self.rules.len() == other.rules.len()
            && self.used.iter().all(|&rule| {
                let (a, b) = (&self.rules[usize::from(rule)], &other.rules[usize::from(rule)]);
                (&a.direction, a.seam, a.sense, a.strokes.flatness)
                    == (&b.direction, b.seam, b.sense, b.strokes.flatness)
            })
    }

    /// The field, or none where every direction is stated outright. What does not depend on guides comes from the field `before`,
    /// if all else is the same.
    pub(crate) fn solve(&self, before: Option<&BodyField>) -> Option<BodyField> {
        let same = |before: &&BodyField| {
            Self { guides: Arc::clone(&before.inputs.guides), ..self.clone() } == before.inputs
        };
        let ground = before.filter(same).map_or_else(
            || Arc::new(FieldGround { points: self.points(), graph: OnceLock::new() }),
            |before| Arc::clone(&before.ground),
        );
        let points = &ground.points;
        let combs = |guide: &&BodyGuide| guide.mode == GuideMode::Comb;
        let guided =
            |rule: usize| self.guides.iter().filter(combs).any(|guide| usize::from(guide.rule) == rule);
        let free: Vec<bool> = (0..self.rules.len())
            .map(|rule| match self.rules[rule].direction {
                Direction::Auto => guided(rule),
                Direction::Curvature(_) => true,
                _ => false,
            })
            .collect();
        let settled = |sample: &SamplePoint| sample.base.exact >= 1.0 && !free[sample.point.rule];
        let soft = self.used.iter().any(|&rule| self.rules[usize::from(rule)].seam != Seam::Hard);
        if !soft && !self.smooths() && points.iter().all(settled) {
            return None;
        }
        let graph = ground.graph.get_or_init(|| self.graph(points));
        let anchors = self.anchors(points, &free);
        let constraints: Vec<Constraint> = (0..points.len())
            .into_par_iter()
            .with_min_len(256)
            .map(|sample| self.constraint(&points[sample], anchors[sample], &free))
            .collect();
        let constraints = self.with_curvature(graph, points, constraints);
        // A body has one symmetry: arrows only where all of it has.
        let symmetry = self.symmetry(points);
        let solved = graph.solve(symmetry, &constraints);
        let relaxed =
            self.smooths().then(|| graph.relaxed(symmetry, &solved, &self.holds(points, &solved, symmetry)));
        let singularities = OnceLock::new();
        let anchored = anchors.iter().all(|&anchor| anchor >= 1.0);
        let inputs = self.clone();
        Some(BodyField { inputs, symmetry, ground, solved, relaxed, anchors, anchored, singularities })
    }

    fn points(&self) -> Vec<SamplePoint> {
        let stated = Stated {
            rules: &self.rules,
            automatic: self.parts.directions(self.references.own()),
            extent: self.extent,
        };
        let samples = self.samples.particles.par_iter().with_min_len(256);
        samples.map(|sample| self.point(sample, &stated)).collect()
    }

    fn symmetry(&self, points: &[SamplePoint]) -> Symmetry {
        let of = |sample: &SamplePoint| symmetry(&self.rules[sample.point.rule]);
        if !points.is_empty() && points.iter().all(|sample| of(sample) == Symmetry::Arrows) {
            Symmetry::Arrows
        } else {
            Symmetry::Lines
        }
    }

    fn point(&self, sample: &Particle, stated: &Stated<'_>) -> SamplePoint {
        let rule = usize::from(self.regions.of(sample));
        let part = self.parts.of_triangle[sample.triangle as usize] as usize;
        let (position, normal) = (sample.position.as_dvec3(), sample.normal.as_dvec3());
        let point = Point { position, normal, rule, part };
        let views = self.references.views((position, normal), rule, |_| None);
        let base = stated.base(point, &views);
        let stated = symmetry(&self.rules[rule]).encode(base.tangent, tangent_axes(normal));
        SamplePoint { point, base, stated }
    }

    fn joined(&self, a: Point, b: Point) -> bool {
        if a.part != b.part {
            return false;
        }
        // The region painted over the other says how they meet; the implicit one lies under all.
        let height = |rule: usize| if rule + 1 == self.rules.len() { 0 } else { rule + 1 };
        let upper = if height(a.rule) > height(b.rule) { a.rule } else { b.rule };
        a.rule == b.rule || self.rules[upper].seam != Seam::Hard
    }

    fn graph(&self, points: &[SamplePoint]) -> FieldGraph {
        let FieldSamples { positions, normals, spacing, .. } = &*self.samples;
        FieldGraph::new(positions, normals, *spacing, |a, b| self.joined(points[a].point, points[b].point))
    }

    /// How far the stated direction of each sample holds: not at all where guides or bends rule, less towards a soft seam.
    fn anchors(&self, points: &[SamplePoint], free: &[bool]) -> Vec<f64> {
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
                        // Half the spacing: the border lies between the two samples.
                        let distance = own.position.distance(other.point.position);
                        (distance - 0.5 * self.samples.spacing).max(0.0) / reach.max(f64::MIN_POSITIVE)
                    })
                    .fold(1.0, f64::min);
                plain(sample) * to_seam * to_seam * (3.0 - 2.0 * to_seam)
            })
            .collect()
    }

    fn constraint(&self, sample: &SamplePoint, anchor: f64, free: &[bool]) -> Constraint {
        let spacings = GUESS_REACH * self.extent.1 / self.samples.spacing;
        let guess = NEIGHBOURS / (spacings * spacings).max(1.0);
        let faint = if free[sample.point.rule] || anchor < 1.0 { FAINT } else { guess };
        // Inside a soft seam the two sides meet by themselves; what is stated there pulls little.
        let mut weight = faint + FIRM * anchor.powi(12) * sample.base.exact.powi(2);
        let mut target = sample.stated;
        let rule = &self.rules[sample.point.rule];
        let symmetry = symmetry(rule);
        let views = || {
            let at = (sample.point.position, sample.point.normal);
            self.references.views(at, sample.point.rule, |_| None)
        };
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

    /// Where the bend is asked for, it pulls as far as one direction bends more than the other.
    fn with_curvature(
        &self,
        graph: &FieldGraph,
        points: &[SamplePoint],
        mut constraints: Vec<Constraint>,
    ) -> Vec<Constraint> {
        let FieldSamples { positions, normals, spacing, .. } = &*self.samples;
        let bends = |sample: &SamplePoint| match self.rules[sample.point.rule].direction {
            Direction::Curvature(bend) => Some(bend),
            _ => None,
        };
        constraints.par_iter_mut().enumerate().with_min_len(256).for_each(|(sample, constraint)| {
            let Some(bend) = bends(&points[sample]) else { return };
            let normal = normals[sample].as_dvec3();
            let near = graph.neighbours(sample).map(|other| {
                let offset = (positions[other] - positions[sample]).as_dvec3();
                (offset, normals[other].as_dvec3())
            });
            let Some(found) = curvature::principal(normal, near) else { return };
            let [most, least] = found.curvatures.map(f64::abs);
            let direction = match bend {
                impasto_scene::document::Bend::Max => found.directions[0],
                impasto_scene::document::Bend::Min => found.directions[1],
            };
            // Angle by which normals differ over one spacing, and how lopsided that is.
            let pull = 30.0 * ((most - least) * spacing).clamp(0.0, 0.5);
            if pull > constraint.weight {
                let symmetry = symmetry(&self.rules[points[sample].point.rule]);
                let target = symmetry.encode(direction, tangent_axes(normal));
                *constraint = Constraint { target, weight: pull };
            }
        });
        constraints
    }

    /// The tangent whose stroke shows along the gesture of a guide in the view that it was drawn in.
    pub(crate) fn combed(&self, guide: &BodyGuide, found: Influence, point: Point, views: &Views) -> DVec3 {
        let Point { position, normal, rule, .. } = point;
        let Influence { along, turn_rad, .. } = found;
        // What shows turns with the tangent: one to one when flat, else at a slope that is measured.
        let turned = |tangent: DVec3, angle_rad: f64| {
            let (sin, cos) = angle_rad.sin_cos();
            tangent * cos + normal.cross(tangent) * sin
        };
        let on_surface = turned((along - normal * normal.dot(along)).normalize_or(views.axes[0]), turn_rad);
        let map = match guide.view {
            None => self.references.of_rule(rule).map,
            Some([eye, target]) => {
                let gaze = (target - eye).normalize_or(DVec3::NEG_Z);
                let up = if gaze.cross(DVec3::Y).length_squared() > 1e-12 { DVec3::Y } else { DVec3::Z };
                let view: DMat4 = glam::dcamera::rh::view::look_to_mat4(eye, gaze, up);
                let lens = if self.orthographic {
                    PixelLens::Orthographic { px_per_unit: 1000.0 }
                } else {
                    PixelLens::Perspective { focal_px: 1000.0 }
                };
                ScreenMap::new(view, DAffine3::IDENTITY, lens)
            }
        };
        let jacobian = map.jacobian(position);
        let in_front = map.depth(position) > 0.0 || self.orthographic;
        let wanted = shown_rad(along, jacobian) + turn_rad;
        // Hidden in its own view, a stroke follows the gesture as it lies on the surface.
        let trust = ((facing(jacobian, normal) - 0.02) / 0.15).clamp(0.0, 1.0);
        if !in_front || trust.is_nan() || trust <= 0.0 || !wanted.is_finite() {
            return on_surface;
        }
        let flatness = f64::from(self.rules[rule].strokes.flatness);
        let mut tangent = views.tangent_at(wanted, jacobian);
        let error = |tangent: DVec3| wrap_pi(wanted - views.lift(tangent).map(jacobian).shown_rad(flatness));
        for _ in 0..16 {
            let off = error(tangent);
            if off.abs() < 1e-7 {
                break;
            }
            let slope = if flatness < 1.0 { wrap_pi(off - error(turned(tangent, 1e-4))) / 1e-4 } else { 1.0 };
            tangent = turned(tangent, (off / slope.clamp(0.2, 20.0)).clamp(-0.6, 0.6));
        }
        let lines = Symmetry::Lines;
        let mix = |tangent: DVec3| lines.encode(tangent, views.axes);
        if trust >= 1.0 {
            return tangent;
        }
        let mixed = mix(tangent) * trust + mix(on_surface) * (1.0 - trust);
        let mixed = lines.decode(mixed, views.axes);
        if mixed.dot(tangent) < 0.0 { -mixed } else { mixed }
    }

    /// The guides of a rule, in the order of the file.
    pub(crate) fn guides_of(&self, rule: usize) -> impl Iterator<Item = &BodyGuide> {
        self.guides.iter().filter(move |guide| usize::from(guide.rule) == rule)
    }

    /// The direction of a particle after every guide that reaches it; `relaxed` is what the field says after smoothing.
    pub(crate) fn with_guides(
        &self,
        point: Point,
        views: &Views,
        tangent: DVec3,
        relaxed: impl Fn() -> Option<DVec3>,
    ) -> DVec3 {
        let symmetry = symmetry(&self.rules[point.rule]);
        let mut z = symmetry.encode(tangent, views.axes);
        let mut last = None;
        for guide in self.guides_of(point.rule) {
            let Some(found) = guide.guide.influence(point.position, point.normal, 0.0) else { continue };
            let (tangent, share) = match guide.mode {
                GuideMode::Comb => (self.combed(guide, found, point, views), found.weight),
                GuideMode::Smooth => match relaxed() {
                    Some(relaxed) => (relaxed, smooth::share(found.weight)),
                    None => continue,
                },
            };
            let there = symmetry.encode(tangent, views.axes);
            z = (z * (1.0 - share) + there * share).try_normalize().unwrap_or(there);
            last = Some(tangent);
        }
        let Some(last) = last else { return tangent };
        let found = symmetry.decode(z, views.axes);
        // Of a line's two ends, the one that the last gesture points to.
        if found.dot(last) < 0.0 && symmetry == Symmetry::Lines { -found } else { found }
    }
}

impl BodyField {
    /// The points where strokes have no direction.
    pub(crate) fn singularities(&self) -> &[Singularity] {
        let FieldSamples { positions, normals, .. } = &*self.inputs.samples;
        let shown = self.relaxed.as_deref().unwrap_or(&self.solved);
        self.singularities.get_or_init(|| {
            self.ground.graph.get().map_or_else(Vec::new, |graph| {
                singularities::find(graph, positions, normals, shown, self.symmetry)
            })
        })
    }

    /// The direction of a particle with its stated one: the field's, where what is stated does not hold.
    pub(crate) fn direction(
        &self,
        (stencils, particle): (&Stencils, usize),
        point: Point,
        base: &Base,
    ) -> DVec3 {
        if self.anchored && base.exact >= 1.0 {
            return base.tangent;
        }
        let symmetry = self.symmetry;
        let axes = tangent_axes(point.normal);
        let stated = symmetry.encode(base.tangent, axes);
        let Some((found, anchor)) = self.carried(&self.solved, (stencils, particle), point, stated) else {
            return base.tangent;
        };
        let hold = anchor * base.exact;
        if hold >= 1.0 - 1e-9 {
            return base.tangent;
        }
        let mixed = (found * (1.0 - hold) + stated * hold).try_normalize().unwrap_or(stated);
        let tangent = symmetry.decode(mixed, axes);
        let nearer = symmetry == Symmetry::Lines && tangent.dot(base.tangent) < 0.0;
        if nearer { -tangent } else { tangent }
    }

    /// The direction of a particle after the guides that smooth; `None` where there is none.
    pub(crate) fn relaxed(&self, at: (&Stencils, usize), point: Point, base: &Base) -> Option<DVec3> {
        let axes = tangent_axes(point.normal);
        let stated = self.symmetry.encode(base.tangent, axes);
        let (found, _) = self.carried(self.relaxed.as_ref()?, at, point, stated)?;
        let tangent = self.symmetry.decode(found, axes);
        let nearer = self.symmetry == Symmetry::Lines && tangent.dot(base.tangent) < 0.0;
        Some(if nearer { -tangent } else { tangent })
    }

    /// What the samples round a particle say, and how far what is stated holds there.
    fn carried(
        &self,
        solved: &[DVec2],
        (stencils, particle): (&Stencils, usize),
        point: Point,
        stated: DVec2,
    ) -> Option<(DVec2, f64)> {
        let inputs = &self.inputs;
        let sample = |index: usize| {
            let sample = &self.ground.points[index];
            inputs.joined(sample.point, point).then(|| SolvedSample {
                position: inputs.samples.positions[index],
                normal: sample.point.normal,
                solved: solved[index],
                stated: sample.stated,
                anchor: self.anchors[index],
            })
        };
        let position = point.position.as_vec3();
        stencils.carry(particle, position, point.normal, stated, self.symmetry, sample)
    }
}
