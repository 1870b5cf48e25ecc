//! Problems in files: where, what is wrong, and how to mend it. Every reader of this crate reports in this form.

use std::fmt;
use std::path::{Path, PathBuf};

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
    /// What to do about it, as one sentence without a full stop; may be empty.
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

/// At least one fatal problem, and whatever else was found on the way.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct Report(pub Vec<Problem>);

impl Problem {
    /// If the problem is that a named file is missing, the path of that file, beside the file that names it. `None` for
    /// any other problem. The name is read from the message, which is that of [`crate::assets::AssetError::Missing`].
    pub fn missing_file(&self) -> Option<PathBuf> {
        let (named, _) = self.message.split_once("\" was not found (tried ")?;
        let (_, name) = named.rsplit_once('"')?;
        let is_whole = !name.is_empty() && !name.contains(['…', '\\']);
        is_whole.then(|| self.path.parent().unwrap_or(Path::new("")).join(name))
    }
}

impl fmt::Display for Problem {
    /// `file:line:column: error: what is wrong; what to do about it`.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}", escaped(&self.path.to_string_lossy(), MOST_OF_A_PATH))?;
        if let Some(place) = self.place {
            write!(formatter, ":{}:{}", place.line, place.column)?;
        }
        let word = match self.severity {
            Severity::Warning => "warning",
            Severity::Error => "error",
            Severity::Limit => "limit",
        };
        write!(formatter, ": {word}: {}", harmless(&self.message))?;
        if self.mend.is_empty() { Ok(()) } else { write!(formatter, "; {}", harmless(&self.mend)) }
    }
}

/// The most characters of a word that are shown: few names of files are longer, and a hostile word may have millions.
const MOST_OF_A_WORD: usize = 200;

/// The most characters that are shown of a word in the path of a file. Linux opens no longer path.
const MOST_OF_A_PATH: usize = 4096;

/// A text that is safe to show in a terminal: control characters except line feeds and tabs are escaped, and very long
/// words are cut.
pub fn harmless(text: &str) -> String {
    escaped(text, MOST_OF_A_WORD)
}

fn escaped(text: &str, most_of_a_word: usize) -> String {
    let mut shown = String::with_capacity(text.len().min(1 << 12));
    let mut length = 0;
    for letter in text.chars() {
        length = if letter.is_whitespace() { 0 } else { length + 1 };
        if length > most_of_a_word {
            shown.extend((length == most_of_a_word + 1).then_some('…'));
        } else if letter.is_control() && letter != '\n' && letter != '\t' {
            shown.extend(letter.escape_debug());
        } else {
            shown.push(letter);
        }
    }
    shown
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_file_is_known_by_its_words() {
        use crate::assets::AssetError;
        let missing = |name: &str| AssetError::Missing { name: name.to_owned(), tried: vec!["/a/b".into()] };
        let of = |error: AssetError| error.to_problem(Severity::Warning, Path::new("/m/apple.mtl"), None);
        assert_eq!(of(missing("maps/skin 1.png")).missing_file(), Some("/m/maps/skin 1.png".into()));
        assert_eq!(of(missing("long…")).missing_file(), None);
        assert_eq!(of(AssetError::NotAFile("/m/skin.png".into())).missing_file(), None);
        let prefixed = Problem { message: format!("objects: {}", missing("a.obj")), ..of(missing("a.obj")) };
        assert_eq!(prefixed.missing_file(), Some("/m/a.obj".into()));
    }

    #[test]
    fn what_is_shown_steers_no_terminal_and_has_an_end() {
        assert_eq!(harmless("a \u{1b}[31mred\u{7}\n\tb é"), "a \\u{1b}[31mred\\u{7}\n\tb é");
        let long = format!("{} next {}", "x".repeat(10_000_000), "y".repeat(200));
        assert_eq!(harmless(&long), format!("{}… next {}", "x".repeat(200), "y".repeat(200)));
        // The path of a file is told whole.
        let path = Path::new("/farm").join("of_a_show/".repeat(30)).join("shot.ron");
        let error = crate::assets::AssetError::NotAFile("a.obj".into());
        let told = error.to_problem(Severity::Warning, &path, None).to_string();
        assert!(told.starts_with(&format!("{}: warning", path.display())), "{told}");
    }
}
