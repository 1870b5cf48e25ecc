//! Names of output files.

use std::path::{Path, PathBuf};

use crate::failure::Failure;

/// A path with a place for the frame number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Pattern {
    before: String,
    digits: usize,
    after: String,
}

impl Pattern {
    /// `####` (as many digits as there are), `%04d`, `$F4`; a name without any gets `_####` before its ending.
    pub(crate) fn parse(text: &str) -> Self {
        let found = hashes(text).or_else(|| percent(text)).or_else(|| dollar(text));
        let (start, end, digits) = found.unwrap_or_else(|| {
            let name_at = text.rfind(['/', '\\']).map_or(0, |at| at + 1);
            let dot = text[name_at..].rfind('.').map_or(text.len(), |at| name_at + at);
            (dot, dot, 0)
        });
        if digits == 0 {
            return Self { before: format!("{}_", &text[..start]), digits: 4, after: text[end..].to_owned() };
        }
        Self { before: text[..start].to_owned(), digits, after: text[end..].to_owned() }
    }

    /// The file of a frame.
    pub(crate) fn path(&self, frame: i64) -> PathBuf {
        let sign = if frame < 0 { "-" } else { "" };
        let Self { before, digits, after } = self;
        PathBuf::from(format!("{before}{sign}{:0digits$}{after}", frame.unsigned_abs()))
    }

    /// A file beside the frames, named after them.
    pub(crate) fn beside(&self, word: &str) -> PathBuf {
        PathBuf::from(format!("{}{word}{}", self.before, self.after))
    }
}

fn hashes(text: &str) -> Option<(usize, usize, usize)> {
    let start = text.rfind('#').map(|last| text[..=last].trim_end_matches('#').len())?;
    let digits = text[start..].len() - text[start..].trim_start_matches('#').len();
    Some((start, start + digits, digits))
}

fn percent(text: &str) -> Option<(usize, usize, usize)> {
    let start = text.find('%')?;
    let length = text[start + 1..].find('d')?;
    let number = &text[start + 1..start + 1 + length];
    let digits = if number.is_empty() { 1 } else { number.parse().ok()? };
    Some((start, start + length + 2, usize::clamp(digits, 1, 18)))
}

fn dollar(text: &str) -> Option<(usize, usize, usize)> {
    let start = text.find("$F")?;
    let number: String = text[start + 2..].chars().take_while(char::is_ascii_digit).collect();
    let digits = number.parse().unwrap_or(1);
    Some((start, start + 2 + number.len(), usize::clamp(digits, 1, 18)))
}

/// Makes the folder of an output file and finds out whether a file can be written there.
pub(crate) fn ready_folder(path: &Path) -> Result<PathBuf, Failure> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_path_buf(),
        _ => PathBuf::from("."),
    };
    let refused = |error: std::io::Error| {
        Failure::Refused(format!(
            "cannot write into {}: {error}; name another place with -o",
            folder.display()
        ))
    };
    std::fs::create_dir_all(&folder).map_err(refused)?;
    tempfile::NamedTempFile::new_in(&folder).map_err(refused)?;
    Ok(folder)
}

/// Refuses to write over something that is read.
pub(crate) fn not_an_input(output: &Path, inputs: &[PathBuf]) -> Result<(), Failure> {
    let Ok(output_now) = output.canonicalize() else { return Ok(()) };
    match inputs.iter().find(|input| input.canonicalize().is_ok_and(|input| input == output_now)) {
        Some(input) => Err(Failure::Refused(format!(
            "{} is read by this command and would be written over; name another place with -o",
            input.display()
        ))),
        None => Ok(()),
    }
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
            ("f.$F3.png", 7, "f.007.png"),
            ("out/f.png", 7, "out/f_0007.png"),
            ("out.d/f", 7, "out.d/f_0007"),
            ("f_####.png", -3, "f_-0003.png"),
        ] {
            assert_eq!(Pattern::parse(pattern).path(frame), PathBuf::from(path), "{pattern}");
        }
        assert_eq!(Pattern::parse("out/f_####.png").beside("sheet"), PathBuf::from("out/f_sheet.png"));
    }
}
