//! What the fuzz targets share.

use std::path::{Path, PathBuf};

/// A folder of this process and target, in memory where the system has it.
///
/// # Panics
/// Where it cannot be made.
pub fn folder(target: &str) -> PathBuf {
    let memory = Path::new("/dev/shm");
    let parent = if memory.is_dir() { memory.to_owned() } else { std::env::temp_dir() };
    let folder = parent.join(format!("impasto_fuzz_{target}_{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder of its own");
    folder
}
