//! Moving, turning and scaling: the modal state machine behind G, R, S and the gizmo.
//!
//! `Idle ─G R S─▶ Modal ─X Y Z, digits, movement─▶ preview ─Enter, press─▶ kept`, or `─Esc, right press─▶ back`.

use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3};
use impasto_scene::document::Lens;

use crate::picking::{Ray, View};
use crate::session::Axes;

#[cfg(test)]
mod tests;
mod typed;

use typed::Typed;

/// The kind of a transform.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// Moves (key G).
    Move,
    /// Turns (key R).
    Turn,
    /// Scales (key S).
    Scale,
}

/// One axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Axis {
    /// Drawn in red.
    X,
    /// Drawn in green.
    Y,
    /// Drawn in blue.
    Z,
}

/// The constraint of a transform.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Constraint {
    /// Moves parallel to the picture plane, turns about the camera's axis, scales evenly.
    #[default]
    None,
    /// Along or about one axis.
    Axis(Axis),
    /// Moves or scales in the plane perpendicular to one axis, or turns about that axis.
    Plane(Axis),
}

/// The result of a transform, with axes and factors in [`Transforming::space`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TransformDelta {
    /// A movement along the axes of its space, world units.
    Move(DVec3),
    /// A turn about an axis of its space, counter-clockwise as seen from the tip of the axis.
    Turn {
        /// The axis, a unit vector.
        axis: DVec3,
        /// Radians.
        angle_rad: f64,
    },
    /// A scaling by these factors along the axes of its space.
    Scale(DVec3),
}

/// An event from pointer or keys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TransformEvent {
    /// The pointer moved.
    Move {
        /// Where it is now, pixels.
        at_px: DVec2,
        /// Whether values go in steps, as they do while Ctrl is held.
        snap: Snap,
    },
    /// X, Y or Z.
    Axis(Axis),
    /// Shift with X, Y or Z.
    Plane(Axis),
    /// A digit, `.`, or `-`.
    Typed(char),
    /// Removes the last typed character.
    Backspace,
    /// Keeps the result: Enter, a press or, if a press began the transform, the release of the button.
    Keep,
    /// Cancels the transform: Esc, a right press, or the loss of the window's focus.
    Back,
}

/// Whether values go in steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Snap {
    /// Any value.
    #[default]
    Free,
    /// Multiples of 0.1, or of 5°.
    Steps,
}

/// The result of an event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TransformStep {
    /// The transform goes on; this is its result so far.
    Preview(TransformDelta),
    /// The transform has ended; its result is to be applied as one undo entry. `None` if it changes nothing.
    Kept(Option<TransformDelta>),
    /// Cancelled.
    Back,
}

/// A transform under way.
#[derive(Clone, Debug)]
pub struct Transforming {
    name: String,
    operation: Operation,
    constraint: Constraint,
    space: Axes,
    /// The space that an axis key means when it is pressed for the first time.
    first_space: Axes,
    typed: Typed,
    view: View,
    /// The object's pose when the transform began.
    world_from_model: DAffine3,
    from_px: DVec2,
    at_px: DVec2,
    snap: Snap,
    /// Angle by which the pointer has gone round the pivot, radians, counter-clockwise; not wrapped at whole turns.
    gone_round_rad: f64,
}

/// A pointer nearer to the pivot than this does not turn the object, and scales it as if it were at this distance.
const LEAST_ARM_PX: f64 = 4.0;
/// Steps of snapping: `STEP` for moves (world units) and for scale factors, `STEP_DEG` for turns (degrees).
const STEP: f64 = 0.1;
const STEP_DEG: f64 = 5.0;
/// Factors that scaling stays within.
const FACTORS: std::ops::RangeInclusive<f64> = 1e-3..=1e3;

/// The initial state of a transform.
#[derive(Clone, Debug, PartialEq)]
pub struct TransformStart {
    /// Name of the object, for the status line.
    pub name: String,
    /// Its pose.
    pub world_from_model: DAffine3,
    /// The view.
    pub view: View,
    /// The pointer, pixels.
    pub at_px: DVec2,
    /// The space of the axes, as the options state it.
    pub space: Axes,
}

impl Transforming {
    /// A transform that begins with a key.
    pub fn new(operation: Operation, start: TransformStart) -> Self {
        Self {
            name: start.name,
            operation,
            constraint: Constraint::None,
            space: start.space,
            first_space: start.space,
            typed: Typed::default(),
            view: start.view,
            world_from_model: start.world_from_model,
            from_px: start.at_px,
            at_px: start.at_px,
            snap: Snap::Free,
            gone_round_rad: 0.0,
        }
    }

    /// A transform that begins with a press on a handle of the gizmo.
    pub fn held(operation: Operation, constraint: Constraint, start: TransformStart) -> Self {
        Self { constraint, ..Self::new(operation, start) }
    }

    /// The kind of the transform.
    pub fn operation(&self) -> Operation {
        self.operation
    }

    /// Its constraint.
    pub fn constraint(&self) -> Constraint {
        self.constraint
    }

    /// The space of its delta's axes.
    pub fn space(&self) -> Axes {
        self.space
    }

    /// Takes an event.
    pub fn take(&mut self, event: TransformEvent) -> TransformStep {
        match event {
            TransformEvent::Move { at_px, snap } => {
                if at_px.is_finite() {
                    self.follow(at_px);
                }
                self.snap = snap;
            }
            TransformEvent::Axis(axis) => self.hold(Constraint::Axis(axis)),
            TransformEvent::Plane(axis) => self.hold(Constraint::Plane(axis)),
            TransformEvent::Typed(character) => self.typed.push(character),
            TransformEvent::Backspace => self.typed.pop(),
            TransformEvent::Keep => {
                return TransformStep::Kept(Some(self.delta()).filter(|delta| !delta.is_nothing()));
            }
            TransformEvent::Back => return TransformStep::Back,
        }
        TransformStep::Preview(self.delta())
    }

    /// Its result so far.
    pub fn delta(&self) -> TransformDelta {
        match self.operation {
            Operation::Move => TransformDelta::Move(self.moved()),
            Operation::Turn => {
                let angle_rad = match self.typed.value() {
                    Some(degrees) => degrees.to_radians(),
                    None => self.turned_rad(),
                };
                TransformDelta::Turn { axis: self.turn_axis(), angle_rad }
            }
            Operation::Scale => {
                let factor = self.typed.value().unwrap_or_else(|| self.scaled());
                let factor = if factor.abs() < *FACTORS.start() { *FACTORS.start() } else { factor.abs() };
                let factor = factor.min(*FACTORS.end());
                TransformDelta::Scale(match self.constraint {
                    Constraint::None => DVec3::splat(factor),
                    Constraint::Axis(axis) => DVec3::ONE + axis.unit() * (factor - 1.0),
                    Constraint::Plane(axis) => DVec3::splat(factor) + axis.unit() * (1.0 - factor),
                })
            }
        }
    }

    /// The words of the status line, and its keys.
    pub fn status(&self) -> String {
        let verb = match self.operation {
            Operation::Move => "Move",
            Operation::Turn => "Turn",
            Operation::Scale => "Scale",
        };
        let value = self.value_words();
        format!(
            "{verb} {}  {value}   [X Y Z] axis  [Shift X] plane  type a number  [Enter] keep  [Esc] back",
            self.name
        )
    }

    /// The axes of its space in the world, unit columns.
    pub fn world_from_space(&self) -> DMat3 {
        axes_of(self.space, self.world_from_model, &self.view)
    }

    fn value_words(&self) -> String {
        let space = match (self.constraint, self.space) {
            (Constraint::None, _) | (_, Axes::World) => "",
            (_, Axes::Local) => " local",
            (_, Axes::View) => " view",
        };
        let held = match self.constraint {
            Constraint::None => String::new(),
            Constraint::Axis(axis) => format!("{}{space} ", axis.letter()),
            Constraint::Plane(axis) => {
                let [first, second] = axis.others().map(Axis::letter);
                format!("{first}{second}{space} ")
            }
        };
        if let Some(typed) = self.typed.text() {
            let unit = if self.operation == Operation::Turn { "°" } else { "" };
            return format!("{held}{typed}{unit}");
        }
        match (self.delta(), self.constraint) {
            (TransformDelta::Move(by), Constraint::Axis(axis)) => format!("{held}{:.2}", by[axis.index()]),
            (TransformDelta::Move(by), Constraint::Plane(axis)) => {
                let [first, second] = axis.others();
                format!("{held}{:.2} {:.2}", by[first.index()], by[second.index()])
            }
            (TransformDelta::Move(by), Constraint::None) => {
                format!("X {:.2}  Y {:.2}  Z {:.2}", by.x, by.y, by.z)
            }
            (TransformDelta::Turn { angle_rad, .. }, _) => format!("{held}{:.1}°", angle_rad.to_degrees()),
            (TransformDelta::Scale(by), Constraint::Axis(axis)) => format!("{held}{:.3}", by[axis.index()]),
            (TransformDelta::Scale(by), Constraint::Plane(axis)) => {
                format!("{held}{:.3}", by[axis.others()[0].index()])
            }
            (TransformDelta::Scale(by), Constraint::None) => format!("{:.3}", by.x),
        }
    }

    /// Sets a constraint. Setting the same one again switches to the object's own axes, or to the world's if the
    /// object's came first. Setting it a third time removes it.
    fn hold(&mut self, constraint: Constraint) {
        let other = if self.first_space == Axes::Local { Axes::World } else { Axes::Local };
        if self.constraint != constraint {
            (self.constraint, self.space) = (constraint, self.first_space);
        } else if self.space == self.first_space {
            self.space = other;
        } else {
            (self.constraint, self.space) = (Constraint::None, self.first_space);
        }
    }

    fn follow(&mut self, at_px: DVec2) {
        if let Some(pivot_px) = self.view.project(self.pivot()) {
            let (from, to) = (self.at_px - pivot_px, at_px - pivot_px);
            if from.length() > LEAST_ARM_PX && to.length() > LEAST_ARM_PX {
                // Y goes down in pixels, so `angle_to` is negative for counter-clockwise turns.
                self.gone_round_rad -= from.angle_to(to);
            }
        }
        self.at_px = at_px;
    }

    fn pivot(&self) -> DVec3 {
        self.world_from_model.translation
    }

    /// The movement so far along the axes of its space, world units.
    fn moved(&self) -> DVec3 {
        let axes = self.world_from_space();
        if let Some(value) = self.typed.value() {
            return match self.constraint {
                Constraint::Axis(axis) => axis.unit() * value,
                // A typed number moves along one axis: the first free one.
                Constraint::None => DVec3::X * value,
                Constraint::Plane(axis) => axis.others()[0].unit() * value,
            };
        }
        let pivot = self.pivot();
        let [from, to] = [self.from_px, self.at_px].map(|at_px| self.view.ray(at_px));
        let in_world = match self.constraint {
            Constraint::None => {
                self.view.at_depth_of(self.at_px, pivot) - self.view.at_depth_of(self.from_px, pivot)
            }
            Constraint::Axis(axis) => {
                let along = axes * axis.unit();
                along * (self.along_axis(self.at_px, along) - self.along_axis(self.from_px, along))
            }
            Constraint::Plane(axis) => {
                let normal = axes * axis.unit();
                let meet = |ray: &Ray| {
                    let slope = ray.direction.dot(normal);
                    let distance = (pivot - ray.origin).dot(normal) / slope;
                    (slope.abs() > 1e-3 && distance > 0.0).then(|| ray.origin + ray.direction * distance)
                };
                // In a plane that is seen edge-on, a drag moves nothing.
                meet(&from).zip(meet(&to)).map_or(DVec3::ZERO, |(from, to)| to - from)
            }
        };
        let by = axes.transpose() * in_world;
        let by = match self.constraint {
            Constraint::Axis(axis) => by * axis.unit(),
            Constraint::Plane(axis) => by * (DVec3::ONE - axis.unit()),
            Constraint::None => by,
        };
        if self.snap == Snap::Steps { (by / STEP).round() * STEP } else { by }
    }

    /// Of all points of an axis through the pivot, finds the one that appears nearest to a pixel. Returns its position
    /// along the axis, in world units from the pivot. 0 if the axis points at the eye, or the pivot has no projection.
    fn along_axis(&self, at_px: DVec2, along: DVec3) -> f64 {
        let [jx, jy] = self.view.map(DAffine3::IDENTITY).jacobian(self.pivot());
        let shown = DVec2::new(jx.dot(along), -jy.dot(along));
        let Some(pivot_px) = self.view.project(self.pivot()) else { return 0.0 };
        // An axis that points straight at the eye shows as a point, so nothing can be dragged along it.
        let size = self.view.px_per_unit(self.pivot());
        if shown.length() < 0.02 * size {
            return 0.0;
        }
        let on_axis_px = pivot_px + (at_px - pivot_px).project_onto(shown);
        let ray = self.view.ray(on_axis_px);
        // The point of the axis that is nearest to the ray.
        let between = self.pivot() - ray.origin;
        let cosine = ray.direction.dot(along);
        (cosine * between.dot(ray.direction) - between.dot(along)) / (1.0 - cosine * cosine)
    }

    /// The axis of a turn, in its space, unit.
    fn turn_axis(&self) -> DVec3 {
        match self.constraint {
            Constraint::Axis(axis) | Constraint::Plane(axis) => axis.unit(),
            Constraint::None => {
                (self.world_from_space().transpose() * -self.view.axes()[2]).normalize_or(DVec3::Z)
            }
        }
    }

    fn turned_rad(&self) -> f64 {
        let towards_eye = match self.view.camera.lens {
            Lens::Perspective { .. } => self.view.camera.eye - self.pivot(),
            Lens::Orthographic { .. } => -self.view.axes()[2],
        };
        // A turn about an axis that points away from the eye appears reversed on the screen.
        let away = (self.world_from_space() * self.turn_axis()).dot(towards_eye) < 0.0;
        let angle_rad = if away { -self.gone_round_rad } else { self.gone_round_rad };
        if self.snap == Snap::Steps {
            ((angle_rad.to_degrees() / STEP_DEG).round() * STEP_DEG).to_radians()
        } else {
            angle_rad
        }
    }

    fn scaled(&self) -> f64 {
        let Some(pivot_px) = self.view.project(self.pivot()) else { return 1.0 };
        let (from, to) = (self.from_px.distance(pivot_px), self.at_px.distance(pivot_px));
        let factor = to.max(LEAST_ARM_PX) / from.max(LEAST_ARM_PX);
        if self.snap == Snap::Steps { (factor / STEP).round().max(1.0) * STEP } else { factor }
    }
}

impl TransformDelta {
    /// Whether it changes nothing.
    pub fn is_nothing(&self) -> bool {
        match *self {
            Self::Move(by) => by == DVec3::ZERO,
            Self::Turn { angle_rad, .. } => angle_rad == 0.0,
            Self::Scale(by) => by == DVec3::ONE,
        }
    }

    /// Maps each point of the world to its place after the transform. Turns and scalings are about `pivot`. The columns
    /// of `world_from_space` are the axes of the delta. Commands on poses cannot take the matrix of an uneven scaling;
    /// `Arrange::Stretch` takes its factors instead.
    pub fn world_from_world(&self, pivot: DVec3, world_from_space: DMat3) -> DAffine3 {
        let about_pivot = |linear: DMat3| DAffine3::from_mat3_translation(linear, pivot - linear * pivot);
        match *self {
            Self::Move(by) => DAffine3::from_translation(world_from_space * by),
            Self::Turn { axis, angle_rad } => {
                let axis = (world_from_space * axis).normalize_or(DVec3::Y);
                about_pivot(DMat3::from_quat(DQuat::from_axis_angle(axis, angle_rad)))
            }
            // An even scaling is the same in any space. Without the axes the result is exact.
            Self::Scale(by) if by == DVec3::splat(by.x) => about_pivot(DMat3::from_diagonal(by)),
            Self::Scale(by) => {
                about_pivot(world_from_space * DMat3::from_diagonal(by) * world_from_space.transpose())
            }
        }
    }
}

/// The axes of a space in the world, unit columns, for an object at a pose in a view.
pub fn axes_of(space: Axes, world_from_model: DAffine3, view: &View) -> DMat3 {
    match space {
        Axes::World => DMat3::IDENTITY,
        Axes::Local => {
            let [x, y, z] = world_from_model.matrix3.to_cols_array_2d().map(DVec3::from);
            DMat3::from_cols(x.normalize_or(DVec3::X), y.normalize_or(DVec3::Y), z.normalize_or(DVec3::Z))
        }
        Axes::View => {
            let [right, up, gaze] = view.axes();
            DMat3::from_cols(right, up, -gaze)
        }
    }
}

impl Axis {
    /// All three.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// The unit vector along it.
    pub fn unit(self) -> DVec3 {
        [DVec3::X, DVec3::Y, DVec3::Z][self.index()]
    }

    /// Its letter, always shown beside its colour.
    pub fn letter(self) -> char {
        ['X', 'Y', 'Z'][self.index()]
    }

    /// The other two, in their order.
    pub fn others(self) -> [Self; 2] {
        match self {
            Self::X => [Self::Y, Self::Z],
            Self::Y => [Self::X, Self::Z],
            Self::Z => [Self::X, Self::Y],
        }
    }

    pub(crate) fn index(self) -> usize {
        self as usize
    }
}
