//! Packs everything that a shot needs into one folder or `.tar` file: the scene file unchanged, and all files that were
//! read with it. Each file lies where the scene finds it, so that the user need not name any folders to search. Equal
//! inputs give equal bytes on every machine.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use impasto_scene::loaded::LoadedScene;
use impasto_scene::whole_file::WholeFile;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// The name of the file that lists the files of a pack; it lies beside them.
pub const LIST_NAME: &str = "pack.json";

/// The time that a `.tar` states for every file: 1980-01-01, which all archive formats can hold.
const WRITTEN_S: u64 = 315_532_800;

/// Why a shot is not packed, or a pack is not whole.
#[derive(Debug, thiserror::Error)]
pub enum PackError {
    /// A file outside the scene's folder is named by a path that leads out of that folder. So no place in a pack fits
    /// the file.
    #[error("{} is used from outside the scene's folder under a name that finds it nowhere else: copy it into the scene's folder", .0.display())]
    NoPlace(PathBuf),
    /// Two files that would lie at one place.
    #[error("{} and {} would lie at one place, {place}: rename one of them", first.display(), second.display())]
    OnePlace {
        /// One of them.
        first: PathBuf,
        /// The other.
        second: PathBuf,
        /// The place, relative to the scene's folder.
        place: String,
    },
    /// A file has a name that is not text.
    #[error("{} has a name that is not UTF-8: rename it", .0.display())]
    NotText(PathBuf),
    /// The folder to pack into exists already.
    #[error("{} is there already: name a new folder, or a .tar file", .0.display())]
    IsThere(PathBuf),
    /// A name that promises another kind of archive.
    #[error("{} is neither a folder nor a .tar file: let the name end in .tar, and press it afterwards if you like", .0.display())]
    NoTar(PathBuf),
    /// A folder without a list, or a file where the folder of a pack is wanted.
    #[error("{} is no pack: it has no {LIST_NAME}. Name the folder that came out of the .tar file", .0.display())]
    NoPack(PathBuf),
    /// Another version packed it.
    #[error("{} was packed by impasto {packed}, and this is {own}: only the same version paints the same frames. Install that one, or pack again with this", folder.display())]
    OtherVersion {
        /// The folder.
        folder: PathBuf,
        /// The version that packed it.
        packed: String,
        /// The version of this program.
        own: &'static str,
    },
    /// A file grew or shrank while it was packed.
    #[error("{} changed while it was packed: pack it again", .0.display())]
    Changed(PathBuf),
    /// A list that cannot be read.
    #[error("{} is not as it was packed: {what}; unpack it again", path.display())]
    NotAsPacked {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
    /// Files of a pack differ from its list.
    #[error("{} is not as it was packed: {}; unpack it again, or pack the shot again if it was edited", folder.display(), some_of(wrong))]
    FilesChanged {
        /// The folder.
        folder: PathBuf,
        /// The files, each with what is wrong.
        wrong: Vec<String>,
    },
    /// The system would not read or write.
    #[error("{}: {error}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system said.
        error: io::Error,
    },
}

/// The first few of many, and how many more there are.
fn some_of(wrong: &[String]) -> String {
    const SHOWN: usize = 5;
    let mut words = wrong[..wrong.len().min(SHOWN)].join(", ");
    if wrong.len() > SHOWN {
        words += &format!(" and {} more", wrong.len() - SHOWN);
    }
    words
}

/// Endings of archives that are not made here.
const OTHER_ARCHIVES: [&str; 8] = ["zip", "gz", "tgz", "xz", "zst", "bz2", "7z", "rar"];

/// The list of a pack.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PackList {
    /// The version of the program that packed it.
    pub impasto: String,
    /// The scene, or the model or shot that is rendered.
    pub scene: String,
    /// All files, in the order of their paths.
    pub files: Vec<PackedFile>,
}

/// A file of a pack.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PackedFile {
    /// Its path in the pack, with `/` between folders.
    pub path: String,
    /// Its length.
    pub bytes: u64,
    /// The SHA-256 of its bytes, in hexadecimal digits.
    pub sha256: String,
}

/// Packs a scene into a new folder, or into a `.tar` file. A `.tar` file that is there already is replaced only when
/// the new one is whole.
///
/// # Errors
/// [`PackError`]; then nothing is left behind.
pub fn pack(loaded: &LoadedScene, to: &Path) -> Result<PackList, PackError> {
    let (scene, sources) = sources(loaded)?;
    let is_other =
        |ending: &std::ffi::OsStr| OTHER_ARCHIVES.iter().any(|other| ending.eq_ignore_ascii_case(other));
    if to.extension().is_some_and(is_other) {
        return Err(PackError::NoTar(to.to_owned()));
    }
    let is_tar = to.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("tar"));
    let mut list = PackList { impasto: env!("CARGO_PKG_VERSION").to_owned(), scene, files: Vec::new() };
    let of_target = |error| PackError::File { path: to.to_owned(), error };
    if is_tar {
        let stem = loaded.path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let mut file = WholeFile::create(to).map_err(of_target)?;
        let mut tar = Tar { builder: tar::Builder::new(&mut file), folder: stem };
        fill(&mut tar, &mut list, &sources)?;
        tar.builder.finish().map_err(of_target)?;
        drop(tar);
        file.finish().map_err(of_target)?;
    } else {
        if to.exists() {
            return Err(PackError::IsThere(to.to_owned()));
        }
        let parent = to.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let name = to.file_name().unwrap_or_default().to_string_lossy();
        let unfinished = tempfile::Builder::new()
            .prefix(&format!(".{name}~"))
            .suffix(".part")
            .tempdir_in(parent)
            .map_err(|error| PackError::File { path: parent.to_owned(), error })?;
        let folder = unfinished.path().join("pack");
        fill(&mut Folder(folder.clone()), &mut list, &sources)?;
        std::fs::rename(&folder, to).map_err(of_target)?;
    }
    Ok(list)
}

/// Compares a folder with the list in it.
///
/// # Errors
/// The folder has no list that can be read, another version of the program packed it, or files differ from the list.
pub fn check(folder: &Path) -> Result<PackList, PackError> {
    if folder.is_file() {
        return Err(PackError::NoPack(folder.to_owned()));
    }
    let list_path = folder.join(LIST_NAME);
    let text = std::fs::read(&list_path).map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => PackError::NoPack(folder.to_owned()),
        _ => PackError::File { path: list_path.clone(), error },
    })?;
    let list: PackList = serde_json::from_slice(&text)
        .map_err(|error| PackError::NotAsPacked { path: list_path, what: error.to_string() })?;
    let own = env!("CARGO_PKG_VERSION");
    if list.impasto != own {
        return Err(PackError::OtherVersion { folder: folder.to_owned(), packed: list.impasto, own });
    }
    let wrong: Vec<String> = list
        .files
        .iter()
        .filter_map(|known| Some(format!("{} ({})", known.path, what_changed(folder, known)?)))
        .collect();
    if wrong.is_empty() {
        Ok(list)
    } else {
        Err(PackError::FilesChanged { folder: folder.to_owned(), wrong })
    }
}

/// What is wrong with a file of a pack; `None` if it is as it was packed.
fn what_changed(folder: &Path, known: &PackedFile) -> Option<String> {
    let read = || -> io::Result<(u64, String)> {
        let file = File::open(folder.join(&known.path))?;
        // Reads at most one byte more than the file had when it was packed, however long it is now.
        let mut summed = Summed::new(file.take(known.bytes.saturating_add(1)));
        io::copy(&mut summed, &mut io::sink())?;
        Ok(summed.finish())
    };
    match read() {
        Ok((bytes, sha256)) if bytes == known.bytes && sha256 == known.sha256 => None,
        Ok(_) => Some("its content has changed".to_owned()),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Some("it is not there".to_owned()),
        Err(error) => Some(error.to_string()),
    }
}

/// The name of the scene in the pack, and for each path in the pack the file that goes there.
fn sources(loaded: &LoadedScene) -> Result<(String, BTreeMap<String, PathBuf>), PackError> {
    let name = PathBuf::from(loaded.path.file_name().unwrap_or_default());
    let scene = as_text(&name)?;
    let mut sources = BTreeMap::from([(scene.clone(), loaded.path.clone())]);
    for (path, place) in loaded.files.places() {
        let place = place.filter(|place| !place.as_os_str().is_empty());
        let place = as_text(&place.ok_or_else(|| PackError::NoPlace(path.clone()))?)?;
        match sources.get(&place) {
            Some(known) if !is_one_file(known, &path) => {
                return Err(PackError::OnePlace { first: known.clone(), second: path, place });
            }
            Some(_) => {}
            None => drop(sources.insert(place, path)),
        }
    }
    if let Some(own) = sources.get(LIST_NAME) {
        let place = LIST_NAME.to_owned();
        return Err(PackError::OnePlace { first: own.clone(), second: PathBuf::from(LIST_NAME), place });
    }
    Ok((scene, sources))
}

fn is_one_file(one: &Path, other: &Path) -> bool {
    matches!((one.canonicalize(), other.canonicalize()), (Ok(one), Ok(other)) if one == other)
}

/// A relative path with `/` between folders.
fn as_text(path: &Path) -> Result<String, PackError> {
    let parts: Option<Vec<&str>> = path.iter().map(|part| part.to_str()).collect();
    parts.map(|parts| parts.join("/")).ok_or_else(|| PackError::NotText(path.to_owned()))
}

/// Puts all files into a pack, and the list at its end.
fn fill(
    into: &mut dyn Target,
    list: &mut PackList,
    sources: &BTreeMap<String, PathBuf>,
) -> Result<(), PackError> {
    for (place, path) in sources {
        let of_source = |error| PackError::File { path: path.clone(), error };
        let file = File::open(path).map_err(of_source)?;
        let length = file.metadata().map_err(of_source)?.len();
        // A file that grows meanwhile is noticed below.
        let mut summed = Summed::new(file.take(length));
        into.add(place, length, &mut summed)?;
        let Summed { read: mut rest, sum, bytes } = summed;
        rest.set_limit(1);
        let is_longer = rest.read(&mut [0]).map_err(of_source)? > 0;
        let sha256 = hex(sum);
        if bytes != length || is_longer {
            return Err(PackError::Changed(path.clone()));
        }
        list.files.push(PackedFile { path: place.clone(), bytes, sha256 });
    }
    let mut text = serde_json::to_string_pretty(list)
        .map_err(|error| PackError::File { path: PathBuf::from(LIST_NAME), error: error.into() })?;
    text.push('\n');
    into.add(LIST_NAME, text.len() as u64, &mut text.as_bytes())
}

/// A pack that is being written.
trait Target {
    /// Adds a file of this length.
    fn add(&mut self, place: &str, length: u64, content: &mut dyn Read) -> Result<(), PackError>;
}

struct Folder(PathBuf);

impl Target for Folder {
    fn add(&mut self, place: &str, _length: u64, content: &mut dyn Read) -> Result<(), PackError> {
        let path = self.0.join(place);
        let mut write = || -> io::Result<()> {
            std::fs::create_dir_all(path.parent().unwrap_or(&self.0))?;
            let mut file = File::create_new(&path)?;
            io::copy(content, &mut file)?;
            file.sync_all()
        };
        write().map_err(|error| PackError::File { path: PathBuf::from(place), error })
    }
}

struct Tar<W: Write> {
    builder: tar::Builder<W>,
    folder: String,
}

impl<W: Write> Target for Tar<W> {
    fn add(&mut self, place: &str, length: u64, content: &mut dyn Read) -> Result<(), PackError> {
        let mut header = tar::Header::new_gnu();
        header.set_size(length);
        header.set_mode(0o644);
        header.set_mtime(WRITTEN_S);
        header.set_entry_type(tar::EntryType::Regular);
        let path = format!("{}/{place}", self.folder);
        // A file that has become shorter is filled up with zeros, so that the tar stays valid until `fill` notices the
        // change.
        let mut whole = content.chain(io::repeat(0)).take(length);
        self.builder
            .append_data(&mut header, &path, &mut whole)
            .map_err(|error| PackError::File { path: PathBuf::from(place), error })
    }
}

/// A reader that hashes and counts the bytes that are read.
struct Summed<R> {
    read: R,
    sum: Sha256,
    bytes: u64,
}

impl<R: Read> Summed<R> {
    fn new(read: R) -> Self {
        Self { read, sum: Sha256::new(), bytes: 0 }
    }

    fn finish(self) -> (u64, String) {
        (self.bytes, hex(self.sum))
    }
}

impl<R: Read> Read for Summed<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.read.read(buffer)?;
        self.sum.update(&buffer[..count]);
        self.bytes += count as u64;
        Ok(count)
    }
}

fn hex(sum: Sha256) -> String {
    sum.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}
