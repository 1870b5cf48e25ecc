//! The whole editor without its window: a document and a session, driven by plain events.
//!
//! ```text
//! keys ──▶ Editor::key ─▶ Action ─┐
//! menus, palette ───────▶ Action ─┴▶ Editor::act ─┐
//! pointer ─▶ Editor::pointer ─────────────────────┴▶ document, session, or a Request for the window
//!            (tools, gizmo, navigation, selection)
//! ```

mod actions;
mod lights;
mod mending;
mod objects;
mod painted;
mod pointer;
mod request;
mod saving;
#[cfg(test)]
mod tests;
mod time;

use std::sync::Arc;

use glam::{DAffine3, DVec2, DVec3};
use impasto_painting::Painting;
use impasto_scene::document::{Reference, Scene};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::motion::{self, CameraPose};
use impasto_scene::new_scene::Ground;

use crate::camera_rig::Looking;
use crate::command::{Arrange, Command, Pose, Time};
use crate::document::{Document, Step};
use crate::keymap::{Key, Keymap, Modifiers, Navigation, Scope};
use crate::picking::{Picker, View};
use crate::refusal::Refusal;
use crate::selection::{Item, Selection};
use crate::session::{Mode, Session, Tool};
use crate::timeline::{KeysEvent, TimeHand};
use crate::tools::{Hand, ToolOutput};
use crate::transform::Transforming;

pub use lights::LightPlace;
pub use mending::{Mend, Mended, Took};
pub use pointer::{PointerEvent, PointerKind};
pub use request::{Offer, Request, Said};

/// A transform under way, of objects or of one light.
#[derive(Debug)]
struct TransformDrag {
    machine: Transforming,
    objects: Vec<String>,
    /// Name of the light that is transformed; `None` if objects are transformed.
    light: Option<String>,
    /// Whether a press of the button began the transform. If so, the release ends it.
    held: bool,
}

/// The interaction under way.
#[derive(Debug, Default)]
enum Busy {
    #[default]
    Idle,
    /// A drag moves the view: orbits about this point, or pans or zooms with respect to it.
    Navigating(Navigation, DVec3),
    /// A drag with the shot camera tool moves the shot's camera, now at this pose.
    Shot(CameraPose),
    /// The pointer moves the shot's camera, now at this pose: in a drag, or without a button after a move, turn or
    /// scale key. The other fields are as in `Navigating`.
    ShotView(Navigation, DVec3, CameraPose),
    /// A tool of Paint has the pointer.
    Painting,
    /// The button is down on an object or a light; after a few pixels this becomes a drag.
    Pressed(DVec2),
    /// Objects or a light are moved, turned or scaled.
    Transforming(Box<TransformDrag>),
}

/// The editor without its window.
pub struct Editor {
    document: Document,
    /// Mode, tools, overlays, frame.
    pub session: Session,
    /// What the viewport looks through.
    pub looking: Looking,
    /// The keymap.
    pub keymap: Keymap,
    painting: Option<Painting>,
    picker: Picker,
    hand: Hand,
    output: ToolOutput,
    time: TimeHand,
    busy: Busy,
    /// Where the pointer is, when it is over the viewport.
    pointer_px: Option<DVec2>,
    /// Where the right button went down, if that began nothing: a release there asks for a menu.
    right_px: Option<DVec2>,
    held: Modifiers,
    at_secs: f64,
    /// When the pointer last did something. `at_secs` is later than this while the pointer rests.
    moved_secs: f64,
    /// Whether the tool already knows that the pointer rests.
    has_rested: bool,
    said: Vec<Said>,
    requests: Vec<Request>,
    version: u64,
    /// The result of [`losses_of`] when messages were last taken or [`Editor::save`] last saved, whichever was later.
    losses: (usize, bool),
}

/// How many losses are left, and whether saving over the file would lose text.
fn losses_of(document: &Document) -> (usize, bool) {
    (document.loss_count(), document.saving_loses())
}

impl Editor {
    /// An editor with a document.
    pub fn new(document: Document) -> Self {
        // A shot from another program may begin long after frame 0.
        let timeline = &document.scene().timeline;
        let frame = reference_frame(document.scene()).max(timeline.first as f64).min(timeline.last as f64);
        let losses = losses_of(&document);
        let session = Session { frame, ..Session::default() };
        Self {
            document,
            session,
            looking: Looking::Shot,
            keymap: Keymap::default(),
            painting: None,
            picker: Picker::default(),
            hand: Hand::default(),
            output: ToolOutput::default(),
            time: TimeHand::default(),
            busy: Busy::Idle,
            pointer_px: None,
            right_px: None,
            held: Modifiers::default(),
            at_secs: 0.0,
            moved_secs: 0.0,
            has_rested: false,
            said: Vec::new(),
            requests: Vec::new(),
            version: 1,
            losses,
        }
    }

    /// The document.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// Switches to another document; interactions and the view start over.
    pub fn open(&mut self, document: Document) {
        let (keymap, version) = (self.keymap.clone(), self.version + 1);
        let fresh = Self::new(document);
        let frame = fresh.session.frame;
        let session = Session { frame, frame_before_paint: None, ..self.session.clone() };
        *self = Self { session, keymap, version, ..fresh };
    }

    /// The scene as it is to be shown, and a number that changes with it.
    pub fn shown(&self) -> (&Arc<LoadedScene>, u64) {
        (self.document.shown(), self.version)
    }

    /// Takes over a painting that was prepared from the scene as shown.
    pub fn prepared(&mut self, painting: Painting) {
        self.picker.follow(&painting, self.session.frame);
        self.painting = Some(painting);
        // The surface under a resting pointer may have changed.
        self.has_rested = false;
    }

    /// The painting that was prepared last.
    pub fn painting(&self) -> Option<&Painting> {
        self.painting.as_ref()
    }

    /// The picker, which finds the surfaces that rays hit.
    pub fn picker(&self) -> &Picker {
        &self.picker
    }

    /// The shot's camera at the frame that is shown.
    pub fn shot(&self) -> CameraPose {
        self.shot_at(self.session.frame)
    }

    fn shot_at(&self, frame: f64) -> CameraPose {
        match &self.busy {
            Busy::Shot(pose) | Busy::ShotView(_, _, pose) => pose.clone(),
            _ => motion::camera_at(&self.document.shown().scene, frame),
        }
    }

    /// The camera that the viewport looks through at another frame.
    pub fn camera_at(&self, frame: f64) -> CameraPose {
        self.looking.pose(&self.shot_at(frame)).clone()
    }

    /// The camera that the viewport looks through.
    pub fn camera(&self) -> CameraPose {
        self.looking.pose(&self.shot()).clone()
    }

    /// The objects' `world_from_model` at the frame that is shown.
    pub fn poses(&self) -> Vec<DAffine3> {
        motion::poses_at(&self.document.shown().scene, self.session.frame)
    }

    /// What the tool has to show: rings, needle, lines.
    pub fn tool_output(&self) -> &ToolOutput {
        &self.output
    }

    /// Index of the object that was selected last.
    pub fn active_object(&self) -> Option<usize> {
        let Some(Item::Object(name)) = self.document.selection().active() else { return None };
        self.document.shown().scene.objects.iter().position(|object| object.name == *name)
    }

    /// Whether an interaction is under way, so that pictures may be drafts.
    pub fn is_moving(&self) -> bool {
        !matches!(self.busy, Busy::Idle | Busy::Pressed(_))
    }

    /// Whether the view is being moved.
    pub fn is_navigating(&self) -> bool {
        matches!(self.busy, Busy::Navigating(..) | Busy::Shot(_) | Busy::ShotView(..))
    }

    /// Takes all messages to show.
    pub fn take_said(&mut self) -> Vec<Said> {
        let losses = losses_of(&self.document);
        match (std::mem::replace(&mut self.losses, losses), losses) {
            ((_, true), (0, _)) => self.say("No problems left. Saving is on again."),
            ((_, true), (_, false)) => self.say("Saving is on again."),
            ((1.., false), (0, _)) => self.say("No problems left."),
            _ => {}
        }
        std::mem::take(&mut self.said)
    }

    /// Takes all requests to the window.
    pub fn take_requests(&mut self) -> Vec<Request> {
        std::mem::take(&mut self.requests)
    }

    /// Applies a command and adds its messages. Returns whether it changed anything.
    pub fn run(&mut self, command: &Command) -> bool {
        if let Some(posed) = self.take_loose(command) {
            return self.keep(&posed);
        }
        self.pose_loosely(command).unwrap_or_else(|| self.keep(command))
    }

    /// Gives the shot camera another pose: in Animate at this frame only; in the other modes all its keys move along.
    fn place_shot(&mut self, pose: CameraPose) -> bool {
        let frame = self.session.frame;
        self.run(&match self.session.mode {
            Mode::Animate => Command::Time(Time::PoseAtFrame(Pose::Camera(pose), frame)),
            Mode::Arrange | Mode::Paint => Command::Arrange(Arrange::SetCamera { frame, pose }),
        })
    }

    /// As [`Editor::run`], but a pose always becomes an entry of the history, never a loose pose (one without a key).
    fn keep(&mut self, command: &Command) -> bool {
        let result = self.document.apply(command);
        self.edited();
        self.told(result)
    }

    /// To be called when the document may have changed. Stops playback, deselects keys that are gone, and shows the
    /// loose poses again. Loose poses that were dropped before can no longer be restored.
    fn edited(&mut self) {
        self.version += 1;
        self.time.playback.stop();
        self.time.put_back = None;
        self.time.keys.retain(&crate::timeline::lanes(self.document.scene()));
        if self.time.loose.is_some() {
            self.show_loose();
        }
    }

    /// As [`Editor::run`]; commands with the same key within a second become one entry.
    pub fn run_merged(&mut self, command: &Command, key: &str, at_secs: f64) -> bool {
        if let Some(posed) = self.pose_loosely(command) {
            return posed;
        }
        let result = self.document.apply_merged(command, key, at_secs);
        self.edited();
        self.told(result)
    }

    /// Moves the document to another folder, if it was never saved and names no files; see [`Document::live_in`].
    pub fn live_in(&mut self, folder: &std::path::Path) -> bool {
        self.document.live_in(folder)
    }

    /// Adds a mesh by its path from the scene's folder.
    pub fn import(&mut self, mesh: &str) -> bool {
        let result = self.document.import(mesh);
        self.edited();
        self.told(result)
    }

    /// Shows the document as a command would leave it.
    pub fn preview(&mut self, command: &Command) {
        self.time.playback.stop();
        let result = match &self.time.loose {
            Some(loose) => {
                let both = vec![loose.command(), command.clone()];
                self.document.preview(&Command::Several(String::new(), both))
            }
            None => self.document.preview(command),
        };
        match result {
            Ok(()) => self.version += 1,
            Err(refusal) => self.refuse(&refusal),
        }
    }

    /// Ends a preview: shows the document as it is, with its loose poses.
    pub fn end_preview(&mut self) {
        self.show_loose();
        self.version += 1;
    }

    /// Replaces the selection; the timeline's lanes lose the keyboard focus.
    pub fn select(&mut self, selection: Selection) {
        self.time.keys.take(KeysEvent::Blur, &[]);
        self.document.select(selection);
    }

    /// Adds the messages of a command's result. Returns whether anything changed.
    fn told(&mut self, result: Result<Step, Refusal>) -> bool {
        match result {
            Ok(step) => {
                if let Some(note) = step.note {
                    self.said.push(Said { words: note, offers: Some(Offer::Undo), is_refusal: false });
                } else if step.text.starts_with("Delete ") {
                    let words = step.text.replacen("Delete", "Deleted", 1);
                    self.said.push(Said { words, offers: Some(Offer::Undo), is_refusal: false });
                }
                !step.text.is_empty()
            }
            Err(refusal) => {
                self.refuse(&refusal);
                false
            }
        }
    }

    fn say(&mut self, words: impl Into<String>) {
        self.said.push(Said { words: words.into(), offers: None, is_refusal: false });
    }

    fn refuse(&mut self, refusal: &Refusal) {
        // The same message is not repeated.
        if self.said.last().is_none_or(|said| said.words != refusal.0) {
            self.said.push(Said { words: refusal.0.clone(), offers: None, is_refusal: true });
        }
    }

    /// Handles a key. Returns false if it has no meaning here. `typing` says whether a text field has the focus.
    pub fn key(&mut self, key: Key, held: Modifiers, typing: bool, view: &View) -> bool {
        self.held = held;
        let scope = match (&self.busy, self.session.mode) {
            _ if typing => Scope::Typing,
            (Busy::Transforming(_), _) => Scope::Transform,
            (Busy::Painting, _) => Scope::Drawing,
            (_, Mode::Paint) if self.hand.is_busy() => Scope::Drawing,
            _ if self.time.keys.has_focus() => Scope::Lane,
            (_, Mode::Arrange) => Scope::Arrange,
            (_, Mode::Paint) => Scope::Paint,
            (_, Mode::Animate) => Scope::Animate,
        };
        if scope == Scope::Transform
            && let Some(character) = key.typed()
        {
            self.type_into_transform(character, view);
            return true;
        }
        match self.keymap.action_for(key, held, scope) {
            Some(action) => {
                self.act(action, view);
                true
            }
            None => false,
        }
    }

    /// The window lost its focus: cancels the interaction under way.
    pub fn focus_lost(&mut self, view: &View) {
        self.cancel(view);
        self.pointer_px = None;
    }

    /// The text of the status line. Keys are in brackets, as the user's keymap has them.
    pub fn status(&self) -> String {
        self.keymap.in_own_keys(&self.status_in_usual_keys())
    }

    fn status_in_usual_keys(&self) -> String {
        if let Busy::Transforming(drag) = &self.busy {
            return drag.machine.status();
        }
        if matches!(self.busy, Busy::ShotView(..)) {
            return "Moving the shot camera   [Click] keep  [Esc] back".to_owned();
        }
        if let Some(words) = self.time_status() {
            return words;
        }
        if self.document.scene().objects.is_empty() {
            return "Drop a mesh or a scene anywhere in the window".to_owned();
        }
        let light = self.active_light().map(|place| place.light.name);
        let object = || Some(&self.document.shown().scene.objects[self.active_object()?]);
        // The hint for a ground names no drag, because a drag does not move grounds.
        let is_ground = light.is_none() && object().is_some_and(|object| Ground::of_object(object).is_some());
        let object = light.or_else(|| Some(object()?.name.clone()));
        let object = object.as_deref().unwrap_or("an object");
        match self.session.mode {
            Mode::Arrange if is_ground && self.session.tool() == Tool::Select => {
                format!("[G R S] move, turn, scale {object}  [Shift A] add  [Middle] orbit")
            }
            Mode::Arrange => match self.session.tool() {
                Tool::AddLight => "[Click] add a light here  [Middle] orbit".to_owned(),
                Tool::ShotCamera => {
                    "[Drag] orbit the shot  [NumPad 0] look through it  [Middle] orbit".to_owned()
                }
                _ => {
                    format!("[Drag] move {object}  [G R S] move, turn, scale  [Shift A] add  [Middle] orbit")
                }
            },
            Mode::Paint => self.output.status.clone(),
            Mode::Animate => {
                format!("[Drag] move {object}  [X Y Z] lock axis  [I] key  [Space] play  [Middle] orbit")
            }
        }
    }
}

/// The frame of a scene's reference.
pub fn reference_frame(scene: &Scene) -> f64 {
    match scene.reference {
        Reference::Frame(frame) | Reference::View { frame, .. } => frame as f64,
    }
}
