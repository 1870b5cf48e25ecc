//! Copies a mesh (with the files that it names) or a picture into a scene's folder, so that the scene can use it.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use impasto_scene::assets::{self, AssetError, AssetFolders, AssetRequest};
use impasto_scene::problem::{Problem, Report};
use impasto_scene::whole_file::{WholeFile, failure_in_words};
use impasto_scene::{mesh_format, texture};

use super::name_of;

/// The most bytes that one import copies.
const MAX_COPIED_BYTES: u64 = 2 << 30;

/// How many names are tried for the new folder: NAME, NAME-2 and so on.
const MAX_NAMES: usize = 1000;

/// A file that a scene can name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Adopted {
    /// Its path relative to the scene's folder, with `/`, as the scene file names it.
    pub name: String,
    /// Full paths of the copies; empty if the file was in the scene's folder already, or was copied before.
    pub copied: Vec<PathBuf>,
}

/// Why a file was not copied into a scene's folder. No partial copy is left there.
#[derive(Debug, thiserror::Error)]
pub enum AdoptError {
    /// The mesh has errors.
    #[error("{0}")]
    Mesh(#[from] Report),
    /// The picture cannot be used.
    #[error("{}", unusable(.0))]
    Picture(Box<Problem>),
    /// One of the files cannot be read.
    #[error("{0}")]
    Unread(#[from] AssetError),
    /// A copy could not be written.
    #[error("{file} could not be copied into {}: {}", folder.display(), failure_in_words(source))]
    Unwritable {
        /// The file's name.
        file: String,
        /// The scene's folder.
        folder: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The files together are too large.
    #[error("{file} and what it names are over {} MiB, the most that is copied; put them into the scene's folder", MAX_COPIED_BYTES >> 20)]
    TooMuch {
        /// The file's name.
        file: String,
    },
}

/// Makes a mesh available to a scene. A mesh inside the scene's folder is used where it is, if the scene can find it by
/// its name. Any other is copied to `meshes/NAME/` in that folder, with the files that belong to it
/// ([`mesh_format::companions`]) and are inside the mesh's own folder. No existing file is overwritten.
///
/// # Errors
/// [`AdoptError`], with the words to show.
pub fn adopt_mesh(mesh: &Path, scene_folder: &Path) -> Result<Adopted, AdoptError> {
    if let Some(name) = name_within(mesh, scene_folder) {
        return Ok(Adopted { name, copied: Vec::new() });
    }
    let source = canonical(mesh)?;
    let folder = source.parent().unwrap_or(Path::new("/")).to_owned();
    let own_name = PathBuf::from(format!("{}.{}", plain_stem(&source), ending(&source)));
    let mut files = BTreeMap::from([(own_name.clone(), (source.clone(), mesh_format::max_bytes(&source)))]);
    for file in mesh_format::companions(&source, &folder)? {
        if let Ok(within) = file.strip_prefix(&folder) {
            files.entry(within.to_owned()).or_insert((file.clone(), mesh_format::max_bytes(&file)));
        }
    }
    copy_into_scene(&files, &own_name, scene_folder, "meshes")
}

/// Makes a picture available to a scene, as [`adopt_mesh`] does; copies go to `subfolder/NAME/`. A picture that cannot
/// be used is not copied.
///
/// # Errors
/// [`AdoptError`], with the words to show.
pub fn adopt_picture(picture: &Path, scene_folder: &Path, subfolder: &str) -> Result<Adopted, AdoptError> {
    let source = canonical(picture)?;
    let bytes = assets::read_regular_file(&source, texture::MAX_FILE_BYTES)?;
    texture::decode(&source, &bytes).map_err(|problem| AdoptError::Picture(Box::new(problem)))?;
    if let Some(name) = name_within(picture, scene_folder) {
        return Ok(Adopted { name, copied: Vec::new() });
    }
    let own_name = PathBuf::from(format!("{}.{}", plain_stem(&source), ending(&source)));
    let files = BTreeMap::from([(own_name.clone(), (source, texture::MAX_FILE_BYTES))]);
    copy_into_scene(&files, &own_name, scene_folder, subfolder)
}

/// Why a picture cannot be used, in one sentence.
fn unusable(problem: &Problem) -> String {
    let mend = problem.mend.replace("it is left out; ", "");
    format!("{}: {}; {mend}", name_of(&problem.path), problem.message)
}

/// Copies a file to where another file looks for it. No existing file is overwritten.
///
/// # Errors
/// What the system said, in words to show.
pub fn bring(file: &Path, to: &Path) -> Result<(), String> {
    let copy = || -> io::Result<()> {
        if let Some(folder) = to.parent() {
            fs::create_dir_all(folder)?;
        }
        let mut copy = WholeFile::create(to)?;
        io::copy(&mut fs::File::open(file)?, &mut copy)?;
        copy.finish_new()
    };
    copy().map_err(|error| match error.kind() {
        io::ErrorKind::AlreadyExists => format!("{} is there by now: press Retry", to.display()),
        _ => {
            format!("{} could not be copied to {}: {}", name_of(file), to.display(), failure_in_words(&error))
        }
    })
}

/// A file's ending in small letters.
fn ending(file: &Path) -> String {
    file.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase()).unwrap_or_default()
}

/// How a scene in `folder` names a file inside it; none if the file is elsewhere, or the scene could not find it by
/// that name.
fn name_within(file: &Path, folder: &Path) -> Option<String> {
    let (file, folder) = (fs::canonicalize(file).ok()?, fs::canonicalize(folder).ok()?);
    let name = file.strip_prefix(&folder).ok()?.to_str()?.to_owned();
    let beside = folder.join("scene.ron");
    let request = AssetRequest { beside: &beside, root: &folder, name: &name, max_bytes: u64::MAX };
    let found = AssetFolders::default().find(&request).ok()?;
    (found == file).then_some(name)
}

/// Copies files to `scene_folder/subfolder/NAME`, where NAME comes from the file `own_name`. `files` maps the path in
/// the new folder to the source and its size limit in bytes.
fn copy_into_scene(
    files: &BTreeMap<PathBuf, (PathBuf, u64)>,
    own_name: &Path,
    scene_folder: &Path,
    subfolder: &str,
) -> Result<Adopted, AdoptError> {
    let unwritable =
        |source| AdoptError::Unwritable { file: name_of(own_name), folder: scene_folder.to_owned(), source };
    let size = |file: &Path| fs::metadata(file).map_or(0, |metadata| metadata.len());
    if files.values().map(|(file, _)| size(file)).sum::<u64>() > MAX_COPIED_BYTES {
        return Err(AdoptError::TooMuch { file: name_of(own_name) });
    }
    let subfolder_path = scene_folder.join(subfolder);
    let was_there = subfolder_path.is_dir();
    fs::create_dir_all(&subfolder_path).map_err(unwritable)?;
    let copied = copy_beside(files, &subfolder_path, own_name);
    if copied.is_err() && !was_there {
        // If the folder is not empty, this fails and leaves it.
        let _not_empty = fs::remove_dir(&subfolder_path);
    }
    let (place, copied) = copied.map_err(|error| match error {
        CopyFailure::Read(error) => AdoptError::Unread(error),
        CopyFailure::Write(error) => unwritable(error),
    })?;
    let name = format!("{subfolder}/{place}/{}", own_name.display());
    Ok(Adopted { name, copied })
}

enum CopyFailure {
    Read(AssetError),
    Write(io::Error),
}

impl From<io::Error> for CopyFailure {
    fn from(error: io::Error) -> Self {
        Self::Write(error)
    }
}

/// Copies into a hidden temporary folder, then renames that to its final name. Returns the name and the copies.
fn copy_beside(
    files: &BTreeMap<PathBuf, (PathBuf, u64)>,
    subfolder: &Path,
    own_name: &Path,
) -> Result<(String, Vec<PathBuf>), CopyFailure> {
    let stem = plain_stem(own_name);
    let hidden = tempfile::Builder::new().prefix(".coming-").tempdir_in(subfolder)?;
    for (within, (file, limit)) in files {
        let bytes = assets::read_regular_file(file, *limit).map_err(CopyFailure::Read)?;
        let target = hidden.path().join(within);
        if let Some(parent) = target.parent() {
            fs::create_dir_all(parent)?;
        }
        fs::write(target, bytes)?;
    }
    open_to_readers(hidden.path())?;
    for number in 1..=MAX_NAMES {
        let place = if number == 1 { stem.clone() } else { format!("{stem}-{number}") };
        let target = subfolder.join(&place);
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
            // Another program took the name in the meantime.
            Err(_) if fs::symlink_metadata(&target).is_ok() => (),
            Err(error) => return Err(error.into()),
        }
    }
    Err(io::Error::other(format!("there are {MAX_NAMES} folders named {stem} already")).into())
}

/// Lets other users read the folder: temporary folders are private, but the copies are ordinary files.
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

/// Whether the folder already has all of the files, each equal to its copy.
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

/// The file's name without its extension; characters that a scene cannot use in a path are replaced.
fn plain_stem(file: &Path) -> String {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let plain = |c: char| if c.is_control() || "\\/:".contains(c) { '_' } else { c };
    let stem: String = stem.chars().take(100).map(plain).collect();
    let stem = stem.trim().trim_start_matches('.');
    if stem.is_empty() { "mesh".to_owned() } else { stem.to_owned() }
}
