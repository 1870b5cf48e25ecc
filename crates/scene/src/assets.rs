//! Which files a scene may read: those under its own folder and under the folders that the user names.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use crate::found_files::{FoundFiles, without_dots};
use crate::problem::{Problem, Severity, TextPosition};

/// The longest file name that is accepted, in bytes, folders included. Linux opens no path that is longer.
pub const MAX_NAME_BYTES: usize = 4096;

/// The folders that a scene's files may come from.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AssetFolders {
    /// The folders of `--asset-dir`, searched in this order after the folder of the file that names the asset.
    pub extra: Vec<PathBuf>,
    /// The list that every found file is added to.
    found: FoundFiles,
}

/// A file that another file names.
#[derive(Clone, Copy, Debug)]
pub struct AssetRequest<'a> {
    /// The file that names it: the name is relative to this file's folder.
    pub beside: &'a Path,
    /// The scene's folder. Only files in it or in the extra folders are read.
    pub root: &'a Path,
    /// The name as written. `/` and `\` both separate folders.
    pub name: &'a str,
    /// The largest file that is read, in bytes.
    pub max_bytes: u64,
}

/// A file that was found and read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Asset {
    /// Where it was found.
    pub path: PathBuf,
    /// Its contents.
    pub bytes: Vec<u8>,
}

/// Why a file that another file names was not read.
#[derive(Debug, thiserror::Error)]
pub enum AssetError {
    /// The name itself is refused: nothing was opened.
    #[error("{name:?} is refused: {why}")]
    Refused {
        /// The name, cut short if it is very long.
        name: String,
        /// Why.
        why: &'static str,
    },
    /// None of the folders has the file.
    #[error("{name:?} was not found (tried {})", list(.tried))]
    Missing {
        /// The name, cut short if it is very long.
        name: String,
        /// The full paths that were tried.
        tried: Vec<PathBuf>,
    },
    /// It is a folder, a device, a pipe or a socket.
    #[error("{} is not a regular file", .0.display())]
    NotAFile(PathBuf),
    /// It is larger than the limit.
    #[error("{} is larger than the limit of {max_bytes} bytes", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// The limit.
        max_bytes: u64,
    },
    /// The system would not read it.
    #[error("{} could not be read: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
}

impl AssetError {
    /// What to do about it, as one sentence without a full stop.
    pub fn mend(&self) -> &'static str {
        match self {
            Self::Refused { .. } => {
                "write a path relative to the file that names it, inside the scene's folder (--asset-dir names other folders)"
            }
            Self::Missing { .. } => "put the file there, or name its folder with --asset-dir",
            Self::NotAFile(_) => "name a regular file",
            Self::TooLarge { .. } => "make the file smaller",
            Self::Unreadable { .. } => "check the file and its permissions",
        }
    }

    /// The problem to report. `path` and `place` say where the file is named. A file that is too large always gives
    /// [`Severity::Limit`].
    pub fn to_problem(&self, severity: Severity, path: &Path, place: Option<TextPosition>) -> Problem {
        let severity = if matches!(self, Self::TooLarge { .. }) { Severity::Limit } else { severity };
        Problem {
            severity,
            path: path.to_owned(),
            place,
            field_path: Box::default(),
            message: self.to_string(),
            mend: self.mend().to_owned(),
        }
    }
}

impl AssetFolders {
    /// The scene's own folder, and the folders in `extra`.
    pub fn with(extra: Vec<PathBuf>) -> Self {
        Self { extra, found: FoundFiles::default() }
    }

    /// The same folders; files that are found from now on are added to the list `found`.
    pub(crate) fn noting(&self, found: &FoundFiles) -> Self {
        Self { found: found.clone(), ..self.clone() }
    }

    pub(crate) fn found(&self) -> &FoundFiles {
        &self.found
    }

    /// Finds and reads a file that another file names: first beside that file, then in the extra folders.
    ///
    /// # Errors
    /// As [`Self::find`], and when the file is not a regular one, is over `max_bytes`, or cannot be read.
    pub fn open(&self, request: &AssetRequest<'_>) -> Result<Asset, AssetError> {
        let path = self.find(request)?;
        let bytes = read_regular_file(&path, request.max_bytes)?;
        Ok(Asset { path, bytes })
    }

    /// Finds a file that another file names, without opening it: first beside that file, then in the extra folders.
    ///
    /// # Errors
    /// [`AssetError`] when the name is empty, absolute, a URL, over [`MAX_NAME_BYTES`] or has a NUL byte; when it leads
    /// (also through a link) out of the scene's folder and the extra folders; or when none of the folders has the file.
    pub fn find(&self, request: &AssetRequest<'_>) -> Result<PathBuf, AssetError> {
        let name = request.name.trim().replace('\\', "/");
        if let Some(why) = refusal(&name) {
            return Err(AssetError::Refused { name: shorten(&name), why });
        }
        let allowed: Vec<PathBuf> = std::iter::once(request.root)
            .chain(self.extra.iter().map(PathBuf::as_path))
            .map(canonical)
            .collect();
        let folder_of_naming_file = canonical(request.beside.parent().unwrap_or(Path::new("")));
        let folders =
            std::iter::once(folder_of_naming_file).chain(self.extra.iter().map(|extra| canonical(extra)));
        let mut tried = Vec::new();
        let mut is_outside = false;
        for folder in folders {
            let candidate = without_dots(&folder.join(&name));
            if !is_inside(&candidate, &allowed) {
                is_outside = true;
                continue;
            }
            match fs::canonicalize(&candidate) {
                Ok(real) if is_inside(&real, &allowed) => {
                    self.found.note([request.beside, request.root], &candidate, &name);
                    return Ok(candidate);
                }
                Ok(_) => is_outside = true,
                Err(_) => tried.push(candidate),
            }
        }
        if is_outside {
            let why = "it leads out of the scene's folder";
            return Err(AssetError::Refused { name: shorten(&name), why });
        }
        Err(AssetError::Missing { name: shorten(&name), tried })
    }
}

/// Reads a regular file of at most `max_bytes`. Devices, pipes and folders are refused before they are opened.
/// However large the file claims to be, at most one byte more than the limit is read.
///
/// # Errors
/// [`AssetError`] when there is no such file, it is not a regular one, is over the limit, or cannot be read.
pub fn read_regular_file(path: &Path, max_bytes: u64) -> Result<Vec<u8>, AssetError> {
    let unreadable = |source: io::Error| match source.kind() {
        io::ErrorKind::NotFound => {
            AssetError::Missing { name: shorten(&path.to_string_lossy()), tried: vec![path.to_owned()] }
        }
        _ => AssetError::Unreadable { path: path.to_owned(), source },
    };
    let metadata = fs::metadata(path).map_err(unreadable)?;
    if !metadata.is_file() {
        return Err(AssetError::NotAFile(path.to_owned()));
    }
    let too_large = || AssetError::TooLarge { path: path.to_owned(), max_bytes };
    if metadata.len() > max_bytes {
        return Err(too_large());
    }
    let mut bytes = Vec::with_capacity(metadata.len() as usize);
    // One byte more than allowed, to notice a file that has grown since its size was read.
    File::open(path).map_err(unreadable)?.take(max_bytes + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > max_bytes { Err(too_large()) } else { Ok(bytes) }
}

/// Why a name (with `/` separators) is refused before any file is looked for.
fn refusal(name: &str) -> Option<&'static str> {
    let has_drive = name.len() >= 2 && name.as_bytes()[0].is_ascii_alphabetic() && name.as_bytes()[1] == b':';
    if name.is_empty() {
        Some("the name is empty")
    } else if name.len() > MAX_NAME_BYTES {
        Some("the name is longer than 4096 bytes")
    } else if name.contains("://") || name.starts_with("file:") || name.starts_with("data:") {
        Some("it is a URL, and nothing is fetched from a network")
    } else if name.starts_with('/') || has_drive {
        Some("it is an absolute path, which holds on one machine only")
    } else if name.contains('\0') {
        Some("it holds a NUL byte")
    } else {
        None
    }
}

/// The real path of a folder, with links followed. If there is no such folder, the path unchanged.
fn canonical(folder: &Path) -> PathBuf {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned())
}

fn is_inside(path: &Path, allowed: &[PathBuf]) -> bool {
    allowed.iter().any(|folder| path.starts_with(folder))
}

/// A name for a message: a very long one is cut.
fn shorten(name: &str) -> String {
    if name.chars().count() <= 120 {
        name.to_owned()
    } else {
        name.chars().take(100).chain("…".chars()).collect()
    }
}

fn list(paths: &[PathBuf]) -> String {
    paths.iter().map(|path| shorten(&path.to_string_lossy())).collect::<Vec<_>>().join(", ")
}
