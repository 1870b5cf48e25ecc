//! Installs and finds what the peers, the programs that we are compared with, need: a C++ compiler with two header
//! libraries, and Python with five packages.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, bail};

/// The Debian packages for all peers.
const PACKAGES: [&str; 6] =
    ["g++", "libeigen3-dev", "libnanoflann-dev", "libusb-1.0-0", "python3", "python3-venv"];

/// How to install the Debian packages.
pub fn advice() -> String {
    format!("`cargo xtask bench -- --install`, or apt-get install {}", PACKAGES.join(" "))
}

/// Installs the Debian packages, with sudo unless we are root.
pub fn install() -> anyhow::Result<()> {
    let root = Command::new("id").arg("-u").output().is_ok_and(|output| output.stdout.trim_ascii() == b"0");
    let update = vec!["update"];
    let install =
        ["install", "--yes", "--no-install-recommends"].into_iter().chain(PACKAGES).collect::<Vec<_>>();
    for arguments in [update, install] {
        let words: Vec<&str> = if root { vec!["apt-get"] } else { vec!["sudo", "apt-get"] }
            .into_iter()
            .chain(arguments)
            .collect();
        eprintln!("running: {}", words.join(" "));
        let status =
            Command::new(words[0]).args(&words[1..]).status().context("apt-get cannot be started")?;
        if !status.success() {
            bail!("`{}` failed", words.join(" "));
        }
    }
    Ok(())
}

/// The folder for built peers, in cargo's target folder.
fn built_folder() -> anyhow::Result<PathBuf> {
    let program = std::env::current_exe()?;
    let folder = program.parent().context("a program without a folder")?.join("peers");
    std::fs::create_dir_all(&folder)?;
    Ok(folder)
}

/// Builds a C++ peer, unless its program is newer than its sources; returns the program.
pub fn build_cpp(sources: &Path, name: &str) -> anyhow::Result<PathBuf> {
    let source = sources.join(format!("{name}.cpp"));
    let program = built_folder()?.join(name);
    let changed = |path: &Path| std::fs::metadata(path).and_then(|data| data.modified()).ok();
    let newest = [&source, &sources.join("rounds.hpp")].into_iter().filter_map(|path| changed(path)).max();
    if changed(&program) > newest {
        return Ok(program);
    }
    let output = Command::new("g++")
        .args(["-std=c++17", "-O3", "-march=native", "-fopenmp", "-I/usr/include/eigen3", "-o"])
        .args([&program, &source])
        .output();
    let Ok(output) = output else { bail!("there is no g++: {}", advice()) };
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        let missing = said.lines().find(|line| line.contains("No such file"));
        match missing {
            Some(_) => bail!("a header is missing: {}", advice()),
            None => bail!("g++: {}", said.lines().find(|line| line.contains("error")).unwrap_or("failed")),
        }
    }
    Ok(program)
}

/// Makes a Python environment with the pinned packages in `out/bench/venv`, unless it is there with these packages
/// already. Returns its interpreter.
pub fn make_python(root: &Path, may_fetch: bool) -> anyhow::Result<PathBuf> {
    let list = root.join("bench/peers/requirements.txt");
    let wanted = std::fs::read_to_string(&list)?;
    let folder = root.join("out/bench/venv");
    let (python, stamp) = (folder.join("bin/python"), folder.join("requirements.txt"));
    if std::fs::read_to_string(&stamp).is_ok_and(|had| had == wanted) && python.is_file() {
        return Ok(python);
    }
    if !may_fetch {
        bail!("its packages are not installed, and nothing may be fetched");
    }
    eprintln!("fetching Python's packages into {} (once)", folder.display());
    let log = root.join("out/bench/venv.log");
    std::fs::create_dir_all(root.join("out/bench"))?;
    let step = |program: &Path, arguments: &[&str]| {
        let file = std::fs::File::options().create(true).append(true).open(&log)?;
        let status = Command::new(program).args(arguments).stdout(file.try_clone()?).stderr(file).status();
        match status {
            Ok(status) if status.success() => Ok(()),
            Ok(_) => Err(anyhow::anyhow!("see {}", log.display())),
            Err(_) => Err(anyhow::anyhow!("there is no {}: {}", program.display(), advice())),
        }
    };
    step(Path::new("python3"), &["-m", "venv", &folder.to_string_lossy()])
        .context("the Python environment cannot be made")?;
    let quiet = ["-m", "pip", "install", "--disable-pip-version-check", "--requirement"];
    let list = list.to_string_lossy();
    step(&python, &[&quiet[..], &[&list]].concat()).context("the Python packages cannot be installed")?;
    std::fs::write(&stamp, wanted)?;
    Ok(python)
}
