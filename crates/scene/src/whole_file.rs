//! Writes files whole or not at all: at any moment, the name stands for the old file or for the new one.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::TempPath;

/// How many characters of the target's name go into the name of the unfinished file, which must not become too long for
/// a file system.
const NAME_CHARS: usize = 60;

/// Permissions of a new file before the user's umask, and of one that only the user may read.
const SHARED_MODE: u32 = 0o666;
const PRIVATE_MODE: u32 = 0o600;

/// A file that is being written. It lies beside its target as `.NAME~RANDOM.part` and gets the target's name when it is
/// finished; dropped before that, it is removed.
///
/// A link is followed: the file it points to is replaced. A file that is replaced passes on its permissions, and one
/// that is read-only is left alone. A target that is no regular file (a device, a pipe) is never replaced; the contents
/// are written into it.
#[derive(Debug)]
pub struct WholeFile {
    writer: BufWriter<File>,
    /// `None` where the target is no regular file.
    part: Option<TempPath>,
    target: PathBuf,
}

/// Why a file was not written or read, in words for someone who knows no error numbers: *the disk is full*.
pub fn failure_in_words(error: &io::Error) -> String {
    use io::ErrorKind as Kind;
    let words = match error.kind() {
        Kind::StorageFull => "the disk is full",
        Kind::QuotaExceeded => "your share of the disk is used up",
        Kind::ReadOnlyFilesystem => "the disk is read-only",
        Kind::FileTooLarge => "the disk takes no file of that size",
        Kind::NotFound => "its folder is not there",
        Kind::InvalidFilename => "the disk takes no such name",
        // The message that [`WholeFile`] gives says more than the kind.
        Kind::PermissionDenied
            if error.raw_os_error().is_none() && error.to_string().contains("read-only") =>
        {
            return error.to_string();
        }
        Kind::PermissionDenied => "you may not write there",
        _ => {
            let said = error.to_string();
            let said = said.split(" (os error ").next().unwrap_or_default();
            // A temporary file's name would mean nothing to the user.
            return said.split(" at path ").next().unwrap_or_default().to_owned();
        }
    };
    words.to_owned()
}

impl WholeFile {
    /// Begins a file. The permissions of a new one follow the user's umask.
    ///
    /// # Errors
    /// What the file system said; a target that is read-only.
    pub fn create(path: &Path) -> io::Result<Self> {
        Self::with_mode(path, SHARED_MODE)
    }

    /// Begins a file. A new one may be read by the user only.
    ///
    /// # Errors
    /// As [`WholeFile::create`].
    pub fn create_private(path: &Path) -> io::Result<Self> {
        Self::with_mode(path, PRIVATE_MODE)
    }

    fn with_mode(path: &Path, mode: u32) -> io::Result<Self> {
        let target = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        let before = fs::metadata(&target).ok();
        if before.as_ref().is_some_and(|before| !before.is_file()) {
            let writer = BufWriter::new(File::options().write(true).open(&target)?);
            return Ok(Self { writer, part: None, target });
        }
        let permissions = before.map(|before| before.permissions());
        if permissions.as_ref().is_some_and(fs::Permissions::readonly) {
            let message = format!("{} is read-only", target.display());
            return Err(io::Error::new(io::ErrorKind::PermissionDenied, message));
        }
        let name: String =
            target.file_name().unwrap_or_default().to_string_lossy().chars().take(NAME_CHARS).collect();
        let prefix = format!(".{name}~");
        let mut options = File::options();
        options.read(true).write(true).create_new(true);
        #[cfg(unix)]
        std::os::unix::fs::OpenOptionsExt::mode(&mut options, mode);
        #[cfg(not(unix))]
        let _ = mode;
        // The closure opens the file itself, so that an error is the system's own, without the name of the unfinished
        // file.
        let part = tempfile::Builder::new()
            .prefix(&prefix)
            .suffix(".part")
            .make_in(folder_of(&target), |path| options.open(path))?;
        let (file, part) = part.into_parts();
        if let Some(permissions) = permissions {
            file.set_permissions(permissions)?;
        }
        Ok(Self { writer: BufWriter::new(file), part: Some(part), target })
    }

    /// The path of the unfinished file, or the target if that is no regular file. Instead of using this writer, a
    /// caller may let another program (such as ffmpeg) write the contents there.
    pub fn part_path(&self) -> &Path {
        self.part.as_deref().unwrap_or(&self.target)
    }

    /// Gives the file its name. It then survives a power cut, as far as the disk keeps its promises.
    ///
    /// # Errors
    /// What the file system said; the target is then untouched.
    pub fn finish(self) -> io::Result<()> {
        self.finish_by(|part, target| part.persist(target).map_err(|error| error.error))
    }

    /// Gives the file its name, unless something has that name already.
    ///
    /// # Errors
    /// As [`WholeFile::finish`], and [`io::ErrorKind::AlreadyExists`].
    pub fn finish_new(self) -> io::Result<()> {
        if self.part.is_none() {
            return Err(io::ErrorKind::AlreadyExists.into());
        }
        self.finish_by(|part, target| part.persist_noclobber(target).map_err(|error| error.error))
    }

    fn finish_by(self, rename: impl FnOnce(TempPath, &Path) -> io::Result<()>) -> io::Result<()> {
        let file = self.writer.into_inner().map_err(io::IntoInnerError::into_error)?;
        let Some(part) = self.part else { return Ok(()) };
        file.sync_all()?;
        rename(part, &self.target)?;
        // The new name reaches the disk only when the folder is synced. The file is in place already, so an error here
        // is ignored.
        #[cfg(unix)]
        let _ = File::open(folder_of(&self.target)).and_then(|folder| folder.sync_all());
        Ok(())
    }
}

impl Write for WholeFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

/// Writes a file of these bytes, as [`WholeFile::create`] and [`WholeFile::finish`] do.
///
/// # Errors
/// What the file system said; the file that was there is then untouched.
pub fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = WholeFile::create(path)?;
    file.write_all(bytes)?;
    file.finish()
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn failures_are_told_without_numbers() {
        let words = |error: &io::Error| failure_in_words(error);
        assert_eq!(words(&io::Error::from_raw_os_error(28)), "the disk is full");
        assert_eq!(words(&io::Error::from_raw_os_error(13)), "you may not write there");
        assert!(!words(&io::Error::from_raw_os_error(5)).contains("os error"));
        let folder = tempfile::tempdir().unwrap();
        let told = words(&write(&folder.path().join("no/such/s.ron"), b"").unwrap_err());
        assert_eq!(told, "its folder is not there");
    }

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let mut names: Vec<String> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn the_target_is_old_until_the_new_file_is_finished() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        fs::write(&path, "old").unwrap();
        let mut dropped = WholeFile::create(&path).unwrap();
        dropped.write_all(b"half").unwrap();
        assert!(names(folder.path())[0].starts_with(".a.txt~"));
        drop(dropped);
        assert_eq!(
            (names(folder.path()), fs::read_to_string(&path).unwrap()),
            (vec!["a.txt".to_owned()], "old".to_owned())
        );
        write(&path, b"new").unwrap();
        assert_eq!(
            (names(folder.path()), fs::read_to_string(&path).unwrap()),
            (vec!["a.txt".to_owned()], "new".to_owned())
        );
        let mut another = WholeFile::create(&path).unwrap();
        another.write_all(b"another").unwrap();
        assert_eq!(another.finish_new().unwrap_err().kind(), io::ErrorKind::AlreadyExists);
        assert_eq!((names(folder.path()).len(), fs::read_to_string(&path).unwrap()), (1, "new".to_owned()));
        // A name as long as a file system allows.
        let long = folder.path().join("ä".repeat(127));
        write(&long, b"long").unwrap();
        assert_eq!(fs::read_to_string(&long).unwrap(), "long");
    }

    #[cfg(unix)]
    #[test]
    fn permissions_and_links_stay_as_they_were() {
        use std::os::unix::fs::{PermissionsExt as _, symlink};
        let folder = tempfile::tempdir().unwrap();
        let (path, link) = (folder.path().join("a.txt"), folder.path().join("link"));
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        fs::write(&path, "old").unwrap();
        let usual = mode(&path);
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
        symlink("a.txt", &link).unwrap();
        write(&link, b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!((mode(&path), fs::read_to_string(&path).unwrap()), (0o640, "new".to_owned()));
        let (shared, private) = (folder.path().join("shared"), folder.path().join("private"));
        write(&shared, b"").unwrap();
        WholeFile::create_private(&private).unwrap().finish().unwrap();
        assert_eq!((mode(&shared), mode(&private)), (usual, 0o600));
        fs::set_permissions(&path, fs::Permissions::from_mode(0o444)).unwrap();
        assert!(write(&path, b"newer").unwrap_err().to_string().contains("read-only"));
        assert_eq!(fs::read_to_string(&path).unwrap(), "new");
    }

    /// Tried with a pipe, because a bug here could replace `/dev/null`.
    #[cfg(unix)]
    #[test]
    fn what_is_no_regular_file_is_written_into() {
        use std::os::unix::fs::FileTypeExt as _;
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let reader = std::thread::spawn({
            let pipe = pipe.clone();
            move || fs::read(pipe)
        });
        write(&pipe, b"through").unwrap();
        assert_eq!(reader.join().unwrap().unwrap(), b"through");
        assert!(fs::metadata(&pipe).unwrap().file_type().is_fifo());
        assert!(write(folder.path(), b"").is_err(), "a folder was written into");
    }
}
