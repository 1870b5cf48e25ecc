//! Copying a mesh or a picture, with the files that it names, into a scene's folder.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use impasto_scene::assets::{self, AssetError, AssetFolders, AssetRequest};
use impasto_scene::problem::Report;
use impasto_scene::{obj, texture};

use super::name_of;

/// The most bytes that one import copies.
const MAX_COPIED_BYTES: u64 = 2 << 30;

/// How many names are tried for a folder of its own.
const MAX_NAMES: usize = 1000;

/// A file that a scene can name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Adopted {
    /// The path to write in the scene: from its folder, with `/`.
    pub name: String,
    /// The files that were copied there, whole paths; none where the file lay in the scene's folder, or was copied
    /// before.
    pub copied: Vec<PathBuf>,
}

/// Why a file was not brought into a scene's folder. Nothing is left behind there.
#[derive(Debug, thiserror::Error)]
pub enum AdoptError {
    /// The mesh is wrong.
    #[error("{0}")]
    Mesh(#[from] Report),
    /// One of the files cannot be read.
    #[error("{0}")]
    Unread(#[from] AssetError),
    /// A copy could not be written.
    #[error("{file} could not be copied into {}: {source}", folder.display())]
    Unwritable {
        /// The file's name.
        file: String,
        /// The scene's folder.
        folder: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The files are too many or too large.
    #[error("{file} and what it names are over {} MiB, the most that is copied; put them into the scene's folder", MAX_COPIED_BYTES >> 20)]
    TooMuch {
        /// The file's name.
        file: String,
    },
}

/// Brings a mesh within a scene's reach. One that lies in the scene's folder is named from there; any other is copied to
/// `meshes/NAME/` in it, with the MTL files and pictures that it names and that lie in the mesh's own folder. A file that is
/// there already is never written over.
///
/// # Errors
/// [`AdoptError`], with the words to show.
pub fn adopt_mesh(mesh: &Path, scene_folder: &Path) -> Result<Adopted, AdoptError> {
    if let Some(name) = name_within(mesh, scene_folder) {
        return Ok(Adopted { name, copied: Vec::new() });
    }
    let source = canonical(mesh)?;
    let folder = source.parent().unwrap_or(Path::new("/")).to_owned();
    let own_name = PathBuf::from(format!("{}.obj", plain_stem(&source)));
    let mut files = BTreeMap::from([(own_name.clone(), (source.clone(), obj::MAX_FILE_BYTES))]);
    for file in obj::companions(&source, &folder)? {
        let is_mtl = file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mtl"));
        let limit = if is_mtl { obj::MAX_MTL_BYTES } else { texture::MAX_FILE_BYTES };
        if let Ok(within) = file.strip_prefix(&folder) {
            files.entry(within.to_owned()).or_insert((file.clone(), limit));
        }
    }
    bring(&files, &own_name, scene_folder, "meshes")
}

/// Brings a picture within a scene's reach, as [`adopt_mesh`] does, to `brushes/NAME/`.
///
/// # Errors
/// [`AdoptError`], with the words to show.
pub fn adopt_picture(picture: &Path, scene_folder: &Path) -> Result<Adopted, AdoptError> {
    if let Some(name) = name_within(picture, scene_folder) {
        return Ok(Adopted { name, copied: Vec::new() });
    }
    let source = canonical(picture)?;
    let ending =
        source.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    let own_name = PathBuf::from(format!("{}.{ending}", plain_stem(&source)));
    let files = BTreeMap::from([(own_name.clone(), (source, texture::MAX_FILE_BYTES))]);
    bring(&files, &own_name, scene_folder, "brushes")
}

/// How a scene in `folder` names a file there; none where it lies elsewhere, or where its name would not be found again.
fn name_within(file: &Path, folder: &Path) -> Option<String> {
    let (file, folder) = (fs::canonicalize(file).ok()?, fs::canonicalize(folder).ok()?);
    let name = file.strip_prefix(&folder).ok()?.to_str()?.to_owned();
    let beside = folder.join("scene.ron");
    let request = AssetRequest { beside: &beside, root: &folder, name: &name, max_bytes: u64::MAX };
    let found = AssetFolders::default().find(&request).ok()?;
    (found == file).then_some(name)
}

/// Copies files (by their paths in the new folder, with their limits in bytes) to `folder/shelf/NAME`, where NAME is after
/// the file `own_name`.
fn bring(
    files: &BTreeMap<PathBuf, (PathBuf, u64)>,
    own_name: &Path,
    scene_folder: &Path,
    shelf: &str,
) -> Result<Adopted, AdoptError> {
    let unwritable =
        |source| AdoptError::Unwritable { file: name_of(own_name), folder: scene_folder.to_owned(), source };
    let size = |file: &Path| fs::metadata(file).map_or(0, |metadata| metadata.len());
    if files.values().map(|(file, _)| size(file)).sum::<u64>() > MAX_COPIED_BYTES {
        return Err(AdoptError::TooMuch { file: name_of(own_name) });
    }
    let shelf_folder = scene_folder.join(shelf);
    let was_there = shelf_folder.is_dir();
    fs::create_dir_all(&shelf_folder).map_err(unwritable)?;
    let copied = copy_beside(files, &shelf_folder, own_name);
    if copied.is_err() && !was_there {
        // Only an empty folder goes.
        let _not_empty = fs::remove_dir(&shelf_folder);
    }
    let (place, copied) = copied.map_err(|error| match error {
        Copying::Read(error) => AdoptError::Unread(error),
        Copying::Write(error) => unwritable(error),
    })?;
    let name = format!("{shelf}/{place}/{}", own_name.display());
    Ok(Adopted { name, copied })
}

enum Copying {
    Read(AssetError),
    Write(io::Error),
}

impl From<io::Error> for Copying {
    fn from(error: io::Error) -> Self {
        Self::Write(error)
    }
}

/// Copies into a folder that nobody sees yet, and gives it its name when it is whole. Returns the name and the copies.
fn copy_beside(
    files: &BTreeMap<PathBuf, (PathBuf, u64)>,
    shelf: &Path,
    own_name: &Path,
) -> Result<(String, Vec<PathBuf>), Copying> {
    let stem = plain_stem(own_name);
    let hidden = tempfile::Builder::new().prefix(".coming-").tempdir_in(shelf)?;
    for (within, (file, limit)) in files {
        let bytes = assets::read_regular_file(file, *limit).map_err(Copying::Read)?;
        let target = hidden.path().join(within);
        if let Some(parent) = target.parent() {
            fs::create_dir_all(parent)?;
        }
        fs::write(target, bytes)?;
    }
    open_to_readers(hidden.path())?;
    for number in 1..=MAX_NAMES {
        let place = if number == 1 { stem.clone() } else { format!("{stem}-{number}") };
        let target = shelf.join(&place);
        if fs::symlink_metadata(&target).is_ok() {
            if is_same(files, hidden.path(), &target) {
                return Ok((place, Vec::new()));
            }
            continue;
        }
        match fs::rename(hidden.path(), &target) {
            Ok(()) => {
                // The folder has moved: there is nothing left to remove.
                let _moved = hidden.keep();
                return Ok((place, files.keys().map(|within| target.join(within)).collect()));
            }
            // Another program took the name in between.
            Err(_) if fs::symlink_metadata(&target).is_ok() => (),
            Err(error) => return Err(error.into()),
        }
    }
    Err(io::Error::other(format!("there are {MAX_NAMES} folders named {stem} already")).into())
}

/// Temporary folders are closed to others; a mesh folder is like any other.
fn open_to_readers(folder: &Path) -> io::Result<()> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        fs::set_permissions(folder, fs::Permissions::from_mode(0o755))?;
    }
    #[cfg(not(unix))]
    let _ = folder;
    Ok(())
}

/// Whether the folder has each of the files with the bytes of its copy.
fn is_same(files: &BTreeMap<PathBuf, (PathBuf, u64)>, copies: &Path, folder: &Path) -> bool {
    files.iter().all(|(within, (_, limit))| {
        let (there, copy) = (folder.join(within), copies.join(within));
        let bytes = |path| assets::read_regular_file(path, *limit).ok();
        matches!((bytes(&there), bytes(&copy)), (Some(a), Some(b)) if a == b)
    })
}

fn canonical(file: &Path) -> Result<PathBuf, AdoptError> {
    let unreadable = |source| AssetError::Unreadable { path: file.to_owned(), source };
    Ok(fs::canonicalize(file).map_err(unreadable)?)
}

/// The file's name without its ending, in characters that a scene can name it by.
fn plain_stem(file: &Path) -> String {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let plain = |c: char| if c.is_control() || "\\/:".contains(c) { '_' } else { c };
    let stem: String = stem.chars().take(100).map(plain).collect();
    let stem = stem.trim().trim_start_matches('.');
    if stem.is_empty() { "mesh".to_owned() } else { stem.to_owned() }
}
