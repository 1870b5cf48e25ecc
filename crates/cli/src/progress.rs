//! Progress of a command: a bar in a terminal, or lines for runners of Open Job Descriptions.

use std::io::{IsTerminal as _, Write as _};

use clap::ValueEnum;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Progress {
    /// A bar, in a terminal.
    #[default]
    Bar,
    /// Lines for runners of Open Job Descriptions.
    Openjd,
}

impl Progress {
    /// Tells a runner of Open Job Descriptions how many frames are done, and the number of the last.
    pub(crate) fn tell_openjd(done: u64, count: u64, frame: i64) -> std::io::Result<()> {
        let mut out = std::io::stdout().lock();
        let percent = 100.0 * done as f64 / count.max(1) as f64;
        writeln!(out, "openjd_progress: {percent:.1}\nopenjd_status: frame {frame}, {done} of {count}")?;
        out.flush()
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
