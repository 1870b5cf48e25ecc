//! `cargo xtask fuzz`: runs the fuzz targets of `fuzz/`, guided by coverage. Each begins with the files of its kind in
//! `scenes/` and in the folder that `IMPASTO_CORPUS` names.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, bail};

use crate::steps::{self, cargo, target_folder};

/// Minutes for each target, unless `--minutes` says how many.
const MINUTES: u64 = 30;

/// Larger files are left out: they are slow to mutate, and find nothing more.
const MOST_BYTES: u64 = 64 << 10;

/// An input counts as a find if it takes more than this many seconds, or more than this many MiB of memory.
const SLOW_S: u64 = 20;
const MOST_MIB: u64 = 2048;

/// Some varied bytes to begin with, for targets that read any bytes as numbers.
const NUMBERS: &str =
    "0 aA1!bB2\"cC3#dD4$eE5%fF6&gG7'hH8(iI9)jJ:*kK;+lL<,mM=-nN>.oO?/pP@qQ[rR]sS^tT_uU`vV{wW|xX}yY~zZ";

/// A target of `fuzz/targets/`, and the endings of the files that are its first inputs.
struct Target {
    name: &'static str,
    endings: &'static [&'static str],
    /// Texts that are first inputs as well.
    texts: &'static [&'static str],
}

const TARGETS: [Target; 9] = [
    Target { name: "scene", endings: &["ron"], texts: &[] },
    Target { name: "frame", endings: &["ron"], texts: &[] },
    Target {
        name: "obj",
        endings: &["obj"],
        texts: &["mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n\0newmtl a\nKd 1 0 0\n"],
    },
    Target { name: "edits", endings: &[], texts: &[NUMBERS] },
    Target { name: "guides", endings: &[], texts: &[NUMBERS] },
    Target { name: "gltf", endings: &["gltf", "glb"], texts: &[] },
    Target { name: "picture", endings: &["png", "jpg", "tga", "bmp"], texts: &[] },
    Target { name: "point_cache", endings: &["pc2"], texts: &["POINTCACHE2\0\u{1}\0\0\0\u{4}\0\0\0"] },
    Target {
        name: "values",
        endings: &[],
        texts: &[
            "strokes.scale=1.5\nstrokes=",
            "regions[0]+=(name: \"x\", on: Everything)\nregions[1]=",
            "camera.keys[0].ease=Step\nstyle=SumiE()",
            "1-9:2,30",
            "out/frame_####.png",
        ],
    },
];

/// Runs the named targets, or all, for so many minutes each.
///
/// # Errors
/// A target that does not exist, a step that failed, or inputs on which a target failed, with their folder.
pub fn run(root: &Path, own: &[String]) -> anyhow::Result<()> {
    let (mut minutes, mut names) = (MINUTES, Vec::new());
    let mut words = own.iter();
    while let Some(word) = words.next() {
        match word.as_str() {
            "--minutes" => {
                let number = words.next().context("--minutes needs a number")?;
                minutes =
                    number.parse().with_context(|| format!("--minutes {number}: write a whole number"))?;
            }
            name => names.push(name),
        }
    }
    if let Some(name) = names.iter().find(|name| TARGETS.iter().all(|target| target.name != **name)) {
        let known: Vec<&str> = TARGETS.iter().map(|target| target.name).collect();
        bail!("there is no target `{name}`; known are {}", known.join(", "));
    }
    let folder = root.join("fuzz");
    steps::run(&folder, &cargo(), &["build", "--locked", "--release"])?;
    let programs = folder.join("target/x86_64-unknown-linux-gnu/release");
    let found = target_folder(root)?.join("fuzz");
    let corpus = std::env::var_os("IMPASTO_CORPUS").map(PathBuf::from);
    let mut fallen = Vec::new();
    for target in TARGETS.iter().filter(|target| names.is_empty() || names.contains(&target.name)) {
        let inputs = found.join(target.name);
        std::fs::create_dir_all(&inputs)?;
        for (number, text) in target.texts.iter().enumerate() {
            std::fs::write(inputs.join(format!("text_{number}")), text)?;
        }
        for from in [Some(root.join("scenes")), corpus.clone()].into_iter().flatten() {
            gather(&from, target.endings, &inputs)?;
        }
        let done = steps::step(target.name, || {
            let status = Command::new(programs.join(target.name))
                .arg(format!("-max_total_time={}", minutes * 60))
                .arg(format!("-timeout={SLOW_S}"))
                .arg(format!("-rss_limit_mb={MOST_MIB}"))
                .arg(format!("-artifact_prefix={}/{}_", found.display(), target.name))
                .arg("-print_final_stats=1")
                .arg("-verbosity=0")
                .arg(&inputs)
                .current_dir(root)
                .status()?;
            Ok(status.success())
        })?;
        if !done {
            fallen.push(target.name);
        }
    }
    if !fallen.is_empty() {
        bail!("{} fell over; the inputs are in {}: make each a test", fallen.join(", "), found.display());
    }
    Ok(())
}

/// Copies files with these endings, from a folder and all below it.
fn gather(from: &Path, endings: &[&str], into: &Path) -> anyhow::Result<()> {
    let mut folders = vec![from.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).with_context(|| folder.display().to_string())? {
            let path = entry?.path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let is_kind = path.extension().is_some_and(|own| endings.iter().any(|ending| own == *ending));
            if is_kind && path.metadata()?.len() <= MOST_BYTES {
                // Names repeat from folder to folder.
                let name = path.strip_prefix(from)?.to_string_lossy().replace('/', "_");
                std::fs::copy(&path, into.join(name))?;
            }
        }
    }
    Ok(())
}
