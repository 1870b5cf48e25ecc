//! `cargo xtask same`: checks that pictures and strokes are still, byte for byte, those of the last `same --keep`.
//!
//! It draws the first, middle and last frame of every shipped scene through EGL and OSMesa, and lists their strokes.
//! Where `IMPASTO_CORPUS` names a corpus, it does the same with the corpus's good models. It keeps checksums of the
//! files, not the files.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, bail, ensure};

use crate::packages::{self, Install};
use crate::steps::{Profile, build};

const KEPT: &str = "out/same.txt";
const SIZE: &str = "320x180";
const DRIVERS: [&str; 2] = ["egl", "osmesa"];
/// How many differences are printed; the others are only counted.
const SHOWN_DIFFERENCES: usize = 40;

/// The checksum of each file, by the file's name: `roll.egl.0007.png`.
type Sums = BTreeMap<String, String>;

/// Draws everything and keeps its checksums, or compares them with those that were kept.
///
/// # Errors
/// When something differs, or nothing was kept.
pub fn run(root: &Path, keep: bool) -> anyhow::Result<()> {
    let path = root.join(KEPT);
    let kept = if keep { None } else { Some(read(&path)?) };
    packages::ensure(root, packages::FOR_TESTS, Install::Yes)?;
    let impasto = build(root, Profile::Dev)?;
    let mut now = Sums::new();
    for subject in subjects(root)? {
        println!("{}", subject.name);
        now.extend(sums(&subject, &impasto)?);
    }
    let Some(kept) = kept else {
        let text: String = now.iter().map(|(name, sum)| format!("{name}: {sum}\n")).collect();
        std::fs::create_dir_all(root.join("out"))?;
        std::fs::write(&path, text).with_context(|| format!("{} cannot be written", path.display()))?;
        println!("{} sums are kept in {KEPT}", now.len());
        return Ok(());
    };
    let differences = differences(&kept, &now);
    if !differences.is_empty() {
        let shown = &differences[..differences.len().min(SHOWN_DIFFERENCES)];
        bail!("{} of {} differ:\n{}", differences.len(), kept.len(), shown.join("\n"));
    }
    println!("{} pictures and lists of strokes are the same", now.len());
    Ok(())
}

/// A scene or a model, and the frames of it that are drawn.
struct Subject {
    name: String,
    path: PathBuf,
    frames: Vec<i64>,
}

/// All shipped scenes; then the good models of the corpus, if there is one.
fn subjects(root: &Path) -> anyhow::Result<Vec<Subject>> {
    let mut subjects = Vec::new();
    for path in files(&root.join("scenes"), "ron")? {
        let text = std::fs::read_to_string(&path)?;
        // A scene may leave its timeline to its shot, which is not read here: then these three frames are drawn.
        let frames = frames(&text).unwrap_or_else(|| vec![0, 12, 24]);
        subjects.push(Subject { name: stem(&path), path, frames });
    }
    let Some(corpus) = std::env::var_os("IMPASTO_CORPUS") else {
        println!("IMPASTO_CORPUS names no folder: shipped scenes only");
        return Ok(subjects);
    };
    let corpus =
        std::fs::canonicalize(&corpus).with_context(|| format!("the corpus {}", corpus.display()))?;
    for path in files(&corpus.join("models/good"), "obj")? {
        subjects.push(Subject { name: format!("corpus {}", stem(&path)), path, frames: vec![0] });
    }
    Ok(subjects)
}

/// Every file with this extension in a folder and the folders in it, sorted.
fn files(folder: &Path, extension: &str) -> anyhow::Result<Vec<PathBuf>> {
    let (mut files, mut folders) = (Vec::new(), vec![folder.to_path_buf()]);
    while let Some(folder) = folders.pop() {
        let entries = std::fs::read_dir(&folder).with_context(|| folder.display().to_string())?;
        for entry in entries {
            let path = entry?.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|end| end == extension) {
                files.push(path);
            }
        }
    }
    files.sort();
    Ok(files)
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// The first, the middle and the last frame of a scene's timeline, each once.
fn frames(scene: &str) -> Option<Vec<i64>> {
    let timeline = scene.split_once("timeline: (")?.1.split_once(')')?.0;
    let number = |name: &str| timeline.split_once(name)?.1.split(',').next()?.trim().parse::<i64>().ok();
    let (first, last) = (number("first:").unwrap_or(0), number("last:")?);
    let mut frames = vec![first, first + (last - first) / 2, last];
    frames.dedup();
    Some(frames)
}

/// Checksums of one subject's pictures and strokes. If `impasto` refuses a subject, that is noted as its checksum, and
/// must not change either.
fn sums(subject: &Subject, impasto: &Path) -> anyhow::Result<Sums> {
    let folder = tempfile::tempdir()?;
    let mut sums = Sums::new();
    let mut run = |what: &str, arguments: &[&str], output: &str| -> anyhow::Result<()> {
        let mut command = Command::new(impasto);
        command.args(arguments).arg(&subject.path).args(["--size", SIZE, "-o", output]);
        let ended = command.current_dir(folder.path()).output()?;
        if !ended.status.success() {
            sums.insert(format!("{}.{what}", subject.name), format!("refused, {}", ended.status));
        }
        Ok(())
    };
    let list: Vec<String> = subject.frames.iter().map(i64::to_string).collect();
    for driver in DRIVERS {
        let arguments = ["render", "--quiet", "--driver", driver, "--frames", &list.join(",")];
        run(driver, &arguments, &format!("{driver}.####.png"))?;
    }
    for frame in &list {
        run(&format!("{frame:0>4}.csv"), &["strokes", "--frame", frame], &format!("{frame:0>4}.csv"))?;
    }
    for entry in std::fs::read_dir(folder.path())? {
        let entry = entry?;
        let bytes = std::fs::read(entry.path())?;
        let name = format!("{}.{}", subject.name, entry.file_name().to_string_lossy());
        sums.insert(name, format!("{:08x} {}", crc32fast::hash(&bytes), bytes.len()));
    }
    Ok(sums)
}

/// Reads kept checksums, one a line: a name, then its checksum and its length in bytes, or that it was refused.
fn read(path: &Path) -> anyhow::Result<Sums> {
    let text = std::fs::read_to_string(path)
        .with_context(|| format!("{} is missing: `cargo xtask same --keep` first", path.display()))?;
    let sum_of_line = |line: &str| {
        let (name, sum) = line.split_once(": ")?;
        Some((name.to_owned(), sum.to_owned()))
    };
    let sums: Sums = text.lines().filter_map(sum_of_line).collect();
    ensure!(!sums.is_empty(), "{} holds no sums", path.display());
    Ok(sums)
}

/// A line for each name whose checksum has changed.
fn differences(kept: &Sums, now: &Sums) -> Vec<String> {
    let missing = "not there".to_owned();
    let names: BTreeSet<&String> = kept.keys().chain(now.keys()).collect();
    names
        .into_iter()
        .filter(|name| kept.get(*name) != now.get(*name))
        .map(|name| {
            let of = |sums: &Sums| sums.get(name).unwrap_or(&missing).clone();
            format!("{name}: was {}, is {}", of(kept), of(now))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_those_of_the_timeline() {
        assert_eq!(frames("timeline: (fps: 24, first: 10, last: 61),"), Some(vec![10, 35, 61]));
        assert_eq!(frames("timeline: (last: 0)"), Some(vec![0]));
        assert_eq!(frames("no timeline"), None);
    }

    #[test]
    fn one_changed_byte_one_lost_file_and_one_new_file_are_told() {
        let sums = |all: &[(&str, &str)]| -> Sums {
            all.iter().map(|&(name, sum)| (name.to_owned(), sum.to_owned())).collect()
        };
        let kept = sums(&[("a", "1 5"), ("b", "2 5"), ("c", "3 5")]);
        assert_eq!(differences(&kept, &kept), [""; 0]);
        let now = sums(&[("a", "1 5"), ("b", "9 5"), ("d", "4 5")]);
        let told = ["b: was 2 5, is 9 5", "c: was 3 5, is not there", "d: was not there, is 4 5"];
        assert_eq!(differences(&kept, &now), told);
    }
}
