//! `cargo xtask test`: the whole test suite, after making sure that the drivers it draws with are there.

use std::path::Path;

use crate::packages::{self, Install};
use crate::steps::{cargo, run as run_program};

/// Installs what is missing, then runs every test of the workspace; `passed_on` goes to `cargo test`.
pub fn run(root: &Path, install: Install, passed_on: &[String]) -> anyhow::Result<()> {
    packages::ensure(root, packages::FOR_TESTS, install)?;
    let mut arguments = vec!["test", "--workspace", "--locked"];
    arguments.extend(passed_on.iter().map(String::as_str));
    run_program(root, &cargo(), &arguments)
}
