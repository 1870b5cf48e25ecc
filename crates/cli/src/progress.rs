//! Progress of a command: a bar in a terminal, lines of JSON, or lines for runners of Open Job Descriptions.

use std::io::{IsTerminal as _, Write as _};
use std::path::Path;

use clap::ValueEnum;
use impasto_gl_render::Renderer;
use impasto_sequence::Drawn;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Progress {
    /// A bar, in a terminal.
    #[default]
    Bar,
    /// Lines for runners of Open Job Descriptions.
    Openjd,
}

/// What `render` prints on stdout for programs, frame by frame.
pub(crate) struct FrameLines {
    json: bool,
    progress: Progress,
    /// How many frames there are.
    count: u64,
    passed: u64,
}

impl FrameLines {
    pub(crate) fn new(json: bool, progress: Progress, count: u64) -> Self {
        Self { json, progress, count, passed: 0 }
    }

    /// Says which driver draws.
    pub(crate) fn begin(&self, renderer: &Renderer) -> std::io::Result<()> {
        if self.json {
            let driver = renderer.report().to_string();
            let line = serde_json::json!({ "version": 1, "event": "context", "driver": driver });
            writeln!(std::io::stdout(), "{line}")?;
        }
        Ok(())
    }

    /// Says that a frame was painted, into this file.
    pub(crate) fn painted(&self, frame_number: i64, path: &Path, drawn: &Drawn) -> std::io::Result<()> {
        if self.json {
            let line = serde_json::json!({
                "version": 1,
                "event": "frame",
                "frame": frame_number,
                "path": path,
                "strokes": drawn.painted_strokes,
                "seconds": drawn.seconds,
            });
            writeln!(std::io::stdout(), "{line}")?;
        }
        Ok(())
    }

    /// Says how many frames are done, painted or not, and the number of the last.
    pub(crate) fn passed(&mut self, frame_number: i64) -> std::io::Result<()> {
        self.passed += 1;
        if self.progress == Progress::Openjd {
            let (done, count) = (self.passed, self.count);
            let percent = 100.0 * done as f64 / count.max(1) as f64;
            let mut out = std::io::stdout().lock();
            writeln!(
                out,
                "openjd_progress: {percent:.1}\nopenjd_status: frame {frame_number}, {done} of {count}"
            )?;
            out.flush()?;
        }
        Ok(())
    }
}

/// A bar on stderr. It is hidden if `quiet`, or if stderr is not a terminal.
pub(crate) fn progress_bar(count: u64, quiet: bool) -> ProgressBar {
    let shown = std::io::stderr().is_terminal() && !quiet;
    let target = if shown { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
    let bar = ProgressBar::with_draw_target(Some(count), target);
    if let Ok(style) = ProgressStyle::with_template("{prefix}{wide_bar} {pos}/{len} frames, {eta} left") {
        bar.set_style(style);
    }
    bar
}
