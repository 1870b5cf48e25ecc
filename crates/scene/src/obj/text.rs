//! Lines, words and places of an OBJ or MTL text, with any line ends. UTF-16 is known by its byte order mark.

use std::borrow::Cow;
use std::path::Path;

use crate::problem::{Problem, Report, Severity, TextPosition};

/// How many errors, and how many warnings, are reported one by one.
const MAX_REPORTED: usize = 20;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Word<'a> {
    /// Its bytes, none of them white space.
    pub bytes: &'a [u8],
    /// Where it begins in the text, in bytes.
    pub offset: usize,
}

impl<'a> Word<'a> {
    /// The word as text, for a message or a number; bytes that are no UTF-8 become U+FFFD.
    pub fn text(self) -> Cow<'a, str> {
        String::from_utf8_lossy(self.bytes)
    }

    /// The word between quotes and short enough for a message.
    pub fn quoted(self) -> String {
        let text = self.text();
        if text.chars().count() <= 40 {
            format!("{text:?}")
        } else {
            format!("{:?}…", text.chars().take(32).collect::<String>())
        }
    }
}

/// A word as a finite number.
pub(super) fn finite(word: &[u8]) -> Option<f64> {
    std::str::from_utf8(word).ok()?.parse::<f64>().ok().filter(|number| number.is_finite())
}

/// Turns a file's bytes into text, and returns whether they were UTF-16. UTF-16 becomes UTF-8, a byte order mark is
/// left out, and a carriage return without a line feed behind it becomes a line feed.
pub(super) fn to_utf8(bytes: Vec<u8>) -> (Vec<u8>, bool) {
    let wide = |to_unit: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes[2..].chunks_exact(2).map(|pair| to_unit([pair[0], pair[1]])).collect();
        String::from_utf16_lossy(&units).into_bytes()
    };
    let (mut text, was_utf16) = match bytes.get(..2) {
        Some([0xff, 0xfe]) => (wide(u16::from_le_bytes), true),
        Some([0xfe, 0xff]) => (wide(u16::from_be_bytes), true),
        _ if bytes.starts_with(&[0xef, 0xbb, 0xbf]) => (bytes[3..].to_vec(), false),
        _ => (bytes, false),
    };
    if text.contains(&b'\r') {
        for at in 0..text.len() {
            if text[at] == b'\r' && text.get(at + 1) != Some(&b'\n') {
                text[at] = b'\n';
            }
        }
    }
    (text, was_utf16)
}

/// Keywords of lines that end in a name. In such a line, a `#` belongs to the name.
const NAMING: [&[u8]; 7] = [b"g", b"o", b"usemtl", b"mtllib", b"newmtl", b"map_Kd", b"map_kd"];

/// Walks through the lines that have words. A `\` at the end of a line joins the next line to it. A `#` at the
/// beginning of a word begins a comment, except in a name.
pub(super) struct Lines<'a> {
    text: &'a [u8],
    at: usize,
}

impl<'a> Lines<'a> {
    pub fn new(text: &'a [u8]) -> Self {
        Self { text, at: 0 }
    }

    /// The lines of a part of a text. `start` and `end` lie between two lines, or at an end of the text.
    pub fn between(text: &'a [u8], start: usize, end: usize) -> Self {
        Self { text: &text[..end], at: start }
    }

    /// Where the next line begins.
    pub fn at(&self) -> usize {
        self.at
    }

    /// Fills `words` with the next line's words; false at the end of the text.
    pub fn next_into(&mut self, words: &mut Vec<Word<'a>>) -> bool {
        words.clear();
        while self.at < self.text.len() {
            let byte = self.text[self.at];
            if byte == b'\n' {
                self.at += 1;
                if !words.is_empty() {
                    return true;
                }
            } else if byte == b'#' && !words.first().is_some_and(|first| NAMING.contains(&first.bytes)) {
                self.skip_comment();
            } else if let Some(length) = joint(&self.text[self.at..]) {
                self.at += length;
            } else if byte.is_ascii_whitespace() || byte == 0x0b {
                self.at += 1;
            } else {
                words.push(self.word());
            }
        }
        !words.is_empty()
    }

    fn skip_comment(&mut self) {
        while self.at < self.text.len() && self.text[self.at] != b'\n' {
            self.at += 1;
        }
    }

    fn word(&mut self) -> Word<'a> {
        let offset = self.at;
        while let Some(&byte) = self.text.get(self.at)
            && !byte.is_ascii_whitespace()
            && byte != 0x0b
            && joint(&self.text[self.at..]).is_none()
        {
            self.at += 1;
        }
        Word { bytes: &self.text[offset..self.at], offset }
    }
}

/// The length of a `\` and the line end that follows it.
fn joint(text: &[u8]) -> Option<usize> {
    match text {
        [b'\\', b'\r', b'\n', ..] => Some(3),
        [b'\\', b'\n', ..] => Some(2),
        _ => None,
    }
}

/// The words of a name joined by single spaces: names are compared in this form, so that tabs, trailing blanks and
/// line ends make no difference.
pub(super) fn name_of(words: &[Word<'_>]) -> String {
    words.iter().map(|word| word.text()).collect::<Vec<_>>().join(" ")
}

/// The problems of one text, with their places; the first 20 errors and the first 20 warnings are kept, the rest
/// counted.
pub(super) struct Findings<'a> {
    path: &'a Path,
    text: &'a [u8],
    problems: Vec<Problem>,
    errors: usize,
    warnings: usize,
}

impl<'a> Findings<'a> {
    pub fn new(path: &'a Path, text: &'a [u8]) -> Self {
        Self { path, text, problems: Vec::new(), errors: 0, warnings: 0 }
    }

    /// Line and column of a byte of the text.
    pub fn place(&self, offset: usize) -> TextPosition {
        Walk::default().to(self.text, offset)
    }

    pub fn error(&mut self, offset: usize, message: impl Into<String>, mend: &str) {
        self.errors += 1;
        if self.errors <= MAX_REPORTED {
            let place = Some(self.place(offset));
            self.push(Severity::Error, place, message.into(), mend);
        }
    }

    pub fn warning(&mut self, offset: usize, message: impl Into<String>, mend: &str) {
        self.warnings += 1;
        if self.warnings <= MAX_REPORTED {
            let place = Some(self.place(offset));
            self.push(Severity::Warning, place, message.into(), mend);
        }
    }

    /// An error about the whole file.
    pub fn error_of_file(&mut self, message: impl Into<String>, mend: &str) {
        self.errors += 1;
        self.push(Severity::Error, None, message.into(), mend);
    }

    fn push(&mut self, severity: Severity, place: Option<TextPosition>, message: String, mend: &str) {
        let path = self.path.to_owned();
        self.problems.push(Problem {
            severity,
            path,
            place,
            field_path: Box::default(),
            message,
            mend: mend.to_owned(),
        });
    }

    pub fn has_errors(&self) -> bool {
        self.errors > 0
    }

    /// The warnings, or the report when there was any error; both in the order of the file.
    pub fn finish(mut self) -> Result<Vec<Problem>, Report> {
        self.problems.sort_by_key(|problem| (problem.place.is_none(), problem.place));
        for (count, severity, word) in
            [(self.errors, Severity::Error, "errors"), (self.warnings, Severity::Warning, "warnings")]
        {
            if count > MAX_REPORTED {
                self.push(severity, None, format!("{} more {word} like these", count - MAX_REPORTED), "");
            }
        }
        if self.errors > 0 { Err(Report(self.problems)) } else { Ok(self.problems) }
    }
}

/// A walk through a text that counts its lines, so that the places of many words cost one pass.
#[derive(Default)]
pub(super) struct Walk {
    at: usize,
    lines: usize,
    line_start: usize,
}

impl Walk {
    /// Line and column of a byte, which must not come before the byte asked for last.
    pub fn to(&mut self, text: &[u8], offset: usize) -> TextPosition {
        let offset = offset.min(text.len());
        while self.at < offset {
            let byte = text[self.at];
            self.at += 1;
            if byte == b'\n' {
                self.lines += 1;
                self.line_start = self.at;
            }
        }
        let is_char_start = |byte: &&u8| **byte & 0xc0 != 0x80;
        let column = text[self.line_start.min(offset)..offset].iter().filter(is_char_start).count() + 1;
        TextPosition { line: self.lines + 1, column }
    }
}
