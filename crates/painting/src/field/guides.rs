//! Applies guides to the direction field: finds the directions that combing guides state, and how far smoothing guides
//! loosen the field.

use glam::{DAffine3, DMat4, DVec2, DVec3};
use impasto_core::ScreenMap;
use impasto_core::angle::wrap_pi;
use impasto_core::direction::field::Constraint;
use impasto_core::direction::guide::Influence;
use impasto_core::direction::{Symmetry, tangent_axes};
use impasto_core::screen_map::PixelLens;
use impasto_scene::document::{Amount, GuideMode};
use rayon::prelude::*;

use super::inputs::{FieldInputs, SamplePoint};
use crate::amounts::painted_flatness;
use crate::references::{SurfacePoint, Views, shown_rad};
use crate::regions::{BodyGuide, BodyGuideView};
use crate::stated::symmetry;

/// How firmly a direction that is stated outright pulls at a sample, and how firmly a guide pulls at a sample on the
/// guide's own line. One neighbour pulls with a firmness of 1.
pub(super) const FIRM: f64 = 300.0;

/// How firmly smoothing holds a sample to its solved direction: `HELD` where no guide loosens it, `LET_GO` where one
/// loosens it wholly.
const HELD: f64 = 1e4;
const LET_GO: f64 = 1e-6;

/// How much of the relaxed field a stroke takes where a smoothing guide has this weight. It may rise steeply with the
/// weight, because the relaxed field itself still equals the solved one at the guide's rim.
fn relaxed_share(weight: f64) -> f64 {
    1.0 - (1.0 - weight).powi(4)
}

impl FieldInputs {
    /// The guides of a rule, in the order of the file.
    pub(super) fn guides_of(&self, rule: usize) -> impl Iterator<Item = &BodyGuide> {
        self.guides.iter().filter(move |guide| usize::from(guide.rule) == rule)
    }

    /// The tangent whose stroke lies along the gesture (the drawn line) of a combing guide, as seen in the view that
    /// the gesture was drawn in.
    pub(super) fn combed(
        &self,
        guide: &BodyGuide,
        found: Influence,
        point: SurfacePoint,
        views: &Views,
    ) -> DVec3 {
        let SurfacePoint { position, normal, rule, .. } = point;
        let Influence { along, turn_rad, .. } = found;
        let turned = |tangent: DVec3, angle_rad: f64| {
            let (sin, cos) = angle_rad.sin_cos();
            tangent * cos + normal.cross(tangent) * sin
        };
        let on_surface = turned((along - normal * normal.dot(along)).normalize_or(views.axes[0]), turn_rad);
        let map = match &guide.view {
            None => self.references.of_rule(rule).map,
            Some(BodyGuideView { eye, target, .. }) => {
                let (eye, target) = (*eye, *target);
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
        // The body as it is bent in the guide's view or, if the guide has none, in the reference; `None` at rest.
        let bent = match &guide.view {
            Some(view) => view.stands.bent.as_ref(),
            None => self.references.of_rule(rule).stands.bent.as_ref(),
        };
        let carried = bent.map(|bent| bent.place(point.place));
        let (seen_at, seen_normal) =
            carried.map_or((position, normal), |carried| (carried.position, carried.normal(normal)));
        let seen = map.jacobian(seen_at);
        let jacobian = carried.map_or(seen, |carried| carried.pulled_back(seen));
        let in_front = map.depth(seen_at) > 0.0 || self.orthographic;
        let wanted = shown_rad(along, jacobian) + turn_rad;
        // Where the guide's view does not see the point, its stroke follows the gesture as projected to the surface.
        let trust = ((map.facing(seen, seen_normal) - 0.02) / 0.15).clamp(0.0, 1.0);
        if !in_front || trust.is_nan() || trust <= 0.0 || !wanted.is_finite() {
            return on_surface;
        }
        let painted = self.amounts.at(Amount::Flatness, rule as u16, position.as_vec3(), normal.as_vec3());
        let flatness = f64::from(painted_flatness(self.rules[rule].strokes.flatness, painted));
        // Newton's method: turns the tangent until its stroke shows at the wanted angle. Flat strokes turn as far as
        // their tangents; for others the ratio of the two turns, the slope, is measured.
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
        let encoded = |tangent: DVec3| lines.encode(tangent, views.axes);
        if trust >= 1.0 {
            return tangent;
        }
        let mixed = encoded(tangent) * trust + encoded(on_surface) * (1.0 - trust);
        let mixed = lines.decode(mixed, views.axes);
        if mixed.dot(tangent) < 0.0 { -mixed } else { mixed }
    }

    /// The direction of a particle after every guide that reaches it. `relaxed` gives the field's direction after
    /// smoothing.
    pub(crate) fn with_guides(
        &self,
        point: SurfacePoint,
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
                    Some(relaxed) => (relaxed, relaxed_share(found.weight)),
                    None => continue,
                },
            };
            let there = symmetry.encode(tangent, views.axes);
            z = (z * (1.0 - share) + there * share).try_normalize().unwrap_or(there);
            last = Some(tangent);
        }
        let Some(last) = last else { return tangent };
        let found = symmetry.decode(z, views.axes);
        // A line has two opposite directions. The stroke takes the one nearer to the last guide's direction.
        if found.dot(last) < 0.0 && symmetry == Symmetry::Lines { -found } else { found }
    }

    pub(super) fn smooths(&self) -> bool {
        self.guides.iter().any(|guide| guide.mode == GuideMode::Smooth)
    }

    /// What still holds each sample that a smoothing guide loosens; `None` for all other samples. Each smoothing guide
    /// multiplies the pull on the sample by a small factor. Combing guides that come after it in the file pull towards
    /// their gestures.
    pub(super) fn holds(
        &self,
        points: &[SamplePoint],
        solved: &[DVec2],
        symmetry: Symmetry,
    ) -> Vec<Option<Constraint>> {
        let hold = |(sample, solved): (&SamplePoint, &DVec2)| {
            let point = sample.point;
            let mut hold: Option<Constraint> = None;
            for guide in self.guides_of(point.rule) {
                let Some(found) = guide.guide.influence(point.position, point.normal, 0.0) else { continue };
                match (guide.mode, &mut hold) {
                    (GuideMode::Smooth, _) => {
                        let held = hold.get_or_insert(Constraint { target: *solved, weight: HELD });
                        held.weight *= (LET_GO / HELD).powf(found.weight);
                    }
                    (GuideMode::Comb, Some(held)) => {
                        let views = self.references.views(point, |_| None);
                        let tangent = self.combed(guide, found, point, &views);
                        let there = symmetry.encode(tangent, tangent_axes(point.normal));
                        let pull = FIRM * found.weight;
                        let target = (held.target * held.weight + there * pull).try_normalize();
                        held.target = target.unwrap_or(there);
                        held.weight = held.weight.max(pull);
                    }
                    // Nothing is loosened yet, and the solved direction already follows this guide.
                    (GuideMode::Comb, None) => {}
                }
            }
            hold.map(|held| Constraint { weight: held.weight.max(LET_GO), ..held })
        };
        points.par_iter().zip(solved).with_min_len(256).map(hold).collect()
    }
}
