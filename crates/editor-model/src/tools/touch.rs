//! The tool that lays touches: a click places one stroke, a drag a long one along the surface.

use glam::{DVec2, DVec3};
use impasto_scene::document::{Amount, AmountDab, Touch, TouchPoint};
use impasto_scene::limits;

use super::pressure::Felt;
use super::ring::Ring;
use super::{NOTHING_HERE, Paintable, Surroundings, ToolEvent, ToolOutput, amounts};
use crate::command::{Amounts, Command, Touches};
use crate::keymap::{Action, Modifiers};
use crate::path::{Faces, PathPoint, PathSettings, STAMP_SHARE, SurfacePath, simplify};
use crate::picking::Hit;
use crate::refusal::Refusal;
use crate::selection::Item;
use crate::session::ToolOptions;

/// A drag that stays nearer to its press than this, in pixels of the viewport, places a single stroke.
const CLICK_PX: f64 = 5.0;

/// The line of a touch may deviate from what was drawn by [`TOLERANCE`], a share of the ring's radius, or by
/// [`LEAST_TOLERANCE_PX`], in pixels of the viewport, whichever is more.
const TOLERANCE: f64 = 0.04;
const LEAST_TOLERANCE_PX: f64 = 0.75;

/// The name of a new touch, before it is made unique.
const NAME: &str = "touch";

#[derive(Clone, Debug, Default)]
pub(super) struct TouchTool {
    drag: Option<Drag>,
}

#[derive(Clone, Debug)]
struct Drag {
    erases: bool,
    on: Paintable,
    /// The object's name.
    object: String,
    path: SurfacePath,
    press_px: DVec2,
    /// The farthest that the pointer has been from the press, pixels.
    farthest_px: f64,
    at_px: DVec2,
}

impl TouchTool {
    pub(super) fn is_busy(&self) -> bool {
        self.drag.is_some()
    }

    pub(super) fn take(&mut self, event: &ToolEvent, around: &Surroundings) -> ToolOutput {
        match *event {
            ToolEvent::Hover { at_px, .. } => aim(at_px, around),
            ToolEvent::Press { at_px, held, pressure, .. } => self.press(at_px, held, pressure, around),
            ToolEvent::Move { at_px, pressure, .. } => {
                let Some(drag) = &mut self.drag else { return aim(at_px, around) };
                drag.at_px = at_px;
                drag.farthest_px = drag.farthest_px.max(at_px.distance(drag.press_px));
                let object = drag.on.object;
                drag.path.press_by(pressure);
                drag.path.move_to(at_px, &mut |at_px| around.hit(at_px).filter(|hit| hit.object == object));
                self.under_way(around)
            }
            ToolEvent::Release { pressure } => {
                let lifted = |drag: Drag| Drag { path: drag.path.lifted(pressure), ..drag };
                let commit = self.drag.take().and_then(|drag| lifted(drag).command(around));
                ToolOutput { commit, ..ToolOutput::saying(waiting_words(around.options)) }
            }
            ToolEvent::Cancel | ToolEvent::FocusLost | ToolEvent::Key(Action::Cancel) => {
                self.drag = None;
                ToolOutput::saying(waiting_words(around.options))
            }
            ToolEvent::Key(_) if self.drag.is_some() => self.under_way(around),
            ToolEvent::Key(_) => ToolOutput::saying(waiting_words(around.options)),
        }
    }

    fn press(&mut self, at_px: DVec2, held: Modifiers, pressure: f64, around: &Surroundings) -> ToolOutput {
        let options = around.options;
        let hit = around.hit(at_px).filter(|hit| hit.front || !options.front_only);
        let Some(hit) = hit else { return ToolOutput::refusing(Refusal::new(NOTHING_HERE)) };
        if held.ctrl {
            let found = touches_near(around, &hit, &[point_of(at_px, &hit)], radius_of(&hit, around));
            let select = found.last().map(|name| Item::Touch(name.clone()));
            return ToolOutput { select, ..aim(at_px, around) };
        }
        let on = match paintable(&hit, around) {
            Ok(on) => on,
            Err(refusal) => return ToolOutput::refusing(refusal),
        };
        let Some(object) = around.object(hit.object) else { return ToolOutput::default() };
        let settings = PathSettings {
            radius_px: options.radius_px,
            steady: options.steady,
            faces: if options.front_only { Faces::Front } else { Faces::All },
        };
        self.drag = Some(Drag {
            erases: options.touch_erases != held.shift,
            on,
            object: object.name.clone(),
            path: SurfacePath::press(at_px, &hit, around.view, around.pose(hit.object), &settings)
                .pressed(pressure),
            press_px: at_px,
            farthest_px: 0.0,
            at_px,
        });
        self.under_way(around)
    }

    fn under_way(&self, around: &Surroundings) -> ToolOutput {
        let Some(drag) = &self.drag else { return ToolOutput::default() };
        let verb = if drag.erases { "Erasing on" } else { "Laying a touch on" };
        let words = format!("{verb} {}   [Esc] take it back", drag.object);
        let radius_px = around.options.radius_px * Felt::of_path(&drag.path, around.options).radius;
        let rings = match around.hit(drag.at_px).filter(|hit| hit.object == drag.on.object) {
            Some(hit) => vec![Ring::on(&hit, radius_px, around)],
            None => vec![Ring::hollow(drag.at_px, radius_px)],
        };
        ToolOutput { preview: drag.command(around), rings, ..ToolOutput::saying(words) }
    }
}

/// What shows while no button is pressed.
fn aim(at_px: DVec2, around: &Surroundings) -> ToolOutput {
    let rings = match around.hit(at_px) {
        Some(hit) => vec![Ring::on(&hit, around.options.radius_px, around)],
        None => vec![Ring::hollow(at_px, around.options.radius_px)],
    };
    ToolOutput { rings, ..ToolOutput::saying(waiting_words(around.options)) }
}

/// The words of the status line while no drag is under way.
pub(super) fn waiting_words(options: &ToolOptions) -> String {
    let [click, shift] = if options.touch_erases {
        ["[Drag] erase", "lay"]
    } else {
        ["[Click] one stroke  [Drag] a long one", "erase"]
    };
    format!("{click}  [Shift] {shift}  [Ctrl] select  [F] width  [Middle] orbit")
}

/// What a press at a hit would paint on, or why nothing may be painted there.
fn paintable(hit: &Hit, around: &Surroundings) -> Result<Paintable, Refusal> {
    let object = around.object(hit.object).ok_or_else(|| Refusal::new(NOTHING_HERE))?;
    if object.locked {
        return Err(Refusal::new(format!("{} is locked", object.name)));
    }
    around.paintable(Some(hit))
}

fn point_of(at_px: DVec2, hit: &Hit) -> PathPoint {
    PathPoint::new(at_px, hit, 1.0)
}

fn radius_of(hit: &Hit, around: &Surroundings) -> f64 {
    around.options.radius_px / hit.px_per_model_unit(around.view, around.poses)
}

/// Names of the touches that come within 1.5 times this radius of any of these points, in the order of the scene. Only
/// visible touches of the hit's object count.
fn touches_near(around: &Surroundings, hit: &Hit, touched: &[PathPoint], radius: f64) -> Vec<String> {
    let Some(object) = around.object(hit.object) else { return Vec::new() };
    near(around, &object.name, touched, radius)
}

fn near(around: &Surroundings, object: &str, touched: &[PathPoint], radius: f64) -> Vec<String> {
    let is_near = |touch: &&Touch| {
        let places: Vec<DVec3> = touch.points.iter().map(|point| DVec3::from(point.at)).collect();
        let line = match places.len() {
            0 | 1 => places,
            count => impasto_core::smooth_path::smooth_path(&places, 12 * (count - 1)),
        };
        touch.on == object
            && !touch.hidden
            && touched.iter().any(|stamp| distance_to_line(&line, stamp.position) <= 1.5 * radius)
    };
    around.scene().touches.iter().filter(is_near).map(|touch| touch.name.clone()).collect()
}

/// The distance from a point to the nearest place on a line through these points; infinite without points.
fn distance_to_line(line: &[DVec3], to: DVec3) -> f64 {
    let to_piece = |piece: &[DVec3]| {
        let (from, along) = (piece[0], piece[piece.len() - 1] - piece[0]);
        let share = (to - from).dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
        (from + along * share.clamp(0.0, 1.0)).distance(to)
    };
    let pieces = if line.len() == 1 { line.chunks(1) } else { [].chunks(1) };
    pieces.chain(line.windows(2)).map(to_piece).fold(f64::INFINITY, f64::min)
}

impl Drag {
    /// The command that a release would give now; `None` if it would change nothing.
    fn command(&self, around: &Surroundings) -> Option<Command> {
        let object = self.on.object;
        let path = self.path.finished(&mut |at_px| around.hit(at_px).filter(|hit| hit.object == object));
        if self.erases {
            return self.erased(&path, around);
        }
        let touches: Vec<Touch> = if self.farthest_px < CLICK_PX {
            let first = path.pieces().first().and_then(|piece| piece.first())?;
            vec![self.touch(&[*first], &path, around)]
        } else {
            let pieces = path.pieces().iter().filter(|piece| piece.len() > 1);
            pieces.map(|piece| self.touch(piece, &path, around)).collect()
        };
        (!touches.is_empty()).then_some(Command::Touches(Touches::Lay(touches)))
    }

    fn touch(&self, piece: &[PathPoint], path: &SurfacePath, around: &Surroundings) -> Touch {
        let options = around.options;
        let px_per_unit = options.radius_px / path.radius();
        let mut tolerance = (TOLERANCE * options.radius_px).max(LEAST_TOLERANCE_PX) / px_per_unit;
        let mut kept = simplify::within(piece, tolerance);
        while kept.len() > limits::MAX_TOUCH_POINTS {
            tolerance *= 1.5;
            kept = simplify::within(piece, tolerance);
        }
        let short = |value: f64, length: f64| amounts::short(value, length);
        let points = kept.iter().map(|point| TouchPoint {
            at: point.position.to_array().map(|value| short(value, path.radius())),
            normal: point.normal.to_array().map(|value| short(value, 1.0)),
        });
        // The stroke is as wide as the ring. Its width is converted from pixels of the viewport to pixels of the scene.
        let scale = f64::from(around.scene().size.1) / around.view.size_px.y.max(1.0);
        let felt = Felt::of_path(path, options);
        let width_px = (2.0 * options.radius_px * felt.radius * scale)
            .clamp(*limits::TOUCH_WIDTH_PX.start(), *limits::TOUCH_WIDTH_PX.end());
        let width_px = (width_px * 10.0).round() / 10.0;
        let ratio = Touch::USUAL_LENGTH_PX / Touch::USUAL_WIDTH_PX;
        let length_px = (width_px * ratio)
            .round()
            .clamp(*limits::TOUCH_LENGTH_PX.start(), *limits::TOUCH_LENGTH_PX.end());
        Touch {
            width_px,
            length_px: if kept.len() == 1 { length_px } else { Touch::USUAL_LENGTH_PX },
            color: (!options.touch_from_picture).then_some(options.touch_color),
            opacity: felt.strength(options.touch_opacity),
            taper: options.touch_taper,
            ..Touch::new(NAME, self.object.clone(), points.collect())
        }
    }

    /// Erases the touches near the drag. If there are none, thins the strokes there to nothing.
    fn erased(&self, path: &SurfacePath, around: &Surroundings) -> Option<Command> {
        let path = path.clone().narrowed(Felt::of_path(path, around.options).radius);
        let touched = path.stamps_apart(STAMP_SHARE);
        let names = near(around, &self.object, &touched, path.radius());
        if !names.is_empty() {
            return Some(Command::Touches(Touches::Erase(names)));
        }
        let dabs: Vec<AmountDab> =
            amounts::dabs(&path.stamps_apart(amounts::DAB_SHARE), 1.5 * path.radius(), |_| (1.0, 0.0));
        (!dabs.is_empty()).then(|| {
            Command::Amounts(Amounts::Paint {
                region: self.on.target.clone(),
                of: Amount::Density,
                object: self.on.object_name.clone(),
                dabs,
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_near_between_its_points_too() {
        let line = [DVec3::ZERO, DVec3::X * 10.0, DVec3::X * 10.0, DVec3::new(10.0, 2.0, 0.0)];
        let distance = |line: &[DVec3], x: f64, y: f64| distance_to_line(line, DVec3::new(x, y, 0.0));
        assert_eq!(distance(&line, 5.0, 0.5), 0.5);
        assert_eq!(distance(&line, -3.0, 4.0), 5.0);
        assert_eq!(distance(&line, 12.0, 1.0), 2.0);
        assert_eq!(distance(&line[..1], 3.0, 4.0), 5.0);
        assert_eq!(distance(&[], 3.0, 4.0), f64::INFINITY);
    }
}
