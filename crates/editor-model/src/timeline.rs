//! The timeline: lanes of keys, which keys are selected, and what the hand does to them and to the playhead.

mod keys;
mod lanes;
mod typed;

use std::sync::Arc;

use impasto_scene::loaded::LoadedScene;

use crate::command::Command;
use crate::playback::Playback;

pub use keys::{DRAG_PX, Dragged, KeysEvent, KeysHand, LanePosition};
pub use lanes::{KeyAt, Lane, LaneKey, keyed_frames, lanes, next_ease};
pub use typed::typed_frame;

/// What is done on the timeline.
#[derive(Clone, Debug, PartialEq)]
pub enum TimelineEvent {
    /// The playhead follows a hand; what plays waits.
    Scrub(f64),
    /// The hand lets go; what played plays on.
    EndScrub,
    /// The playhead goes to a frame.
    GoTo(f64),
    /// Something happens to keys.
    Keys(KeysEvent),
}

/// Everything about time that is no part of the document: playback, selected keys, poses that are not keyed.
#[derive(Debug, Default)]
pub struct TimeHand {
    /// Playback.
    pub playback: Playback,
    /// Selected keys, and what is done to them.
    pub keys: KeysHand,
    /// Whether a hand scrubs, and whether playing goes on after it.
    pub(crate) scrubbing: Option<bool>,
    pub(crate) loose: Option<LoosePoses>,
    /// What was last put back to its keys, until something else is done.
    pub(crate) put_back: Option<LoosePoses>,
    /// The frame that playing showed last: another one is the hand's.
    pub(crate) played: Option<f64>,
}

/// Poses that were made with Auto key off: they show at their frame, and nowhere else, until they are keyed.
#[derive(Clone, Debug)]
pub(crate) struct LoosePoses {
    pub(crate) frame: f64,
    /// What would key each, by what is posed.
    pub(crate) poses: Vec<(String, Command)>,
    /// The scene with them.
    pub(crate) loaded: Arc<LoadedScene>,
}

impl LoosePoses {
    /// What keys them all.
    pub(crate) fn command(&self) -> Command {
        match &self.poses[..] {
            [(_, command)] => command.clone(),
            several => {
                let commands = several.iter().map(|(_, command)| command.clone()).collect();
                Command::Several(format!("Pose {} objects at {}", several.len(), self.frame), commands)
            }
        }
    }

    /// *apple*, *2 objects*.
    pub(crate) fn names(&self) -> String {
        match &self.poses[..] {
            [(name, _)] => name.clone(),
            several => format!("{} objects", several.len()),
        }
    }
}

impl TimeHand {
    /// Whether a thing stands in a pose that is not keyed.
    pub fn is_loose(&self, name: &str) -> bool {
        self.loose.as_ref().is_some_and(|loose| loose.poses.iter().any(|(other, _)| other == name))
    }

    /// The scene with the poses that are not keyed, where there are any.
    pub fn loose_scene(&self) -> Option<&Arc<LoadedScene>> {
        self.loose.as_ref().map(|loose| &loose.loaded)
    }
}
