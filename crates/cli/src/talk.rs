//! `--verbose` and `--quiet`: how much a command says on stderr.

use clap::Args;

/// How much to say.
#[derive(Args, Clone, Copy, Debug)]
pub(crate) struct Talk {
    /// Say more: which driver and why, the steps of preparing, and for each frame its strokes, overdraw, memory and
    /// passes. Rendering is slower then.
    #[arg(short, long, action = clap::ArgAction::Count)]
    pub(crate) verbose: u8,
    /// Say nothing but errors.
    #[arg(short, long, conflicts_with = "verbose")]
    pub(crate) quiet: bool,
}

impl Talk {
    /// What is said while a scene is prepared.
    pub(crate) fn loudness(self) -> Loudness {
        match self {
            Self { quiet: true, .. } => Loudness::Errors,
            Self { verbose: 0, .. } => Loudness::Warnings,
            _ => Loudness::Steps,
        }
    }
}

/// What is said while a scene is prepared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Loudness {
    /// Errors.
    Errors,
    /// Errors and warnings.
    Warnings,
    /// Also what each step takes.
    Steps,
}
