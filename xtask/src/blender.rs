//! `cargo xtask blender`: builds the extension, installs it into a throw-away profile of each Blender, and runs its
//! tests there.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, bail, ensure};

use crate::steps::{self, cargo, target_folder};

/// The Blenders that are tried, as modules of Python 3.11.
const VERSIONS: [&str; 3] = ["5.0.1", "4.5.15", "4.2.23"];

/// The environment variable that names a Python which already has Blender as a module.
const OWN_PYTHON: &str = "IMPASTO_BPY";

/// Whether missing Blenders are fetched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fetch {
    /// Fetched by pip: about 1 GB on the disk for each.
    Yes,
    /// Only Blenders that this machine has are tried.
    No,
}

/// Builds, installs and tests the extension. Without any Blender, says so and does nothing.
///
/// # Errors
/// A step that failed.
pub fn run(root: &Path, fetch: Fetch) -> anyhow::Result<()> {
    let folder = target_folder(root)?.join("blender");
    std::fs::create_dir_all(&folder)?;
    let mut pythons: Vec<PathBuf> = std::env::var_os(OWN_PYTHON).map(PathBuf::from).into_iter().collect();
    if pythons.is_empty() {
        pythons = VERSIONS.iter().filter_map(|version| python_with(&folder, version, fetch)).collect();
    }
    if pythons.is_empty() {
        println!(
            "no Blender here: not tested (`cargo xtask blender` fetches it; {OWN_PYTHON} names a Python that has it)"
        );
        return Ok(());
    }
    steps::run(root, &cargo(), &["build", "--locked", "--package", "impasto-cli"])?;
    for python in pythons {
        test(root, &folder, &python)?;
    }
    Ok(())
}

/// A Python with this Blender. `None` if this machine has none and it is not fetched, because `fetch` forbids it or
/// because fetching fails.
fn python_with(folder: &Path, version: &str, fetch: Fetch) -> Option<PathBuf> {
    let place = folder.join(format!("bpy-{version}"));
    let python = place.join("bin/python");
    let has_it = |python: &Path| {
        python.is_file()
            && Command::new(python)
                .args(["-c", "import bpy"])
                .output()
                .is_ok_and(|done| done.status.success())
    };
    if has_it(&python) {
        return Some(python);
    }
    if fetch == Fetch::No {
        return None;
    }
    let Some(maker) = python_3_11() else {
        println!("no Python 3.11, which Blender as a module needs: Blender {version} is not tested");
        return None;
    };
    println!("fetching Blender {version} into {}", place.display());
    let made =
        Command::new(maker).args(["-m", "venv"]).arg(&place).status().is_ok_and(|status| status.success())
            && Command::new(&python)
                .args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"])
                .arg(format!("bpy=={version}"))
                .status()
                .is_ok_and(|status| status.success());
    if made && has_it(&python) {
        return Some(python);
    }
    println!("Blender {version} could not be fetched: not tested");
    None
}

fn python_3_11() -> Option<&'static str> {
    ["python3.11", "python3"].into_iter().find(|name| {
        let asked = Command::new(name)
            .args(["-c", "import sys, venv; print(sys.version_info[:2] == (3, 11))"])
            .output();
        asked.is_ok_and(|asked| asked.stdout.starts_with(b"True"))
    })
}

fn python(python: &Path, folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(python);
    command.args(arguments).current_dir(folder).env("PYTHONDONTWRITEBYTECODE", "1");
    command
}

fn succeed(mut command: Command, what: &str) -> anyhow::Result<()> {
    let done = command.output().with_context(|| format!("{what} does not start"))?;
    let said = String::from_utf8_lossy(&done.stdout);
    for line in said.lines().filter(|line| line.starts_with("  ")) {
        println!("{line}");
    }
    if !done.status.success() {
        bail!("{what}: {}\n{said}\n{}", done.status, String::from_utf8_lossy(&done.stderr));
    }
    Ok(())
}

/// Builds and validates the extension with one Blender, and runs its tests there. The first test installs the
/// extension.
fn test(root: &Path, folder: &Path, interpreter: &Path) -> anyhow::Result<()> {
    const FIND: &str = "import bpy, os, glob; print(glob.glob(os.path.dirname(bpy.__file__) + '/**/bl_pkg/cli/blender_ext.py', recursive=True)[0])";
    // After the import, `bpy.__file__` no longer names the module's folder, so it is found through the site-packages.
    let find = FIND.replace(
        "os.path.dirname(bpy.__file__)",
        "[p for p in __import__('sys').path if p.endswith('site-packages')][0] + '/bpy'",
    );
    let found = python(interpreter, folder, &["-c", &find]).output()?;
    let tool = String::from_utf8_lossy(&found.stdout).lines().last().unwrap_or_default().to_owned();
    ensure!(Path::new(&tool).is_file(), "{} has no tool for extensions", interpreter.display());
    let source = root.join("blender/impasto");
    let zip = folder.join(format!("impasto-{}.zip", version_of(&source)?));
    let (source, zip_text) = (source.to_string_lossy().into_owned(), zip.to_string_lossy().into_owned());
    let into = folder.to_string_lossy().into_owned();
    let build = ["build", "--source-dir", &source, "--output-dir", &into];
    succeed(python(interpreter, folder, &[&[tool.as_str()][..], &build].concat()), "building the extension")?;
    succeed(python(interpreter, folder, &[&tool, "validate", &zip_text]), "validating the extension")?;
    let profile = folder.join("profile");
    if profile.exists() {
        std::fs::remove_dir_all(&profile)?;
    }
    std::fs::create_dir_all(&profile)?;
    let program = target_folder(root)?.join("debug");
    let known = std::env::var_os("PATH").unwrap_or_default();
    let paths = std::iter::once(program).chain(std::env::split_paths(&known));
    let paths = std::env::join_paths(paths)?;
    let scripts = root.join("tests/blender/extension");
    let mut names: Vec<PathBuf> =
        std::fs::read_dir(&scripts)?.map(|entry| Ok(entry?.path())).collect::<std::io::Result<_>>()?;
    names.retain(|path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("test_")));
    names.sort();
    // Installing comes first.
    names.sort_by_key(|path| !path.ends_with("test_install.py"));
    ensure!(!names.is_empty(), "there are no tests in {}", scripts.display());
    for script in names {
        let name = script.file_name().unwrap_or_default().to_string_lossy().into_owned();
        println!("{name}");
        let mut command = python(interpreter, folder, &[&script.to_string_lossy(), &zip_text]);
        command.env("BLENDER_USER_RESOURCES", &profile).env("PATH", &paths);
        succeed(command, &name)?;
    }
    Ok(())
}

fn version_of(source: &Path) -> anyhow::Result<String> {
    let text = std::fs::read_to_string(source.join("blender_manifest.toml"))?;
    let line = text.lines().find_map(|line| line.strip_prefix("version = \""));
    let version = line.and_then(|rest| rest.strip_suffix('"'));
    version.map(str::to_owned).context("the manifest of the extension states no version")
}
