//! Commands on touches: strokes placed by hand.

use impasto_scene::document::{Scene, Touch};
use impasto_scene::limits;

use super::region::in_file;
use super::{Done, counted, unlocked_object};
use crate::names;
use crate::refusal::Refusal;
use crate::selection::{Item, Selection};

/// Strokes placed by hand.
#[derive(Clone, Debug, PartialEq)]
pub enum Touches {
    /// Lays touches over all others, and selects the last of them. Names that are taken get a number.
    Lay(Vec<Touch>),
    /// Changes a touch; its name and its object stay.
    Set {
        /// Its name.
        name: String,
        /// Its new values.
        touch: Box<Touch>,
        /// What changed, in words: *width*.
        what: String,
    },
    /// Takes touches away, by name, as an eraser does.
    Erase(Vec<String>),
}

impl Touches {
    pub(super) fn edit(&self, scene: &mut Scene) -> Result<Done, Refusal> {
        match self {
            Self::Lay(touches) => lay(scene, touches),
            Self::Set { name, touch, what } => {
                let stored = touch_mut(scene, name)?;
                let color = touch.color.map(in_file);
                *stored = Touch { name: name.clone(), on: stored.on.clone(), color, ..Touch::clone(touch) };
                Ok(Done::new(format!("Set {name} {what}")))
            }
            Self::Erase(names) => {
                if names.is_empty() {
                    return Err(Refusal::new("There is no touch here"));
                }
                for name in names {
                    touch_mut(scene, name)?;
                }
                scene.touches.retain(|touch| !names.contains(&touch.name));
                Ok(Done::new(format!("Erase {}", counted(names, "touches"))))
            }
        }
    }
}

fn lay(scene: &mut Scene, touches: &[Touch]) -> Result<Done, Refusal> {
    let points = |touches: &[Touch]| touches.iter().map(|touch| touch.points.len()).sum::<usize>();
    if scene.touches.len() + touches.len() > limits::MAX_TOUCHES
        || points(&scene.touches) + points(touches) > limits::MAX_ALL_TOUCH_POINTS
    {
        return Err(Refusal::new("The scene has as many touches as it can have"));
    }
    let mut last = None;
    for touch in touches {
        unlocked_object(scene, &touch.on)?;
        let name = names::unique(&touch.name, scene.touches.iter().map(|touch| touch.name.as_str()));
        let color = touch.color.map(in_file);
        scene.touches.push(Touch { name: name.clone(), color, ..touch.clone() });
        last = Some(name);
    }
    let Some(last) = last else { return Err(Refusal::new("Nothing to paint here")) };
    let text = format!("Lay {last}");
    Ok(Done::new(text).selecting(Selection::only(Item::Touch(last))))
}

/// A touch, to be changed. Refused if its object is locked.
pub(super) fn touch_mut<'a>(scene: &'a mut Scene, name: &str) -> Result<&'a mut Touch, Refusal> {
    let index = scene.touches.iter().position(|touch| touch.name == name);
    let index = index.ok_or_else(|| Refusal::unknown("touch", name))?;
    let on = scene.touches[index].on.clone();
    if scene.objects.iter().any(|object| object.name == on && object.locked) {
        return Err(Refusal::new(format!("{on} is locked")));
    }
    Ok(&mut scene.touches[index])
}
