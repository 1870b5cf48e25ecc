//! Writes a document as a scene file that a person can read. Fields with their default values are left out, and equal
//! documents give equal bytes.

use std::path::Path;

use serde::Serialize;

use crate::document::Scene;
use crate::whole_file;

mod layout;
mod serializer;

/// The document as text that [`crate::load::parse`] reads back as an equal document; what it only has from its shot is left out.
///
/// Colours are written with 8 bits a channel, which is all that a scene file can hold.
pub fn to_ron(scene: &Scene) -> String {
    let value =
        scene.without_shot().serialize(serializer::ToValue).expect("a document holds only what RON can say");
    format!("#![enable(implicit_some)]\n{}\n", layout::lay_out(&value))
}

/// Writes a scene file so that at any moment, even after a crash, the path holds the old file or the new one, whole.
/// A link is followed: the file that it points to is replaced.
///
/// # Errors
///
/// What the file system said; the old file is then untouched.
pub fn write(path: &Path, scene: &Scene) -> std::io::Result<()> {
    whole_file::write(path, to_ron(scene).as_bytes())
}

#[cfg(test)]
mod tests;
