//! Runs the command once. Because this is an integration test, cargo builds the binary before any test runs, with the
//! features that the whole workspace needs; the package `tests/` at the repository's root runs that binary.

use std::process::Command;

#[test]
fn it_tells_its_version() {
    let output = Command::new(env!("CARGO_BIN_EXE_impasto")).arg("--version").output().expect("it starts");
    assert!(output.status.success());
    let expected = format!("impasto {}\n", env!("CARGO_PKG_VERSION"));
    assert_eq!(String::from_utf8_lossy(&output.stdout), expected);
}
