//! What is wrong or odd in a file: where (a JSON pointer), what, and how to mend it.

use std::borrow::Cow;
use std::fmt;

/// One error or oddity in a glTF file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// Whether the file can still be used.
    pub severity: Severity,
    /// JSON pointer of the value that it concerns, as in `/accessors/3/count`; empty for the file as a whole.
    pub pointer: String,
    /// What is wrong, as one sentence without a full stop.
    pub message: String,
    /// What to do about it, as one sentence without a full stop; empty where the message says it.
    pub mend: Cow<'static, str>,
}

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The file is read, with something replaced or left out.
    Warning,
    /// The file is broken and is not read.
    Error,
    /// The file may be right, but needs a feature that is not read. The message names it.
    Unsupported,
    /// The file asks for more than a limit allows.
    Limit,
}

impl Finding {
    /// Whether the file cannot be used.
    pub fn is_fatal(&self) -> bool {
        self.severity != Severity::Warning
    }
}

impl fmt::Display for Finding {
    /// `/pointer: error: what is wrong; the mend`.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.pointer.is_empty() {
            write!(formatter, "{}: ", self.pointer)?;
        }
        let word = match self.severity {
            Severity::Warning => "warning",
            Severity::Error => "error",
            Severity::Unsupported => "unsupported",
            Severity::Limit => "limit",
        };
        write!(formatter, "{word}: {}", self.message)?;
        if self.mend.is_empty() { Ok(()) } else { write!(formatter, "; {}", self.mend) }
    }
}

/// What most errors ask of the user.
pub(crate) const EXPORT_ANEW: &str = "export the file anew, or check it with the Khronos glTF validator";

/// The most errors, and the most warnings, that are listed for one file. A file of a million faults is as broken as one
/// of fifty.
const MOST_TOLD: usize = 50;

/// The findings of a file while it is read. Errors and warnings are counted apart, so that many warnings never hide an
/// error.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    fatal: Vec<Finding>,
    warnings: Vec<Finding>,
    untold_warnings: usize,
}

impl Findings {
    pub fn add(&mut self, finding: Finding) {
        if finding.is_fatal() {
            if self.fatal.len() < MOST_TOLD {
                self.fatal.push(finding);
            }
        } else if self.warnings.len() < MOST_TOLD {
            self.warnings.push(finding);
        } else {
            self.untold_warnings += 1;
        }
    }

    /// The value. If the result is a finding instead, adds the finding and returns `None`.
    pub fn take<T>(&mut self, result: Checked<T>) -> Option<T> {
        result.map_err(|finding| self.add(*finding)).ok()
    }

    /// Whether there are so many errors that no more would be listed.
    pub fn is_full(&self) -> bool {
        self.fatal.len() >= MOST_TOLD
    }

    /// Whether the file cannot be used.
    pub fn any_fatal(&self) -> bool {
        !self.fatal.is_empty()
    }

    /// All findings, fatal ones first.
    pub fn into_list(self) -> Vec<Finding> {
        let mut list = self.fatal;
        list.extend(self.warnings);
        if self.untold_warnings > 0 {
            list.push(Finding {
                severity: Severity::Warning,
                pointer: String::new(),
                message: format!("{} more warnings are not listed", self.untold_warnings),
                mend: Cow::Borrowed(""),
            });
        }
        list
    }
}

/// A value, or why there is none. The finding is boxed, because errors are rare and results are many.
pub(crate) type Checked<T> = Result<T, Box<Finding>>;
