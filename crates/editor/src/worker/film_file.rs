//! Pictures for which memory has no room, in a file without a name: the system deletes it when it is closed, however
//! the program ends.

use std::fs::File;
use std::io::{Read as _, Seek as _, SeekFrom, Write as _};
use std::path::Path;

use egui::ColorImage;

/// The file grows no larger than this, bytes: 2,000 frames of a window of 1280x800.
const MOST_BYTES: u64 = 8 << 30;

/// At least this many bytes stay free on the file's disk.
const LEFT_FREE: u64 = 2 << 30;

/// Pictures one after the other, as their bytes.
pub(super) struct FilmFile {
    file: File,
    used: u64,
    most_bytes: u64,
    left_free: u64,
}

impl FilmFile {
    /// Makes an empty file in `folder`, and the folder if it is missing. `None` if one of them cannot be made.
    pub(super) fn new(folder: &Path) -> Option<Self> {
        std::fs::create_dir_all(folder).ok()?;
        Some(Self {
            file: tempfile::tempfile_in(folder).ok()?,
            used: 0,
            most_bytes: MOST_BYTES,
            left_free: LEFT_FREE,
        })
    }

    /// Appends a picture. Returns its offset in bytes; `None` if there is no room for it or it cannot be written.
    pub(super) fn put(&mut self, image: &ColorImage) -> Option<u64> {
        let bytes = image.as_raw();
        let (at, size) = (self.used, bytes.len() as u64);
        let fits = at + size <= self.most_bytes
            && self.free_bytes().is_some_and(|free| free >= size + self.left_free);
        if !fits {
            return None;
        }
        self.file.seek(SeekFrom::Start(at)).ok()?;
        self.file.write_all(bytes).ok()?;
        self.used = at + size;
        Some(at)
    }

    /// The picture of this size, in pixels, at the offset `at`, in bytes; `None` if it cannot be read.
    pub(super) fn get(&self, at: u64, size_px: [usize; 2]) -> Option<ColorImage> {
        let mut bytes = vec![0; size_px[0] * size_px[1] * 4];
        let mut file = &self.file;
        file.seek(SeekFrom::Start(at)).ok()?;
        file.read_exact(&mut bytes).ok()?;
        Some(ColorImage::from_rgba_premultiplied(size_px, &bytes))
    }

    #[cfg(test)]
    pub(super) fn used_bytes(&self) -> u64 {
        self.used
    }

    /// As [`Self::new`], with these limits.
    #[cfg(test)]
    pub(super) fn within(folder: &Path, most_bytes: u64, left_free: u64) -> Self {
        Self { most_bytes, left_free, ..Self::new(folder).unwrap() }
    }

    pub(super) fn clear(&mut self) {
        self.used = 0;
        // If the file cannot be shortened, it is overwritten from its beginning.
        let _ = self.file.set_len(0);
    }

    /// The free bytes of the file's disk. `None` if the system does not say; then nothing is put into the file.
    #[cfg(unix)]
    fn free_bytes(&self) -> Option<u64> {
        let disk = rustix::fs::fstatvfs(&self.file).ok()?;
        Some(disk.f_bavail.saturating_mul(disk.f_frsize))
    }

    #[cfg(not(unix))]
    fn free_bytes(&self) -> Option<u64> {
        None
    }
}
