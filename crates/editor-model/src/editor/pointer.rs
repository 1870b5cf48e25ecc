//! Pointer events over the viewport: navigation, selection, dragging, and the tools of Paint.

use glam::{DVec2, DVec3};
use impasto_scene::built_in_mesh::is_built_in;

use super::painted::PaintedView;
use super::{Busy, Editor, Request};
use crate::camera_rig::{FreeView, Looking};
use crate::command::{Arrange, Command, Pose, Time};
use crate::keymap::{Button, Modifiers, Navigation};
use crate::picking::View;
use crate::selection::{Item, Selection};
use crate::session::{Mode, Tool};
use crate::timeline::KeysEvent;
use crate::tools::{Painted as _, REST_SECS, Surroundings, ToolEvent, ToolOutput};
use crate::transform::{Operation, Snap, TransformEvent};

/// A drag of an object or a light begins after this many pixels. A right press that moves less asks for a menu.
const DRAG_PX: f64 = 4.0;

/// A zooming drag of this many pixels counts as one step of the wheel.
const ZOOM_PX_PER_STEP: f64 = 60.0;

/// The kind of a pointer event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PointerKind {
    /// The pointer moves, with or without a button down.
    Move,
    /// A button goes down.
    Press(Button),
    /// A button goes up.
    Release(Button),
    /// The wheel turns by this many steps; positive is towards the screen.
    Wheel(f64),
    /// The pointer leaves the viewport.
    Leave,
}

/// One event of the pointer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointerEvent {
    /// What the pointer does.
    pub kind: PointerKind,
    /// Where, from the viewport's upper left corner, Y down. Here and in [`View`], `px` means logical pixels (points).
    pub at_px: DVec2,
    /// The modifiers that are held.
    pub held: Modifiers,
    /// When, in seconds on any clock.
    pub at_secs: f64,
    /// How hard a pen presses, 0..=1; 1 without a pen. For a release, the greatest pressure since the press.
    pub pressure: f64,
}

/// Turns the pressure that a driver reports into one that tools can use: finite, and in 0..=1.
fn sound(pressure: f64) -> f64 {
    if pressure.is_finite() { pressure.clamp(0.0, 1.0) } else { 1.0 }
}

impl Editor {
    /// Takes an event of the pointer over the viewport.
    pub fn pointer(&mut self, event: &PointerEvent, view: &View) {
        if !event.at_px.is_finite() {
            return;
        }
        // A mouse always reports full pressure. A pen reports less, even while it hovers.
        self.session.has_pen |= event.pressure < 1.0;
        let before_px = self.pointer_px.unwrap_or(event.at_px);
        (self.held, self.at_secs) = (event.held, event.at_secs);
        (self.moved_secs, self.has_rested) = (event.at_secs, false);
        self.pointer_px = (event.kind != PointerKind::Leave).then_some(event.at_px);
        match event.kind {
            PointerKind::Move => self.moved(event, event.at_px - before_px, view),
            PointerKind::Press(button) => self.pressed(button, event, view),
            PointerKind::Release(button) => self.released(button, event, view),
            PointerKind::Wheel(steps) => self.zoom(steps, event.at_px, view),
            PointerKind::Leave => {
                if matches!(self.busy, Busy::Idle) {
                    self.output = ToolOutput { status: self.output.status.clone(), ..ToolOutput::default() };
                }
            }
        }
    }

    /// To be called as time passes without pointer events. Once the pointer rests, the tool of Paint shows its label
    /// and hides its stroke preview. `at_secs` is on the clock of the pointer's events.
    pub fn rested(&mut self, at_secs: f64, view: &View) {
        let waits = matches!(self.busy, Busy::Idle)
            && self.session.mode == Mode::Paint
            && self.pointer_px.is_some()
            && !self.hand.is_busy();
        if waits && self.moved_secs + REST_SECS <= at_secs && !self.has_rested {
            self.at_secs = at_secs;
            self.hover_again(view);
            self.has_rested = true;
        }
    }

    fn moved(&mut self, event: &PointerEvent, delta_px: DVec2, view: &View) {
        match &mut self.busy {
            Busy::Idle => {
                if self.session.mode == Mode::Paint {
                    self.tool(ToolEvent::Hover { at_px: event.at_px, at_secs: event.at_secs }, view);
                }
            }
            Busy::Navigating(way, about) => {
                let (way, about) = (*way, *about);
                let shot = self.shot();
                navigate(self.looking.free(&shot), way, about, delta_px, view);
            }
            Busy::Shot(_) | Busy::ShotView(..) if delta_px == DVec2::ZERO => {}
            Busy::ShotView(way, about, pose) => {
                let mut free = FreeView::new(pose.clone());
                navigate(&mut free, *way, *about, delta_px, view);
                *pose = free.pose().clone();
            }
            Busy::Shot(pose) => {
                let mut free = FreeView::new(pose.clone());
                free.orbit(delta_px, pose.target);
                *pose = free.pose().clone();
            }
            Busy::Painting => {
                let PointerEvent { at_px, at_secs, held, pressure, .. } = *event;
                let event = ToolEvent::Move { at_px, at_secs, held, pressure: sound(pressure) };
                self.tool(event, view);
            }
            Busy::Pressed(from_px) => {
                if from_px.distance(event.at_px) >= DRAG_PX {
                    let from_px = *from_px;
                    self.busy = Busy::Idle;
                    let operation = match self.session.tool() {
                        _ if self.active_light().is_some() => Operation::Move,
                        Tool::Turn => Operation::Turn,
                        Tool::Scale => Operation::Scale,
                        _ => Operation::Move,
                    };
                    if self.begin_transform(operation, None, from_px, true, view) {
                        self.moved(event, DVec2::ZERO, view);
                    }
                }
            }
            Busy::Transforming(_) => {
                let snap =
                    if event.held.ctrl != self.session.options.snap { Snap::Steps } else { Snap::Free };
                self.transform(TransformEvent::Move { at_px: event.at_px, snap }, view);
            }
        }
    }

    fn pressed(&mut self, button: Button, event: &PointerEvent, view: &View) {
        self.time.keys.take(KeysEvent::Blur, &[]);
        match (&self.busy, button) {
            (Busy::Transforming(_), Button::Left) => return self.transform(TransformEvent::Keep, view),
            (Busy::Idle, _) => {}
            (_, Button::Right) => return self.cancel(view),
            _ => return,
        }
        if button == Button::Right && self.hand.is_busy() {
            return self.cancel(view);
        }
        if let Some(way) = self.keymap.navigation(button, event.held) {
            let about = self.turns_about(event.at_px, view);
            self.busy = match self.keys_the_shot() {
                true => Busy::ShotView(way, about, self.shot()),
                false => Busy::Navigating(way, about),
            };
            return;
        }
        if button != Button::Left {
            self.right_px = (button == Button::Right).then_some(event.at_px);
            return;
        }
        match (self.session.mode, self.session.tool()) {
            (Mode::Paint, _) => {
                let PointerEvent { at_px, at_secs, held, pressure, .. } = *event;
                let press = ToolEvent::Press { at_px, at_secs, held, pressure: sound(pressure) };
                self.busy = Busy::Painting;
                self.tool(press, view);
                if self.output.refusal.is_some() {
                    self.busy = Busy::Idle;
                }
            }
            (_, Tool::AddLight) => self.add_light(event.at_px, view),
            (_, Tool::ShotCamera) => self.busy = Busy::Shot(self.shot()),
            _ => self.press_on_object(event, view),
        }
    }

    fn press_on_object(&mut self, event: &PointerEvent, view: &View) {
        let handle = self.gizmo(view).and_then(|gizmo| gizmo.hit(event.at_px).cloned());
        if let Some(handle) = handle {
            let (operation, constraint) = (handle.operation, Some(handle.constraint));
            self.begin_transform(operation, constraint, event.at_px, true, view);
            return;
        }
        let Some(item) = self.item_at(event.at_px, view) else {
            if !event.held.shift {
                self.document.select(Selection::default());
            }
            return;
        };
        let mut selection = self.document.selection().clone();
        if event.held.shift || event.held.ctrl {
            selection.toggle(item.clone());
        } else if selection.active() != Some(&item) {
            selection = Selection::only(item.clone());
        }
        // A drag that slightly misses its object must not move the floor or the wall behind it: only handles and keys
        // move scenery.
        let is_scenery = match &item {
            Item::Object(name) => self.is_scenery(name),
            _ => false,
        };
        self.document.select(selection);
        self.busy = if is_scenery { Busy::Idle } else { Busy::Pressed(event.at_px) };
    }

    /// The light or object under the pointer.
    fn item_at(&self, at_px: DVec2, view: &View) -> Option<Item> {
        let object = || {
            let hit = self.hit(at_px, view)?;
            Some(Item::Object(self.document.shown().scene.objects[hit.object].name.clone()))
        };
        // The icons of lights are drawn over everything.
        self.light_at(at_px, view).or_else(object)
    }

    fn region_at(&self, at_px: DVec2, view: &View) -> Option<Item> {
        let hit = self.hit(at_px, view)?;
        let painted =
            PaintedView { painting: self.painting.as_ref(), camera: &view.camera, frame: self.session.frame };
        let region = painted.region_at(&hit)?;
        Some(Item::Region(self.document.shown().scene.regions.get(region)?.name.clone()))
    }

    /// Selects the thing under the pointer, and asks for its menu. In Paint this is the region, if there is one. In all
    /// other cases it is the light or object.
    fn ask_for_menu(&mut self, at_px: DVec2, view: &View) {
        let region = || self.region_at(at_px, view).filter(|_| self.session.mode == Mode::Paint);
        let item = region().or_else(|| self.item_at(at_px, view));
        if let Some(item) = &item
            && !self.document.selection().contains(item)
        {
            self.document.select(Selection::only(item.clone()));
        }
        self.requests.push(Request::Menu(item));
    }

    /// Whether an object has a built-in mesh, like the floor and the wall of a new scene.
    fn is_scenery(&self, name: &str) -> bool {
        let object = self.document.scene().objects.iter().find(|object| object.name == name);
        object.is_some_and(|object| is_built_in(&object.mesh))
    }

    fn released(&mut self, button: Button, event: &PointerEvent, view: &View) {
        if button == Button::Right
            && let Some(from_px) = self.right_px.take()
            && matches!(self.busy, Busy::Idle)
            && from_px.distance(event.at_px) < DRAG_PX
        {
            return self.ask_for_menu(event.at_px, view);
        }
        match &self.busy {
            Busy::Navigating(..) => self.busy = Busy::Idle,
            Busy::Pressed(_) if button == Button::Left => self.busy = Busy::Idle,
            Busy::Shot(pose) if button == Button::Left => {
                let pose = pose.clone();
                self.busy = Busy::Idle;
                // A click moves nothing.
                if pose != self.shot() {
                    self.place_shot(pose);
                }
            }
            Busy::ShotView(_, _, pose) => {
                let pose = pose.clone();
                self.busy = Busy::Idle;
                if pose != self.shot() {
                    self.place_shot(pose);
                }
            }
            Busy::Painting if button == Button::Left => {
                self.busy = Busy::Idle;
                self.tool(ToolEvent::Release { pressure: sound(event.pressure) }, view);
                // Shows the ring at the pointer again.
                self.hover_again(view);
            }
            Busy::Transforming(drag) if drag.held && button == Button::Left => {
                self.transform(TransformEvent::Keep, view);
            }
            _ => {}
        }
    }

    fn zoom(&mut self, steps: f64, at_px: DVec2, view: &View) {
        let toward = self
            .model_at(at_px, view)
            .unwrap_or_else(|| view.at_depth_of(at_px, self.subject(view).unwrap_or(self.camera().target)));
        let shot = self.shot();
        if self.keys_the_shot() {
            let mut free = FreeView::new(shot);
            free.zoom(steps, toward);
            let pose = Pose::Camera(free.pose().clone());
            let (command, now) = (Command::Time(Time::PoseAtFrame(pose, self.session.frame)), self.at_secs);
            self.run_merged(&command, "zoom the shot", now);
            return;
        }
        self.looking.free(&shot).zoom(steps, toward);
    }

    /// Whether moving the view moves the shot's camera.
    fn keys_the_shot(&self) -> bool {
        self.session.mode == Mode::Animate && self.session.lock_to_view && self.looking == Looking::Shot
    }

    /// The point that a drag turns the view about: the model's surface under the pointer, or else the subject, or else
    /// a point at the depth of the camera's target.
    fn turns_about(&self, at_px: DVec2, view: &View) -> DVec3 {
        let there = self.model_at(at_px, view).or_else(|| self.subject(view));
        there.unwrap_or_else(|| view.at_depth_of(at_px, self.camera().target))
    }

    /// The point of a surface under the pointer. `None` for a built-in backdrop: a user who points at it means the
    /// models in front of it.
    fn model_at(&self, at_px: DVec2, view: &View) -> Option<DVec3> {
        let hit = self.hit(at_px, view)?;
        let object = self.document.shown().scene.objects.get(hit.object)?;
        (!is_built_in(&object.mesh)).then_some(hit.position_in_world)
    }

    /// The middle of the selected model, or else of all models; `None` if that middle is not in the picture.
    fn subject(&self, view: &View) -> Option<DVec3> {
        let objects = &self.document.shown().scene.objects;
        let models = || {
            (0..objects.len())
                .filter(|&object| !objects[object].hidden && !is_built_in(&objects[object].mesh))
        };
        let middle = |objects: Vec<usize>| {
            let [low, high] = self.picker.bounds_in_world(objects, &self.poses())?;
            Some((low + high) * 0.5)
        };
        let selected = self.active_object().filter(|&object| !is_built_in(&objects[object].mesh));
        let subject =
            selected.and_then(|object| middle(vec![object])).or_else(|| middle(models().collect()))?;
        let at_px = view.project(subject)?;
        (at_px.cmpge(DVec2::ZERO) & at_px.cmple(view.size_px)).all().then_some(subject)
    }

    /// What an added light shines on: the surface under the pointer, or else the subject, or else a point at the depth
    /// of the camera's target.
    fn about(&self, at_px: DVec2, view: &View) -> DVec3 {
        let hit = self.hit(at_px, view).map(|hit| hit.position_in_world);
        hit.or_else(|| self.subject(view)).unwrap_or_else(|| view.at_depth_of(at_px, self.camera().target))
    }

    pub(super) fn hit(&self, at_px: DVec2, view: &View) -> Option<crate::picking::Hit> {
        let scene = &self.document.shown().scene;
        let visible = |object: usize| scene.objects.get(object).is_some_and(|object| !object.hidden);
        self.picker.pick(&view.ray(at_px), &self.poses(), visible)
    }

    /// Passes an event to the tool of Paint and carries out its result. Returns whether the tool had a command to carry
    /// out.
    pub(super) fn tool(&mut self, event: ToolEvent, view: &View) -> bool {
        let poses = self.poses();
        let loaded = std::sync::Arc::clone(self.document.loaded());
        let painted =
            PaintedView { painting: self.painting.as_ref(), camera: &view.camera, frame: self.session.frame };
        let around = Surroundings {
            loaded: &loaded,
            view,
            poses: &poses,
            frame: self.session.frame,
            picker: &self.picker,
            options: &self.session.options,
            selection: self.document.selection(),
            painted: &painted,
        };
        let output = self.hand.take(self.session.paint_tool, &event, &around);
        self.output = output;
        if let Some(options) = self.output.options.clone() {
            self.session.options = options;
        }
        if let Some(refusal) = self.output.refusal.clone() {
            self.refuse(&refusal);
        }
        let has_command = self.output.commit.is_some();
        if let Some((command, words)) = self.output.ask.take() {
            self.requests.push(Request::TakeFaces(Box::new(command), words));
        } else if let Some(command) = self.output.commit.take() {
            self.run(&command);
        } else if let Some(command) = self.output.preview.take() {
            self.preview(&command);
        } else if !std::sync::Arc::ptr_eq(self.document.shown(), self.document.loaded()) {
            self.end_preview();
        }
        if let Some(item) = self.output.select.clone() {
            self.document.select(Selection::only(item));
        }
        has_command
    }

    pub(super) fn cancel(&mut self, view: &View) {
        match std::mem::take(&mut self.busy) {
            Busy::Transforming(_) => self.end_preview(),
            Busy::Idle | Busy::Painting => {
                if self.session.mode == Mode::Paint {
                    self.tool(ToolEvent::Cancel, view);
                }
            }
            Busy::Navigating(..) | Busy::Shot(_) | Busy::ShotView(..) | Busy::Pressed(_) => {}
        }
    }

    fn add_light(&mut self, at_px: DVec2, view: &View) {
        let toward = self.about(at_px, view);
        // The light is off the surface, towards the eye, because a light inside the object would not show.
        let to_eye = (view.camera.eye - toward) * 0.25;
        let kind = self.session.options.light;
        self.run(&Command::Arrange(Arrange::AddLight { kind, at: toward + to_eye, toward }));
        self.session.set_tool(Tool::Select);
    }

    /// The modifiers of the last event.
    pub fn held(&self) -> Modifiers {
        self.held
    }
}

fn navigate(free: &mut FreeView, way: Navigation, about: DVec3, delta_px: DVec2, view: &View) {
    match way {
        Navigation::Orbit => free.orbit(delta_px, about),
        Navigation::Pan => free.pan(delta_px, about, view.size_px),
        Navigation::Zoom => free.zoom(-delta_px.y / ZOOM_PX_PER_STEP, about),
    }
}
