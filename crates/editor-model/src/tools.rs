//! The tools of Paint: state machines from plain events to commands.
//!
//! ```text
//! Idle ─Hover─▶ Aiming ─Press─▶ a gesture ─Move─▶ preview ─Release─▶ one command
//!                                        └─Cancel, focus lost─▶ as if never begun
//! ```

use glam::{DAffine3, DVec2, DVec3};
use impasto_core::bending::CarriedPlace;
use impasto_scene::document::{Amount, Object, Scene};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::motion;

use crate::command::{Command, RegionTarget};
use crate::keymap::{Action, Modifiers};
use crate::path::ObjectView;
use crate::picking::{Hit, Picker, View};
use crate::refusal::Refusal;
use crate::selection::{Item, Selection};
use crate::session::{Tool, ToolOptions};

mod amounts;
mod brush;
mod curve;
mod erase;
mod fill;
mod hand;
mod heading;
mod pressure;
mod region;
mod ring;
mod sizing;
mod smear;
#[cfg(test)]
mod tests;
mod touch;
mod turn;

pub use hand::Hand;
pub(crate) use heading::REST_SECS;
pub use ring::{CombPreview, Needle, Ring};

/// What tools read, passed with every event. `loaded` is the scene of the history, without any preview.
#[derive(Clone, Copy)]
pub struct Surroundings<'a> {
    /// The scene and its files.
    pub loaded: &'a LoadedScene,
    /// The view.
    pub view: &'a View,
    /// The objects' `world_from_model` at the frame that is shown.
    pub poses: &'a [DAffine3],
    /// The frame that is shown.
    pub frame: f64,
    /// The objects' surfaces.
    pub picker: &'a Picker,
    /// Settings of the tools.
    pub options: &'a ToolOptions,
    /// What is selected.
    pub selection: &'a Selection,
    /// Answers questions about the painting.
    pub painted: &'a dyn Painted,
}

/// Questions that only the painting can answer.
pub trait Painted {
    /// Index of the region at a hit, if there is one.
    fn region_at(&self, hit: &Hit) -> Option<usize>;

    /// How strokes show at a hit now; `None` where none is near.
    fn shown_at(&self, hit: &Hit) -> Option<PaintedDirection>;

    /// The factor that is painted onto an amount at a hit; `None` if the painting does not have the object.
    fn factor_at(&self, hit: &Hit, of: Amount) -> Option<f64>;

    /// Where a hit is at a frame; `None` if its object is at rest then, or the painting does not have the object.
    fn carried(&self, hit: &Hit, frame: f64) -> Option<CarriedPlace>;
}

/// How strokes show at a point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaintedDirection {
    /// Angle in the current view, counter-clockwise from the picture's +X, radians.
    pub angle_rad: f64,
    /// The trust: how well a rotation describes the change of the picture since the reference, 0..=1.
    pub trust: f64,
}

/// An event for a tool. Positions in logical pixels of the viewport, times in seconds of any clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ToolEvent {
    /// The pointer moved, no button held.
    Hover {
        /// Where.
        at_px: DVec2,
        /// When.
        at_secs: f64,
    },
    /// The left button went down.
    Press {
        /// Where.
        at_px: DVec2,
        /// When.
        at_secs: f64,
        /// Which modifier keys are held.
        held: Modifiers,
        /// How hard a pen presses, 0..=1; 1 without a pen.
        pressure: f64,
    },
    /// The pointer moved with the button held.
    Move {
        /// Where.
        at_px: DVec2,
        /// When.
        at_secs: f64,
        /// Which modifier keys are held.
        held: Modifiers,
        /// How hard a pen presses, 0..=1; 1 without a pen.
        pressure: f64,
    },
    /// The button went up.
    Release {
        /// The most that a pen pressed since the press, 0..=1; 1 without a pen.
        pressure: f64,
    },
    /// A key that the keymap knows.
    Key(Action),
    /// Esc, a right press, or another tool: cancels.
    Cancel,
    /// The window lost its focus: cancels.
    FocusLost,
}

/// The result of an event.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ToolOutput {
    /// The command to preview; `None` ends a preview.
    pub preview: Option<Command>,
    /// The command to apply, as one entry of the history.
    pub commit: Option<Command>,
    /// A command to apply once the user agrees, with what it takes from other regions: *340 triangles of skin*.
    pub ask: Option<(Command, String)>,
    /// Why nothing was done.
    pub refusal: Option<Refusal>,
    /// The status line.
    pub status: String,
    /// The new selection.
    pub select: Option<Item>,
    /// Settings that the gesture changed.
    pub options: Option<ToolOptions>,
    /// The ring at the pointer, and its mirror images.
    pub rings: Vec<Ring>,
    /// The direction at the pointer.
    pub needle: Option<Needle>,
    /// The comb whose strokes are previewed while the pointer moves before a press.
    pub comb_preview: Option<CombPreview>,
    /// The line of a curve that is being drawn, or that the pointer is on.
    pub line_px: Vec<DVec2>,
    /// Handles of the line in `line_px`.
    pub handles_px: Vec<DVec2>,
    /// The label beside the ring once the pointer rests: *10°  trust 0.97*.
    pub label: Option<String>,
}

/// What a press would paint on.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Paintable {
    pub(crate) object: usize,
    /// Index of the region; none where a new one is made.
    pub(crate) region: Option<usize>,
    pub(crate) target: RegionTarget,
    /// Name of the region. For a new one, what the status line says: the object's name, or *new region*.
    pub(crate) name: String,
    /// The object's name, where the region may cover other objects too.
    pub(crate) object_name: Option<String>,
}

pub(crate) const NOTHING_HERE: &str = "Nothing to paint here: the ring must lie on an object";

impl<'a> Surroundings<'a> {
    pub(crate) fn scene(&self) -> &'a Scene {
        &self.loaded.scene
    }

    pub(crate) fn object(&self, index: usize) -> Option<&'a Object> {
        self.scene().objects.get(index)
    }

    /// The visible surface under a pixel.
    pub(crate) fn hit(&self, at_px: DVec2) -> Option<Hit> {
        let visible = |object: usize| self.object(object).is_some_and(|object| !object.hidden);
        at_px.is_finite().then(|| self.picker.pick(&self.view.ray(at_px), self.poses, visible))?
    }

    /// What a press at a hit would paint on, or why nothing may be painted there.
    pub(crate) fn paintable(&self, hit: Option<&Hit>) -> Result<Paintable, Refusal> {
        let hit = hit.ok_or_else(|| Refusal::new(NOTHING_HERE))?;
        let object = self.object(hit.object).ok_or_else(|| Refusal::new(NOTHING_HERE))?;
        let region =
            self.painted.region_at(hit).and_then(|index| Some((index, self.scene().regions.get(index)?)));
        let name = region.map_or(&object.name, |(_, region)| &region.name).clone();
        if object.locked {
            return Err(Refusal::new(format!("{} is locked", object.name)));
        }
        let Some((index, region)) = region else {
            let target = RegionTarget::NewOn(object.name.clone());
            return Ok(Paintable { object: hit.object, region: None, target, name, object_name: None });
        };
        if region.locked || region.hidden {
            let why = if region.locked { "locked" } else { "hidden" };
            return Err(Refusal::new(format!("{name} is {why}")));
        }
        let object_name = region.on.object().is_none().then(|| object.name.clone());
        let target = RegionTarget::Named(name.clone());
        Ok(Paintable { object: hit.object, region: Some(index), target, name, object_name })
    }

    /// The current view and the view of a region's reference, both relative to an object.
    pub(crate) fn views(&self, object: usize, region: Option<usize>) -> [ObjectView; 2] {
        let (camera, pose) = self.reference(object, region);
        let frame = |frame: f64| self.picker.bends(object).then_some(frame);
        let now = ObjectView::new(&self.view.camera, self.pose(object)).at_frame(frame(self.frame));
        [now, ObjectView::new(&camera, pose).at_frame(frame(self.reference_frame(region)))]
    }

    /// The camera of a region's reference, and an object's pose there.
    pub(crate) fn reference(&self, object: usize, region: Option<usize>) -> (motion::CameraPose, DAffine3) {
        let scene = self.scene();
        let own = region.and_then(|region| scene.regions.get(region)?.reference.as_ref());
        let (camera, frame) = motion::referred_to(scene, own.unwrap_or(&scene.reference));
        let pose = motion::poses_at(scene, frame).get(object).copied();
        (camera, pose.unwrap_or(DAffine3::IDENTITY))
    }

    pub(crate) fn reference_frame(&self, region: Option<usize>) -> f64 {
        let scene = self.scene();
        let own = region.and_then(|region| scene.regions.get(region)?.reference.as_ref());
        motion::referred_to(scene, own.unwrap_or(&scene.reference)).1
    }

    pub(crate) fn pose(&self, object: usize) -> DAffine3 {
        self.poses.get(object).copied().unwrap_or(DAffine3::IDENTITY)
    }

    /// A map from an object at rest, in its own space, to the world now. It holds near `position`, a point close to the
    /// object's surface at rest.
    pub(crate) fn now_from_rest(&self, object: usize, position: DVec3) -> DAffine3 {
        self.pose(object) * self.picker.now_from_rest(object, position)
    }

    /// Where a point of the object's own space is now in the world. `position` is close to the surface at rest.
    pub(crate) fn world(&self, object: usize, position: DVec3) -> DVec3 {
        self.now_from_rest(object, position).transform_point3(position)
    }

    /// The selected region, or that of the selected guide.
    pub(crate) fn selected_region(&self) -> Option<usize> {
        let name = match self.selection.active()? {
            Item::Region(name) | Item::Guide(name, _) => name,
            _ => return None,
        };
        self.scene().regions.iter().position(|region| region.name == *name)
    }
}

impl ToolOutput {
    pub(crate) fn saying(status: impl Into<String>) -> Self {
        Self { status: status.into(), ..Self::default() }
    }

    pub(crate) fn refusing(refusal: Refusal) -> Self {
        let unlock = if refusal.0.ends_with(" is locked") { ". [L] unlocks it" } else { "" };
        Self { status: format!("{refusal}{unlock}"), refusal: Some(refusal), ..Self::default() }
    }
}

/// The status line of a tool that waits for a press.
pub(crate) fn waiting_words(tool: Tool, options: &ToolOptions, region: &str) -> String {
    match tool {
        Tool::Comb => "[Drag] comb  [Shift] smooth  [Ctrl] against  [F] radius  [Middle] orbit".to_owned(),
        Tool::GuideCurve => "[Click] add point  [Enter] finish  [Esc] drop it".to_owned(),
        Tool::Fill => format!("[Click] fill {region}  [Drag] angle  [Middle] orbit"),
        Tool::TurnDirection if options.flip => format!("[Click] flip {region}  [Middle] orbit"),
        Tool::TurnDirection => format!("[Drag] turn {region}  [Ctrl] by 5°  [Middle] orbit"),
        Tool::Smooth if options.smear => "[Drag] smear  [F] radius  [Middle] orbit".to_owned(),
        Tool::Smooth => "[Drag] smooth  [F] radius  [Middle] orbit".to_owned(),
        Tool::Erase => "[Drag] erase to automatic  [F] radius  [Middle] orbit".to_owned(),
        Tool::Region => format!("[Drag] add to {region}  [Ctrl] take away"),
        Tool::Amount => amounts::waiting_words(options),
        Tool::Touch => touch::waiting_words(options),
        Tool::Pick => "[Click] take the direction  [Middle] orbit".to_owned(),
        _ => String::new(),
    }
}
