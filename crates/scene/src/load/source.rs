//! Reads, decodes and scans the text of a scene file. Files that are no scenes at all are refused here, before any
//! value is parsed.

use std::io::Read;
use std::path::Path;

use crate::limits;
use crate::locate::{Located, Refused, line_starts, place_in};
use crate::problem::{Problem, Severity, TextPosition};

/// Refuses a file that is missing or not regular (a device, a pipe, a folder), without opening it.
pub(super) fn check_regular(path: &Path) -> Result<(), Problem> {
    let metadata = std::fs::metadata(path).map_err(|error| unreadable(path, &error))?;
    if metadata.is_file() {
        Ok(())
    } else {
        Err(error_in(
            path,
            None,
            "this is no regular file",
            "name a scene file (.ron) or a mesh (.obj, .gltf, .glb)",
        ))
    }
}

fn unreadable(path: &Path, error: &std::io::Error) -> Problem {
    error_in(path, None, format!("the file cannot be read: {error}"), "check the path and the permissions")
}

/// Reads a scene file. One that is longer than [`limits::MAX_SCENE_BYTES`] is refused.
pub(super) fn read(path: &Path) -> Result<Vec<u8>, Problem> {
    check_regular(path)?;
    let failed = |error| unreadable(path, &error);
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path).map_err(failed)?;
    file.take(limits::MAX_SCENE_BYTES + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > limits::MAX_SCENE_BYTES {
        return Err(too_long(path));
    }
    Ok(bytes)
}

/// The text of a scene file, without byte order mark.
pub(super) fn decode<'a>(path: &Path, bytes: &'a [u8]) -> Result<&'a str, Problem> {
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(error_in(path, Some(START), "this file is UTF-16", "save it as UTF-8"));
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    std::str::from_utf8(bytes).map_err(|error| {
        let good = String::from_utf8_lossy(&bytes[..error.valid_up_to()]);
        let place = place_in(&good, &line_starts(&good), good.len());
        error_in(path, Some(place), "this file is not UTF-8 text", "save it as UTF-8")
    })
}

/// Scans a text without byte order mark.
pub(super) fn scan(path: &Path, text: &str) -> Result<Located, Problem> {
    if text.len() as u64 > limits::MAX_SCENE_BYTES {
        return Err(too_long(path));
    }
    let at = |offset| Some(place_in(text, &line_starts(text), offset));
    scan_refusing(text).map_err(|refused| {
        let severity = if refused.is_limit { Severity::Limit } else { Severity::Error };
        let problem = error_in(path, at(refused.offset), refused.message, refused.mend);
        Problem { severity, ..problem }
    })
}

/// Like [`scan`], but does not check the length. The error gives an offset in the text, not a file and a line.
pub(super) fn scan_refusing(text: &str) -> Result<Located, Refused> {
    if let Some(offset) = text.find('\0') {
        let message = "there is a NUL character in the file".to_owned();
        let mend = "save the scene as plain UTF-8 text".to_owned();
        return Err(Refused { offset, message, mend, is_limit: false });
    }
    Located::scan(text)
}

const START: TextPosition = TextPosition { line: 1, column: 1 };

pub(super) fn too_long(path: &Path) -> Problem {
    let limit_mib = limits::MAX_SCENE_BYTES >> 20;
    let problem = error_in(
        path,
        Some(START),
        format!("the scene file is longer than {limit_mib} MiB"),
        "split the scene; meshes belong into files of their own",
    );
    Problem { severity: Severity::Limit, ..problem }
}

pub(super) fn error_in(
    path: &Path,
    place: Option<TextPosition>,
    message: impl Into<String>,
    mend: impl Into<String>,
) -> Problem {
    let (message, mend) = (message.into(), mend.into());
    Problem {
        severity: Severity::Error,
        path: path.to_owned(),
        place,
        field_path: Box::default(),
        message,
        mend,
    }
}
