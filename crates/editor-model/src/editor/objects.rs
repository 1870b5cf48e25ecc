//! Moving, turning and scaling objects; moving and turning lights.

use std::sync::Arc;

use glam::{DAffine3, DVec2, DVec3};
use impasto_scene::document::ObjectKey;
use impasto_scene::mesh_file::MeshFile;
use impasto_scene::motion;

use super::{Busy, Editor, LightPlace, TransformDrag, lights};
use crate::command::{Arrange, Command, Pose, Shift, Time};
use crate::euler;
use crate::gizmo::Gizmo;
use crate::keymap::{Navigation, Preset};
use crate::picking::View;
use crate::refusal::Refusal;
use crate::selection::Item;
use crate::session::{Mode, Tool};
use crate::transform::{
    Constraint, Operation, TransformDelta, TransformEvent, TransformStart, TransformStep, Transforming,
};

impl Editor {
    /// Takes over a mesh that was read from its file; see [`crate::Document::hold_mesh`].
    pub fn hold_mesh(&mut self, mesh: &str, file: Arc<MeshFile>) {
        self.document.hold_mesh(mesh, file);
    }

    /// Begins a transform of what is selected; returns false and says why if it cannot. `at_px` is the place that
    /// movements of the pointer count from, and `held` whether its button is down.
    pub(super) fn begin_transform(
        &mut self,
        operation: Operation,
        constraint: Option<Constraint>,
        at_px: DVec2,
        held: bool,
        view: &View,
    ) -> bool {
        if let Some(LightPlace { light, position }) = self.active_light() {
            let (name, kind) = (light.name.clone(), light.kind);
            if let Some(words) = lights::refusal(kind, operation) {
                self.refuse(&Refusal::new(words));
                return false;
            }
            let pose = DAffine3::from_translation(position);
            let machine = self.machine(operation, constraint, name.clone(), pose, at_px, view);
            let light = Some(name);
            self.busy =
                Busy::Transforming(Box::new(TransformDrag { machine, objects: Vec::new(), light, held }));
            return true;
        }
        let Some(object) = self.active_object() else {
            self.refuse(&Refusal::new("Select an object first"));
            return false;
        };
        let scene = &self.document.shown().scene;
        let objects: Vec<String> = self.document.selection().objects().map(str::to_owned).collect();
        let locked = scene.objects.iter().find(|object| object.locked && objects.contains(&object.name));
        if let Some(locked) = locked {
            let refusal = Refusal::new(format!("{} is locked", locked.name));
            self.refuse(&refusal);
            return false;
        }
        let name = match &objects[..] {
            [_] => scene.objects[object].name.clone(),
            several => format!("{} objects", several.len()),
        };
        let pose = self.poses()[object];
        let machine = self.machine(operation, constraint, name, pose, at_px, view);
        self.busy = Busy::Transforming(Box::new(TransformDrag { machine, objects, light: None, held }));
        true
    }

    /// Whether the shot camera is what was selected last.
    pub(super) fn has_camera_selected(&self) -> bool {
        self.document.selection().active() == Some(&Item::Camera)
    }

    /// Lets the shot camera follow the pointer until a click: *move* pans, *turn* orbits, *scale* zooms.
    pub(super) fn begin_shot_view(&mut self, operation: Operation, view: &View) {
        let way = match operation {
            Operation::Move => Navigation::Pan,
            Operation::Turn => Navigation::Orbit,
            Operation::Scale => Navigation::Zoom,
        };
        let shot = self.shot();
        let about = view.at_depth_of(view.size_px * 0.5, shot.target);
        self.busy = Busy::ShotView(way, about, shot);
    }

    /// With Blender's keys and the pointer over the picture, a copy follows the pointer at once.
    pub(super) fn grab_copy(&mut self, view: &View) {
        let is_grabbed = self.keymap.preset == Preset::Blender
            && self.session.mode != Mode::Paint
            && matches!(self.busy, Busy::Idle)
            && matches!(self.document.selection().active(), Some(Item::Object(_) | Item::Light(_)));
        if let Some(at_px) = self.pointer_px.filter(|_| is_grabbed) {
            self.begin_transform(Operation::Move, None, at_px, false, view);
        }
    }

    fn machine(
        &self,
        operation: Operation,
        constraint: Option<Constraint>,
        name: String,
        world_from_model: DAffine3,
        at_px: DVec2,
        view: &View,
    ) -> Transforming {
        let space = self.session.options.axes;
        let start = TransformStart { name, world_from_model, view: view.clone(), at_px, space };
        match constraint {
            Some(constraint) => Transforming::held(operation, constraint, start),
            None => Transforming::new(operation, start),
        }
    }

    /// The handles round the selected object, in Arrange and Animate, or round the selected light, in Arrange. `None`
    /// if nothing with handles is selected, with a tool that has none, and while the view moves, the shot plays or two
    /// pictures are compared.
    pub fn gizmo(&self, view: &View) -> Option<Gizmo> {
        let operation = match self.session.tool() {
            Tool::Move | Tool::Select => Operation::Move,
            Tool::Turn => Operation::Turn,
            Tool::Scale => Operation::Scale,
            _ => return None,
        };
        // A comparison shows the reference, whose poses differ from the current ones.
        let poses = self.session.mode != Mode::Paint && !self.session.compare;
        let is_shown = poses && !self.is_navigating() && !self.time.playback.is_playing();
        if !is_shown {
            return None;
        }
        let light =
            self.active_light().filter(|place| lights::refusal(place.light.kind, operation).is_none());
        let pose = match light {
            Some(LightPlace { position, .. }) => DAffine3::from_translation(position),
            None => *self.poses().get(self.active_object()?)?,
        };
        Some(Gizmo::new(operation, self.session.options.axes, pose, view))
    }

    /// Hands an event to the transform under way.
    pub(super) fn transform(&mut self, event: TransformEvent, view: &View) {
        let Busy::Transforming(drag) = &mut self.busy else { return };
        let step = drag.machine.take(event);
        match step {
            TransformStep::Preview(delta) => {
                if let Some(command) = self.transform_command(delta) {
                    self.preview(&command);
                }
            }
            TransformStep::Kept(delta) => {
                let command = delta.and_then(|delta| self.transform_command(delta));
                self.busy = Busy::Idle;
                match command {
                    Some(command) => drop(self.run(&command)),
                    None => self.end_preview(),
                }
            }
            TransformStep::Back => self.cancel(view),
        }
    }

    pub(super) fn type_into_transform(&mut self, character: char, view: &View) {
        self.transform(TransformEvent::Typed(character), view);
    }

    /// The command of a transform: in Arrange it moves the whole motion, in Animate the pose at this frame.
    fn transform_command(&self, delta: TransformDelta) -> Option<Command> {
        let Busy::Transforming(drag) = &self.busy else { return None };
        if let Some(light) = &drag.light {
            return self.light_command(light, delta, drag.machine.world_from_space());
        }
        // A loose pose, which is not keyed yet, is what the user sees, so the transform starts from it.
        let loose = self.time.loose_scene().map(|loaded| &loaded.scene);
        let scene = loose.unwrap_or(self.document.scene());
        let frame = self.session.frame;
        let poses = motion::poses_at(scene, frame);
        let active = drag.objects.last()?;
        let index = scene.objects.iter().position(|object| object.name == *active)?;
        let pivot = poses[index].translation;
        let axes = drag.machine.world_from_space();
        let world_from_world = delta.world_from_world(pivot, axes);
        let verb = match delta {
            TransformDelta::Move(_) => "Move",
            TransformDelta::Turn { .. } => "Turn",
            TransformDelta::Scale(factors) if factors.max_element() - factors.min_element() < 1e-12 => {
                "Scale"
            }
            // `Shift` and `key_of` take only one factor for all axes, so uneven factors stretch the object itself.
            // They apply along its own axes, whichever space was chosen.
            TransformDelta::Scale(factors) => {
                let object = active.clone();
                return Some(Command::Arrange(Arrange::Stretch { object, factors }));
            }
        };
        if self.session.mode != Mode::Animate {
            let objects = drag.objects.clone();
            let shift = Shift { world_from_world, frame };
            return Some(Command::Arrange(Arrange::ShiftMotion { objects, shift, verb }));
        }
        let poses_keyed = drag.objects.iter().filter_map(|name| {
            let index = scene.objects.iter().position(|object| object.name == *name)?;
            let object = &scene.objects[index];
            let now = motion::key_at(scene, object, frame);
            let in_parent = {
                let own = pose_of(&now);
                let world_from_parent = poses[index] * own.inverse();
                world_from_parent.inverse() * world_from_world * world_from_parent * own
            };
            let key = key_of(in_parent, &now);
            Some(Command::Time(Time::PoseAtFrame(Pose::Object(name.clone(), key), frame)))
        });
        let mut commands: Vec<Command> = poses_keyed.collect();
        if commands.len() == 1 {
            return commands.pop();
        }
        Some(Command::Several(format!("Pose {} objects at {frame}", commands.len()), commands))
    }
}

fn pose_of(key: &ObjectKey) -> DAffine3 {
    let matrix = euler::matrix(key.rotation_deg) * key.scale.matrix();
    DAffine3::from_mat3_translation(matrix, DVec3::from(key.translation))
}

fn key_of(pose: DAffine3, near: &ObjectKey) -> ObjectKey {
    // The object's own scale is taken out before the factor is found, so that an uneven scale keeps its ratios.
    let unscaled = pose.matrix3 * near.scale.matrix().inverse();
    let factor = unscaled.determinant().cbrt();
    ObjectKey {
        translation: pose.translation.map(euler::tidy).to_array(),
        rotation_deg: euler::degrees(unscaled * (1.0 / factor), near.rotation_deg),
        scale: near.scale.times(factor, euler::tidy),
        ..near.clone()
    }
}
