//! The timeline: lanes of keys, the selected keys, playback, scrubbing, and loose poses.

mod keys;
mod lanes;
mod typed;

use std::sync::Arc;

use impasto_scene::loaded::LoadedScene;

use crate::command::Command;
use crate::playback::Playback;

pub use keys::{DRAG_PX, Dragged, KeysEvent, KeysHand, LanePosition};
pub use lanes::{KeyAt, Lane, LaneKey, eases, keyed_frames, lanes, next_ease};
pub use typed::typed_frame;

/// An event of the timeline.
#[derive(Clone, Debug, PartialEq)]
pub enum TimelineEvent {
    /// The playhead is dragged to a frame; playback pauses.
    Scrub(f64),
    /// The drag of the playhead ends; playback goes on if it was running.
    EndScrub,
    /// The playhead goes to a frame.
    GoTo(f64),
    /// Something happens to keys.
    Keys(KeysEvent),
}

/// The state of the timeline that is not part of the document: playback, selected keys, loose poses.
#[derive(Debug, Default)]
pub struct TimeHand {
    /// Playback.
    pub playback: Playback,
    /// Selected keys, and what is done to them.
    pub keys: KeysHand,
    /// Whether playback goes on after the scrubbing; `None` while the user does not scrub.
    pub(crate) scrubbing: Option<bool>,
    pub(crate) loose: Option<LoosePoses>,
    /// The loose poses that were dropped last. They can be restored until something else is done.
    pub(crate) put_back: Option<LoosePoses>,
    /// The frame that playback showed last. If another frame shows, the user has set it.
    pub(crate) played: Option<f64>,
}

/// Loose poses: made with Auto key off, they show at their frame only, until they are keyed.
#[derive(Clone, Debug)]
pub(crate) struct LoosePoses {
    pub(crate) frame: f64,
    /// For each posed thing, its name and the command that keys it.
    pub(crate) poses: Vec<(String, Command)>,
    /// The scene with these poses.
    pub(crate) loaded: Arc<LoadedScene>,
}

impl LoosePoses {
    /// The command that keys all these poses.
    pub(crate) fn command(&self) -> Command {
        match &self.poses[..] {
            [(_, command)] => command.clone(),
            several => {
                let commands = several.iter().map(|(_, command)| command.clone()).collect();
                Command::Several(format!("Pose {} objects at {}", several.len(), self.frame), commands)
            }
        }
    }

    /// What is posed, in words: *apple*, or *2 objects*.
    pub(crate) fn names(&self) -> String {
        match &self.poses[..] {
            [(name, _)] => name.clone(),
            several => format!("{} objects", several.len()),
        }
    }
}

impl TimeHand {
    /// Whether the shot was played since the document was opened.
    pub fn has_played(&self) -> bool {
        self.played.is_some()
    }

    /// Whether a thing has a loose pose.
    pub fn is_loose(&self, name: &str) -> bool {
        self.loose.as_ref().is_some_and(|loose| loose.poses.iter().any(|(other, _)| other == name))
    }

    /// The scene with the loose poses, if there are any.
    pub fn loose_scene(&self) -> Option<&Arc<LoadedScene>> {
        self.loose.as_ref().map(|loose| &loose.loaded)
    }
}
