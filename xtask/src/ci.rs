//! `cargo xtask ci`: everything that has to hold before a change is taken in, cheapest first.

use std::path::Path;
use std::time::Instant;

use anyhow::{Context as _, bail, ensure};

use crate::packages::{self, Install};
use crate::steps::{self, Profile, build, cargo, step};
use crate::{layers, test, tidy};

/// Runs every check, each with its seconds; stops at the first that fails.
pub fn run(root: &Path) -> anyhow::Result<()> {
    let start = Instant::now();
    step("system packages", || packages::ensure(root, packages::FOR_TESTS, Install::Yes))?;
    step("format", || steps::run(root, &cargo(), &["fmt", "--all", "--check"]))?;
    step("layers", || layers::run(root))?;
    step("tidy", || tidy::run(root))?;
    step("clippy", || {
        let lints = ["clippy", "--workspace", "--all-targets", "--locked", "--", "-D", "warnings"];
        steps::run(root, &cargo(), &lints)?;
        // The command is built without its window too.
        let bare =
            ["clippy", "-p", "impasto-cli", "--no-default-features", "--locked", "--", "-D", "warnings"];
        steps::run(root, &cargo(), &bare)
    })?;
    step("licences", || licences(root))?;
    step("tests", || test::run(root, Install::Yes, &[]))?;
    let binary = step("release build", || build(root, Profile::Release))?;
    let impasto = binary.to_string_lossy().into_owned();
    step("doctor", || steps::run(root, &impasto, &["doctor"]))?;
    step("render", || smoke_render(root, &impasto))?;
    println!("== all checks hold: {:.0} s", start.elapsed().as_secs_f64());
    Ok(())
}

/// Licences, sources and duplicates by deny.toml, where cargo-deny is installed.
fn licences(root: &Path) -> anyhow::Result<()> {
    if steps::output(root, &cargo(), &["deny", "--version"]).is_err() {
        println!("cargo-deny is not installed: not checked here (`cargo install cargo-deny`)");
        return Ok(());
    }
    steps::run(root, &cargo(), &["deny", "check", "bans", "licenses", "sources"])
}

/// Two small frames through the real binary: whole PNG files that differ from each other.
fn smoke_render(root: &Path, impasto: &str) -> anyhow::Result<()> {
    let folder = root.join("out/ci");
    if folder.exists() {
        std::fs::remove_dir_all(&folder)?;
    }
    let pattern = folder.join("roll_####.png");
    let pattern = pattern.to_string_lossy();
    let arguments =
        ["render", "scenes/roll.ron", "--frames", "0,7", "--size", "160x90", "-o", &pattern, "-v"];
    steps::run(root, impasto, &arguments)?;
    let [still, turned] = ["roll_0000.png", "roll_0007.png"].map(|name| folder.join(name));
    let read = |path: &Path| std::fs::read(path).with_context(|| format!("{} is missing", path.display()));
    let (still, turned) = (read(&still)?, read(&turned)?);
    for picture in [&still, &turned] {
        ensure!(picture.starts_with(b"\x89PNG\r\n\x1a\n"), "a frame is no PNG file");
        ensure!(picture.ends_with(b"IEND\xaeB`\x82"), "a frame is cut short");
    }
    if still == turned {
        bail!("frames 0 and 7 of roll.ron are the same picture");
    }
    Ok(())
}
