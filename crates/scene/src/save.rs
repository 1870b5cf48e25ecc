//! Writing a document as a scene file: readable, what is at its default left out, the same bytes every time.

use std::io::Write;
use std::path::Path;

use serde::Serialize;

use crate::document::Scene;

mod layout;
mod serializer;

/// The document as text that [`crate::load::parse`] reads back as an equal document.
///
/// Colours are written with 8 bits a channel, which is all that a scene file can hold.
pub fn to_ron(scene: &Scene) -> String {
    let value = scene.serialize(serializer::ToValue).expect("a document holds only what RON can say");
    format!("#![enable(implicit_some)]\n{}\n", layout::lay_out(&value))
}

/// Writes a scene file so that at any moment, even after a crash, the path holds the old file or the new one, whole.
/// A link is followed: the file that it points to is replaced.
///
/// # Errors
///
/// What the file system said; the old file is then untouched.
pub fn write(path: &Path, scene: &Scene) -> std::io::Result<()> {
    let target = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let folder = match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".impasto-").suffix(".ron.part");
    // As any new file: readable by whom the user's umask lets.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.tempfile_in(folder)?;
    file.write_all(to_ron(scene).as_bytes())?;
    if let Ok(metadata) = std::fs::metadata(&target) {
        if metadata.permissions().readonly() {
            let message = format!("{} is read-only", target.display());
            return Err(std::io::Error::new(std::io::ErrorKind::PermissionDenied, message));
        }
        file.as_file().set_permissions(metadata.permissions())?;
    }
    file.as_file().sync_all()?;
    file.persist(&target).map_err(|error| error.error)?;
    Ok(())
}

#[cfg(test)]
mod tests;
