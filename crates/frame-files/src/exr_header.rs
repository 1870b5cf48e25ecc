//! The head of an EXR file as bytes: sorts its attributes, and tells whether the file ends where its last block ends.
//!
//! A file begins with a magic number and a version. Then come attributes, and a zero after the last. An attribute is a
//! name and a type, which end in a zero each, a size in 4 bytes, and a value. Then a table says at which byte of the
//! file each block of rows begins. A block begins with the number of its first row, and its size.

use std::fs::File;
use std::io::{Read as _, Seek as _, SeekFrom};
use std::ops::Range;
use std::path::Path;

const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// Where the first attribute begins.
const FIRST: usize = 8;

/// Longer heads are not read. Those that Impasto writes are shorter.
const LONGEST: u64 = 64 << 20;

/// Where the attributes are and where the head ends; `None` if the bytes end before the head does.
fn attributes(bytes: &[u8]) -> Option<(Vec<Range<usize>>, usize)> {
    let mut found = Vec::new();
    let mut at = FIRST;
    let after_zero = |from: usize| Some(from + bytes.get(from..)?.iter().position(|&byte| byte == 0)? + 1);
    while *bytes.get(at)? != 0 {
        let value = after_zero(after_zero(at)?)?;
        let size = u32::from_le_bytes(bytes.get(value..value + 4)?.try_into().ok()?) as usize;
        let end = value.checked_add(4)?.checked_add(size)?;
        found.push(at..end);
        at = end;
    }
    Some((found, at + 1))
}

/// Sorts the attributes by name, so that equal pictures give equal bytes. The head stays as long as it was, so the
/// offsets in the table stay right.
pub(crate) fn sort_attributes(bytes: &mut [u8]) {
    let Some((mut ranges, end)) = attributes(bytes) else { return };
    ranges.sort_by(|left, right| bytes[left.clone()].cmp(&bytes[right.clone()]));
    let sorted: Vec<u8> = ranges.into_iter().flat_map(|range| bytes[range].iter().copied()).collect();
    bytes[FIRST..end - 1].copy_from_slice(&sorted);
}

/// Whether a file is an EXR file that ends with the last block of its table. A truncated file does not.
pub(crate) fn is_whole(path: &Path) -> bool {
    ends_with_its_last_block(path).unwrap_or(false)
}

/// The attribute of this name; `None` if there is none, or it is no text.
pub(crate) fn text(path: &Path, name: &str) -> Option<String> {
    let (head, ranges, _) = head(&mut File::open(path).ok()?)?;
    let start = [name.as_bytes(), b"\0string\0"].concat();
    let value = ranges.into_iter().find_map(|range| head[range].strip_prefix(&*start))?;
    // The size comes first.
    Some(String::from_utf8_lossy(value.get(4..)?).into_owned())
}

/// The head of a file, where its attributes are, and where it ends; `None` if the head is cut, or not that of an EXR
/// file.
fn head(file: &mut File) -> Option<(Vec<u8>, Vec<Range<usize>>, usize)> {
    let length = file.metadata().ok()?.len();
    let mut head = Vec::new();
    // Most heads are short; the list of names of a Cryptomatte may make them long.
    let mut wanted = 64 << 10;
    loop {
        file.by_ref().take(wanted - head.len() as u64).read_to_end(&mut head).ok()?;
        if head.len() < FIRST || head[..4] != MAGIC {
            return None;
        }
        match attributes(&head) {
            Some((ranges, end)) => return Some((head, ranges, end)),
            None if head.len() as u64 >= length.min(LONGEST) => return None,
            None => wanted *= 4,
        }
    }
}

fn ends_with_its_last_block(path: &Path) -> Option<bool> {
    let mut file = File::open(path).ok()?;
    let length = file.metadata().ok()?.len();
    let (_, _, end) = head(&mut file)?;
    let mut number = |at: u64, bytes: usize| {
        let mut value = [0; 8];
        file.seek(SeekFrom::Start(at)).ok()?;
        file.read_exact(&mut value[..bytes]).ok()?;
        Some(u64::from_le_bytes(value))
    };
    // The first block follows the table, so the offset of that block tells where the table ends.
    let first = number(end as u64, 8)?;
    let mut last = 0;
    let mut entry = end as u64;
    while entry + 8 <= first.min(length) {
        last = last.max(number(entry, 8)?);
        entry += 8;
    }
    let bytes = number(last.checked_add(4)?, 4)?;
    Some(last > 0 && last.checked_add(8)?.checked_add(bytes)? == length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exr_file::{Channel, ExrPicture, Packing, Samples, encode};
    use crate::picture_file::Provenance;

    #[test]
    fn a_whole_file_is_told_from_one_that_was_cut_anywhere() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let channel = Channel::new("Y", Samples::Float((0..40 * 37).map(|index| index as f32).collect()));
        let from_world = [[0.0; 16]; 2];
        let picture = ExrPicture {
            size_px: [40, 37],
            channels: vec![channel],
            fps: 24.0,
            from_world,
            notes: Vec::new(),
        };
        let provenance = Provenance {
            scene: String::new(),
            state: String::new(),
            frame: String::new(),
            driver: String::new(),
        };
        let bytes = encode(picture, &provenance, Packing::Small).unwrap();
        std::fs::write(&path, &bytes).unwrap();
        assert!(is_whole(&path));
        for kept in [0, 3, 7, 8, 40, 300, bytes.len() / 2, bytes.len() - 1] {
            std::fs::write(&path, &bytes[..kept]).unwrap();
            assert!(!is_whole(&path), "{kept} of {} bytes", bytes.len());
        }
        std::fs::write(&path, [bytes.as_slice(), b"x"].concat()).unwrap();
        assert!(!is_whole(&path), "a byte too many");
        let table = head(&mut File::open(&path).unwrap()).unwrap().2;
        let mut wild = bytes.clone();
        wild[table + 8..table + 16].fill(0xff);
        std::fs::write(&path, &wild).unwrap();
        assert!(!is_whole(&path), "an entry of the table beyond all numbers");
        assert!(!is_whole(&folder.path().join("none.exr")));
    }
}
