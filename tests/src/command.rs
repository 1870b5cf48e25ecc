//! The built `impasto` command, as a user runs it.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// The binary beside the running tests. `cargo test --workspace` has already built it. A run of fewer packages builds it now,
/// with the workspace's features, so that it is never out of date and nothing is compiled twice.
///
/// # Panics
/// When it cannot be built.
pub fn impasto() -> &'static Path {
    static BINARY: OnceLock<PathBuf> = OnceLock::new();
    BINARY.get_or_init(|| {
        let here = std::env::current_exe().expect("a test knows where it is");
        // target/debug/deps/it-… -> target/debug
        let folder = here.parent().and_then(Path::parent).expect("tests are two folders down").to_path_buf();
        let mut build = Command::new(env!("CARGO"));
        // The command line's test `binary` needs the command, so this builds it.
        build.args(["test", "--quiet", "--no-run", "--workspace", "--test", "binary"]).arg("--target-dir");
        build.arg(folder.parent().expect("a profile's folder lies in the target folder"));
        build.current_dir(root());
        assert!(build.status().expect("cargo runs").success(), "impasto does not build");
        folder.join(format!("impasto{}", std::env::consts::EXE_SUFFIX))
    })
}

/// The repository's root.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}
