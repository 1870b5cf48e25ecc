//! Stamps of files, which show whether a file has changed since it was read: first its size and time are compared, then
//! a hash of its bytes.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::time::SystemTime;

/// Size, time and hash of a file at one moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stamp {
    /// Its size, bytes.
    pub bytes: u64,
    /// When it was written last; none where the system does not say.
    pub modified: Option<SystemTime>,
    /// Hash of all its bytes.
    pub hash: u64,
}

impl Stamp {
    /// The stamp of a file, which is read completely. `None` if it is not a regular file that can be read.
    pub fn of(path: &Path) -> Option<Self> {
        let metadata = std::fs::metadata(path).ok().filter(std::fs::Metadata::is_file)?;
        let hash = hash_of(path).ok()?;
        Some(Self { bytes: metadata.len(), modified: metadata.modified().ok(), hash })
    }

    /// Whether a file has another size or time than before. Does not read it.
    pub fn looks_other(before: Option<&Self>, path: &Path) -> bool {
        let metadata = std::fs::metadata(path).ok().filter(std::fs::Metadata::is_file);
        match (before, metadata) {
            (None, None) => false,
            (Some(before), Some(now)) => (before.bytes, before.modified) != (now.len(), now.modified().ok()),
            _ => true,
        }
    }

    /// Whether a file has other bytes than before; reads it only if size or time differ. A deleted file counts as
    /// different.
    pub fn is_other(before: Option<&Self>, path: &Path) -> bool {
        if !Self::looks_other(before, path) {
            return false;
        }
        let content = |stamp: &Self| (stamp.bytes, stamp.hash);
        Self::of(path).as_ref().map(content) != before.map(content)
    }
}

/// The 64-bit FNV-1a hash of bytes.
pub fn hash(bytes: &[u8]) -> u64 {
    fold(START, bytes)
}

const START: u64 = 0xcbf2_9ce4_8422_2325;

fn fold(start: u64, bytes: &[u8]) -> u64 {
    bytes.iter().fold(start, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

fn hash_of(path: &Path) -> io::Result<u64> {
    let mut file = File::open(path)?;
    let mut hash = START;
    let mut buffer = vec![0; 1 << 16];
    loop {
        match file.read(&mut buffer)? {
            0 => return Ok(hash),
            count => hash = fold(hash, &buffer[..count]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn a_file_is_another_only_where_its_bytes_are() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.ron");
        assert!(Stamp::of(&path).is_none() && !Stamp::is_other(None, &path));
        std::fs::write(&path, "one").expect("written");
        assert!(Stamp::is_other(None, &path));
        let stamp = Stamp::of(&path).expect("a stamp");
        assert!(!Stamp::is_other(Some(&stamp), &path));
        // The same bytes at another time.
        let later = SystemTime::now() + Duration::from_secs(60);
        File::options().write(true).open(&path).expect("open").set_modified(later).expect("set");
        assert!(Stamp::looks_other(Some(&stamp), &path));
        assert!(!Stamp::is_other(Some(&stamp), &path));
        // Other bytes of the same size.
        std::fs::write(&path, "two").expect("written");
        File::options().write(true).open(&path).expect("open").set_modified(later).expect("set");
        assert!(Stamp::is_other(Some(&stamp), &path));
        std::fs::remove_file(&path).expect("removed");
        assert!(Stamp::is_other(Some(&stamp), &path));
    }
}
