//! Carries out actions, whether they come from keys, menus or the command search.

use impasto_scene::document::Region;
use impasto_scene::motion;

use super::{Busy, Editor, Request, reference_frame};
use crate::camera_rig::{AxisView, Looking};
use crate::command::{Command, Directions, Edit};
use crate::keymap::{Action, Preset};
use crate::picking::View;
use crate::refusal::Refusal;
use crate::selection::{Item, Selection};
use crate::session::{DirectionLines, Mode, Tool};
use crate::timeline::keyed_frames;
use crate::tools::ToolEvent;
use crate::transform::{Operation, TransformEvent};

impl Editor {
    /// Carries out an action.
    pub fn act(&mut self, action: Action, view: &View) {
        if self.act_on_keys(action) || self.act_on_tools(action, view) {
            return;
        }
        match action {
            Action::NewScene => self.requests.push(Request::New),
            Action::OpenScene => self.requests.push(Request::Open),
            Action::Save => self.requests.push(Request::Save),
            Action::SaveAs => self.requests.push(Request::SaveAs),
            Action::SaveCopy => self.requests.push(Request::SaveCopy),
            Action::Revert if self.document.file().is_none() => {
                self.refuse(&Refusal::new("This scene has no file yet"));
            }
            Action::Revert => self.requests.push(Request::Revert),
            Action::Quit => self.requests.push(Request::Quit),
            Action::ImportMesh => self.requests.push(Request::Import),
            Action::ReadSource => self.requests.push(Request::ReadSource),
            Action::Palette => self.requests.push(Request::Palette),
            Action::Shortcuts => self.requests.push(Request::Shortcuts),
            Action::Rename => self.requests.push(Request::Rename),
            Action::Add => self.requests.push(Request::Add),
            Action::ToggleColumn => self.requests.push(Request::ToggleColumn),
            Action::MaximiseViewport => self.requests.push(Request::MaximiseViewport),
            Action::NextArea => self.requests.push(Request::NextArea),
            Action::Undo | Action::Redo => self.undo_or_redo(action),
            Action::Arrange => self.set_mode(Mode::Arrange, view),
            Action::Paint => self.set_mode(Mode::Paint, view),
            Action::Animate => self.set_mode(Mode::Animate, view),
            Action::TogglePaint => {
                let to =
                    if self.session.mode == Mode::Paint { self.session.mode_before } else { Mode::Paint };
                self.set_mode(to, view);
            }
            Action::NextMode => self.set_mode(
                match self.session.mode {
                    Mode::Arrange => Mode::Paint,
                    Mode::Paint => Mode::Animate,
                    Mode::Animate => Mode::Arrange,
                },
                view,
            ),
            Action::Compare => {
                self.session.compare = !self.session.compare;
                // The layout of the pictures changes, so the pointer is now over something else.
                self.cancel(view);
                self.output = Default::default();
            }
            Action::CycleDirections => {
                let direction_lines = &mut self.session.overlays.direction_lines;
                *direction_lines = match direction_lines {
                    DirectionLines::Off => DirectionLines::Plain,
                    DirectionLines::Plain => DirectionLines::ByRegion,
                    DirectionLines::ByRegion => DirectionLines::Off,
                };
            }
            Action::Curves => self.session.toggle_curves(),
            Action::ToggleTrust => self.session.overlays.trust = !self.session.overlays.trust,
            Action::StepBack => self.session.frame = self.session.frame.ceil() - 1.0,
            Action::StepOn => self.session.frame = self.session.frame.floor() + 1.0,
            Action::FirstFrame => self.session.frame = self.document.scene().timeline.first as f64,
            Action::LastFrame => self.session.frame = self.document.scene().timeline.last as f64,
            Action::PreviousKey | Action::NextKey => self.go_to_key(action == Action::NextKey),
            _ => self.act_on_things(action, view),
        }
    }

    fn act_on_things(&mut self, action: Action, view: &View) {
        match action {
            Action::SelectAll => {
                let objects = self.document.scene().objects.iter();
                let all = objects.map(|object| Item::Object(object.name.clone())).collect();
                self.document.select(all);
            }
            Action::SelectNone => self.document.select(Selection::default()),
            Action::Delete | Action::Duplicate => {
                let items = self.document.selection().items().to_vec();
                if items.is_empty() {
                    return self.refuse(&Refusal::new("Select something first"));
                }
                let done = self.run(&Command::Edit(match action {
                    Action::Delete => Edit::Delete(items),
                    _ => Edit::Duplicate(items),
                }));
                if done && action == Action::Duplicate {
                    self.grab_copy(view);
                }
            }
            Action::Hide | Action::Lock => self.hide_or_lock(action),
            Action::ShowAll => {
                let scene = self.document.scene();
                let objects = scene.objects.iter().filter(|object| object.hidden);
                let regions = scene.regions.iter().filter(|region| region.hidden);
                let touches = scene.touches.iter().filter(|touch| touch.hidden);
                let hidden: Vec<Item> = objects
                    .map(|object| Item::Object(object.name.clone()))
                    .chain(regions.map(|region| Item::Region(region.name.clone())))
                    .chain(touches.map(|touch| Item::Touch(touch.name.clone())))
                    .collect();
                if !hidden.is_empty() {
                    self.run(&Command::Edit(Edit::SetHidden(hidden, false)));
                }
            }
            Action::FrameSelected | Action::FrameAll => self.frame(action == Action::FrameSelected, view),
            Action::ViewFront => self.look_along(AxisView::Front),
            Action::ViewRight => self.look_along(AxisView::Right),
            Action::ViewTop => self.look_along(AxisView::Top),
            Action::ToggleOrthographic => {
                let shot = self.shot();
                self.looking.free(&shot).toggle_orthographic();
            }
            Action::LookThrough => self.looking = Looking::Shot,
            Action::CameraFromView => self.bring_shot_to_view(),
            Action::SetKey => self.set_key(),
            Action::Render => self.requests.push(Request::Render),
            Action::ExportMovie => self.requests.push(Request::ExportMovie),
            Action::Play => self.play_or_stop(),
            _ => {}
        }
    }

    /// Does actions on tools and on the interaction under way. Returns whether the action was one of these.
    fn act_on_tools(&mut self, action: Action, view: &View) -> bool {
        let tool = match action {
            Action::Select => Tool::Select,
            Action::Comb => Tool::Comb,
            Action::GuideCurve => Tool::GuideCurve,
            Action::Fill => Tool::Fill,
            Action::TurnDirection => Tool::TurnDirection,
            Action::Smooth => Tool::Smooth,
            Action::Erase => Tool::Erase,
            Action::Region => Tool::Region,
            Action::Amount => Tool::Amount,
            Action::Touch => Tool::Touch,
            Action::Pick => Tool::Pick,
            Action::Move | Action::Turn | Action::Scale => {
                let (operation, tool) = match action {
                    Action::Move => (Operation::Move, Tool::Move),
                    Action::Turn => (Operation::Turn, Tool::Turn),
                    _ => (Operation::Scale, Tool::Scale),
                };
                // With Blender's keys, a key that is pressed over the viewport starts the transform at once. In all
                // other cases the key takes the tool up.
                let by_key = self.keymap.preset == Preset::Blender && self.session.mode != Mode::Paint;
                match self.pointer_px.filter(|_| by_key) {
                    Some(_) if matches!(self.busy, Busy::Idle) && self.has_camera_selected() => {
                        self.begin_shot_view(operation, view);
                    }
                    Some(at_px) if matches!(self.busy, Busy::Idle) => {
                        self.begin_transform(operation, None, at_px, false, view);
                    }
                    _ => self.take_up(tool, view),
                }
                return true;
            }
            Action::HoldAxis(axis) => {
                self.transform(TransformEvent::Axis(axis), view);
                return true;
            }
            Action::HoldPlane(axis) => {
                self.transform(TransformEvent::Plane(axis), view);
                return true;
            }
            Action::Confirm | Action::TakeBack | Action::Cancel
                if matches!(self.busy, Busy::Transforming(_)) =>
            {
                match action {
                    Action::Confirm => self.transform(TransformEvent::Keep, view),
                    Action::TakeBack => self.transform(TransformEvent::Backspace, view),
                    _ => self.transform(TransformEvent::Back, view),
                }
                return true;
            }
            Action::Cancel => {
                self.cancel(view);
                return true;
            }
            Action::Confirm
            | Action::TakeBack
            | Action::SizeRadius
            | Action::SizeStrength
            | Action::SmallerRadius
            | Action::LargerRadius
            | Action::FlipUnderCursor => {
                if self.session.mode == Mode::Paint {
                    self.tool(ToolEvent::Key(action), view);
                }
                return true;
            }
            // The tool may delete one point of a guide. If it does not, and no gesture is under way, the selection is
            // deleted.
            Action::Delete
                if self.session.mode == Mode::Paint && (self.hand.is_busy() || self.pointer_px.is_some()) =>
            {
                let was_busy = self.hand.is_busy();
                return self.tool(ToolEvent::Key(action), view) || was_busy;
            }
            _ => return false,
        };
        self.take_up(tool, view);
        true
    }

    /// Takes up a tool. If the current mode does not have this tool, changes to a mode that does. Cancels the
    /// interaction under way.
    pub fn take_up(&mut self, tool: Tool, view: &View) {
        self.cancel(view);
        match (tool.is_for_paint(), self.session.mode) {
            (true, Mode::Arrange | Mode::Animate) => self.set_mode(Mode::Paint, view),
            (false, Mode::Paint) => self.set_mode(self.session.mode_before, view),
            _ => {}
        }
        self.session.set_tool(tool);
        if self.session.mode == Mode::Paint {
            self.hover_again(view);
        }
    }

    pub(super) fn hover_again(&mut self, view: &View) {
        if let Some(at_px) = self.pointer_px {
            self.tool(ToolEvent::Hover { at_px, at_secs: self.at_secs }, view);
        } else {
            self.tool(ToolEvent::Cancel, view);
        }
    }

    /// Changes the mode; cancels the interaction under way. Entering Paint also looks through the shot camera.
    pub fn set_mode(&mut self, mode: Mode, view: &View) {
        self.cancel(view);
        let frame = reference_frame(self.document.scene());
        if mode == Mode::Paint && self.session.mode != Mode::Paint {
            self.looking = Looking::Shot;
        }
        self.session.set_mode(mode, frame);
        if mode == Mode::Paint {
            self.hover_again(view);
        }
    }

    fn undo_or_redo(&mut self, action: Action) {
        if self.is_moving() {
            return self.refuse(&Refusal::new("Finish or cancel the gesture first"));
        }
        if action == Action::Undo && self.undo_loose_pose() {
            return;
        }
        let step = if action == Action::Undo { self.document.undo() } else { self.document.redo() };
        self.edited();
        match step {
            Some(step) => {
                let done = if action == Action::Undo { "Undid" } else { "Did again" };
                self.say(format!("{done}: {}", step.text));
                if let Some(note) = step.note {
                    self.refuse(&Refusal::new(note));
                }
            }
            None => self.say(if action == Action::Undo { "Nothing to undo" } else { "Nothing to do again" }),
        }
    }

    /// Hides the selected things or shows them again; or locks or unlocks them. The last one changes its state, and the
    /// others get the same state. Things that cannot be hidden (or locked) do not count.
    fn hide_or_lock(&mut self, action: Action) {
        let hides = action == Action::Hide;
        let can = |item: &&Item| match item {
            Item::Object(_) | Item::Region(_) => true,
            Item::Touch(_) => hides,
            _ => false,
        };
        let items: Vec<Item> = self.document.selection().items().iter().filter(can).cloned().collect();
        let Some(active) = items.last() else {
            let what = if hides {
                "Select an object, a region or a touch first"
            } else {
                "Select an object or a region first"
            };
            return self.refuse(&Refusal::new(what));
        };
        let scene = self.document.scene();
        let name = active.name();
        let state = match active {
            Item::Object(_) => {
                scene.objects.iter().find(|object| object.name == name).map(|it| (it.hidden, it.locked))
            }
            Item::Touch(_) => {
                scene.touches.iter().find(|touch| touch.name == name).map(|it| (it.hidden, false))
            }
            _ => scene.regions.iter().find(|region| region.name == name).map(|it| (it.hidden, it.locked)),
        };
        let (hidden, locked) = state.unwrap_or_default();
        self.run(&Command::Edit(match action {
            Action::Hide => Edit::SetHidden(items, !hidden),
            _ => Edit::SetLocked(items, !locked),
        }));
    }

    fn bring_shot_to_view(&mut self) {
        if self.place_shot(self.camera()) {
            self.looking = Looking::Shot;
        }
    }

    fn look_along(&mut self, axis: AxisView) {
        let shot = self.shot();
        self.looking.free(&shot).look_along(axis);
    }

    fn frame(&mut self, selected: bool, view: &View) {
        let scene = &self.document.shown().scene;
        let selection = self.document.selection();
        let regions: Vec<_> = scene
            .regions
            .iter()
            .filter(|region| selection.contains(&Item::Region(region.name.clone())))
            .collect();
        let chosen: Vec<usize> = (0..scene.objects.len())
            .filter(|&object| {
                let object = &scene.objects[object];
                let is_scenery = impasto_scene::built_in_mesh::is_built_in(&object.mesh);
                match selected {
                    true => {
                        let is_of = |region: &&Region| region.on.object() == Some(object.name.as_str());
                        selection.contains(&Item::Object(object.name.clone())) || regions.iter().any(is_of)
                    }
                    false => !object.hidden && !is_scenery,
                }
            })
            .collect();
        let Some(bounds) = self.picker.bounds_in_world(chosen, &self.poses()) else {
            return self.refuse(&Refusal::new("Select an object first"));
        };
        let shot = self.shot();
        self.looking.free(&shot).frame(bounds, view.size_px);
    }

    fn go_to_key(&mut self, forward: bool) {
        let frames = keyed_frames(self.document.scene());
        let now = self.session.frame;
        let next = if forward {
            frames.into_iter().find(|&frame| frame > now)
        } else {
            frames.into_iter().rfind(|&frame| frame < now)
        };
        self.session.frame = next.unwrap_or(now);
    }

    /// Takes a frame as the new reference.
    pub fn recapture(&mut self, frame: i64) {
        self.run(&Command::Directions(Directions::Recapture(frame)));
    }

    /// The angle, in degrees, by which an object has turned between the reference and the frame that is shown, as the
    /// reference's camera sees it. For the note that Compare shows.
    pub fn turned_deg(&self, object: usize) -> Option<f64> {
        let scene = &self.document.shown().scene;
        let (camera, at) = motion::referred_to(scene, &scene.reference);
        let [before, now] = [at, self.session.frame].map(|frame| motion::poses_at(scene, frame));
        let gaze = (camera.target - camera.eye).try_normalize()?;
        let turn = now.get(object)?.matrix3 * before.get(object)?.matrix3.inverse();
        let quat = glam::DQuat::from_mat3(&(turn * (1.0 / turn.determinant().cbrt())));
        let (axis, angle_rad) = quat.to_axis_angle();
        let angle_rad = impasto_core::angle::wrap_pi(angle_rad);
        // Positive is counter-clockwise as the picture shows it.
        Some((angle_rad * -axis.dot(gaze)).to_degrees())
    }
}
