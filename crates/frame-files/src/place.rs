//! Checks before a file is written: its folder can be written into, and no input is overwritten.

use std::path::{Path, PathBuf};

/// Why a file cannot be written at its intended place.
#[derive(Debug, thiserror::Error)]
pub enum PlaceError {
    /// The folder cannot be made, or nothing can be written into it.
    #[error("cannot write into {}: {error}", folder.display())]
    NotWritable {
        /// The folder.
        folder: PathBuf,
        /// What the system said.
        error: std::io::Error,
    },
    /// No file can have this name: a folder has it already, or it is too long.
    #[error("{} cannot be written: {why}", path.display())]
    NoFile {
        /// The name.
        path: PathBuf,
        /// What the system says of it.
        why: String,
    },
    /// The command reads this file, so it must not write there.
    #[error("{} is read by this command and would be written over", .0.display())]
    Input(PathBuf),
}

/// Makes the folder of an output file, checks that a file of this name can be written there, and returns the folder.
///
/// # Errors
/// [`PlaceError::NotWritable`], [`PlaceError::NoFile`].
pub fn ready_folder(path: &Path) -> Result<PathBuf, PlaceError> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_path_buf(),
        _ => PathBuf::from("."),
    };
    // A device or a pipe is there already: its folder does not matter.
    if std::fs::metadata(path).is_ok_and(|there| !there.is_file() && !there.is_dir()) {
        return Ok(folder);
    }
    // Tries to write a file. The file has no name, so it never leaves anything behind.
    if let Err(error) = std::fs::create_dir_all(&folder).and_then(|()| tempfile::tempfile_in(&folder)) {
        return Err(PlaceError::NotWritable { folder, error });
    }
    let no_file = |why: String| Err(PlaceError::NoFile { path: path.to_owned(), why });
    match std::fs::symlink_metadata(path) {
        Ok(there) if there.is_dir() => no_file("it is a folder".to_owned()),
        Err(error) if error.kind() == std::io::ErrorKind::InvalidFilename => no_file(error.to_string()),
        _ => Ok(folder),
    }
}

/// Refuses to write over a file that the command reads.
///
/// # Errors
/// [`PlaceError::Input`].
pub fn not_an_input(output: &Path, inputs: &[PathBuf]) -> Result<(), PlaceError> {
    let Ok(output_now) = output.canonicalize() else { return Ok(()) };
    match inputs.iter().find(|input| input.canonicalize().is_ok_and(|input| input == output_now)) {
        Some(input) => Err(PlaceError::Input(input.clone())),
        None => Ok(()),
    }
}
