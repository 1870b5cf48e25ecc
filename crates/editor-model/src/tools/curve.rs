//! The guide curve tool: draws curves point by point, and edits existing ones by their handles.
//!
//! `Idle ─press─▶ Drawing ─press─▶ one more point ─Enter, double press, press on the last point─▶ one guide`;
//! `Idle ─press on a handle─▶ Dragging`.

use glam::{DMat3, DVec2, DVec3};
use impasto_scene::document::{Falloff, Guide, GuideMode, GuidePoint, Object};

use super::brush::{mirror_axes, radius_at};
use super::{Paintable, Surroundings, ToolEvent, ToolOutput, waiting_words};
use crate::command::{Command, Directions, Gesture, GuideSettings};
use crate::gizmo::off_px;
use crate::keymap::{Action, Modifiers};
use crate::path::{PathPoint, mirrored, simplify};
use crate::picking::Hit;
use crate::refusal::Refusal;
use crate::selection::Item;
use crate::session::Tool;

mod spline;

/// Distances within which the pointer is on a handle, on a line, and on the arrow beyond its end. A press within
/// `ARROW_PX` of the last point also ends a curve.
const HANDLE_PX: f64 = 12.0;
const LINE_PX: f64 = 6.0;
const ARROW_PX: f64 = 8.0;
/// The middle of the place where the arrow is gripped lies this far beyond the last point.
const ARROW_OUT_PX: f64 = 16.0;
/// A second press within this time and distance ends a curve.
const DOUBLE_SECS: f64 = 0.4;
const DOUBLE_PX: f64 = 4.0;
/// A press on a handle is a click until the pointer has moved this far.
const CLICK_PX: f64 = 3.0;
/// A guide keeps only some points of the drawn curve. The line through them may be this far from the curve, as a share
/// of the radius.
const TOLERANCE: f64 = 0.05;

#[derive(Clone, Debug, Default)]
pub(super) struct Curve {
    state: State,
    at_px: Option<DVec2>,
}

#[derive(Clone, Debug, Default)]
enum State {
    #[default]
    Idle,
    Drawing(Drawing),
    Dragging(Dragging),
}

#[derive(Clone, Debug)]
struct Drawing {
    on: Paintable,
    points: Vec<PathPoint>,
    /// Model units.
    radius: f64,
    pressed_secs: f64,
}

#[derive(Clone, Debug)]
struct Dragging {
    grip: Grip,
    from_px: DVec2,
    /// `None` until the pointer has moved. If a line is gripped, the press already sets the command.
    command: Option<Box<Command>>,
}

/// The part of a guide that is gripped.
#[derive(Clone, Debug, PartialEq)]
struct Grip {
    /// The region's name, and the guide's index in it.
    guide: (String, usize),
    object: usize,
    on: GripOn,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum GripOn {
    Point(usize),
    /// The piece of the line before the point with this index.
    Line(usize),
    Arrow,
    /// A point that was pressed with Alt: dragging it changes the radius.
    Radius(usize),
}

impl Curve {
    pub(super) fn is_busy(&self) -> bool {
        !matches!(self.state, State::Idle)
    }

    pub(super) fn take(&mut self, event: &ToolEvent, around: &Surroundings) -> ToolOutput {
        match *event {
            ToolEvent::Hover { at_px, .. } => {
                self.at_px = Some(at_px);
                self.shown(around)
            }
            ToolEvent::Press { at_px, at_secs, held, .. } => {
                self.at_px = Some(at_px);
                self.press(at_px, at_secs, held, around)
            }
            ToolEvent::Move { at_px, .. } => {
                self.at_px = Some(at_px);
                if let State::Dragging(dragging) = &mut self.state {
                    dragging.follow(at_px, around);
                }
                self.shown(around)
            }
            ToolEvent::Release { .. } => match std::mem::take(&mut self.state) {
                State::Dragging(dragging) => {
                    let select = Item::Guide(dragging.grip.guide.0.clone(), dragging.grip.guide.1);
                    ToolOutput {
                        commit: dragging.command.map(|command| *command),
                        select: Some(select),
                        ..self.shown(around)
                    }
                }
                other => {
                    self.state = other;
                    self.shown(around)
                }
            },
            ToolEvent::Key(Action::Confirm) => self.finish(around),
            ToolEvent::Key(Action::TakeBack) if matches!(self.state, State::Drawing(_)) => {
                if let State::Drawing(drawing) = &mut self.state {
                    drawing.points.pop();
                    if drawing.points.is_empty() {
                        self.state = State::Idle;
                    }
                }
                self.shown(around)
            }
            ToolEvent::Key(Action::Delete) if matches!(self.state, State::Idle) => {
                let grip = self.at_px.and_then(|at_px| grip(at_px, around));
                let commit = grip.and_then(|grip| match grip.on {
                    GripOn::Point(point) | GripOn::Radius(point) => {
                        Some(Command::Directions(Directions::DeleteGuidePoint { guide: grip.guide, point }))
                    }
                    GripOn::Line(_) | GripOn::Arrow => None,
                });
                ToolOutput { commit, ..self.shown(around) }
            }
            ToolEvent::Cancel | ToolEvent::FocusLost | ToolEvent::Key(Action::Cancel) => {
                self.state = State::Idle;
                self.shown(around)
            }
            ToolEvent::Key(_) => self.shown(around),
        }
    }

    fn press(&mut self, at_px: DVec2, at_secs: f64, held: Modifiers, around: &Surroundings) -> ToolOutput {
        match &mut self.state {
            State::Drawing(drawing) => {
                let last_px = drawing.points.last().map_or(at_px, |point| point.at_px);
                let double =
                    at_secs - drawing.pressed_secs <= DOUBLE_SECS && last_px.distance(at_px) <= DOUBLE_PX;
                let ends = drawing.points.len() >= 2 && last_px.distance(at_px) <= ARROW_PX;
                drawing.pressed_secs = at_secs;
                if double || ends {
                    return self.finish(around);
                }
                match around.hit(at_px).filter(|hit| hit.object == drawing.on.object) {
                    Some(hit) => drawing.add(place(at_px, &hit)),
                    None => {
                        let name = around.object(drawing.on.object).map_or("", |object| object.name.as_str());
                        let refusal =
                            Refusal::new(format!("The curve is on {name}: its points must lie there"));
                        return ToolOutput { refusal: Some(refusal), ..self.shown(around) };
                    }
                }
            }
            State::Dragging(_) => {}
            State::Idle => {
                if let Some(found) = grip(at_px, around) {
                    return self.hold(found, at_px, held, around);
                }
                let hit = around.hit(at_px);
                match (around.paintable(hit.as_ref()), hit) {
                    (Ok(on), Some(hit)) => {
                        let (points, radius) = (vec![place(at_px, &hit)], radius_at(&hit, around));
                        self.state = State::Drawing(Drawing { on, points, radius, pressed_secs: at_secs });
                    }
                    (Err(refusal), _) => return ToolOutput::refusing(refusal),
                    (Ok(_), None) => {}
                }
            }
        }
        self.shown(around)
    }

    /// Handles a press on an existing guide.
    fn hold(&mut self, mut grip: Grip, at_px: DVec2, held: Modifiers, around: &Surroundings) -> ToolOutput {
        let region = around.scene().regions.iter().find(|region| region.name == grip.guide.0);
        if region.is_some_and(|region| region.locked) {
            return ToolOutput::refusing(Refusal::new(format!("{} is locked", grip.guide.0)));
        }
        match grip.on {
            GripOn::Arrow => {
                let (region, index) = grip.guide;
                let commit = Some(Command::Directions(Directions::FlipGuide(region, index)));
                return ToolOutput { commit, ..self.shown(around) };
            }
            GripOn::Point(point) if held.alt => grip.on = GripOn::Radius(point),
            _ => {}
        }
        let mut dragging = Dragging { grip, from_px: at_px, command: None };
        if matches!(dragging.grip.on, GripOn::Line(_)) {
            // Even a click without a drag inserts a point into a line.
            dragging.command = dragging.command_at(at_px, around).map(Box::new);
        }
        self.state = State::Dragging(dragging);
        self.shown(around)
    }

    fn finish(&mut self, around: &Surroundings) -> ToolOutput {
        let State::Drawing(drawing) = std::mem::take(&mut self.state) else { return self.shown(around) };
        ToolOutput { commit: drawing.command(&drawing.points, around), ..self.shown(around) }
    }

    fn shown(&self, around: &Surroundings) -> ToolOutput {
        let words = waiting_words(Tool::GuideCurve, around.options, "");
        match &self.state {
            State::Drawing(drawing) => {
                let next = self.at_px.and_then(|at_px| {
                    let hit = around.hit(at_px).filter(|hit| hit.object == drawing.on.object)?;
                    Some(place(at_px, &hit))
                });
                let mut growing = drawing.clone();
                if let Some(next) = next {
                    growing.add(next);
                }
                let points = growing.points;
                let curve = drawing.curve(&points, around);
                ToolOutput {
                    preview: drawing.command(&points, around),
                    line_px: curve.iter().map(|point| point.at_px).collect(),
                    handles_px: drawing.points.iter().map(|point| point.at_px).collect(),
                    ..ToolOutput::saying(words)
                }
            }
            State::Dragging(dragging) => {
                let words = format!("Dragging a point of {}   [Esc] take it back", dragging.grip.guide.0);
                ToolOutput { preview: dragging.command.as_deref().cloned(), ..ToolOutput::saying(words) }
            }
            State::Idle => {
                let found = self.at_px.and_then(|at_px| grip(at_px, around));
                let guide = found.as_ref().and_then(|found| {
                    let region = around.scene().regions.iter().find(|region| region.name == found.guide.0)?;
                    Some((region.guides.get(found.guide.1)?, found.object))
                });
                let line_px = guide.map_or_else(Vec::new, |(guide, object)| line_px(guide, object, around));
                let selected = found.as_ref().is_some_and(|found| {
                    around.selection.contains(&Item::Guide(found.guide.0.clone(), found.guide.1))
                });
                let handles_px = if selected { line_px.clone() } else { Vec::new() };
                let words = match found.map(|found| found.on) {
                    Some(GripOn::Point(_) | GripOn::Radius(_)) => {
                        "[Drag] move the point  [Alt] radius  [Delete] take it out".to_owned()
                    }
                    Some(GripOn::Line(_)) => "[Click] add a point to this curve".to_owned(),
                    Some(GripOn::Arrow) => "[Click] flip this curve".to_owned(),
                    None => words,
                };
                ToolOutput { line_px, handles_px, ..ToolOutput::saying(words) }
            }
        }
    }
}

impl Drawing {
    /// Adds a point, unless it is where the last one is.
    fn add(&mut self, point: PathPoint) {
        if self.points.last().is_none_or(|last| last.at_px.distance(point.at_px) >= 1.0) {
            self.points.push(point);
        }
    }

    /// The curve through `points`, sampled and laid onto the surface.
    fn curve(&self, points: &[PathPoint], around: &Surroundings) -> Vec<PathPoint> {
        spline::through(points, self.radius * 0.25, &mut |at, normal| {
            let found = around.picker.closest_on_surface(self.on.object, at, normal, self.radius);
            let (position, normal) = found.map_or((at, normal), |found| (found.position, found.normal));
            let at_px = around.view.project(around.world(self.on.object, position)).unwrap_or_default();
            PathPoint { at_px, position, normal, pressure: 1.0 }
        })
    }

    fn command(&self, points: &[PathPoint], around: &Surroundings) -> Option<Command> {
        if points.len() < 2 {
            return None;
        }
        let curve = self.curve(points, around);
        let kept = simplify::within(&curve, self.radius * TOLERANCE);
        let [seen, reference] = around.views(self.on.object, self.on.region);
        let own = Guide {
            mode: GuideMode::Comb,
            curve: true,
            object: self.on.object_name.clone(),
            view: seen.guide_view(&reference, curve[curve.len() / 2].position),
            points: kept.iter().map(|point| point.guide_point()).collect(),
            radius: self.radius,
            strength: around.options.strength,
            falloff: if around.options.even { Falloff::Flat } else { Falloff::Smooth },
        };
        let mut nearest =
            |at, facing, farthest| around.picker.closest_on_surface(self.on.object, at, facing, farthest);
        let flips = mirror_axes(around).flips().into_iter();
        let images: Vec<Guide> =
            flips.flat_map(|flip| mirrored(&own, flip, &seen, &reference, &mut nearest)).collect();
        // The curve itself comes last in the list, after its mirror images, because the last guide gets selected.
        let guides = images.into_iter().chain([own]).collect();
        let region = self.on.target.clone();
        Some(Command::Directions(Directions::Stroke { region, gesture: Gesture::Curve, guides }))
    }
}

impl Dragging {
    fn follow(&mut self, at_px: DVec2, around: &Surroundings) {
        let clicked = self.command.is_none() && at_px.distance(self.from_px) < CLICK_PX;
        if !clicked && let Some(command) = self.command_at(at_px, around) {
            self.command = Some(Box::new(command));
        }
    }

    /// The command that the drag gives with the pointer at `at_px`; `None` where the pointer is off the object.
    fn command_at(&self, at_px: DVec2, around: &Surroundings) -> Option<Command> {
        let Grip { guide, object, on } = &self.grip;
        let region = around.scene().regions.iter().find(|region| region.name == guide.0)?;
        let points = &region.guides.get(guide.1)?.points;
        let guide = guide.clone();
        let here = |turn_deg: f64| {
            let hit = around.hit(at_px).filter(|hit| hit.object == *object)?;
            let [at, normal] = [hit.position_in_model, hit.normal_in_model].map(|v| v.to_array());
            Some(GuidePoint { at, normal, turn_deg })
        };
        Some(Command::Directions(match *on {
            GripOn::Point(point) => {
                Directions::MoveGuidePoint { guide, point, to: here(points.get(point)?.turn_deg)? }
            }
            GripOn::Line(point) => Directions::InsertGuidePoint { guide, point, at: here(0.0)? },
            GripOn::Radius(point) => {
                let middle = around.world(*object, DVec3::from(points.get(point)?.at));
                let scale = crate::picking::world_units_per_model_unit(around.pose(*object));
                let radius_px = around.view.project(middle)?.distance(at_px).max(1.0);
                let radius = Some(radius_px / (around.view.px_per_unit(middle) * scale));
                Directions::SetGuide { guide, settings: GuideSettings { radius, ..Default::default() } }
            }
            GripOn::Arrow => return None,
        }))
    }
}

fn place(at_px: DVec2, hit: &Hit) -> PathPoint {
    PathPoint::new(at_px, hit, 1.0)
}

/// The part of a guide that the pointer is on. Only guides of the selected region count, and only parts that face the
/// eye.
fn grip(at_px: DVec2, around: &Surroundings) -> Option<Grip> {
    let region = around.scene().regions.get(around.selected_region()?)?;
    let mut best: Option<(u8, f64, Grip)> = None;
    for (index, guide) in region.guides.iter().enumerate() {
        let name = guide.object.as_deref().or(region.on.object());
        let is_named = |object: &Object| Some(object.name.as_str()) == name;
        let Some(object) = around.scene().objects.iter().position(is_named) else { continue };
        let line = line_px(guide, object, around);
        if line.len() != guide.points.len() {
            continue;
        }
        let faces = |point: usize| facing(&guide.points[point], object, around);
        let last = line.len() - 1;
        let points = (0..=last)
            .filter(|&point| faces(point))
            .map(|point| (0, line[point].distance(at_px) - HANDLE_PX, GripOn::Point(point)));
        let lines = (0..last)
            .filter(|&piece| faces(piece) || faces(piece + 1))
            .map(|piece| (2, off_px(at_px, line[piece], line[piece + 1]) - LINE_PX, GripOn::Line(piece + 1)));
        let out = (line[last] - line[last.saturating_sub(1)]).normalize_or_zero() * ARROW_OUT_PX;
        let arrow = (1, (line[last] + out).distance(at_px) - ARROW_PX, GripOn::Arrow);
        for (rank, gap, on) in points.chain(lines).chain(faces(last).then_some(arrow)) {
            let nearer = best.as_ref().is_none_or(|(least, near, _)| (rank, gap) < (*least, *near));
            if gap <= 0.0 && nearer {
                best = Some((rank, gap, Grip { guide: (region.name.clone(), index), object, on }));
            }
        }
    }
    best.map(|(.., grip)| grip)
}

fn line_px(guide: &Guide, object: usize, around: &Surroundings) -> Vec<DVec2> {
    let shown = |point: &GuidePoint| around.view.project(around.world(object, DVec3::from(point.at)));
    guide.points.iter().filter_map(shown).collect()
}

fn facing(point: &GuidePoint, object: usize, around: &Surroundings) -> bool {
    let now_from_rest = around.now_from_rest(object, DVec3::from(point.at));
    let at = now_from_rest.transform_point3(DVec3::from(point.at));
    // The normal is transformed by the cofactor matrix. A matrix that flattens the body has one, but no inverse.
    let DMat3 { x_axis, y_axis, z_axis } = now_from_rest.matrix3;
    let cofactors = DMat3::from_cols(y_axis.cross(z_axis), z_axis.cross(x_axis), x_axis.cross(y_axis));
    let normal = cofactors * DVec3::from(point.normal);
    around.view.project(at).is_some_and(|at_px| around.view.ray(at_px).direction.dot(normal) < 0.0)
}
