//! Reading a scene with everything that it names.

use std::path::Path;

use crate::document::Scene;
use crate::problem::Report;

mod parse;
mod source;

/// Reads a document from its text; `path` is for messages only, no file is opened. A byte order mark is skipped.
///
/// This finds what is no scene at all: text that is no RON, unknown fields, values of the wrong kind. Whether the
/// values make sense together is [`crate::check`]'s to say.
///
/// # Errors
///
/// Every unknown field, or the first fault of another kind, each with its place.
pub fn parse(path: &Path, text: &str) -> Result<Scene, Report> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    parse::parse(path, text).map(|parsed| parsed.scene)
}
