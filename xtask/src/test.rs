//! `cargo xtask test`: the whole test suite, after making sure that the drivers it draws with are there.

mod times;

use std::io::{BufRead as _, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};

use anyhow::{Context as _, bail};

use crate::packages::{self, Install};
use crate::steps::cargo;
use times::Times;

/// How many of the slowest tests are named.
const SLOWEST: usize = 10;

/// What is built and run: all targets that have tests. Examples are checked by clippy, and there are no doctests.
const TARGETS: [&str; 3] = ["--lib", "--bins", "--tests"];

/// Installs what is missing, then runs every test of the workspace; `passed_on` goes to `cargo test`. Names the slowest
/// tests after a run of all of them.
pub fn run(root: &Path, install: Install, passed_on: &[String]) -> anyhow::Result<()> {
    packages::ensure(root, packages::FOR_TESTS, install)?;
    let mut command = Command::new(cargo());
    command.args(["test", "--workspace", "--locked"]).args(TARGETS).args(passed_on).current_dir(root);
    if !passed_on.is_empty() {
        let status = command.status().context("cargo cannot be started")?;
        return if status.success() { Ok(()) } else { bail!("tests failed: {status}") };
    }
    let mut child = command.stdout(Stdio::piped()).spawn().context("cargo cannot be started")?;
    let mut times = Times::default();
    for line in BufReader::new(child.stdout.take().context("its stdout is a pipe")?).lines() {
        let line = line?;
        println!("{line}");
        times.heard(&line);
    }
    let status = child.wait()?;
    println!("the {SLOWEST} slowest tests, by the clock:");
    for (name, took) in times.slowest(SLOWEST) {
        println!("{:8.1} s  {name}", took.as_secs_f64());
    }
    if status.success() { Ok(()) } else { bail!("tests failed: {status}") }
}
