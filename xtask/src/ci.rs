//! `cargo xtask ci`: all checks that a change must pass, cheapest first.

use std::path::Path;
use std::time::Instant;

use anyhow::{Context as _, bail, ensure};

use crate::packages::{self, Install};
use crate::steps::{self, cargo, step, target_folder};
use crate::{blender, layers, tidy};

/// Runs every check; stops at the first that fails. Prints the seconds of each.
pub fn run(root: &Path) -> anyhow::Result<()> {
    let start = Instant::now();
    let mut seconds = Vec::new();
    let mut check = |name: &'static str, work: &dyn Fn() -> anyhow::Result<()>| {
        let start = Instant::now();
        let done = step(name, work);
        seconds.push((name, start.elapsed().as_secs_f64()));
        done
    };
    check("system packages", &|| packages::ensure(root, packages::FOR_TESTS, Install::Yes))?;
    check("format", &|| steps::run(root, &cargo(), &["fmt", "--all", "--check"]))?;
    check("layers", &|| layers::run(root))?;
    check("tidy", &|| tidy::run(root))?;
    check("licences", &|| licences(root))?;
    // The command without its window comes first: the tests then build the one with it in its place.
    check("clippy, no window", &|| {
        lint(root, &[BUILD, &["--no-default-features", "--test", "binary"]].concat())
    })?;
    // The same command that the README tells people to run.
    check("clippy and tests", &|| lint(root, &["xtask", "test"]))?;
    check("clippy, examples", &|| lint(root, &[BUILD, &["--examples"]].concat()))?;
    // The binary that the tests built and ran: a release build would show nothing more, and takes five minutes.
    let impasto = target_folder(root)?.join("debug").join(format!("impasto{}", std::env::consts::EXE_SUFFIX));
    let impasto = impasto.to_string_lossy();
    check("doctor", &|| steps::run(root, &impasto, &["doctor"]))?;
    check("render", &|| smoke_render(root, &impasto))?;
    check("blender", &|| blender::run(root, blender::Fetch::No))?;
    println!("== seconds a step");
    for (name, seconds) in seconds {
        println!("{seconds:8.1}  {name}");
    }
    println!("== all checks hold: {:.0} s", start.elapsed().as_secs_f64());
    Ok(())
}

/// Clippy in the compiler's place, with no warning allowed: `cargo clippy` sets the same variables. Crates are then compiled
/// and linted in one go. A run of `cargo clippy` of its own would read all dependencies once more, for three minutes.
const LINTED: [(&str, &str); 2] = [
    ("RUSTC_WORKSPACE_WRAPPER", "clippy-driver"),
    ("CLIPPY_ARGS", "-D__CLIPPY_HACKERY__warnings__CLIPPY_HACKERY__"),
];

/// Builds what the tests need, with the features of all their dependencies, so that nothing is compiled twice.
const BUILD: &[&str] = &["test", "--no-run", "--locked", "--workspace"];

/// Runs cargo so that all that it compiles of the workspace is linted too.
fn lint(root: &Path, arguments: &[&str]) -> anyhow::Result<()> {
    steps::run_with(root, &cargo(), arguments, &LINTED)
}

/// Checks licences, sources and duplicates against deny.toml, where cargo-deny is installed.
fn licences(root: &Path) -> anyhow::Result<()> {
    if steps::output(root, &cargo(), &["deny", "--version"]).is_err() {
        println!("cargo-deny is not installed: not checked here (`cargo install cargo-deny`)");
        return Ok(());
    }
    steps::run(root, &cargo(), &["deny", "check", "bans", "licenses", "sources"])
}

/// Renders two small frames with the real binary: they must be whole PNG files, and differ.
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
