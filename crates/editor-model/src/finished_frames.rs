//! Viewing the finished frames of a rendering: which frame is to be shown, and which are read from their files ahead of
//! time. The caller passes the time. Nothing is edited here.

use std::path::{Path, PathBuf};

use crate::playback::{Course, Pacing, Playback};

#[cfg(test)]
mod tests;

/// How many frames are read before they are needed.
const AHEAD: usize = 12;

/// The frames that the user looks through, and which of them is to be shown.
#[derive(Clone, Debug)]
pub struct FinishedFrames {
    frames: Vec<(i64, PathBuf)>,
    fps: f64,
    /// Whether playing begins again at the end.
    pub looped: bool,
    /// The frame that is asked for, as an index.
    at: usize,
    playback: Playback,
}

impl FinishedFrames {
    /// Begins at the first of these frames, each with its number and its file; `None` if there is none.
    pub fn new(frames: Vec<(i64, PathBuf)>, fps: f64) -> Option<Self> {
        let fps = if fps.is_finite() && fps > 0.0 { fps } else { 24.0 };
        let is_any = !frames.is_empty();
        is_any.then(|| Self { frames, fps, looped: true, at: 0, playback: Playback::default() })
    }

    /// Takes over the list of the frames that are finished by now. The frame that is asked for stays the same, and
    /// playback goes on. A list without that frame, or with no more frames than before, is not taken over. Returns
    /// whether it was.
    pub fn extend(&mut self, frames: Vec<(i64, PathBuf)>) -> bool {
        let stays = self.frames.get(self.at).map(|(number, _)| *number);
        let at = stays.and_then(|number| frames.iter().position(|(other, _)| *other == number));
        let (Some(at), true) = (at, frames.len() > self.frames.len()) else { return false };
        (self.frames, self.at) = (frames, at);
        true
    }

    /// How many frames there are, ≥ 1.
    pub fn count(&self) -> usize {
        self.frames.len()
    }

    /// Frames per second.
    pub fn fps(&self) -> f64 {
        self.fps
    }

    /// The index of the frame that is asked for.
    pub fn at(&self) -> usize {
        self.at
    }

    /// The number of a frame in its film, and its file.
    pub fn frame(&self, index: usize) -> (i64, &Path) {
        let (number, path) = &self.frames[index.min(self.frames.len() - 1)];
        (*number, path)
    }

    /// All files, in order.
    pub fn paths(&self) -> Vec<PathBuf> {
        self.frames.iter().map(|(_, path)| path.clone()).collect()
    }

    /// Whether it plays.
    pub fn is_playing(&self) -> bool {
        self.playback.is_playing()
    }

    /// How many frames were skipped since playing began.
    pub fn dropped(&self) -> u64 {
        self.playback.dropped()
    }

    /// Plays, or stops.
    pub fn play_or_stop(&mut self, now_secs: f64) {
        if self.is_playing() {
            self.playback.stop();
        } else {
            self.playback.play(self.at as f64, self.course(), now_secs);
        }
    }

    /// Stops, and goes to a frame. An index beyond either end goes to that end.
    pub fn go_to(&mut self, index: i64) {
        self.playback.stop();
        self.at = index.clamp(0, self.frames.len() as i64 - 1) as usize;
    }

    /// Stops, and goes this many frames on. If playback loops, a step past one end goes on from the other end.
    pub fn step(&mut self, by: i64) {
        let index = self.at as i64 + by;
        self.go_to(if self.looped { index.rem_euclid(self.frames.len() as i64) } else { index });
    }

    /// To be called as time passes.
    pub fn tick(&mut self, now_secs: f64) {
        let course = self.course();
        if let Some(frame) = self.playback.tick(course, now_secs) {
            self.at = frame.max(0.0) as usize;
        }
    }

    /// Notes that a frame is shown.
    pub fn shown(&mut self, index: usize, now_secs: f64) {
        self.playback.shown(index as f64, now_secs);
    }

    /// Seconds until another frame is due; `None` while it does not play.
    pub fn wait_secs(&self, now_secs: f64) -> Option<f64> {
        self.playback.wait_secs(now_secs)
    }

    /// The indices of the frames to read, the most urgent first: the frame that is asked for, then the frame before it
    /// (only while playback is stopped; the last frame counts as the one before the first), then the frames after it.
    pub fn wanted(&self) -> Vec<usize> {
        let count = self.frames.len();
        let mut wanted: Vec<usize> = (0..=AHEAD)
            .map(|step| self.at + step)
            .map_while(|index| (index < count || self.looped).then_some(index % count))
            .collect();
        if !self.is_playing() {
            wanted.insert(1, self.at.checked_sub(1).unwrap_or(count - 1));
        }
        let mut seen = std::collections::HashSet::new();
        wanted.retain(|index| seen.insert(*index));
        wanted
    }

    fn course(&self) -> Course {
        let last = self.frames.len() as i64 - 1;
        Course { first: 0, last, fps: self.fps, looped: self.looped, pacing: Pacing::RealTime }
    }
}
