//! Makes the lines of touches in a view: where each runs in the picture, how wide it is, and what of it can be seen.

use std::ops::Range;

use glam::{DVec2, DVec3};
use impasto_core::presence;
use impasto_scene::document::Touch;
use impasto_scene::presets::LayerKind;

use crate::frame::{LayerRun, LineStrip, LineVertex, Lines, Paint, Stroke, StrokeSource, Strokes};
use crate::painting_view::{PaintingView, PosedBody};
use crate::stroke::mixing;
use crate::touches::{LaidTouch, TouchPlace};

/// The share of a mark's length, and of its width, that paint fills; and how long a mark is, in widths.
const FILL: f64 = impasto_core::brush::FILL as f64;
const MARK_LENGTH: f64 = impasto_core::brush::SIZE[0] as f64 / impasto_core::brush::SIZE[1] as f64;

/// A line up to `STRETCHED` marks long stretches its whole mark evenly. In a longer line, the share `END` of the mark
/// at either end is stretched no further; only the middle is.
const STRETCHED: f64 = 1.5;
const END: f64 = 0.36;

/// By what share of its width a line is narrower at its very ends.
const LIFTED: f64 = 0.22;

/// The brush runs dry: at the end of a line of `DRY_AFTER` widths or more, a texel of the mark shows only if it has
/// `RUNS_DRY` more paint than is needed at the beginning.
const DRY_AFTER: f64 = 12.0;
const RUNS_DRY: f64 = 0.34;

/// How many steps the line of a touch at a single place has.
const STRAIGHT_STEPS: usize = 8;

/// The least slant that is used for a surface, as in `paint.vert`.
const LEAST_SLANT: f64 = 0.05;

/// A point of a line in the picture.
#[derive(Clone, Copy)]
struct LinePoint {
    /// Share of the line, 0..=1.
    share: f64,
    /// Pixels, origin at the lower left.
    at_px: DVec2,
    /// World units.
    depth: f64,
    facing: f64,
    /// How much deeper the surface gets, in pixels of depth per pixel along x and y.
    slope: DVec2,
    /// How far the surface faces the eye, as in `shared/lens.glsl` (`facing_at_px`), without sign; at least
    /// `LEAST_SLANT`.
    slant: f64,
    /// Unit.
    normal_in_world: DVec3,
    /// Offset from the surface point that gives this point its depth, pixels. Zero, except past the ends of the line.
    off_px: DVec2,
}

impl PaintingView<'_> {
    /// Adds the touches as the last layer of paint.
    pub(crate) fn lay_touches(&self, strokes: &mut Strokes) {
        let first = strokes.strokes.len() as u32;
        for touch in self.painting.touches.iter() {
            self.lay_touch(touch, strokes);
        }
        let count = strokes.strokes.len() as u32 - first;
        if count > 0 {
            let order = self.painting.highest_layer();
            strokes.layers.push(LayerRun { order, kind: LayerKind::Touches, first, count });
        }
    }

    fn lay_touch(&self, laid: &LaidTouch, strokes: &mut Strokes) {
        let body = &self.bodies[laid.object];
        if body.hidden {
            return;
        }
        let touch = &self.painting.scene().touches[laid.number as usize];
        let width_px = touch.width_px * f64::from(self.px_scale);
        let line = match &laid.places[..] {
            [] => return,
            [place] => self.straight(laid, touch, body, place),
            places => {
                let last = (places.len() - 1) as f64;
                let points = places.iter().enumerate();
                points.map(|(index, place)| self.line_point(body, place, index as f64 / last)).collect()
            }
        };
        let runs = self.runs_in_view(&line, width_px);
        let Some(anchor) = anchor(&line, &runs) else { return };
        let index = strokes.strokes.len() as u32;
        let length_px = length_px(&line);
        for run in runs {
            push_strip(
                &mut strokes.lines,
                index,
                &line[run],
                &Width { width_px, length_px, taper: touch.taper },
            );
        }
        let (stroke, source) = self.touch_stroke(laid, touch, (&anchor, length_px));
        strokes.strokes.push(stroke);
        strokes.sources.push(source);
    }

    /// A place of a touch in the picture. Its depth is NaN if it is nearer or farther than the camera shows.
    fn line_point(&self, body: &PosedBody, place: &TouchPlace, share: f64) -> LinePoint {
        let (position, normal) = match &body.bent {
            Some(bent) => {
                let carried = bent.place(place.place);
                (carried.position, carried.normal(place.normal))
            }
            None => (place.position, place.normal),
        };
        let depth = body.map.depth(position);
        let jacobian = body.map.jacobian(position);
        let facing = body.map.facing(jacobian, normal);
        let in_world = body.world_from_model.matrix3.inverse().transpose() * normal;
        let normal_in_world = in_world.normalize_or_zero();
        let in_view = self.view_from_world * normal_in_world;
        let towards_eye = body.world_from_model.matrix3 * jacobian[0].cross(jacobian[1]);
        let gaze = self.view_from_world * towards_eye.normalize_or_zero();
        let leans = in_view.dot(gaze) / gaze.z;
        let slant = leans.abs().max(LEAST_SLANT);
        let slope = in_view.truncate() / if leans < 0.0 { -slant } else { slant };
        let half = DVec2::from(self.half_px.map(f64::from));
        LinePoint {
            share,
            at_px: body.map.project(position) + half,
            depth: if self.is_between(depth as f32) { depth } else { f64::NAN },
            facing,
            slope,
            slant,
            normal_in_world,
            off_px: DVec2::ZERO,
        }
    }

    /// The line of a touch at a single place: straight, of the touch's stated length, along the strokes round it.
    fn straight(
        &self,
        laid: &LaidTouch,
        touch: &Touch,
        body: &PosedBody,
        place: &TouchPlace,
    ) -> Vec<LinePoint> {
        let middle = self.line_point(body, place, 0.5);
        let along = DVec2::from_angle(self.angle_round(laid));
        let length_px = touch.length_px * f64::from(self.px_scale);
        let px_per_unit = self.px_per_unit(body, middle.depth);
        let at = |step: usize| {
            let share = step as f64 / STRAIGHT_STEPS as f64;
            let offset_px = along * (length_px * (share - 0.5));
            let depth = middle.depth + middle.slope.dot(offset_px) / px_per_unit;
            LinePoint { share, at_px: middle.at_px + offset_px, depth, ..middle }
        };
        (0..=STRAIGHT_STEPS).map(at).collect()
    }

    /// Pixels per world unit at a depth.
    fn px_per_unit(&self, body: &PosedBody, depth: f64) -> f64 {
        // The rows of the map are in model space; a pose may scale.
        let in_world = body.world_from_model.matrix3.inverse().transpose() * body.map.row_y.truncate();
        let of_lens = if body.map.row_w.truncate() == DVec3::ZERO { 1.0 } else { depth };
        // A shifted lens adds a part along the gaze to the row. That part is left out here.
        let in_view = self.view_from_world * in_world;
        in_view.truncate().length() / of_lens
    }

    /// The mean angle of the strokes round a touch, in which opposite directions count as the same line.
    fn angle_round(&self, laid: &LaidTouch) -> f64 {
        let is_body = |coat: &&crate::painting_view::CoatView<'_>| {
            (coat.coat.object, coat.coat.kind) == (laid.object, LayerKind::Body)
        };
        let Some(coat) = self.coats.iter().find(is_body) else { return 0.0 };
        let round = laid.round.iter().map(|&index| index as usize).filter(|&index| index < coat.len());
        let angles =
            round.map(|index| f64::from(self.angle_rad(coat, index, &coat.placed(index, &coat.look(index)))));
        let mut nearest = None;
        let mut sum = DVec2::ZERO;
        for angle in angles.filter(|angle| angle.is_finite()) {
            nearest = nearest.or(Some(angle));
            sum += DVec2::from_angle(2.0 * angle);
        }
        let Some(nearest) = nearest else { return 0.0 };
        let mean = if sum.length() > 1e-6 { 0.5 * sum.to_angle() } else { nearest };
        // A line has two ends: the touch begins at the one where the nearest stroke begins.
        if (mean - nearest).cos() < 0.0 { mean + std::f64::consts::PI } else { mean }
    }

    /// The parts of a line that can be drawn: in front of the camera, facing it, and not wholly outside the picture.
    fn runs_in_view(&self, line: &[LinePoint], width_px: f64) -> Vec<Range<usize>> {
        let reach = DVec2::splat(width_px) + DVec2::from(self.half_px.map(f64::from));
        let half = DVec2::from(self.half_px.map(f64::from));
        let mut runs: Vec<Range<usize>> = Vec::new();
        for step in 0..line.len().saturating_sub(1) {
            let ends = [line[step], line[step + 1]];
            let is_there = ends.iter().all(|end| end.depth.is_finite() && end.at_px.is_finite());
            let fades = ends.iter().all(|end| end.facing <= 0.0);
            let [low, high] = [ends[0].at_px.min(ends[1].at_px), ends[0].at_px.max(ends[1].at_px)];
            let is_out = (low - half).cmpgt(reach).any() || (high - half).cmplt(-reach).any();
            if !is_there || fades || is_out {
                continue;
            }
            match runs.last_mut() {
                Some(run) if run.end == step + 1 => run.end = step + 2,
                _ => runs.push(step..step + 2),
            }
        }
        runs
    }

    /// The stroke that stands for a touch in the frame: where its colour is found, and its paint.
    fn touch_stroke(
        &self,
        laid: &LaidTouch,
        touch: &Touch,
        (anchor, length_px): (&Anchor, f64),
    ) -> (Stroke, StrokeSource) {
        let strokes = self.strokes_of(laid.rule);
        let layer = strokes.body();
        // At least as thick as the lights that Impasto places itself.
        let thickness = layer.thickness.max(strokes.layer_of(LayerKind::Lights).thickness);
        let byte = |value: f32| value.round().clamp(0.0, 255.0) as u8;
        let stroke = Stroke {
            center_px: anchor.at_px.as_vec2().to_array(),
            depth: anchor.depth as f32,
            angle_rad: anchor.angle_rad as f32,
            length_px: length_px as f32,
            width_px: (touch.width_px * f64::from(self.px_scale)) as f32,
            bits: laid.bits,
            body_id: laid.object as u32 + 1,
            albedo_srgb8: laid.albedo_srgb8,
            mark: laid.mark,
            paint: Paint {
                opacity: byte(touch.opacity as f32 * 255.0),
                thickness: byte(thickness * Paint::THICKNESS_SCALE),
                pickup: 0,
                dryness: byte(0.5 * layer.dryness * 255.0),
            },
            mixing: mixing(strokes, 1.0, self.painting.palette_of_rule[usize::from(laid.rule)]),
            normal_in_world: anchor.normal_in_world,
            overrun_px: self.overrun_px(strokes.edges, layer.overrun, 0.0),
            taper: touch.taper as f32,
            ..Stroke::default()
        };
        let source = StrokeSource {
            place: u32::MAX,
            particle: laid.number,
            region: u32::from(laid.rule),
            kappa: 1.0,
            facing: anchor.facing as f32,
            rank: 0.0,
        };
        (stroke, source)
    }
}

/// Where the colour of a touch is found: the middle of its visible part.
struct Anchor {
    at_px: DVec2,
    depth: f64,
    angle_rad: f64,
    facing: f64,
    normal_in_world: [f32; 3],
}

/// The anchor of a touch with this line; `None` where nothing of the line can be seen.
fn anchor(line: &[LinePoint], runs: &[Range<usize>]) -> Option<Anchor> {
    let seen = || runs.iter().flat_map(|run| &line[run.clone()]);
    let weight = |point: &LinePoint| f64::from(presence::of_facing(point.facing as f32));
    let whole: f64 = seen().map(weight).sum();
    if whole <= 0.0 {
        return None;
    }
    // This share changes slowly as the line turns away, so the anchor moves slowly.
    let share = seen().map(|point| weight(point) * point.share).sum::<f64>() / whole;
    let next = seen().position(|point| point.share >= share).unwrap_or(0).max(1);
    let (from, to) = (seen().nth(next - 1)?, seen().nth(next)?);
    let t = if to.share > from.share { (share - from.share) / (to.share - from.share) } else { 0.0 };
    let t = t.clamp(0.0, 1.0);
    let along = to.at_px - from.at_px;
    Some(Anchor {
        at_px: from.at_px.lerp(to.at_px, t),
        depth: from.depth + (to.depth - from.depth) * t,
        angle_rad: if along.length_squared() > 0.0 { along.to_angle() } else { 0.0 },
        facing: from.facing + (to.facing - from.facing) * t,
        normal_in_world: from
            .normal_in_world
            .lerp(to.normal_in_world, t)
            .normalize_or_zero()
            .as_vec3()
            .to_array(),
    })
}

/// How long a line is in the picture; steps from or to a point on the eye's plane do not count.
fn length_px(line: &[LinePoint]) -> f64 {
    let length = |pair: &[LinePoint]| pair[0].at_px.distance(pair[1].at_px);
    line.windows(2).map(length).filter(|length| length.is_finite()).sum::<f64>().clamp(1e-3, 1e6)
}

struct Width {
    width_px: f64,
    length_px: f64,
    taper: f64,
}

impl Width {
    /// Half the width of the strip at a share of the line.
    fn half_px(&self, share: f64) -> f64 {
        // The hand sets the brush down and lifts it.
        let pressed = 1.0 - LIFTED * (2.0 * share - 1.0).powi(4);
        0.5 * self.width_px * pressed * (1.0 + self.taper * (1.0 - 2.0 * share)) / FILL
    }

    /// How much more paint a texel of the mark needs in order to show, at a share of the line: a long line empties the
    /// brush.
    fn run_dry(&self, share: f64) -> f64 {
        let widths = self.length_px / self.width_px;
        RUNS_DRY * (widths / DRY_AFTER).min(1.0) * ((share - 0.35) / 0.65).max(0.0).powi(2)
    }

    /// The share of the line that each end of the mark takes up.
    fn end_share(&self) -> f64 {
        let marks = self.length_px / (MARK_LENGTH * self.width_px);
        END * (STRETCHED / marks).min(1.0)
    }

    /// The place along the mark, 0..=1, at a share of the line.
    fn on_mark(&self, share: f64) -> f64 {
        let end = self.end_share();
        let u = if share < end {
            share * END / end
        } else if share > 1.0 - end {
            1.0 - (1.0 - share) * END / end
        } else {
            END + (share - end) * (1.0 - 2.0 * END) / (1.0 - 2.0 * end)
        };
        0.5 + (u - 0.5) * FILL
    }

    /// How far the strip reaches past either end of the line, so that the whole mark fits.
    fn past_end_px(&self) -> f64 {
        0.5 * (1.0 / FILL - 1.0) * self.end_share() / END * self.length_px
    }
}

fn push_strip(lines: &mut Lines, stroke: u32, line: &[LinePoint], width: &Width) {
    let first = lines.vertices.len() as u32;
    let last = line.len() - 1;
    let mut before = DVec2::X;
    for (index, point) in line.iter().enumerate() {
        let (from, to) = (line[index.saturating_sub(1)], line[(index + 1).min(last)]);
        let tangent = (to.at_px - from.at_px).try_normalize().unwrap_or(before);
        before = tangent;
        // Past its ends the line goes straight on.
        if index == 0 && point.share <= 0.0 {
            push_pair(lines, &past(point, -tangent * width.past_end_px()), tangent, (width, 0.0));
        }
        push_pair(lines, point, tangent, (width, width.on_mark(point.share)));
        if index == last && point.share >= 1.0 {
            push_pair(lines, &past(point, tangent * width.past_end_px()), tangent, (width, 1.0));
        }
    }
    lines.strips.push(LineStrip { stroke, first, count: lines.vertices.len() as u32 - first });
}

fn past(point: &LinePoint, offset_px: DVec2) -> LinePoint {
    LinePoint { at_px: point.at_px + offset_px, off_px: offset_px, ..*point }
}

fn push_pair(lines: &mut Lines, point: &LinePoint, tangent: DVec2, (width, along): (&Width, f64)) {
    let leave_px = (0.5 * width.width_px + 5.0) * (0.7 / point.slant).max(1.0);
    let half_px = width.half_px(point.share);
    for (side, across) in [(-1.0, 0.0), (1.0, 1.0)] {
        let offset = tangent.perp() * (side * half_px);
        lines.vertices.push(LineVertex {
            at_px: (point.at_px + offset).as_vec2().to_array(),
            on_mark: [along as f32, across],
            from_middle_px: offset.as_vec2().to_array(),
            depth: point.depth as f32,
            presence: presence::of_facing(point.facing as f32),
            lean_px: point.slope.dot(point.off_px + offset) as f32,
            leave_px: leave_px as f32,
            run_dry: width.run_dry(point.share) as f32,
        });
    }
}
