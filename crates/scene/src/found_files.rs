//! Which files a scene was read from, and where each would lie if all lay in the scene's folder.

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// The files that were found while a scene was read. Copies share one list.
#[derive(Clone, Debug, Default)]
pub struct FoundFiles {
    /// See [`FoundFiles::places`].
    places: Arc<Mutex<BTreeMap<PathBuf, Option<PathBuf>>>>,
}

/// All lists are equal, so that comparing `AssetFolders` compares the folders alone.
impl PartialEq for FoundFiles {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Eq for FoundFiles {}

impl FoundFiles {
    /// Notes the file found at `path`. The file `beside`, of a scene in the folder `root`, calls it `name`, with `/`
    /// between folders.
    pub(crate) fn note(&self, [beside, root]: [&Path; 2], path: &Path, name: &str) {
        let mut places = self.places.lock().unwrap_or_else(PoisonError::into_inner);
        // The place of the naming file: from the list if it is there, else from its folder. Its own file name does not
        // matter, so `file` stands in for it.
        let naming = places.get(&without_dots(beside)).cloned().unwrap_or_else(|| {
            let root = std::fs::canonicalize(root).ok()?;
            let folder = beside.parent().filter(|folder| !folder.as_os_str().is_empty());
            let folder = std::fs::canonicalize(folder.unwrap_or(Path::new("."))).ok()?;
            Some(folder.strip_prefix(root).ok()?.join("file"))
        });
        let place = naming.and_then(|naming| within(&naming.parent().unwrap_or(Path::new("")).join(name)));
        places.insert(path.to_owned(), place);
    }

    /// A copy of the list. The keys are the paths at which files were found. Each value is a path relative to the
    /// scene's folder: if the file lay there, its name in the scene or mesh would lead to it without `--asset-dir`.
    /// `None` if there is no such place in the folder.
    pub fn places(&self) -> BTreeMap<PathBuf, Option<PathBuf>> {
        self.places.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// A copy that does not share the list.
    pub(crate) fn copied(&self) -> Self {
        Self { places: Arc::new(Mutex::new(self.places())) }
    }
}

/// A relative path with `.` and `..` resolved; `None` where it leads out of its folder.
fn within(path: &Path) -> Option<PathBuf> {
    let mut plain = PathBuf::new();
    for component in path.components() {
        match component {
            Component::ParentDir => plain.pop().then_some(())?,
            Component::Normal(name) => plain.push(name),
            _ => {}
        }
    }
    Some(plain)
}

/// The path with `.` and `..` resolved by text alone, without the file system.
pub(crate) fn without_dots(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for component in path.components() {
        match component {
            Component::ParentDir => {
                plain.pop();
            }
            Component::CurDir => {}
            other => plain.push(other),
        }
    }
    plain
}
