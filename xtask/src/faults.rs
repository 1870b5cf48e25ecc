//! `cargo xtask faults`: plants faults in shaders, one at a time, and checks that a test notices each. The tests are
//! built once; their renderers read the faulty file from a folder.

mod list;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use anyhow::{Context as _, bail, ensure};

use crate::steps::{self, cargo, target_folder};

/// The environment variable that names the folder of shaders; `tests/src/pictures.rs` reads it.
const PLANTED: &str = "IMPASTO_PLANTED_SHADERS";

/// A small change of a shader that makes a picture wrong.
struct Fault {
    /// What is wrong, in a few words.
    name: &'static str,
    /// The file, below `crates/gl-render/shaders/`.
    file: &'static str,
    /// The text to replace, which the file holds exactly once, and its replacement.
    from: &'static str,
    to: &'static str,
    /// Parts of the names of the tests that should notice the fault.
    tests: &'static [&'static str],
}

/// Plants the faults whose names contain one of `names`; all faults if there are no `names`.
///
/// # Errors
/// A name that is part of no fault's name, a fault whose text `from` its shader does not hold exactly once, a test that
/// fails without any fault, or a fault that no test notices.
pub fn run(root: &Path, names: &[String]) -> anyhow::Result<()> {
    let chosen: Vec<&Fault> = list::FAULTS
        .iter()
        .filter(|fault| names.is_empty() || names.iter().any(|name| fault.name.contains(name)))
        .collect();
    if let Some(name) = names.iter().find(|name| !list::FAULTS.iter().any(|fault| fault.name.contains(*name)))
    {
        bail!("no fault is called `{name}`");
    }
    let program = built_tests(root)?;
    let folder = target_folder(root)?.join("faults");
    // The tests run with unchanged shaders first. So a test that fails anyway is not taken for one that notices a
    // fault.
    let mut all: Vec<&str> = chosen.iter().flat_map(|fault| fault.tests.iter().copied()).collect();
    all.sort_unstable();
    all.dedup();
    plant(root, &folder, "shared/encode.frag", |text| Ok(text.to_owned()))?;
    let failed = steps::step("without a fault", || failing(root, &program, &folder, &all))?;
    ensure!(failed.is_empty(), "without any fault, these tests fail: {}", failed.join(", "));
    let mut unnoticed = Vec::new();
    for fault in &chosen {
        plant(root, &folder, fault.file, |text| planted(fault, text))?;
        let begun = Instant::now();
        let failed = failing(root, &program, &folder, fault.tests)?;
        let who = if failed.is_empty() { "NO TEST".to_owned() } else { failed.join(", ") };
        println!("{:6.1} s  {}: noticed by {who}", begun.elapsed().as_secs_f64(), fault.name);
        if failed.is_empty() {
            unnoticed.push(fault.name);
        }
    }
    println!("{} of {} faults noticed", chosen.len() - unnoticed.len(), chosen.len());
    if !unnoticed.is_empty() {
        bail!("no test noticed: {}", unnoticed.join("; "));
    }
    Ok(())
}

fn planted(fault: &Fault, text: &str) -> anyhow::Result<String> {
    let found = text.matches(fault.from).count();
    ensure!(found == 1, "{}: `{}` stands {found} times in {}", fault.name, fault.from, fault.file);
    Ok(text.replace(fault.from, fault.to))
}

/// Writes the one changed file into a folder that holds no other.
fn plant(
    root: &Path,
    folder: &Path,
    file: &str,
    change: impl Fn(&str) -> anyhow::Result<String>,
) -> anyhow::Result<()> {
    let text = std::fs::read_to_string(root.join(SHADERS).join(file)).with_context(|| file.to_owned())?;
    if folder.exists() {
        std::fs::remove_dir_all(folder)?;
    }
    let path = folder.join(file);
    std::fs::create_dir_all(path.parent().unwrap_or(folder))?;
    Ok(std::fs::write(path, change(&text)?)?)
}

const SHADERS: &str = "crates/gl-render/shaders";

/// The program of the integration tests, built with the features of the whole workspace, so that nothing is built
/// twice.
fn built_tests(root: &Path) -> anyhow::Result<PathBuf> {
    let arguments =
        ["test", "--locked", "--workspace", "--test", "it", "--no-run", "--message-format", "json"];
    let manifest = root.join("tests/Cargo.toml");
    let said = steps::output(root, &cargo(), &arguments)?;
    let program = said
        .lines()
        .filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok())
        .find_map(|message| {
            let is_ours = message["manifest_path"].as_str().map(Path::new) == Some(&manifest);
            is_ours.then(|| message["executable"].as_str().map(PathBuf::from))?
        });
    program.context("cargo did not say where the tests are")
}

/// Runs the tests whose names contain one of `tests`. Returns the names of those that failed.
fn failing(root: &Path, program: &Path, folder: &Path, tests: &[&str]) -> anyhow::Result<Vec<String>> {
    let done =
        Command::new(program).args(tests).env(PLANTED, folder).current_dir(root.join("tests")).output()?;
    let said = String::from_utf8_lossy(&done.stdout);
    let ran = said.lines().filter(|line| line.starts_with("test ") && line.contains(" ... ")).count();
    ensure!(ran > 0, "no test is called {}", tests.join(" or "));
    let failed: Vec<String> = said
        .lines()
        .filter_map(|line| line.strip_prefix("test ")?.strip_suffix(" ... FAILED").map(str::to_owned))
        .collect();
    ensure!(
        done.status.success() != failed.iter().any(|_| true),
        "the tests ended in an unknown way: {}",
        done.status
    );
    Ok(failed)
}
