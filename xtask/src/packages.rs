//! Makes sure that the system has what rendering, tests and packaging need. It looks for the files of libraries and
//! programs, not for installed packages. If some are missing, it installs their packages with apt-get, where the system
//! has it.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, bail};

use crate::steps::run;

/// What to do about a package that is missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Install {
    /// Install it, saying so first.
    Yes,
    /// Print the command that would install it, and stop.
    PrintOnly,
}

/// Where the files of a [`Need`] lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    /// In a library folder, or its `dri` folder.
    Libraries,
    /// In a folder of `PATH`.
    Programs,
    /// Anywhere: `files` are whole paths.
    Paths,
    /// Where Python finds modules: `files` are names of modules.
    PythonModules,
}

/// A library or a program that has to be there, and the Debian package that brings it.
pub struct Need {
    /// What it is, for messages.
    what: &'static str,
    package: &'static str,
    place: Place,
    /// One of these must be there. They are beginnings of file names for a library, names for a program or a module,
    /// and whole paths for [`Place::Paths`].
    files: &'static [&'static str],
    /// Whether newer systems no longer have the package at all.
    retired: bool,
}

const EGL: Need = library("the EGL library", "libegl1", &["libEGL.so.1"]);

const MESA: Need = library(
    "an OpenGL driver for EGL",
    "libgl1-mesa-dri",
    &["swrast_dri.so", "libgallium-", "libEGL_nvidia.so.0"],
);

const OSMESA: Need = Need {
    // Mesa 25.1 dropped OSMesa.
    retired: true,
    ..library("the OSMesa library", "libosmesa6", &["libOSMesa.so.8", "libOSMesa.so.6"])
};

const fn library(what: &'static str, package: &'static str, files: &'static [&'static str]) -> Need {
    Need { what, package, place: Place::Libraries, files, retired: false }
}

const fn program_of(package: &'static str, files: &'static [&'static str]) -> Need {
    Need { what: files[0], package, place: Place::Programs, files, retired: false }
}

/// What `impasto render` needs on a machine without a display.
pub const RENDERING: &[Need] = &[EGL, MESA];

/// What the tests need: they draw with every driver.
const TESTS: &[Need] = &[EGL, MESA, OSMESA];

/// What the tests of the editor's window need: the libraries that winit loads, a virtual display, and a program that
/// sends it input. No program for screenshots is needed: Xvfb writes its screen to a file (`-fbdir`).
const WINDOW_TESTS: &[Need] = &[
    library("the X11 library", "libx11-6", &["libX11.so.6"]),
    library("the bridge from X11 to XCB", "libx11-xcb1", &["libX11-xcb.so.1"]),
    library("the X11 cursors", "libxcursor1", &["libXcursor.so.1"]),
    library("the X11 input library", "libxi6", &["libXi.so.6"]),
    library("the X11 keyboard library", "libxkbcommon-x11-0", &["libxkbcommon-x11.so.0"]),
    program_of("xvfb", &["Xvfb"]),
    program_of("xdotool", &["xdotool"]),
];

/// What `cargo xtask package` needs: it packs an archive, finds out which libraries the program is linked with, strips
/// the program, and makes a Python environment for the tool that makes wheels.
pub const PACKAGING: &[Need] = &[
    program_of("zstd", &["zstd"]),
    program_of("dpkg-dev", &["dpkg-shlibdeps"]),
    program_of("binutils", &["strip"]),
    // Debian's python3 alone has the module `venv`, but not `ensurepip`, without which no environment is made.
    Need {
        what: "Python's venv with ensurepip",
        package: "python3-venv",
        place: Place::PythonModules,
        files: &["ensurepip"],
        retired: false,
    },
];

const MOVIE_TESTS: &[Need] = &[program_of("ffmpeg", &["ffmpeg"])];

/// Models that others made, for the tests that read mesh files.
const MODELS: &[Need] = &[Need {
    what: "the models of assimp",
    package: "assimp-testmodels",
    place: Place::Paths,
    files: &["/usr/share/assimp/models/glTF2"],
    retired: false,
}];

/// What `cargo xtask test`, `ci`, `same` and `strange` need.
pub const FOR_TESTS: &[&[Need]] = &[TESTS, WINDOW_TESTS, MOVIE_TESTS, MODELS];

/// Makes sure that everything in `needs` is there, or says how to get it.
pub fn ensure(root: &Path, needs: &[&[Need]], install: Install) -> anyhow::Result<()> {
    let folders = library_folders();
    let missing: Vec<&Need> =
        needs.iter().copied().flatten().filter(|need| !is_there(need, &folders)).collect();
    if missing.is_empty() {
        return Ok(());
    }
    for need in &missing {
        println!("missing: {} (package {})", need.what, need.package);
    }
    let apt = program("apt-get").is_some();
    if apt && install == Install::Yes {
        apt_get(root, &prefix()?, &["update"])?;
    }
    let missing = wanted(missing, |need| apt && is_known(need));
    if missing.is_empty() {
        return Ok(());
    }
    let names: Vec<&str> = missing.iter().map(|need| need.package).collect();
    if !apt {
        bail!(
            "this system has no apt-get; install what brings {} and try again",
            missing
                .iter()
                .map(|need| format!("{} ({})", need.files[0], need.what))
                .collect::<Vec<_>>()
                .join(", ")
        );
    }
    let prefix = prefix()?;
    if install == Install::PrintOnly {
        let shown: String = prefix.iter().map(|word| format!("{word} ")).collect();
        bail!(
            "install the packages first:\n  {shown}apt-get update && \
             {shown}apt-get install --yes --no-install-recommends {}",
            names.join(" ")
        );
    }
    let mut arguments = vec!["install", "--yes", "--no-install-recommends"];
    arguments.extend(names);
    apt_get(root, &prefix, &arguments)?;
    let folders = library_folders();
    match missing.iter().find(|need| !is_there(need, &folders)) {
        Some(need) => bail!("{} is still missing after installing {}", need.what, need.package),
        None => Ok(()),
    }
}

/// The missing things that are to be installed. A retired one is among them only if the system still packages it;
/// otherwise the work goes on without it.
fn wanted(missing: Vec<&Need>, packages: impl Fn(&Need) -> bool) -> Vec<&Need> {
    let (retired, mut wanted): (Vec<&Need>, Vec<&Need>) = missing.into_iter().partition(|need| need.retired);
    for need in retired {
        if packages(need) {
            wanted.push(need);
        } else {
            println!("this system does not package {}: going on without {}", need.package, need.what);
        }
    }
    wanted
}

/// Whether apt knows the package.
fn is_known(need: &Need) -> bool {
    Command::new("apt-cache")
        .args(["show", "--no-all-versions", need.package])
        .output()
        .is_ok_and(|output| output.status.success() && !output.stdout.is_empty())
}

/// Runs apt-get so that it asks nothing; prints the command first.
fn apt_get(root: &Path, prefix: &[&'static str], arguments: &[&str]) -> anyhow::Result<()> {
    // The setting goes through `env`, because sudo would drop it.
    let mut words = prefix.to_vec();
    words.extend(["env", "DEBIAN_FRONTEND=noninteractive", "apt-get"]);
    words.extend(arguments);
    println!("running: {}", words.join(" "));
    run(root, words[0], &words[1..])
}

/// The words before `apt-get` on the command line: none for root, else `sudo`.
fn prefix() -> anyhow::Result<Vec<&'static str>> {
    let id = Command::new("id").arg("-u").output().context("`id` cannot be started")?;
    if id.stdout.trim_ascii() == b"0" {
        return Ok(Vec::new());
    }
    if program("sudo").is_none() {
        bail!("installing packages needs root, and there is no sudo; run this as root once");
    }
    Ok(vec!["sudo"])
}

fn program(name: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    std::env::split_paths(&path).map(|folder| folder.join(name)).find(|file| file.is_file())
}

/// Whether one of the files is there. A library is looked for in `folders` and in their `dri` folders.
fn is_there(need: &Need, folders: &[PathBuf]) -> bool {
    match need.place {
        Place::Programs => return need.files.iter().any(|name| program(name).is_some()),
        Place::Paths => return need.files.iter().any(|path| Path::new(path).exists()),
        Place::PythonModules => return need.files.iter().any(|name| has_python_module(name)),
        Place::Libraries => {}
    }
    folders.iter().flat_map(|folder| [folder.clone(), folder.join("dri")]).any(|folder| {
        let Ok(entries) = std::fs::read_dir(folder) else { return false };
        entries.flatten().any(|entry| {
            let name = entry.file_name();
            need.files.iter().any(|start| name.to_string_lossy().starts_with(start))
        })
    })
}

/// Whether Python is there and finds this module.
fn has_python_module(name: &str) -> bool {
    let output = Command::new("python3").args(["-c", &format!("import {name}")]).output();
    output.is_ok_and(|output| output.status.success())
}

/// The folders that the dynamic loader looks in: those of its cache, those of `LD_LIBRARY_PATH`, and the usual ones.
fn library_folders() -> Vec<PathBuf> {
    let mut folders: Vec<PathBuf> = Vec::new();
    for ldconfig in ["ldconfig", "/sbin/ldconfig", "/usr/sbin/ldconfig"] {
        let Ok(cache) = Command::new(ldconfig).arg("-p").output() else { continue };
        let cache = String::from_utf8_lossy(&cache.stdout).into_owned();
        let files = cache.lines().filter_map(|line| line.split_once("=> ").map(|(_, file)| file.trim()));
        folders.extend(files.filter_map(|file| Path::new(file).parent().map(Path::to_path_buf)));
        break;
    }
    if let Some(path) = std::env::var_os("LD_LIBRARY_PATH") {
        folders.extend(std::env::split_paths(&path));
    }
    for parent in ["/usr/lib", "/lib"].map(Path::new) {
        folders.push(parent.to_path_buf());
        let triplet = |folder: &PathBuf| folder.extension().is_none() && name_ends(folder, "-linux-gnu");
        let inside = std::fs::read_dir(parent).into_iter().flatten().flatten().map(|entry| entry.path());
        folders.extend(inside.filter(triplet));
    }
    folders.push(PathBuf::from("/usr/lib64"));
    folders.sort();
    folders.dedup();
    folders
}

fn name_ends(path: &Path, end: &str) -> bool {
    path.file_name().and_then(OsStr::to_str).is_some_and(|name| name.ends_with(end))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_library_is_found_by_its_file_also_among_the_drivers() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let folders = [folder.path().to_path_buf()];
        assert!(!is_there(&EGL, &folders) && !is_there(&MESA, &folders));
        std::fs::write(folder.path().join("libEGL.so.1.1.0"), "").expect("written");
        std::fs::create_dir(folder.path().join("dri")).expect("made");
        assert!(is_there(&EGL, &folders) && !is_there(&MESA, &folders));
        std::fs::write(folder.path().join("dri/swrast_dri.so"), "").expect("written");
        assert!(is_there(&MESA, &folders) && !is_there(&OSMESA, &folders));
    }

    #[test]
    fn what_systems_have_given_up_is_done_without() {
        let names = |packages: bool| -> Vec<&str> {
            wanted(vec![&OSMESA, &EGL], |_| packages).iter().map(|need| need.package).collect()
        };
        assert_eq!(names(false), ["libegl1"], "only the retired package is left out");
        assert_eq!(names(true), ["libegl1", "libosmesa6"]);
        assert!(wanted(vec![&OSMESA], |_| false).is_empty());
    }

    #[test]
    fn a_program_is_found_in_the_path_and_not_among_libraries() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        std::fs::write(folder.path().join("no-such-program"), "").expect("written");
        let folders = [folder.path().to_path_buf()];
        assert!(!is_there(&program_of("none", &["no-such-program"]), &folders));
        assert!(is_there(&program_of("cargo", &["cargo"]), &[]));
    }
}
