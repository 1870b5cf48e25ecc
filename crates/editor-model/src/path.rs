//! Gestures on a surface: turns a drag over the picture into guides that do not depend on how often the pointer
//! reports.
//!
//! ```text
//! events ─▶ curve through them ─▶ steps of one pixel ─▶ pulled string ─▶ a ray per step ─▶ pieces on the surface
//! ```
//!
//! The string steadies the hand: its tip draws, and the pointer pulls the tip along only while the string is taut.

use glam::{DAffine3, DVec2, DVec3};
use impasto_scene::document::{Falloff, Guide, GuideMode, GuidePoint};

use crate::picking::{Hit, View, world_units_per_model_unit};

mod curve;
mod mirror;
pub(crate) mod simplify;
#[cfg(test)]
mod tests;
mod view;

use curve::{PointerCurve, Step};

pub use mirror::{MirrorAxes, mirrored};
pub use view::ObjectView;

/// Points of a path lie this far apart on the screen.
const STEP_PX: f64 = 1.0;
/// Stamps, the points where a brush touches, lie this share of the radius apart on the surface.
pub(crate) const STAMP_SHARE: f64 = 0.25;
/// A guide leaves out points of its path as long as its line stays within this distance of the path.
const TOLERANCE_PX: f64 = 0.5;
/// The same on a body that bends. A straight gesture there is a curve on the surface at rest, and needs more points.
const BENT_TOLERANCE_PX: f64 = 0.1;
/// If two neighbouring steps are farther apart on the surface than this many pixels, it is checked whether the surface
/// is connected between them.
const LEAP_PX: f64 = 4.0;
/// A hand that tries to hold a pen in one place moves it by up to this distance.
const TREMBLE_PX: f64 = 4.0;
/// Length of the string at full steadiness.
const LONGEST_STRING_PX: f64 = 120.0;

/// How a drag becomes a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathSettings {
    /// Radius of the brush at the press, pixels, > 0.
    pub radius_px: f64,
    /// How far a pulled string steadies the stroke, 0..=1.
    pub steady: f64,
    /// Which sides of the surface take part.
    pub faces: Faces,
}

/// Which sides of a surface take part in a gesture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Faces {
    /// Those that carry paint and face the viewer.
    #[default]
    Front,
    /// The inside of closed surfaces, too.
    All,
}

/// One step of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// Its place in the view in which it was drawn, pixels.
    pub at_px: DVec2,
    /// Its position on the surface, in the object's own space.
    pub position: DVec3,
    /// Normal of the surface there, unit.
    pub normal: DVec3,
    /// How hard the pen pressed there, 0..=1; 1 without a pen.
    pub pressure: f64,
}

/// A gesture under way. It stays on the object of its press.
#[derive(Clone, Debug)]
pub struct SurfacePath {
    object: usize,
    /// Radius of the brush, model units.
    radius: f64,
    px_per_unit: f64,
    string_px: f64,
    faces: Faces,
    curve: PointerCurve,
    /// How hard the pen presses now.
    pressure: f64,
    /// The end of the string, which draws.
    tip: DVec2,
    /// Where the tip was when the surface under it was looked up last.
    sampled_px: DVec2,
    /// Whether there was no surface to draw on at the last look-up.
    lifted: bool,
    pieces: Vec<Vec<PathPoint>>,
}

/// How the guides of a path are written.
#[derive(Clone, Debug, PartialEq)]
pub struct GuideStyle {
    /// What the guides do with the strokes that they reach.
    pub mode: GuideMode,
    /// Name of the object, where the region covers more than one.
    pub object: Option<String>,
    /// How far strokes follow, 0..=1.
    pub strength: f64,
    /// How the strength falls off.
    pub falloff: Falloff,
    /// Whether strokes run along the drag, or against it.
    pub sense: PathSense,
}

/// Whether strokes run along the drag.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PathSense {
    /// As dragged.
    #[default]
    Along,
    /// The other way.
    Against,
}

impl SurfacePath {
    /// Begins at a press on a surface, for a pointer that reports no pressure.
    pub fn press(
        at_px: DVec2,
        hit: &Hit,
        view: &View,
        world_from_model: DAffine3,
        settings: &PathSettings,
    ) -> Self {
        let px_per_unit =
            view.px_per_unit(hit.position_in_world) * world_units_per_model_unit(world_from_model);
        Self {
            object: hit.object,
            radius: settings.radius_px / px_per_unit,
            px_per_unit,
            string_px: settings.steady.clamp(0.0, 1.0) * LONGEST_STRING_PX,
            faces: settings.faces,
            curve: PointerCurve::new(Step { at_px, pressure: 1.0 }),
            pressure: 1.0,
            tip: at_px,
            sampled_px: at_px,
            lifted: false,
            pieces: vec![vec![PathPoint::new(at_px, hit, 1.0)]],
        }
    }

    /// The path with this pressure at its press. A path that already has more points stays as it is.
    pub fn pressed(mut self, pressure: f64) -> Self {
        if let [piece] = self.pieces.as_mut_slice()
            && let [point] = piece.as_mut_slice()
        {
            point.pressure = pressure;
            self.pressure = pressure;
            self.curve = PointerCurve::new(Step { at_px: point.at_px, pressure });
        }
        self
    }

    /// Sets how hard the pen presses from now on.
    pub fn press_by(&mut self, pressure: f64) {
        self.pressure = pressure;
    }

    /// How hard the pen presses now.
    pub fn pressure(&self) -> f64 {
        self.pressure
    }

    /// How hard the pen pressed along the path, on the average; exactly 1 without a pen.
    pub fn mean_pressure(&self) -> f64 {
        let points = self.pieces.iter().flatten();
        let count = points.clone().count().max(1);
        points.map(|point| point.pressure).sum::<f64>() / count as f64
    }

    /// The path as drawn by a brush that is smaller by this factor.
    pub fn narrowed(mut self, by: f64) -> Self {
        self.radius *= by;
        self
    }

    /// The object of the press.
    pub fn object(&self) -> usize {
        self.object
    }

    /// Radius of the brush in the object's own units.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Whether the tip of the string had no surface to draw on at the last look-up.
    pub fn is_lifted(&self) -> bool {
        self.lifted
    }

    /// The pieces so far. Each is a list of steps on the surface.
    pub fn pieces(&self) -> &[Vec<PathPoint>] {
        &self.pieces
    }

    /// The pointer moved. `pick` finds the surface under a pixel, and returns `None` where the gesture may not go
    /// (another region).
    pub fn move_to(&mut self, at_px: DVec2, pick: &mut dyn FnMut(DVec2) -> Option<Hit>) {
        if at_px.is_finite() {
            let press_px = self.pieces[0][0].at_px;
            if press_px.distance(at_px) <= self.string_px.max(TREMBLE_PX) {
                self.harden(self.pressure);
            }
            let steps = self.curve.move_to(Step { at_px, pressure: self.pressure });
            self.walk(&steps, pick);
        }
    }

    /// The path once the pen is lifted. `greatest` is the highest pressure since the pen was set down: a path that is
    /// only a press gets at least this pressure.
    pub fn lifted(mut self, greatest: f64) -> Self {
        self.harden(greatest);
        self
    }

    /// If the path still has only the point of its press, raises the pressure there to at least `pressure`.
    fn harden(&mut self, pressure: f64) {
        if let [piece] = self.pieces.as_mut_slice()
            && let [point] = piece.as_mut_slice()
        {
            point.pressure = point.pressure.max(pressure);
        }
    }

    /// The path as it would be if the button were released now.
    pub fn finished(&self, pick: &mut dyn FnMut(DVec2) -> Option<Hit>) -> Self {
        let mut path = self.clone();
        let steps = path.curve.finish();
        path.walk(&steps, pick);
        if let Some(&Step { at_px: hand, .. }) =
            steps.last().filter(|_| path.sampled_px != path.pieces[0][0].at_px)
        {
            path.finish_at(hand, pick);
        }
        path
    }

    /// The points where a brush touches: on the surface along the pieces, a quarter of the radius apart.
    pub fn stamps(&self) -> Vec<PathPoint> {
        self.stamps_apart(STAMP_SHARE)
    }

    /// As [`Self::stamps`], this share of the radius apart.
    pub fn stamps_apart(&self, share: f64) -> Vec<PathPoint> {
        self.stamps_of(share, &|_| 1.0)
    }

    /// As [`Self::stamps_apart`], for a brush whose radius at each point is smaller by the factor `narrows`, > 0.
    pub fn stamps_of(&self, share: f64, narrows: &dyn Fn(&PathPoint) -> f64) -> Vec<PathPoint> {
        let spacing_at = |point: &PathPoint| self.radius * share * narrows(point);
        let mut stamps = Vec::new();
        for piece in &self.pieces {
            stamps.extend(piece.first());
            let mut walked = 0.0;
            let mut spacing = piece.first().map_or(self.radius * share, spacing_at);
            for pair in piece.windows(2) {
                let length = pair[0].position.distance(pair[1].position);
                let mut at = spacing - walked;
                while at <= length {
                    let stamp = pair[0].mixed(&pair[1], at / length);
                    stamps.push(stamp);
                    spacing = spacing_at(&stamp);
                    at += spacing;
                }
                walked = length - (at - spacing);
            }
        }
        stamps
    }

    /// The pieces as guides, each with few points that keep it within half a pixel of the piece (a tenth of a pixel on
    /// a body that bends). Pieces shorter than two steps give none. `seen` is the view that the path was drawn in,
    /// `reference` the view that the region's directions refer to.
    pub fn guides(&self, style: &GuideStyle, seen: &ObjectView, reference: &ObjectView) -> Vec<Guide> {
        self.guides_turned(style, [seen, reference], &|_, _| 0.0)
    }

    /// As [`Self::guides`], but strokes are turned from the gesture's line. `turn_deg` gives the turn at a point; its
    /// second argument is the angle at which the line shows there (radians, counter-clockwise).
    pub fn guides_turned(
        &self,
        style: &GuideStyle,
        [seen, reference]: [&ObjectView; 2],
        turn_deg: &dyn Fn(&PathPoint, f64) -> f64,
    ) -> Vec<Guide> {
        let mut guides = Vec::new();
        for piece in &self.pieces {
            // Only a body that bends has a frame.
            let tolerance_px = if seen.frame.is_some() { BENT_TOLERANCE_PX } else { TOLERANCE_PX };
            let kept = simplify::within(piece, tolerance_px / self.px_per_unit);
            let length_px: f64 = piece.windows(2).map(|pair| pair[0].at_px.distance(pair[1].at_px)).sum();
            if kept.len() < 2 || length_px < 2.0 * STEP_PX {
                continue;
            }
            let mut points: Vec<GuidePoint> = (0..kept.len())
                .map(|index| GuidePoint {
                    turn_deg: turn_deg(&kept[index], line_rad(&kept, index)),
                    ..kept[index].guide_point()
                })
                .collect();
            if style.sense == PathSense::Against {
                points.reverse();
            }
            guides.push(Guide {
                mode: style.mode,
                curve: false,
                object: style.object.clone(),
                view: seen.guide_view(reference, piece[piece.len() / 2].position),
                points,
                radius: self.radius,
                strength: style.strength,
                falloff: style.falloff,
            });
        }
        guides
    }

    /// Draws on from the tip, which lags behind by the length of the string, to where the pointer was released.
    fn finish_at(&mut self, hand: DVec2, pick: &mut dyn FnMut(DVec2) -> Option<Hit>) {
        let from = self.tip;
        let count = (from.distance(hand) / STEP_PX).ceil().clamp(1.0, 65_536.0) as u32;
        // A pen that is lifted presses less and less, but this piece keeps the pressure of the last point before it.
        let pressure = self.pieces.last().and_then(|piece| piece.last()).map_or(1.0, |point| point.pressure);
        let steps: Vec<Step> = (1..=count)
            .map(|step| Step { at_px: from.lerp(hand, f64::from(step) / f64::from(count)), pressure })
            .collect();
        self.string_px = 0.0;
        self.walk(&steps, pick);
    }

    /// Pulls the string along steps of the pointer.
    fn walk(&mut self, steps: &[Step], pick: &mut dyn FnMut(DVec2) -> Option<Hit>) {
        for step in steps {
            let pull = step.at_px - self.tip;
            let length = pull.length();
            if length <= self.string_px {
                continue;
            }
            self.tip += pull * ((length - self.string_px) / length);
            // A little less than a step, so that rounding does not skip one.
            if self.tip.distance(self.sampled_px) > STEP_PX * 0.999 {
                self.sampled_px = self.tip;
                self.sample(step.pressure, pick);
            }
        }
    }

    fn sample(&mut self, pressure: f64, pick: &mut dyn FnMut(DVec2) -> Option<Hit>) {
        let Some(point) = self.look_up(self.tip, pressure, pick) else {
            self.lifted = true;
            return;
        };
        let last = self.pieces.last().and_then(|piece| piece.last()).copied();
        let joined = !self.lifted && last.is_some_and(|last| self.is_connected(last, point, pick));
        self.lifted = false;
        match self.pieces.last_mut() {
            Some(piece) if joined => piece.push(point),
            _ => self.pieces.push(vec![point]),
        }
    }

    fn look_up(
        &self,
        at_px: DVec2,
        pressure: f64,
        pick: &mut dyn FnMut(DVec2) -> Option<Hit>,
    ) -> Option<PathPoint> {
        let hit = pick(at_px)?;
        let takes_part = hit.object == self.object && (hit.front || self.faces == Faces::All);
        takes_part.then(|| PathPoint::new(at_px, &hit, pressure))
    }

    /// Whether the surface is connected between two steps, and does not jump from a fold to the surface behind it.
    /// Bisects the step: on a connected surface the distance between its ends shrinks, across a gap it does not.
    fn is_connected(
        &self,
        mut from: PathPoint,
        mut to: PathPoint,
        pick: &mut dyn FnMut(DVec2) -> Option<Hit>,
    ) -> bool {
        let leap = from.position.distance(to.position);
        if leap * self.px_per_unit <= LEAP_PX * STEP_PX {
            return true;
        }
        for _ in 0..6 {
            let at_px = (from.at_px + to.at_px) * 0.5;
            let Some(middle) = self.look_up(at_px, to.pressure, pick) else { return false };
            if middle.position.distance(from.position) > middle.position.distance(to.position) {
                to = middle;
            } else {
                from = middle;
            }
        }
        from.position.distance(to.position) < 0.5 * leap
    }
}

/// The angle, radians counter-clockwise, at which a line shows at one of its points: the direction there of the arc
/// through the point and its two neighbours.
fn line_rad(points: &[PathPoint], index: usize) -> f64 {
    let piece = |from: usize| points[from + 1].at_px - points[from].at_px;
    let last = points.len() - 2;
    let (before, after) = (piece(index.saturating_sub(1).min(last)), piece(index.min(last)));
    let along = before.normalize_or_zero() * after.length() + after.normalize_or_zero() * before.length();
    (along * DVec2::new(1.0, -1.0)).to_angle()
}

impl PathPoint {
    pub(crate) fn new(at_px: DVec2, hit: &Hit, pressure: f64) -> Self {
        Self { at_px, position: hit.position_in_model, normal: hit.normal_in_model, pressure }
    }

    fn mixed(&self, other: &Self, share: f64) -> Self {
        Self {
            at_px: self.at_px.lerp(other.at_px, share),
            position: self.position.lerp(other.position, share),
            normal: self.normal.lerp(other.normal, share).normalize_or(self.normal),
            pressure: self.pressure + (other.pressure - self.pressure) * share,
        }
    }

    pub(crate) fn guide_point(self) -> GuidePoint {
        GuidePoint { at: self.position.to_array(), normal: self.normal.to_array(), turn_deg: 0.0 }
    }
}
