//! Commands: every change of a document, each with the text that the history shows for it.

mod amounts;
mod arrange;
mod direction;
mod edit;
mod keys;
mod material;
mod region;
mod scene;
mod time;
mod touches;

use impasto_scene::document::{Object, Region, Scene};
use impasto_scene::loaded::LoadedScene;

pub use amounts::Amounts;
pub use arrange::{Arrange, PoseField, Shift, set_light};
pub use direction::{Directions, Gesture, GuideSettings, RegionTarget};
pub use edit::Edit;
pub use keys::{KeyOf, KeyedValue, strokes_at};
pub use region::{Regions, StrokeChange, StrokesOf};
pub use scene::SceneEdit;
pub use time::{Pose, Time, ease_name, same_ease};
pub use touches::Touches;

use crate::refusal::Refusal;
use crate::selection::Selection;

/// One change of a document.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Names, parents, order, visibility, locks, copies, deletion.
    Edit(Edit),
    /// Objects, lights and cameras, and their poses.
    Arrange(Arrange),
    /// Directions and guides.
    Directions(Directions),
    /// Painted amounts.
    Amounts(Amounts),
    /// Strokes placed by hand.
    Touches(Touches),
    /// Regions and their strokes.
    Regions(Regions),
    /// Keys and the timeline.
    Time(Time),
    /// Size, seed, ground, background, exposure and style.
    Scene(SceneEdit),
    /// Several commands as one entry of the history, with one text; if one is refused, all are.
    Several(String, Vec<Command>),
}

#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Done {
    /// The text that the history shows.
    pub(crate) text: String,
    /// The new selection; `None` keeps the old one.
    pub(crate) selection: Option<Selection>,
    /// An additional message to the user.
    pub(crate) note: Option<String>,
}

impl Done {
    pub(crate) fn new(text: impl Into<String>) -> Self {
        Self { text: text.into(), ..Self::default() }
    }

    pub(crate) fn selecting(mut self, selection: Selection) -> Self {
        self.selection = Some(selection);
        self
    }

    pub(crate) fn noting(mut self, note: impl Into<String>) -> Self {
        self.note = Some(note.into());
        self
    }
}

impl Command {
    /// Changes `scene`, a copy of the scene in `before`. Some commands also use the files of `before`.
    pub(crate) fn edit(&self, scene: &mut Scene, before: &LoadedScene) -> Result<Done, Refusal> {
        match self {
            Self::Edit(command) => command.edit(scene),
            Self::Arrange(command) => command.edit(scene, before),
            Self::Directions(command) => command.edit(scene),
            Self::Amounts(command) => command.edit(scene),
            Self::Touches(command) => command.edit(scene),
            Self::Regions(command) => command.edit(scene),
            Self::Time(command) => command.edit(scene),
            Self::Scene(command) => command.edit(scene, before),
            Self::Several(text, commands) => {
                let mut all = Done::new(text.clone());
                for command in commands {
                    let done = command.edit(scene, before)?;
                    all.selection = done.selection.or(all.selection);
                    all.note = done.note.or(all.note);
                }
                Ok(all)
            }
        }
    }
}

pub(crate) fn object_mut<'a>(scene: &'a mut Scene, name: &str) -> Result<&'a mut Object, Refusal> {
    let object = scene.objects.iter_mut().find(|object| object.name == name);
    object.ok_or_else(|| Refusal::unknown("object", name))
}

pub(crate) fn region_mut<'a>(scene: &'a mut Scene, name: &str) -> Result<&'a mut Region, Refusal> {
    let region = scene.regions.iter_mut().find(|region| region.name == name);
    region.ok_or_else(|| Refusal::unknown("region", name))
}

pub(crate) fn unlocked_object<'a>(scene: &'a mut Scene, name: &str) -> Result<&'a mut Object, Refusal> {
    let object = object_mut(scene, name)?;
    if object.locked { Err(Refusal::new(format!("{name} is locked"))) } else { Ok(object) }
}

/// An object whose pose may be changed: it is not locked, and not moved by the scene's shot.
pub(crate) fn posable_object<'a>(scene: &'a mut Scene, name: &str) -> Result<&'a mut Object, Refusal> {
    if let Some(object) = scene.objects.iter().find(|object| object.name == name)
        && scene.is_moved_by_shot(object)
    {
        return Err(moved_by_shot(scene, name));
    }
    unlocked_object(scene, name)
}

/// The refusal of a command that would pose something that the scene's shot moves.
pub(crate) fn moved_by_shot(scene: &Scene, name: &str) -> Refusal {
    let shot = scene.shot.as_deref().unwrap_or("the shot");
    Refusal::new(format!("{name} moves as {shot} has it: make own keys first, in the inspector"))
}

/// A region that may be changed: neither it nor its object is locked.
pub(crate) fn unlocked_region<'a>(scene: &'a mut Scene, name: &str) -> Result<&'a mut Region, Refusal> {
    let on = region_mut(scene, name)?.on.object().map(str::to_owned);
    if let Some(object) = scene.objects.iter().find(|object| Some(&object.name) == on.as_ref())
        && object.locked
    {
        return Err(Refusal::new(format!("{} is locked", object.name)));
    }
    let region = region_mut(scene, name)?;
    if region.locked { Err(Refusal::new(format!("{name} is locked"))) } else { Ok(region) }
}

/// The name if there is exactly one, else the count: *apple*, or *3 objects*.
pub(crate) fn counted(names: &[impl AsRef<str>], what: &str) -> String {
    match names {
        [name] => name.as_ref().to_owned(),
        names => format!("{} {what}", names.len()),
    }
}

pub(crate) fn finite(value: f64) -> Result<f64, Refusal> {
    if value.is_finite() { Ok(value) } else { Err(Refusal::new("That is no number")) }
}
