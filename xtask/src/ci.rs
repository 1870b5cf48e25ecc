//! `cargo xtask ci`: all checks that a change must pass. Most of the quick ones come before the tests.

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
    check("clippy", &|| clippy(root))?;
    check("licences", &|| licences(root))?;
    // The same command that the README tells people to run.
    check("tests", &|| steps::run(root, &cargo(), &["xtask", "test"]))?;
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

/// Runs clippy with the editor's window and without it, and allows no warning. Both runs name the whole workspace and
/// all targets, so that crates which both share have the same features and are not checked twice. Where
/// `.ci/rustc_and_clippy` stands in for the compiler, clippy reads what is built. All targets are also what the tests
/// need, with the same features.
fn clippy(root: &Path) -> anyhow::Result<()> {
    let wrapper = std::env::var_os("RUSTC_WORKSPACE_WRAPPER");
    let lints_as_it_builds = wrapper.is_some_and(|path| Path::new(&path).ends_with(".ci/rustc_and_clippy"));
    let (command, strict): (&str, &[&str]) =
        if lints_as_it_builds { ("build", &[]) } else { ("clippy", &["--", "-D", "warnings"]) };
    // The build with the window comes last, so that the command which the next steps run has it.
    for features in [&["--no-default-features"][..], &[]] {
        let arguments = [&[command, "--workspace", "--all-targets", "--locked"], features, strict].concat();
        steps::run(root, &cargo(), &arguments)?;
    }
    Ok(())
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
