//! Lists a folder for the sheet that asks for a file, and resolves and completes the paths that are typed there.

use std::fs;
use std::path::{Component, Path, PathBuf};

use impasto_scene::whole_file::failure_in_words;

use super::Kind;

/// At most this many rows are listed.
const MAX_ROWS: usize = 5000;

/// At most this many entries of a folder are read.
const MAX_ENTRIES: usize = 50_000;

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum ListedFile {
    Parent,
    Folder(String),
    File(String),
}

impl ListedFile {
    pub(super) fn name(&self) -> &str {
        match self {
            Self::Parent => "..",
            Self::Folder(name) | Self::File(name) => name,
        }
    }
}

/// A folder as it was when it was read.
#[derive(Debug)]
pub(super) struct Listing {
    pub(super) folder: PathBuf,
    /// The parent, then folders, then files of the wanted kinds, sorted without regard to case.
    pub(super) rows: Vec<ListedFile>,
    /// A remark to show under the list.
    pub(super) note: Option<String>,
}

impl Listing {
    pub(super) fn read(folder: &Path, kinds: &[Kind]) -> Self {
        let mut rows = Vec::new();
        if folder.parent().is_some() {
            rows.push(ListedFile::Parent);
        }
        let (found, note) = match entries(folder, kinds) {
            Ok(found) if found.len() > MAX_ROWS => {
                let words = format!("{MAX_ROWS} of {} are listed: type the name of another", found.len());
                (found, Some(words))
            }
            Ok(found) if found.is_empty() => (found, Some("Nothing to choose in this folder.".to_owned())),
            Ok(found) => (found, None),
            Err(error) => {
                (Vec::new(), Some(format!("This folder cannot be read: {}", failure_in_words(&error))))
            }
        };
        rows.extend(found.into_iter().take(MAX_ROWS));
        Self { folder: folder.to_owned(), rows, note }
    }

    /// Completes the typed text with what all names that begin with it have in common. `None` if that adds nothing, or
    /// the folder in the text cannot be read.
    pub(super) fn complete(&self, typed: &str, kinds: &[Kind]) -> Option<String> {
        let (folder, start) = typed.rfind('/').map_or(("", typed), |at| typed.split_at(at + 1));
        let read;
        let rows = if folder.is_empty() {
            &self.rows
        } else {
            read = entries(&resolve(&self.folder, folder), kinds).ok()?;
            &read
        };
        let names = rows.iter().filter(|row| **row != ListedFile::Parent).map(|row| match row {
            ListedFile::Folder(name) => format!("{name}/"),
            row => row.name().to_owned(),
        });
        let fitting: Vec<String> = names.filter(|name| name.starts_with(start)).collect();
        let first = fitting.first()?;
        let common = first
            .char_indices()
            .map(|(at, c)| at + c.len_utf8())
            .take_while(|&end| fitting.iter().all(|name| name.get(..end) == first.get(..end)))
            .last()?;
        (common > start.len()).then(|| format!("{folder}{}", &first[..common]))
    }
}

/// The folders, then the files of the wanted kinds (of any kind, if `kinds` is empty), both sorted by name. Hidden
/// entries are left out.
fn entries(folder: &Path, kinds: &[Kind]) -> std::io::Result<Vec<ListedFile>> {
    let (mut folders, mut files) = (Vec::new(), Vec::new());
    for entry in fs::read_dir(folder)?.flatten().take(MAX_ENTRIES) {
        // A name that is not valid Unicode cannot be shown.
        let Ok(name) = entry.file_name().into_string() else { continue };
        if name.starts_with('.') {
            continue;
        }
        let path = entry.path();
        if path.is_dir() {
            folders.push(name);
        } else if kinds.is_empty() || Kind::of(&path).is_some_and(|kind| kinds.contains(&kind)) {
            files.push(name);
        }
    }
    for names in [&mut folders, &mut files] {
        names.sort_by_cached_key(|name| (name.to_lowercase(), name.clone()));
    }
    Ok(folders.into_iter().map(ListedFile::Folder).chain(files.into_iter().map(ListedFile::File)).collect())
}

/// The full path of a typed one, which may be relative to `folder` or begin with `~` for the user's home.
pub(super) fn resolve(folder: &Path, typed: &str) -> PathBuf {
    let home = || etcetera::home_dir().ok();
    let path = match typed.strip_prefix('~') {
        Some("") => home(),
        Some(rest) => rest.strip_prefix('/').and_then(|rest| Some(home()?.join(rest))),
        None => None,
    };
    let path = path.unwrap_or_else(|| folder.join(typed));
    let mut plain = PathBuf::new();
    for component in path.components() {
        match component {
            Component::ParentDir => {
                plain.pop();
            }
            Component::CurDir => (),
            other => plain.push(other),
        }
    }
    plain
}
