//! `cargo xtask package`: makes the packages that people install, and puts them into `target/package/`: a Debian
//! package, an archive for any Linux, and a wheel for pip.

mod changelog;
mod licences;
mod tree;

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, bail, ensure};

use crate::packages::{self, Install};
use crate::steps::{self, Profile, build, cargo, step};

// The versions of the packaging tools that were tried. This command installs its own copies into `target/tools`.
const CARGO_DEB: &str = "3.8.0";
const MATURIN: &str = "1.16.0";

/// The folder of the packages, relative to the repository. `[package.metadata.deb]` in crates/cli/Cargo.toml names it
/// too: change both together.
const FOLDER: &str = "target/package";

/// Makes all three packages, and says where they are.
///
/// # Errors
/// If a step fails.
pub fn run(root: &Path, install: Install) -> anyhow::Result<()> {
    packages::ensure(root, &[packages::PACKAGING], install)?;
    let binary = step("build", || build(root, Profile::Release))?;
    let folder = root.join(FOLDER);
    let when = Moment::of(root)?;
    let tree = step("files", || tree::lay(root, &folder, &binary))?;
    changelog::write(root, &folder.join("changelog"), &when)?;
    let deb = step("Debian package", || debian_package(root, &folder, &when))?;
    tree::add_licences(root, &tree)?;
    let archive = step("archive", || archive(root, &tree, &when))?;
    let wheel = step("wheel", || wheel(root, &folder, &when))?;
    for made in [deb, archive, wheel] {
        let bytes = std::fs::metadata(&made)?.len();
        println!("{} ({:.1} MB)", made.display(), bytes as f64 / 1e6);
    }
    Ok(())
}

/// The time that all files of the packages bear, so that equal sources give equal packages.
struct Moment {
    seconds: String,
    /// As Debian's changelogs write it.
    in_words: String,
}

impl Moment {
    /// `SOURCE_DATE_EPOCH` where it is set, else the time of the last commit.
    fn of(root: &Path) -> anyhow::Result<Self> {
        let seconds = match std::env::var("SOURCE_DATE_EPOCH") {
            Ok(seconds) => seconds,
            Err(_) => steps::output(root, "git", &["log", "-1", "--format=%ct"])
                .context("set SOURCE_DATE_EPOCH where there is no git")?,
        };
        let seconds = seconds.trim().to_owned();
        let asked = ["--utc", "--date", &format!("@{seconds}"), "+%a, %d %b %Y %H:%M:%S +0000"];
        let date = Command::new("date").args(asked).env("LC_ALL", "C").output()?;
        ensure!(date.status.success(), "`date` cannot read the time {seconds}");
        let in_words = String::from_utf8_lossy(&date.stdout).trim().to_owned();
        Ok(Self { seconds, in_words })
    }
}

/// The version of this crate and of the program: both take it from the workspace.
fn version() -> &'static str {
    env!("CARGO_PKG_VERSION")
}

fn succeed(command: &mut Command) -> anyhow::Result<()> {
    let name = command.get_program().to_string_lossy().into_owned();
    let status = command.status().with_context(|| format!("`{name}` cannot be started"))?;
    ensure!(status.success(), "`{name}` failed: {status}");
    Ok(())
}

/// Packs the tree with cargo-deb, as `[package.metadata.deb]` in crates/cli/Cargo.toml says.
fn debian_package(root: &Path, folder: &Path, when: &Moment) -> anyhow::Result<PathBuf> {
    let tools = root.join("target/tools");
    let tool = tools.join("bin/cargo-deb");
    let is_there = Command::new(&tool)
        .arg("--version")
        .output()
        .is_ok_and(|said| said.stdout.trim_ascii() == format!("cargo-deb {CARGO_DEB}").as_bytes());
    if !is_there {
        let tools = tools.to_string_lossy();
        steps::run(
            root,
            &cargo(),
            &["install", "cargo-deb", "--locked", "--version", CARGO_DEB, "--root", &tools],
        )?;
    }
    let made = folder.join(format!("impasto_{}-1_{}.deb", version(), debian_architecture()?));
    let mut command = Command::new(&tool);
    command.args(["--package", "impasto-cli", "--no-build", "--no-strip", "--quiet", "--output"]).arg(&made);
    succeed(command.current_dir(root).env("SOURCE_DATE_EPOCH", &when.seconds))?;
    Ok(made)
}

fn debian_architecture() -> anyhow::Result<&'static str> {
    match std::env::consts::ARCH {
        "x86_64" => Ok("amd64"),
        "aarch64" => Ok("arm64"),
        other => bail!("Debian's name for {other} is not known here"),
    }
}

/// Packs the tree for any Linux: names sorted, one time stamp for all files, root as owner. The completions for zsh
/// move to where zsh itself looks for them.
fn archive(root: &Path, tree: &Path, when: &Moment) -> anyhow::Result<PathBuf> {
    let name = format!("impasto-{}-{}-linux", version(), std::env::consts::ARCH);
    let made = root.join(FOLDER).join(format!("{name}.tar.zst"));
    let mut command = Command::new("tar");
    command
        .args(["--create", "--sort=name", "--format=gnu", "--owner=0", "--group=0", "--numeric-owner"])
        .args(["--mode=u=rwX,go=rX", "--use-compress-program=zstd -19 --threads=1 --quiet"])
        .arg(format!("--mtime=@{}", when.seconds))
        // Only Debian's zsh looks into vendor-completions.
        .arg("--transform=s,zsh/vendor-completions,zsh/site-functions,")
        .arg(format!("--transform=s,^tree,{name},"))
        .arg("--file")
        .arg(&made)
        .arg("--directory")
        .arg(tree.parent().context("the tree lies in a folder")?)
        .arg("tree");
    succeed(&mut command)?;
    Ok(made)
}

/// Builds a wheel of the program and its licences with maturin, as packaging/wheel/pyproject.toml says.
fn wheel(root: &Path, folder: &Path, when: &Moment) -> anyhow::Result<PathBuf> {
    let python = root.join("target/tools/maturin/bin/python");
    let version_of_tool =
        Command::new(&python).args(["-m", "maturin", "--version"]).output().map(|said| said.stdout);
    if version_of_tool.ok().is_none_or(|said| said.trim_ascii() != format!("maturin {MATURIN}").as_bytes()) {
        let venv = root.join("target/tools/maturin");
        succeed(Command::new("python3").args(["-m", "venv", "--clear"]).arg(&venv))
            .context("python3 with its module venv makes the wheel (Debian: python3-venv)")?;
        let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check"];
        succeed(Command::new(&python).args(pip).arg(format!("maturin=={MATURIN}")))?;
    }
    let into = folder.join("wheel");
    if into.exists() {
        std::fs::remove_dir_all(&into)?;
    }
    let project = wheel_project(root, folder)?;
    let mut command = Command::new(&python);
    command.args(["-m", "maturin", "build", "--release", "--locked", "--quiet", "--out"]).arg(&into);
    succeed(command.current_dir(project).env("SOURCE_DATE_EPOCH", &when.seconds))?;
    let mut made =
        std::fs::read_dir(&into)?.map(|entry| Ok(entry?.path())).collect::<std::io::Result<Vec<_>>>()?;
    let made = made.pop().context("maturin made no wheel")?;
    let beside = folder.join(made.file_name().context("a wheel has a name")?);
    std::fs::rename(&made, &beside)?;
    std::fs::remove_dir(&into)?;
    Ok(beside)
}

/// Lays out the folder that maturin starts from, and returns it: the files of packaging/wheel, with the licences beside
/// them. The path to the program's manifest is made absolute, since the copy lies elsewhere.
fn wheel_project(root: &Path, folder: &Path) -> anyhow::Result<PathBuf> {
    let project = folder.join("wheel-project");
    let licences = project.join("licences");
    std::fs::create_dir_all(&licences)?;
    let from = root.join("packaging/wheel");
    let manifest = root.join("crates/cli/Cargo.toml");
    let settings = std::fs::read_to_string(from.join("pyproject.toml"))?;
    let settings = settings.replace("../../crates/cli/Cargo.toml", &manifest.to_string_lossy());
    std::fs::write(project.join("pyproject.toml"), settings)?;
    std::fs::copy(from.join("README.md"), project.join("README.md"))?;
    for name in ["LICENSE-MIT", "LICENSE-APACHE", "third_party.txt"] {
        std::fs::copy(folder.join("tree/share/doc/impasto").join(name), licences.join(name))?;
    }
    Ok(project)
}
