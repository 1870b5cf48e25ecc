//! File names of frames: a pattern with a place for the frame number.

use std::io;
use std::path::{Path, PathBuf};

/// A path with a place for the frame number. For a single frame it may have none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pattern {
    before: String,
    /// How many digits the number has at least; `None` where the path has no place for the number.
    digits: Option<usize>,
    after: String,
}

impl Pattern {
    /// Finds `####` (as many digits as there are `#`), `%04d` or `$F4` in the file's name. Folders are taken as they
    /// are. If the name has no such place, a single frame gets the name as it is. For several frames, `_####` is put
    /// before the name's ending.
    pub fn parse(text: &str, frames: u64) -> Self {
        let name_at = text.rfind(['/', '\\']).map_or(0, |at| at + 1);
        let name = &text[name_at..];
        if let Some((start, end, digits)) = hashes(name).or_else(|| percent(name)).or_else(|| dollar(name)) {
            return Self {
                before: text[..name_at + start].to_owned(),
                digits: Some(digits),
                after: text[name_at + end..].to_owned(),
            };
        }
        let dot = text[name_at..].rfind('.').map_or(text.len(), |at| name_at + at);
        let (name, after) = (text[..dot].to_owned(), text[dot..].to_owned());
        match frames {
            0 | 1 => Self { before: name, digits: None, after },
            _ => Self { before: format!("{name}_"), digits: Some(4), after },
        }
    }

    /// The file of a frame.
    pub fn path(&self, frame: i64) -> PathBuf {
        let sign = if frame < 0 { "-" } else { "" };
        let Self { before, digits, after } = self;
        let Some(digits) = *digits else { return PathBuf::from(format!("{before}{after}")) };
        PathBuf::from(format!("{before}{sign}{:0digits$}{after}", frame.unsigned_abs()))
    }

    /// The pattern as text, with `#` for each digit of the number.
    pub fn text(&self) -> String {
        format!("{}{}{}", self.before, "#".repeat(self.digits.unwrap_or_default()), self.after)
    }

    /// Whether the name has a place for the frame number.
    pub fn has_place(&self) -> bool {
        self.digits.is_some()
    }

    /// The numbers of the frames whose files are there, from low to high. A file counts only if its name is the one
    /// that [`Pattern::path`] gives.
    ///
    /// # Errors
    /// What the system said about the folder.
    pub fn frames_there(&self) -> io::Result<Vec<i64>> {
        let name_at = self.before.rfind(['/', '\\']).map_or(0, |at| at + 1);
        let (folder, start) = self.before.split_at(name_at);
        let folder = if folder.is_empty() { Path::new(".") } else { Path::new(folder) };
        let mut frames = Vec::new();
        for entry in std::fs::read_dir(folder)? {
            let name = entry?.file_name();
            let number = name
                .to_str()
                .and_then(|name| name.strip_prefix(start)?.strip_suffix(&self.after))
                .and_then(|number| number.parse::<i64>().ok());
            if let Some(number) = number
                && self.path(number).file_name() == Some(&name)
            {
                frames.push(number);
            }
        }
        frames.sort_unstable();
        Ok(frames)
    }

    /// A file beside the frames, with `word` where they have their number.
    pub fn beside(&self, word: &str) -> PathBuf {
        let gap = if self.digits.is_some() { "" } else { "_" };
        PathBuf::from(format!("{}{gap}{word}{}", self.before, self.after))
    }
}

/// Where the last run of `#` begins and ends, and how many digits it asks for.
fn hashes(text: &str) -> Option<(usize, usize, usize)> {
    let start = text.rfind('#').map(|last| text[..=last].trim_end_matches('#').len())?;
    let digits = text[start..].len() - text[start..].trim_start_matches('#').len();
    Some((start, start + digits, digits.min(18)))
}

/// Where a number like `%04d` begins and ends, and how many digits it asks for.
fn percent(text: &str) -> Option<(usize, usize, usize)> {
    text.match_indices('%').find_map(|(start, _)| {
        let number: String = text[start + 1..].chars().take_while(char::is_ascii_digit).collect();
        let end = start + 1 + number.len();
        let digits = if number.is_empty() { 1 } else { number.parse().ok()? };
        text[end..].starts_with('d').then_some((start, end + 1, usize::clamp(digits, 1, 18)))
    })
}

/// Where a number like `$F4` begins and ends, and how many digits it asks for.
fn dollar(text: &str) -> Option<(usize, usize, usize)> {
    let start = text.find("$F")?;
    let number: String = text[start + 2..].chars().take_while(char::is_ascii_digit).collect();
    let digits = number.parse().unwrap_or(1);
    Some((start, start + 2 + number.len(), usize::clamp(digits, 1, 18)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_way_of_naming_frames() {
        for (pattern, frame, path) in [
            ("out/f_####.png", 7, "out/f_0007.png"),
            ("out/f_##.png", 123, "out/f_123.png"),
            ("f_%04d.png", 7, "f_0007.png"),
            ("f_%d.png", 7, "f_7.png"),
            ("50%_%04d.png", 7, "50%_0007.png"),
            ("f.$F3.png", 7, "f.007.png"),
            ("out/f.png", 7, "out/f_0007.png"),
            ("out.d/f", 7, "out.d/f_0007"),
            ("f_####.png", -3, "f_-0003.png"),
            ("take #2/f_####.png", 7, "take #2/f_0007.png"),
            ("take #2/f.png", 7, "take #2/f_0007.png"),
        ] {
            assert_eq!(Pattern::parse(pattern, 9).path(frame), PathBuf::from(path), "{pattern}");
        }
        assert_eq!(Pattern::parse("out/f.png", 1).path(7), PathBuf::from("out/f.png"));
        assert_eq!(Pattern::parse("out/f.png", 1).beside("sheet"), PathBuf::from("out/f_sheet.png"));
        assert_eq!(Pattern::parse("out/f_####.png", 9).beside("sheet"), PathBuf::from("out/f_sheet.png"));
    }

    #[test]
    fn frames_that_are_there_are_found_by_their_exact_names() {
        let folder = tempfile::tempdir().unwrap();
        for name in [
            "f_0010.png",
            "f_0002.png",
            "f_-0001.png",
            "f_12345.png",
            // Other digits, other names, no numbers.
            "f_003.png",
            "f_00004.png",
            "f_+005.png",
            "f_0006.png.txt",
            "g_0007.png",
            "f_sheet.png",
            "f_.png",
            "f_0008.PNG",
        ] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let there = |name: &str| {
            let pattern = Pattern::parse(&folder.path().join(name).display().to_string(), 1);
            assert!(pattern.has_place());
            pattern.frames_there().unwrap()
        };
        for name in ["f_####.png", "f_%04d.png", "f_$F4.png"] {
            assert_eq!(there(name), [-1, 2, 10, 12_345], "{name}");
        }
        assert_eq!(there("f_#.png"), [12_345]);
        assert!(Pattern::parse("no/such/folder/####.png", 1).frames_there().is_err());
        assert!(!Pattern::parse("out/f.png", 1).has_place());
    }
}
