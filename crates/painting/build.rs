//! Puts a hash of the sources that preparing depends on, and of the compiler and its flags, into `IMPASTO_SOURCES`. The
//! hash is part of the key of what is kept on disk, so that a program never uses what a different build has kept.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The crates whose code decides what preparing makes.
const CRATES: [&str; 4] = ["core", "gltf", "painting", "scene"];

fn main() {
    let crates = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default()).join("..");
    let mut hash = Fnv(0xcbf2_9ce4_8422_2325);
    for name in CRATES {
        let sources = crates.join(name).join("src");
        // A packaged crate has no sources of other crates beside it; its version stands for all of them.
        if !sources.is_dir() {
            continue;
        }
        println!("cargo:rerun-if-changed={}", sources.display());
        hash.folder(&sources);
    }
    let lock = crates.join("../Cargo.lock");
    println!("cargo:rerun-if-changed={}", lock.display());
    hash.bytes(&std::fs::read(lock).unwrap_or_default());
    for name in ["CARGO_PKG_VERSION", "TARGET", "OPT_LEVEL", "CARGO_ENCODED_RUSTFLAGS"] {
        hash.bytes(env::var(name).unwrap_or_default().as_bytes());
    }
    let compiler = env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    hash.bytes(&Command::new(compiler).arg("-vV").output().map(|output| output.stdout).unwrap_or_default());
    println!("cargo:rustc-env=IMPASTO_SOURCES={:016x}", hash.0);
}

/// FNV-1a, 64 bits: it only has to tell builds of one program apart.
struct Fnv(u64);

impl Fnv {
    fn bytes(&mut self, bytes: &[u8]) {
        for byte in bytes.iter().copied().chain((bytes.len() as u64).to_le_bytes()) {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    /// Adds the names and the bytes of all files of a folder and its subfolders, sorted by name.
    fn folder(&mut self, folder: &Path) {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
        paths.sort();
        for path in paths {
            self.bytes(path.file_name().unwrap_or_default().as_encoded_bytes());
            if path.is_dir() {
                self.folder(&path);
            } else {
                self.bytes(&std::fs::read(&path).unwrap_or_default());
            }
        }
    }
}
