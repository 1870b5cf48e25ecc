//! Plays the shot in the editor: says which frame is to be shown now, and which frames were dropped. The caller passes
//! the time, in seconds of any clock.
//!
//! ```text
//! play ─▶ tick(now) ─▶ frame asked for ─▶ a picture ─▶ shown(frame, now) ─▶ dropped, lead
//! ```
//!
//! Pictures that take time to draw are asked for earlier (by the lead), so that they are shown when their frame is due.

use std::collections::BTreeSet;

#[cfg(test)]
mod tests;

/// If the clock jumps ahead by more than this many seconds (as after a suspension of the machine), or back by more than
/// [`MOST_LEAD_SECS`], playback goes on from the frame that is shown.
const SLEPT_SECS: f64 = 5.0;
/// The greatest lead, seconds. The lead is the time by which pictures are asked for before they are due.
const MOST_LEAD_SECS: f64 = 0.4;
/// The share of a picture's lateness that is added to the lead.
const LEAD_GAIN: f64 = 0.2;
/// The weight of the newest interval in the mean time between pictures.
const RATE_GAIN: f64 = 0.2;
/// Tolerance against rounding of times, in frames.
const ROUNDING: f64 = 1e-6;

/// Whether playback follows the clock or shows every frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Pacing {
    /// The frame that the clock asks for; frames that cannot be drawn in time are dropped.
    #[default]
    RealTime,
    /// All frames, however long they take.
    EveryFrame,
}

/// The range of frames that is played, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Course {
    /// First frame.
    pub first: i64,
    /// Last frame, not before the first.
    pub last: i64,
    /// Frames per second, > 0.
    pub fps: f64,
    /// Whether it begins again at the end.
    pub looped: bool,
    /// Whether it follows the clock or shows every frame.
    pub pacing: Pacing,
}

/// Playback, running or stopped, and the frames that it dropped.
#[derive(Clone, Debug, Default)]
pub struct Playback {
    playing: Option<Playing>,
    dropped: u64,
    missed: BTreeSet<i64>,
    lead_secs: f64,
}

/// Playback while it runs. `asked` and `shown` are indices: they count frames from the one that playing began at, and
/// go on across the loop's end.
#[derive(Clone, Debug)]
struct Playing {
    course: Course,
    start_secs: f64,
    start_frame: i64,
    ticked_secs: f64,
    asked: i64,
    shown: i64,
    /// With [`Pacing::EveryFrame`], when the shown frame was due; the next is due one frame later.
    due_secs: f64,
    shown_secs: f64,
    /// Mean seconds between pictures.
    interval_secs: Option<f64>,
}

impl Course {
    /// How many frames there are, ≥ 1.
    pub fn count(&self) -> i64 {
        self.last.saturating_sub(self.first).saturating_add(1).max(1)
    }

    /// The frame at which playing begins: the playhead's. If the playhead is outside the range, or at the end of a
    /// range that is not looped, it is the first frame.
    fn start(&self, frame: f64) -> i64 {
        let is_inside = frame >= self.first as f64 && frame < self.last as f64 + 1.0;
        let start = if is_inside { frame.floor() as i64 } else { self.first };
        if !self.looped && start == self.last { self.first } else { start }
    }
}

impl Playing {
    fn frame_of(&self, index: i64) -> i64 {
        let Course { first, last, looped, .. } = self.course;
        if looped {
            first + (self.start_frame - first + index).rem_euclid(self.course.count())
        } else {
            (self.start_frame + index).min(last)
        }
    }

    /// Index of the last frame, counted from the one that playing began at; none if playback loops.
    fn end(&self) -> Option<i64> {
        (!self.course.looped).then_some(self.course.last - self.start_frame)
    }

    /// The index that shows this frame; if playback loops, the latest that is not after `asked`.
    fn index_of(&self, frame: i64) -> i64 {
        let behind = self.frame_of(self.asked) - frame;
        let behind = if self.course.looped { behind.rem_euclid(self.course.count()) } else { behind };
        self.asked - behind
    }

    /// Index of the frame that is due at a time.
    fn due_by_clock(&self, now_secs: f64) -> i64 {
        ((now_secs - self.start_secs) * self.course.fps + ROUNDING).floor() as i64
    }

    /// Starts again from the frame that is shown, with `now_secs` as the new time zero.
    fn begin_again(&mut self, course: Course, now_secs: f64) {
        let frame = self.frame_of(self.shown);
        *self = Self::new(course, course.start(frame as f64), now_secs);
    }

    fn new(course: Course, start_frame: i64, now_secs: f64) -> Self {
        Self {
            course,
            start_secs: now_secs,
            start_frame,
            ticked_secs: now_secs,
            asked: 0,
            shown: 0,
            due_secs: now_secs,
            shown_secs: now_secs,
            interval_secs: None,
        }
    }
}

impl Playback {
    /// Plays from a frame; the count of dropped frames starts over.
    pub fn play(&mut self, frame: f64, course: Course, now_secs: f64) {
        self.dropped = 0;
        self.missed.clear();
        self.resume(frame, course, now_secs);
    }

    /// Plays on from a frame, after a scrub.
    pub fn resume(&mut self, frame: f64, course: Course, now_secs: f64) {
        self.playing = Some(Playing::new(course, course.start(frame), now_secs + self.lead_secs));
    }

    /// Stops. The count of dropped frames stays.
    pub fn stop(&mut self) {
        self.playing = None;
    }

    /// Whether it plays.
    pub fn is_playing(&self) -> bool {
        self.playing.is_some()
    }

    /// The frame that should be drawn next; `None` once playback has stopped.
    pub fn tick(&mut self, course: Course, now_secs: f64) -> Option<f64> {
        let lead_secs = self.lead_secs;
        let playing = self.playing.as_mut()?;
        let passed = now_secs - playing.ticked_secs;
        if course != playing.course || !(-MOST_LEAD_SECS..SLEPT_SECS).contains(&passed) {
            playing.begin_again(course, now_secs + lead_secs);
        }
        playing.ticked_secs = now_secs;
        let is_still = course.count() == 1;
        let asked = match course.pacing {
            Pacing::RealTime => playing.due_by_clock(now_secs + lead_secs),
            Pacing::EveryFrame if playing.shown < playing.asked && !is_still => playing.asked,
            Pacing::EveryFrame if now_secs + ROUNDING >= playing.due_secs + 1.0 / course.fps => {
                playing.asked + 1
            }
            Pacing::EveryFrame => playing.asked,
        };
        playing.asked = asked.max(playing.asked).min(playing.end().unwrap_or(i64::MAX));
        if is_still {
            // If the range has only one frame, it counts as shown at every tick.
            (playing.shown, playing.due_secs) = (playing.asked, now_secs);
        }
        let frame = playing.frame_of(playing.asked);
        if playing.end().is_some_and(|end| playing.shown >= end) {
            self.stop();
        }
        Some(frame as f64)
    }

    /// The frame that was asked for last; none while stopped.
    pub fn asked(&self) -> Option<f64> {
        self.playing.as_ref().map(|playing| playing.frame_of(playing.asked) as f64)
    }

    /// Call this when a picture of this frame is shown. Returns whether playback goes on to this frame. It does if the
    /// frame was asked for and is later than the one that was shown.
    pub fn shown(&mut self, frame: f64, now_secs: f64) -> bool {
        let Some(playing) = &mut self.playing else { return false };
        let (Course { fps, pacing, .. }, index) = (playing.course, playing.index_of(frame.round() as i64));
        if index <= playing.shown || index > playing.asked {
            return false;
        }
        let skipped = index - playing.shown - 1;
        self.dropped += skipped.unsigned_abs();
        for missed in (playing.shown + 1..index).rev().take(playing.course.count() as usize) {
            self.missed.insert(playing.frame_of(missed));
        }
        playing.shown = index;
        let interval = now_secs - playing.shown_secs;
        playing.shown_secs = now_secs;
        let mean = playing.interval_secs.unwrap_or(interval);
        playing.interval_secs = Some(mean + (interval - mean) * RATE_GAIN);
        match pacing {
            Pacing::RealTime => {
                let late = (now_secs - playing.start_secs) - (index as f64 + 0.5) / fps;
                self.lead_secs = (self.lead_secs + late * LEAD_GAIN).clamp(0.0, MOST_LEAD_SECS);
            }
            // At most one frame of lateness is made up for, so that frames do not race after a slow picture.
            Pacing::EveryFrame => playing.due_secs = (playing.due_secs + 1.0 / fps).max(now_secs - 1.0 / fps),
        }
        true
    }

    /// How many frames were skipped since playing began.
    pub fn dropped(&self) -> u64 {
        self.dropped
    }

    /// The frames that were dropped at least once, in order.
    pub fn missed(&self) -> impl Iterator<Item = i64> {
        self.missed.iter().copied()
    }

    /// Pictures a second; `None` while stopped and before the first picture.
    pub fn rate(&self) -> Option<f64> {
        let interval = self.playing.as_ref()?.interval_secs?;
        (interval > 0.0).then(|| 1.0 / interval)
    }

    /// The frame that the clock has reached, with its fraction; `None` while stopped.
    pub fn clock_frame(&self, now_secs: f64) -> Option<f64> {
        let playing = self.playing.as_ref()?;
        let frames = ((now_secs - playing.start_secs) * playing.course.fps).max(0.0);
        let index = frames.floor();
        let end = playing.end().unwrap_or(i64::MAX);
        Some(playing.frame_of((index as i64).min(end)) as f64 + (frames - index))
    }

    /// The frame that will likely be asked for after the one that is drawn now; `None` while stopped.
    pub fn upcoming(&self) -> Option<f64> {
        let playing = self.playing.as_ref()?;
        let step = match playing.course.pacing {
            Pacing::RealTime => {
                let interval = playing.interval_secs.unwrap_or(0.0);
                (interval * playing.course.fps).round().max(1.0) as i64
            }
            Pacing::EveryFrame => 1,
        };
        Some(playing.frame_of(playing.asked.saturating_add(step)) as f64)
    }

    /// Seconds until [`Playback::tick`] asks for another frame; `None` while stopped.
    pub fn wait_secs(&self, now_secs: f64) -> Option<f64> {
        let playing = self.playing.as_ref()?;
        let next = match playing.course.pacing {
            Pacing::RealTime => {
                let due = (playing.asked + 1) as f64 / playing.course.fps;
                playing.start_secs + due - self.lead_secs
            }
            Pacing::EveryFrame => playing.due_secs + 1.0 / playing.course.fps,
        };
        Some((next - now_secs).max(0.0))
    }
}
