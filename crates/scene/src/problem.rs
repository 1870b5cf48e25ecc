//! Problems in files: where, what is wrong, and how to mend it. Every reader of this crate reports in this form.

use std::fmt;
use std::path::PathBuf;

/// One error or oddity in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Whether the file can still be used.
    pub severity: Severity,
    /// The file that it is in.
    pub path: PathBuf,
    /// Line and column, where they are known.
    pub place: Option<TextPosition>,
    /// The field of the scene that it concerns, as in `objects[2].keys[1].frame`; empty where it concerns none.
    pub field_path: Box<str>,
    /// What is wrong, as one sentence without a full stop.
    pub message: String,
    /// What to do about it, as one sentence without a full stop.
    pub mend: String,
}

/// A position in a text file, counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct TextPosition {
    /// Line.
    pub line: usize,
    /// Column, in characters.
    pub column: usize,
}

/// How bad a problem is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The file is used, with something replaced or left out.
    Warning,
    /// The file cannot be used.
    Error,
    /// The file exceeds a limit and cannot be used.
    Limit,
}

impl Severity {
    /// Whether the file cannot be used.
    pub fn is_fatal(self) -> bool {
        self != Self::Warning
    }
}

/// At least one fatal problem, and whatever else was found on the way, in the order of the file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct Report(pub Vec<Problem>);

impl fmt::Display for Problem {
    /// `file:line:column: error: what is wrong; the mend`.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}", self.path.display())?;
        if let Some(place) = self.place {
            write!(formatter, ":{}:{}", place.line, place.column)?;
        }
        let word = match self.severity {
            Severity::Warning => "warning",
            Severity::Error => "error",
            Severity::Limit => "limit",
        };
        write!(formatter, ": {word}: {}", self.message)?;
        if self.mend.is_empty() { Ok(()) } else { write!(formatter, "; {}", self.mend) }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, problem) in self.0.iter().enumerate() {
            if index > 0 {
                writeln!(formatter)?;
            }
            write!(formatter, "{problem}")?;
        }
        Ok(())
    }
}
