//! `cargo xtask bench`: the benchmarks, which are a package outside the workspace with a lock file of its own.

use std::path::Path;

use crate::steps::{cargo, run as run_program};

/// Builds the benchmarks and runs them with the arguments `passed_on`.
pub fn run(root: &Path, passed_on: &[String]) -> anyhow::Result<()> {
    let mut arguments = vec!["run", "--release", "--locked", "--manifest-path", "bench/Cargo.toml", "--"];
    arguments.extend(passed_on.iter().map(String::as_str));
    run_program(root, &cargo(), &arguments)
}
