//! The progress of rendering frames, in numbers and in words for the window. The caller passes the times: no clock is
//! read here.

use std::path::PathBuf;

/// What is being done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stage {
    /// The scene is being prepared.
    #[default]
    Preparing,
    /// Frames are drawn.
    Drawing,
}

/// How rendering ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Every frame has its file.
    Done,
    /// It was stopped.
    Stopped,
    /// It broke off; the words say what went wrong and where.
    Failed(String),
}

/// How far rendering has come.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RenderProgress {
    /// What is being done.
    pub stage: Stage,
    /// How many frames there will be.
    pub total: u64,
    /// How many frames were written.
    pub written: u64,
    /// How many frames had files before, which are kept.
    pub kept: u64,
    /// Time since rendering began, seconds.
    pub gone_s: f64,
    /// The part of `gone_s` that went into the written frames, seconds.
    pub drawing_s: f64,
    /// Strokes of the last frame.
    pub strokes: usize,
    /// The file that was written last.
    pub last: Option<PathBuf>,
    /// How rendering ended; `None` while it runs.
    pub outcome: Option<Outcome>,
    /// Whether it was asked to stop.
    pub stopping: bool,
}

impl RenderProgress {
    /// How many frames have their files now.
    pub fn done(&self) -> u64 {
        self.written + self.kept
    }

    /// The share that is done, 0 to 1.
    pub fn share(&self) -> f64 {
        if self.total == 0 { 0.0 } else { self.done() as f64 / self.total as f64 }
    }

    /// *47 of 120*.
    pub fn count(&self) -> String {
        format!("{} of {}", self.done(), self.total)
    }

    /// Estimated time left, seconds, from the frames so far; `None` before the first frame and after the last.
    pub fn left_s(&self) -> Option<f64> {
        let left = self.total.saturating_sub(self.done());
        let is_known = self.written > 0 && left > 0 && self.outcome.is_none();
        is_known.then(|| self.drawing_s / self.written as f64 * left as f64)
    }

    /// *1 min 52 s gone, about 2 min 54 s left*.
    pub fn time_words(&self) -> String {
        let gone = duration(self.gone_s);
        match (&self.outcome, self.left_s()) {
            (Some(_), _) => format!("took {gone}"),
            (None, Some(left)) => format!("{gone} gone, about {} left", duration(left)),
            (None, None) => format!("{gone} gone"),
        }
    }

    /// *2.4 s a frame, 5,774 strokes*; empty before the first frame.
    pub fn frame_words(&self) -> String {
        if self.written == 0 {
            return String::new();
        }
        let each = self.drawing_s / self.written as f64;
        let each = if each < 10.0 { format!("{each:.1} s") } else { duration(each) };
        if self.strokes == 0 {
            format!("{each} a frame")
        } else {
            format!("{each} a frame, {} strokes", grouped(self.strokes))
        }
    }

    /// The state, or how it ended, in one line.
    pub fn state_words(&self) -> String {
        let frames = |count: u64| super::counted_frames(count);
        match (&self.outcome, self.stage) {
            (Some(Outcome::Done), _) if self.kept > 0 => {
                format!("{} written, {} were there", frames(self.written), self.kept)
            }
            (Some(Outcome::Done), _) => format!("{} written", frames(self.written)),
            (Some(Outcome::Stopped), _) => format!("Stopped; {} are whole", frames(self.done())),
            (Some(Outcome::Failed(words)), _) => words.clone(),
            (None, _) if self.stopping => "Stopping\u{2026}".to_owned(),
            (None, Stage::Preparing) => "Preparing the scene\u{2026}".to_owned(),
            (None, Stage::Drawing) => "Finished frames are safe to use now".to_owned(),
        }
    }
}

/// *2 min 54 s*, *1 h 5 min*, *8 s*.
fn duration(seconds: f64) -> String {
    let whole = seconds.max(0.0).round() as u64;
    let (hours, minutes, seconds) = (whole / 3600, whole / 60 % 60, whole % 60);
    match (hours, minutes) {
        (0, 0) => format!("{seconds} s"),
        (0, _) => format!("{minutes} min {seconds} s"),
        _ => format!("{hours} h {minutes} min"),
    }
}

fn grouped(count: usize) -> String {
    if count < 1000 { count.to_string() } else { format!("{},{:03}", grouped(count / 1000), count % 1000) }
}
