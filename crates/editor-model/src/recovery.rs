//! Copies of unsaved work, in one of the user's folders. They are written during work, and offered after a crash.
//!
//! ```text
//! Document ─▶ Work ─▶ Keeper (a thread) ─▶ Recovery::keep ─▶ NAME.ron   whole or not at all, never over a scene
//! next start: Recovery::offers ─▶ Offer ─▶ Document::recovered, as it was and not saved
//! ```
//!
//! A session is one running editor. It holds a lock on `NAME.lock`, so that other sessions can tell its copy from one
//! that was left behind: the system releases the lock when the process ends, however that happens.

mod cadence;
mod copy;
mod keeper;
#[cfg(test)]
mod tests;

use std::fs::{self, File, TryLockError};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use impasto_scene::whole_file::WholeFile;

pub use cadence::Cadence;
pub use copy::{Copy, Work};
pub use keeper::{Keeper, Kept};

/// The most copies that are kept; the oldest are deleted first.
pub const MAX_COPIES: usize = 20;

/// The most entries of the folder that are read.
const MAX_ENTRIES: usize = 1000;

/// Extensions of copies, of lock files, and of copies that are still being written.
const COPY: &str = "ron";
const LOCK: &str = "lock";
const PART: &str = "part";

/// The place of one session's copy.
#[derive(Debug)]
pub struct Recovery {
    folder: PathBuf,
    name: String,
    /// Held as long as the session lives.
    _lock: File,
}

/// A copy that no living session holds. While the offer exists, no other session is offered the copy.
#[derive(Debug)]
pub struct Offer {
    /// The copy.
    pub copy: Copy,
    file: PathBuf,
    lock_file: PathBuf,
    _lock: File,
}

impl Recovery {
    /// Makes the place for one session. `name` must be unique, such as a process id with the time of its start.
    ///
    /// # Errors
    /// What the system said: the folder cannot be made or written.
    pub fn open(folder: &Path, name: &str) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        // The lock file gets its name only when it is locked, so that no other session ever finds it unlocked.
        let lock = tempfile::Builder::new().prefix(name).suffix(".new").tempfile_in(folder)?;
        lock.as_file().lock()?;
        let lock = lock.persist(folder.join(name).with_extension(LOCK)).map_err(|error| error.error)?;
        Ok(Self { folder: folder.to_owned(), name: name.to_owned(), _lock: lock })
    }

    /// Writes the copy of this session. Its file is never half written: it is replaced as a whole.
    ///
    /// # Errors
    /// What the system said; the previous copy is untouched.
    pub fn keep(&self, work: &Work) -> io::Result<()> {
        let mut file = WholeFile::create_private(&self.file())?;
        file.write_all(work.to_text().as_bytes())?;
        file.finish()
    }

    /// Removes the copy of this session, after its work was saved or discarded.
    ///
    /// # Errors
    /// What the system said.
    pub fn forget(&self) -> io::Result<()> {
        match fs::remove_file(self.file()) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
            _ => Ok(()),
        }
    }

    /// Makes an offered copy this session's own, so that work goes on with it.
    ///
    /// # Errors
    /// What the system said. The copy can then be offered again, unless only the last step failed: writing the folder
    /// to the disk.
    pub fn take_over(&self, offer: Offer) -> io::Result<()> {
        fs::rename(&offer.file, self.file())?;
        // A lock file without a copy has no effect. If it cannot be removed now, the next call of `offers` removes it.
        let _ = fs::remove_file(&offer.lock_file);
        // The rename is safe only once the folder itself is written to the disk.
        if cfg!(unix) { File::open(&self.folder)?.sync_all() } else { Ok(()) }
    }

    /// The copies that ended sessions left behind, the newest first. Keeps only the newest [`MAX_COPIES`] of them. Also
    /// deletes the lock files and half-written copies of those ended sessions that left no finished copy.
    pub fn offers(folder: &Path) -> Vec<Offer> {
        let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
        let files: Vec<PathBuf> =
            entries.take(MAX_ENTRIES).filter_map(|entry| Some(entry.ok()?.path())).collect();
        let has_ending =
            |file: &&PathBuf, ending: &str| file.extension().is_some_and(|extension| extension == ending);
        let mut offers = Vec::new();
        for file in files.iter().filter(|file| has_ending(file, COPY)) {
            let lock_file = file.with_extension(LOCK);
            let Some(lock) = lock_of(&lock_file) else { continue };
            // A copy that cannot be read stays, so that people can look at it.
            let Some(copy) = Copy::read(file) else { continue };
            offers.push(Offer { copy, file: file.clone(), lock_file, _lock: lock });
        }
        offers.sort_by_key(|offer| std::cmp::Reverse(offer.copy.at_unix_secs));
        for offer in offers.drain(MAX_COPIES.min(offers.len())..) {
            // If that fails, the next call tries again.
            let _ = offer.discard();
        }
        for file in files.iter().filter(|file| has_ending(file, LOCK) || has_ending(file, PART)) {
            // `NAME.lock`, or a copy that was being written: `.NAME.ron~RANDOM.part`.
            let stem = file.file_stem().unwrap_or_default().to_string_lossy();
            let session = folder.join(stem.trim_start_matches('.').split('~').next().unwrap_or_default());
            let lock = File::open(session.with_extension(LOCK));
            let is_dead = lock.map_or(true, |lock| lock.try_lock().is_ok());
            if is_dead && !session.with_extension(COPY).exists() {
                let _ = fs::remove_file(file);
            }
        }
        offers
    }

    fn file(&self) -> PathBuf {
        self.folder.join(&self.name).with_extension(COPY)
    }
}

impl Drop for Recovery {
    /// Removes the lock file, unless there is still a copy.
    fn drop(&mut self) {
        if !self.file().exists() {
            let _ = fs::remove_file(self.folder.join(&self.name).with_extension(LOCK));
        }
    }
}

impl Offer {
    /// Throws the copy away.
    ///
    /// # Errors
    /// What the system said.
    pub fn discard(self) -> io::Result<()> {
        fs::remove_file(&self.file)?;
        fs::remove_file(&self.lock_file)
    }
}

/// Takes the lock of a copy; `None` if a session holds the lock (the copy's own session, or one to which the copy was
/// offered), or if the lock file cannot be opened.
fn lock_of(lock_file: &Path) -> Option<File> {
    let lock = File::options().create(true).truncate(false).write(true).open(lock_file).ok()?;
    match lock.try_lock() {
        Ok(()) => Some(lock),
        Err(TryLockError::WouldBlock) => None,
        // The file system has no locks. It is better to offer a copy too often than to lose it.
        Err(TryLockError::Error(_)) => Some(lock),
    }
}
