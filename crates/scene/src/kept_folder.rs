//! A folder in which prepared scenes are kept from one process to the next. Any number of processes may use one folder
//! at once, on a network share too: a file appears under its name whole or not at all, and no process locks or waits.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use crate::whole_file::WholeFile;

/// The ending of a kept file. Its name before that is a key of hexadecimal digits.
const ENDING: &str = ".prepared";

/// How many digits a key has.
const DIGITS: usize = 32;

/// An unfinished file older than this is taken to be left over from a process that was killed.
const LEFT_OVER: Duration = Duration::from_secs(3600);

/// The folder, and how large it may become.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeptFolder {
    /// The folder.
    pub path: PathBuf,
    /// How many bytes all kept files may have together.
    pub most_bytes: u64,
}

/// An open kept file. Its contents stay the same even if another file takes its name.
#[derive(Debug)]
pub struct KeptFile {
    file: File,
    /// How many bytes it had when it was opened.
    pub bytes: u64,
}

impl KeptFile {
    /// Fills `to` with the bytes at the offset `from`. Several threads may read at once.
    ///
    /// # Errors
    /// Those of the system; the file ends too early.
    pub fn read(&self, from: u64, to: &mut [u8]) -> io::Result<()> {
        read_at(&self.file, from, to)
    }
}

#[cfg(unix)]
fn read_at(file: &File, from: u64, to: &mut [u8]) -> io::Result<()> {
    std::os::unix::fs::FileExt::read_exact_at(file, to, from)
}

#[cfg(not(unix))]
fn read_at(mut file: &File, from: u64, to: &mut [u8]) -> io::Result<()> {
    use std::io::{Read as _, Seek as _, SeekFrom};
    // All readers share the file's one position.
    static ONE: std::sync::Mutex<()> = std::sync::Mutex::new(());
    let _one = ONE.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    file.seek(SeekFrom::Start(from))?;
    file.read_exact(to)
}

/// What to keep, and under which key.
pub struct ToWrite<'a> {
    /// The key: 32 hexadecimal digits.
    pub key: String,
    /// How many bytes `write` writes.
    pub bytes: u64,
    /// Writes these bytes.
    pub write: &'a dyn Fn(&mut dyn Write) -> io::Result<()>,
    /// Whether to replace an existing file of the same size. One of another size is always replaced.
    pub replace: bool,
}

impl KeptFolder {
    /// The path of the file that is kept under a key.
    pub fn file(&self, key: &str) -> PathBuf {
        self.path.join(format!("{key}{ENDING}"))
    }

    /// The file that is kept under a key; `None` where there is none. It counts as used now.
    ///
    /// # Errors
    /// Those of the system; the file is no regular file, or is larger than the argument `most_bytes`.
    pub fn find(&self, key: &str, most_bytes: u64) -> io::Result<Option<KeptFile>> {
        let file = match File::open(self.file(key)) {
            Ok(file) => file,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(error),
        };
        let metadata = file.metadata()?;
        if !metadata.is_file() || metadata.len() > most_bytes {
            return Err(io::Error::other("it is no regular file, or larger than the memory that there is"));
        }
        // An error here does no harm: the file merely looks as if it was last used longer ago.
        let _ = file.set_modified(SystemTime::now());
        Ok(Some(KeptFile { file, bytes: metadata.len() }))
    }

    /// Keeps bytes under a key. The folder is made if only its last part is missing.
    ///
    /// # Errors
    /// Those of the system; more bytes than the folder may have.
    pub fn keep(&self, wanted: &ToWrite<'_>) -> io::Result<()> {
        let ToWrite { key, bytes, write, replace } = wanted;
        let path = self.file(key);
        if *bytes > self.most_bytes {
            let words = format!("{} MiB are more than may be kept there", bytes >> 20);
            return Err(io::Error::other(words));
        }
        let is_there = || fs::metadata(&path).is_ok_and(|there| there.len() == *bytes);
        if !replace && is_there() {
            // Another process was quicker.
            return Ok(());
        }
        if !self.path.is_dir() {
            match fs::create_dir(&self.path) {
                Err(error) if error.kind() != io::ErrorKind::AlreadyExists => return Err(error),
                _ => {}
            }
        }
        let mut file = WholeFile::create(&path)?;
        write(&mut file)?;
        file.finish()
    }

    /// Removes the files that were used longest ago until the others fit in `most_bytes`. Also removes old unfinished
    /// files, left over from processes that were killed. The file of `key` stays in any case, as do files whose names
    /// are not ours.
    pub fn tidy(&self, key: &str) {
        let entries = fs::read_dir(&self.path).into_iter().flatten().flatten();
        let mut files: Vec<(SystemTime, u64, PathBuf)> = Vec::new();
        for entry in entries {
            let Some(name) = entry.file_name().to_str().map(str::to_owned) else { continue };
            let Some(metadata) = entry.metadata().ok().filter(fs::Metadata::is_file) else { continue };
            let Ok(used) = metadata.modified() else { continue };
            if is_kept(&name) {
                files.push((used, metadata.len(), entry.path()));
            } else if is_unfinished(&name) && used.elapsed().is_ok_and(|age| age > LEFT_OVER) {
                remove(&entry.path());
            }
        }
        files.sort();
        let mut bytes: u64 = files.iter().map(|(_, bytes, _)| bytes).sum();
        let own = self.file(key);
        for (_, of_file, path) in files.iter().filter(|(_, _, path)| *path != own) {
            if bytes <= self.most_bytes {
                break;
            }
            remove(path);
            bytes -= of_file;
        }
    }
}

/// Removes a file. It may fail: another process may have removed it meanwhile.
fn remove(path: &Path) {
    let _ = fs::remove_file(path);
}

fn is_key(text: &str) -> bool {
    text.len() == DIGITS && text.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'))
}

fn is_kept(name: &str) -> bool {
    name.strip_suffix(ENDING).is_some_and(is_key)
}

/// Whether [`WholeFile`] gave this name to a kept file that is not finished.
fn is_unfinished(name: &str) -> bool {
    let target = || name.strip_prefix('.')?.strip_suffix(".part")?.rsplit_once('~');
    target().is_some_and(|(target, _)| is_kept(target))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(number: u8) -> String {
        format!("{number:032x}")
    }

    fn keep(folder: &KeptFolder, number: u8, contents: &[u8]) -> io::Result<()> {
        folder.keep(&ToWrite {
            key: key(number),
            bytes: contents.len() as u64,
            write: &|out| out.write_all(contents),
            replace: true,
        })
    }

    fn is_there(folder: &KeptFolder, number: u8) -> bool {
        folder.file(&key(number)).exists()
    }

    /// Marks a file as last used so many seconds ago.
    fn used(path: &Path, seconds_ago: u64) {
        let then = SystemTime::now() - Duration::from_secs(seconds_ago);
        File::options().write(true).open(path).unwrap().set_modified(then).unwrap();
    }

    #[test]
    fn what_was_used_longest_ago_goes_and_what_is_not_ours_stays() {
        let folder = tempfile::tempdir().unwrap();
        let folder = KeptFolder { path: folder.path().join("made"), most_bytes: 250 };
        for number in 0..4 {
            keep(&folder, number, &[number; 100]).unwrap();
            used(&folder.file(&key(number)), 1000 - u64::from(number));
        }
        let old = |name: &str| {
            let path = folder.path.join(name);
            fs::write(&path, [0; 1000]).unwrap();
            used(&path, 1_000_000);
            path
        };
        let foreign = [
            "notes.txt",
            ".notes.txt~abc.part",
            "0123.prepared",
            "0000000000000000000000000000000g.prepared",
            ".0123.prepared~x.part",
        ];
        let foreign = foreign.map(old);
        let left_over = old(&format!(".{}.prepared~Ab1.part", key(9)));
        let at_work = old(&format!(".{}.prepared~Ab2.part", key(9)));
        used(&at_work, 60);
        // The oldest is used again.
        let (file, mut bytes) = (folder.find(&key(0), 1 << 20).unwrap().unwrap(), [1; 60]);
        file.read(40, &mut bytes).unwrap();
        assert_eq!((file.bytes, bytes), (100, [0; 60]));
        assert!(file.read(41, &mut bytes).is_err(), "bytes beyond the end were read");
        folder.tidy(&key(3));
        assert_eq!([0, 1, 2, 3].map(|number| is_there(&folder, number)), [true, false, false, true]);
        assert!(foreign.iter().all(|path| path.exists()) && at_work.exists() && !left_over.exists());
        // The file of the key that is handed in stays, whatever its age; both newer files go.
        used(&folder.file(&key(3)), 5000);
        keep(&folder, 4, &[4; 200]).unwrap();
        folder.tidy(&key(3));
        assert_eq!([0, 3, 4].map(|number| is_there(&folder, number)), [false, true, false]);
    }

    #[test]
    fn what_cannot_be_kept_or_found_says_why() {
        let folder = tempfile::tempdir().unwrap();
        let kept = KeptFolder { path: folder.path().to_owned(), most_bytes: 250 };
        assert!(kept.find(&key(0), 1 << 20).unwrap().is_none());
        assert!(keep(&kept, 0, &[0; 251]).unwrap_err().to_string().contains("more than may be kept"));
        let missing = KeptFolder { path: folder.path().join("a/b"), most_bytes: 250 };
        assert!(missing.find(&key(0), 1 << 20).unwrap().is_none());
        assert_eq!(keep(&missing, 0, &[0; 3]).unwrap_err().kind(), io::ErrorKind::NotFound);
        missing.tidy(&key(0));
        keep(&kept, 1, &[1; 100]).unwrap();
        assert!(kept.find(&key(1), 99).is_err(), "a file over the limit of 99 bytes was opened");
        fs::create_dir(kept.file(&key(2))).unwrap();
        assert!(kept.find(&key(2), 1 << 20).is_err(), "a folder was opened as a kept file");
        assert!(keep(&kept, 2, &[0; 3]).is_err());
    }
}
