//! A finding of `cargo xtask tidy`: one untidy place.

use std::fmt;

/// One untidy place.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Finding {
    /// Path from the repository's root, with `/`.
    pub file: String,
    /// Line from 1; 1 where the whole file is meant.
    pub line: usize,
    /// What is untidy.
    pub what: String,
    /// What to do about it.
    pub mend: &'static str,
}

impl Finding {
    /// A finding about a whole file.
    pub fn of_file(file: &str, what: impl Into<String>, mend: &'static str) -> Self {
        Self::at(file, 1, what, mend)
    }

    /// A finding about one line, counted from 1.
    pub fn at(file: &str, line: usize, what: impl Into<String>, mend: &'static str) -> Self {
        Self { file: file.to_owned(), line, what: what.into(), mend }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}:{}: {}; {}", self.file, self.line, self.what, self.mend)
    }
}
