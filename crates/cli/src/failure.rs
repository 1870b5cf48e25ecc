//! Why a command ends early, and the exit code that says so.

use std::fmt::Display;
use std::path::Path;

use impasto_frame_files::PlaceError;
use impasto_gl_render::RenderError;
use impasto_gl_render::context::ContextError;
use impasto_scene::problem::Report;
use impasto_sequence::FrameError;
use impasto_sequence::movie::MovieError;

/// The exit code where the command line is wrong.
pub(crate) const USAGE: u8 = 2;

#[derive(Debug)]
pub(crate) enum Failure {
    /// Nothing more is printed; the command ends with this exit code.
    Quiet(u8),
    /// Something went wrong that is not the input's fault.
    Other(String),
    /// The command line is wrong.
    Usage(String),
    /// A file is wrong.
    Input(Report),
    /// What was asked for cannot be done with this input.
    Refused(String),
    NoOpenGl(ContextError),
    #[cfg(feature = "editor")]
    NoWindow(String),
    /// Some frames failed; the others are written.
    SomeFrames {
        failed: u64,
        done: u64,
    },
    /// A frame could not be written, for the reason in `words`, after `done` frames were written.
    NotWritten {
        words: String,
        done: u64,
    },
    /// A signal came after `done` frames were written.
    Interrupted {
        done: u64,
    },
}

impl Failure {
    /// For a file that could not be read or written.
    pub(crate) fn of_file(path: &Path, error: impl Display) -> Self {
        Self::Other(format!("{}: {error}", path.display()))
    }

    pub(crate) fn code(&self) -> u8 {
        match self {
            Self::Quiet(code) => *code,
            Self::Other(_) => 1,
            Self::Usage(_) => USAGE,
            Self::Input(_) | Self::Refused(_) => 3,
            Self::NoOpenGl(_) => 4,
            #[cfg(feature = "editor")]
            Self::NoWindow(_) => 4,
            Self::SomeFrames { .. } | Self::NotWritten { .. } => 5,
            Self::Interrupted { .. } => 130,
        }
    }

    pub(crate) fn words(&self) -> Option<String> {
        Some(match self {
            Self::Quiet(_) => return None,
            Self::Other(words) | Self::Usage(words) | Self::Refused(words) => {
                format!("impasto: error: {words}")
            }
            Self::Input(report) => report.to_string(),
            Self::NoOpenGl(error) => format!("impasto: error: {error}"),
            #[cfg(feature = "editor")]
            Self::NoWindow(words) => format!("impasto: error: {words}"),
            Self::SomeFrames { failed, done } => {
                let failed = if *failed == 1 { "1 frame".to_owned() } else { format!("{failed} frames") };
                let are = if *done == 1 { "is" } else { "are" };
                format!("impasto: error: {failed} failed, {done} {are} done")
            }
            Self::NotWritten { words, done } => {
                let whole = match done {
                    0 => "nothing is written".to_owned(),
                    1 => "1 frame is done and whole (go on with --skip-existing)".to_owned(),
                    _ => format!("{done} frames are done and whole (go on with --skip-existing)"),
                };
                format!("impasto: error: {words}; {whole}")
            }
            Self::Interrupted { done: 0 } => "impasto: interrupted; nothing is written".to_owned(),
            Self::Interrupted { done } => {
                let done = if *done == 1 { "1 frame is".to_owned() } else { format!("{done} frames are") };
                format!("impasto: interrupted; {done} done and whole (go on with --skip-existing)")
            }
        })
    }
}

impl From<Report> for Failure {
    fn from(report: Report) -> Self {
        Self::Input(report)
    }
}

impl From<PlaceError> for Failure {
    fn from(error: PlaceError) -> Self {
        Self::Refused(format!("{error}; name another place with -o"))
    }
}

impl From<ContextError> for Failure {
    fn from(error: ContextError) -> Self {
        Self::NoOpenGl(error)
    }
}

impl From<RenderError> for Failure {
    fn from(error: RenderError) -> Self {
        match error {
            RenderError::TooLarge { .. } | RenderError::Empty => Self::Refused(error.to_string()),
            RenderError::Gl(_) => Self::Other(error.to_string()),
        }
    }
}

impl From<FrameError> for Failure {
    fn from(error: FrameError) -> Self {
        match error {
            FrameError::Render(error) => error.into(),
            FrameError::Encode(_) | FrameError::Write(_) => Self::Other(error.to_string()),
        }
    }
}

impl From<MovieError> for Failure {
    fn from(error: MovieError) -> Self {
        match error {
            MovieError::NoTransparency(words) => Self::Usage(format!("--alpha: {words}")),
            MovieError::NotInstalled(words) => Self::Refused(format!(
                "{words}, or let impasto render write frames (-o out/frame_####.png) or one animated PNG (--apng)"
            )),
            MovieError::NoEncoder(words) => Self::Refused(words),
            MovieError::Failed(words) => Self::Other(words),
            MovieError::Frame(error) => error.into(),
        }
    }
}
