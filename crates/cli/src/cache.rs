//! `--cache`: keeps prepared scenes in a folder, for the next process that paints the same scene.

use std::io;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;

use clap::Args;
use impasto_painting::{Kept, KeptBytes, KeptKey, Painting};
use impasto_scene::kept_folder::{KeptFile, KeptFolder, ToWrite};

use crate::memory_size::size_bytes;
use crate::talk::Loudness;

/// The environment variable that names the folder if `--cache` is left out.
const VARIABLE: &str = "IMPASTO_CACHE";

/// Where prepared scenes are kept.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct CacheArguments {
    /// A folder to keep prepared scenes in, so that painting the same scene again begins at once; $IMPASTO_CACHE when
    /// left out, else none.
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    /// The most that this folder may hold; what was used longest ago is removed.
    #[arg(long, value_name = "SIZE", value_parser = size_bytes, default_value = "4G")]
    cache_size: u64,
}

/// A folder of prepared scenes.
#[derive(Clone)]
pub(crate) struct Cache {
    folder: KeptFolder,
    /// The memory that may be allocated, as `--memory` or the system limits it, in bytes: a larger file of the folder
    /// is not read. `None` where no limit is known.
    memory_bytes: Option<u64>,
    loudness: Loudness,
    /// Whether a warning was printed: only the first one is.
    was_told: Arc<AtomicBool>,
}

impl Cache {
    /// The folder that the command line or the environment names; `None` if neither does.
    pub(crate) fn of(
        arguments: &CacheArguments,
        memory_bytes: Option<u64>,
        loudness: Loudness,
    ) -> Option<Self> {
        let of_environment = || std::env::var_os(VARIABLE).filter(|folder| !folder.is_empty());
        let path = arguments.cache.clone().or_else(|| of_environment().map(PathBuf::from))?;
        let folder = KeptFolder { path, most_bytes: arguments.cache_size };
        Some(Self { folder, memory_bytes, loudness, was_told: Arc::default() })
    }

    /// The file that is kept under a key; `None` if there is none, or it cannot be read.
    pub(crate) fn find(&self, key: &KeptKey) -> Option<Box<dyn KeptBytes>> {
        let key = key.to_string();
        let found = self.folder.find(&key, self.memory_bytes.unwrap_or(u64::MAX));
        let found = found.unwrap_or_else(|error| {
            self.tell(&format!("{}: {error}: it is made anew", self.folder.file(&key).display()));
            None
        });
        found.map(|file| Box::new(OpenFile(file)) as Box<dyn KeptBytes>)
    }

    /// Keeps a painting, unless it was taken from the folder, and tidies the folder. This happens on another thread.
    pub(crate) fn store(self, painting: &Painting) -> Storing {
        let (key, is_new, replace) = match painting.kept() {
            Kept::NotAsked => return Storing::default(),
            Kept::NotThere(key) => (*key, true, false),
            Kept::Taken(key, bytes) => {
                if self.loudness == Loudness::Steps {
                    let path = self.folder.file(&key.to_string());
                    eprintln!("  taken from the cache: {:.1} MB, {}", *bytes as f64 / 1e6, path.display());
                }
                (*key, false, false)
            }
            Kept::Unfit(key, why) => {
                let path = self.folder.file(&key.to_string());
                self.tell(&format!("{}: {why}: it is made anew", path.display()));
                (*key, true, true)
            }
        };
        let painting = painting.clone();
        Storing(Some(std::thread::spawn(move || {
            if is_new {
                self.keep(&painting, &key, replace);
            }
            self.folder.tidy(&key.to_string());
        })))
    }

    fn keep(&self, painting: &Painting, key: &KeptKey, replace: bool) {
        let Some(to_keep) = painting.to_keep() else { return };
        let wanted = ToWrite {
            key: key.to_string(),
            bytes: to_keep.bytes(),
            write: &|out| to_keep.write(key, out),
            replace,
        };
        match self.folder.keep(&wanted) {
            Ok(()) if self.loudness == Loudness::Steps => {
                let path = self.folder.file(&wanted.key);
                eprintln!("kept in the cache: {:.1} MB, {}", wanted.bytes as f64 / 1e6, path.display());
            }
            Ok(()) => {}
            Err(error) => {
                let folder = self.folder.path.display();
                let mend = match error.kind() {
                    io::ErrorKind::NotFound => "; make the folder",
                    _ => "",
                };
                self.tell(&format!("{folder}: the prepared scene is not kept: {error}{mend}"));
            }
        }
    }

    fn tell(&self, words: &str) {
        if self.loudness != Loudness::Errors && !self.was_told.swap(true, Ordering::Relaxed) {
            eprintln!("warning: {words}");
        }
    }
}

struct OpenFile(KeptFile);

impl KeptBytes for OpenFile {
    fn count(&self) -> u64 {
        self.0.bytes
    }

    fn read(&self, from: u64, to: &mut [u8]) -> io::Result<()> {
        self.0.read(from, to)
    }
}

/// Work on the folder that goes on in another thread. Dropping this waits until the work is done.
#[derive(Default)]
pub(crate) struct Storing(Option<JoinHandle<()>>);

impl Drop for Storing {
    fn drop(&mut self) {
        if let Some(storing) = self.0.take() {
            // A failure is ignored, because no picture depends on what is kept.
            let _ = storing.join();
        }
    }
}
