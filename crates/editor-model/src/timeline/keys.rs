//! Selecting and dragging keys: `Idle —press a key→ Held —3 px→ Dragging —release→ one command`. Keys that a drag would
//! replace are shown during the drag, and replaced only on release. A drag that begins beside keys draws a selection
//! box.

use impasto_scene::limits::MAX_FRAME;

use super::lanes::{KeyAt, Lane, next_ease};
use crate::command::{Command, KeyOf, Time};

#[cfg(test)]
mod tests;

/// A drag begins after this many logical pixels (points).
pub const DRAG_PX: f64 = 3.0;

/// A position on the lanes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LanePosition {
    /// Points from the left.
    pub x_px: f64,
    /// Points from the top of the first lane.
    pub y_px: f64,
    /// The frame there, not rounded.
    pub frame: f64,
    /// Index of the lane there. Below the last lane it is beyond the last index.
    pub lane: usize,
}

/// An event that concerns keys.
#[derive(Clone, Debug, PartialEq)]
pub enum KeysEvent {
    /// The button goes down, on a key or beside all keys.
    Press {
        /// Where.
        at: LanePosition,
        /// The key there.
        key: Option<KeyAt>,
        /// Whether Shift or Ctrl is held. A key is then added to the selection, or taken out of it, and a box adds its
        /// keys.
        adds: bool,
    },
    /// The pointer moved.
    Move(LanePosition),
    /// The button goes up.
    Release,
    /// Selects one key alone.
    Select(KeyAt),
    /// Selects all keys.
    SelectAll,
    /// Selects none.
    SelectNone,
    /// Copies of the selected keys follow the pointer until a press. If keys are being dragged, copies are dragged
    /// instead.
    Copy,
    /// Cancels the drag or the box.
    Cancel,
    /// Another part of the window has the keyboard.
    Blur,
}

/// A drag of keys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dragged {
    /// By how many frames.
    pub by: f64,
    /// Whether copies move and the keys stay.
    pub copies: bool,
}

#[derive(Clone, Debug, Default, PartialEq)]
enum Busy {
    #[default]
    Idle,
    Held {
        key: KeyAt,
        from: LanePosition,
        adds: bool,
    },
    Dragging {
        /// The frame of the key that was grabbed; it snaps to whole frames.
        grabbed: f64,
        /// Where the pointer was when the drag began; `None` until the first movement.
        from: Option<LanePosition>,
        dragged: Dragged,
    },
    Boxing {
        from: LanePosition,
        to: LanePosition,
        before: Vec<KeyAt>,
        adds: bool,
    },
}

/// The selected keys, and the drag under way.
#[derive(Clone, Debug, Default)]
pub struct KeysHand {
    selected: Vec<KeyAt>,
    busy: Busy,
    focused: bool,
}

impl KeysHand {
    /// The selected keys.
    pub fn selected(&self) -> &[KeyAt] {
        &self.selected
    }

    /// Whether a key is selected.
    pub fn contains(&self, of: &KeyOf, frame: f64) -> bool {
        self.selected.iter().any(|(other, at)| other == of && *at == frame)
    }

    /// Whether the selected keys have the keyboard focus.
    pub fn has_focus(&self) -> bool {
        self.focused && !self.selected.is_empty()
    }

    /// The drag under way.
    pub fn dragged(&self) -> Option<Dragged> {
        match &self.busy {
            Busy::Dragging { dragged, .. } => Some(*dragged),
            _ => None,
        }
    }

    /// Whether keys or copies follow the pointer; copies do so even with no button held.
    pub fn follows(&self) -> bool {
        matches!(self.busy, Busy::Dragging { .. })
    }

    /// Opposite corners of the box under way, each in points from the left and from the top of the first lane.
    pub fn boxed(&self) -> Option<[[f64; 2]; 2]> {
        match &self.busy {
            Busy::Boxing { from, to, .. } if is_far(from, to) => {
                Some([[from.x_px, from.y_px], [to.x_px, to.y_px]])
            }
            _ => None,
        }
    }

    /// The keys that would be replaced if the button were released now.
    pub fn replaces(&self, lanes: &[Lane]) -> Vec<KeyAt> {
        let Some(Dragged { by, copies }) = self.dragged().filter(|dragged| dragged.by != 0.0) else {
            return Vec::new();
        };
        let lands = self.selected.iter().map(|(of, frame)| (of, frame + by));
        let is_taken = |(of, frame): &(&KeyOf, f64)| {
            let stays = copies || !self.contains(of, *frame);
            stays && lanes.iter().any(|lane| lane.of == **of && lane.has(*frame))
        };
        lands.filter(is_taken).map(|(of, frame)| (of.clone(), frame)).collect()
    }

    /// Handles an event; returns the command that follows from it, if any.
    pub fn take(&mut self, event: KeysEvent, lanes: &[Lane]) -> Option<Command> {
        match event {
            KeysEvent::Press { .. } if matches!(self.busy, Busy::Dragging { .. }) => {
                return self.release(lanes);
            }
            KeysEvent::Press { at, key, adds } => self.press(at, key, adds),
            KeysEvent::Move(at) => self.moved(at, lanes),
            KeysEvent::Release => return self.release(lanes),
            KeysEvent::Select(key) => (self.selected, self.focused) = (vec![key], true),
            KeysEvent::SelectAll => {
                let keys = |lane: &Lane| {
                    lane.keys.iter().map(|key| (lane.of.clone(), key.frame)).collect::<Vec<_>>()
                };
                self.selected = lanes.iter().flat_map(keys).collect();
            }
            KeysEvent::SelectNone => self.selected.clear(),
            KeysEvent::Copy => match &mut self.busy {
                Busy::Dragging { dragged, .. } => dragged.copies = true,
                Busy::Idle => {
                    let grabbed = self.selected.first()?.1;
                    let dragged = Dragged { by: 0.0, copies: true };
                    self.busy = Busy::Dragging { grabbed, from: None, dragged };
                }
                Busy::Held { .. } | Busy::Boxing { .. } => {}
            },
            KeysEvent::Cancel => {
                if let Busy::Boxing { before, .. } = std::mem::take(&mut self.busy) {
                    self.selected = before;
                }
            }
            KeysEvent::Blur => self.focused = false,
        }
        None
    }

    /// Shifts the frames in the selection by `by`. To be called before a command moves or copies the selected keys by
    /// as much, so that the moved keys, or the copies, are selected afterwards. Returns the old selection.
    pub(crate) fn go(&mut self, by: f64) -> Vec<KeyAt> {
        let before = self.selected.clone();
        self.selected.iter_mut().for_each(|(_, frame)| *frame += by);
        before
    }

    pub(crate) fn select(&mut self, keys: Vec<KeyAt>) {
        self.selected = keys;
    }

    /// Deselects keys that do not exist any more.
    pub(crate) fn retain(&mut self, lanes: &[Lane]) {
        self.selected.retain(|(of, frame)| lanes.iter().any(|lane| lane.of == *of && lane.has(*frame)));
    }

    fn press(&mut self, at: LanePosition, key: Option<KeyAt>, adds: bool) {
        self.focused = true;
        let Some(key) = key else {
            let before = self.selected.clone();
            self.busy = Busy::Boxing { from: at, to: at, before, adds };
            return;
        };
        let is_selected = self.contains(&key.0, key.1);
        if adds && is_selected {
            self.selected.retain(|other| *other != key);
            return;
        }
        if !is_selected {
            if !adds {
                self.selected.clear();
            }
            self.selected.push(key.clone());
        }
        self.busy = Busy::Held { key, from: at, adds };
    }

    fn moved(&mut self, at: LanePosition, lanes: &[Lane]) {
        match &mut self.busy {
            Busy::Idle => {}
            Busy::Held { key, from, .. } => {
                if (at.x_px - from.x_px).abs() >= DRAG_PX {
                    let (grabbed, from) = (key.1, Some(*from));
                    let dragged = Dragged { by: 0.0, copies: false };
                    self.busy = Busy::Dragging { grabbed, from, dragged };
                    self.moved(at, lanes);
                }
            }
            Busy::Dragging { grabbed, from, dragged } => {
                let from = from.get_or_insert(at);
                let frames = self.selected.iter().map(|(_, frame)| *frame);
                let (least, most) =
                    (frames.clone().fold(*grabbed, f64::min), frames.fold(*grabbed, f64::max));
                let by = (*grabbed + at.frame - from.frame).round() - *grabbed;
                dragged.by = by.clamp(-MAX_FRAME - least, MAX_FRAME - most);
            }
            Busy::Boxing { from, to, before, adds } => {
                *to = at;
                if !is_far(from, to) {
                    return;
                }
                let rows = from.lane.min(at.lane)..=from.lane.max(at.lane);
                let frames = from.frame.min(at.frame)..=from.frame.max(at.frame);
                self.selected = if *adds { before.clone() } else { Vec::new() };
                for (_, lane) in lanes.iter().enumerate().filter(|(row, _)| rows.contains(row)) {
                    for key in lane.keys.iter().filter(|key| frames.contains(&key.frame)) {
                        let key = (lane.of.clone(), key.frame);
                        if !self.selected.contains(&key) {
                            self.selected.push(key);
                        }
                    }
                }
            }
        }
    }

    fn release(&mut self, lanes: &[Lane]) -> Option<Command> {
        match std::mem::take(&mut self.busy) {
            Busy::Idle => None,
            Busy::Held { key, adds, .. } => {
                if !adds {
                    self.selected = vec![key];
                }
                None
            }
            Busy::Dragging { dragged: Dragged { by, copies }, .. } => {
                let keys = self.selected.clone();
                let time = if copies { Time::CopyKeys(keys, by) } else { Time::MoveKeys(keys, by) };
                (by != 0.0).then_some(Command::Time(time))
            }
            Busy::Boxing { from, to, adds, .. } => {
                if is_far(&from, &to) {
                    return None;
                }
                let lane = lanes.get(from.lane);
                let left = lane.and_then(|lane| Some((lane, lane.left_of(from.frame)?)));
                match left {
                    // A click between two keys.
                    Some((lane, key)) if !adds => {
                        let keys = vec![(lane.of.clone(), key.frame)];
                        next_ease(key.ease).map(|ease| Command::Time(Time::SetEase(keys, ease)))
                    }
                    _ => {
                        if !adds {
                            self.selected.clear();
                        }
                        None
                    }
                }
            }
        }
    }
}

fn is_far(from: &LanePosition, to: &LanePosition) -> bool {
    (from.x_px - to.x_px).hypot(from.y_px - to.y_px) >= DRAG_PX
}
