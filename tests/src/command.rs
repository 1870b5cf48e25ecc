//! Finds the built `impasto` command, so that tests can run it as a user does.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// The path of the command's binary, in the same target folder as the running tests. The binary is built first, in the
/// profile of the tests and with the features of the whole workspace. After `cargo test --workspace` nothing is left to
/// build; in a run of fewer packages this brings it up to date.
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
        // `binary` is a test in `crates/cli` that runs `impasto`, so that building the test also builds `impasto`.
        build.args(["test", "--quiet", "--no-run", "--workspace", "--test", "binary"]).arg("--target-dir");
        build.arg(folder.parent().expect("a profile's folder lies in the target folder"));
        if folder.ends_with("release") {
            build.arg("--release");
        }
        build.current_dir(root());
        assert!(build.status().expect("cargo runs").success(), "impasto does not build");
        folder.join(format!("impasto{}", std::env::consts::EXE_SUFFIX))
    })
}

/// The repository's root.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}
