//! `cargo xtask strange`: makes files that nobody has seen before, throws them at the program, and judges how each
//! command ends. Some files are made up at random, others are damaged copies of `scenes/` and of the corpus.
//!
//! A seed and a number always give the same case; `--seed SEED --only NUMBER` runs one case again. Cases that fell over
//! stay in `target/strange/`, but only a few of those that fell over in the same way.

mod binaries;
mod cases;
mod chance;
mod damage;
mod models;
mod page;
mod scenes;
mod shots;
mod trial;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use anyhow::{Context as _, bail};

use self::cases::{Case, Source};
use self::trial::Ended;
use crate::packages::{self, Install};
use crate::steps::{Profile, build, target_folder};

/// Minutes of a run, unless `--minutes` says how many.
const MINUTES: u64 = 10;

/// How many cases that fell over in the same way are kept.
const KEPT_OF_A_KIND: usize = 5;

/// The folder of a case's files.
const FILES: &str = "files";

struct Asked {
    minutes: u64,
    seed: u64,
    only: Option<u64>,
}

/// The results of all cases together.
#[derive(Default)]
struct Sums {
    /// By kind: how many were painted, painted with a warning, refused.
    kinds: BTreeMap<&'static str, [usize; 3]>,
    /// How many fell over, by what was wrong.
    faults: BTreeMap<String, usize>,
    slowest: (f64, String),
    largest: (u64, String),
}

/// Makes and tries strange files until the time is over.
///
/// # Errors
/// Where the program cannot be built or started, or a file made it fall over.
pub fn run(root: &Path, own: &[String]) -> anyhow::Result<()> {
    let asked = asked(own)?;
    packages::ensure(root, packages::FOR_TESTS, Install::Yes)?;
    let built = build(root, Profile::Dev)?;
    let source = Source::read(root)?;
    let kept = target_folder(root)?.join("strange");
    std::fs::create_dir_all(&kept)?;
    // A copy, so that a build meanwhile does not replace the program.
    let program = kept.join("impasto");
    std::fs::copy(&built, &program)?;
    println!("seed {}", asked.seed);
    let trials = Trials { program, kept, keeps_all: asked.only.is_some(), sums: Mutex::default() };
    let (next, start) = (AtomicU64::new(asked.only.unwrap_or(0)), Instant::now());
    let is_over = |number: u64| match asked.only {
        Some(only) => number > only,
        None => start.elapsed() > Duration::from_secs(60 * asked.minutes),
    };
    let lane = || -> anyhow::Result<()> {
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if is_over(number) {
                return Ok(());
            }
            let name = format!("{}_{number}", asked.seed);
            let case = source.case(asked.seed, number);
            trials.run(&case, &name).with_context(|| format!("case {number}"))?;
        }
    };
    let lanes = if asked.only.is_some() { 1 } else { std::thread::available_parallelism()?.get() };
    std::thread::scope(|scope| {
        let lanes: Vec<_> = (0..lanes).map(|_| scope.spawn(lane)).collect();
        lanes.into_iter().try_for_each(|lane| lane.join().unwrap_or_else(|_| bail!("a lane panicked")))
    })?;
    let sums = trials.sums.into_inner().unwrap_or_default();
    sums.print();
    if !sums.faults.is_empty() {
        bail!("some files made it fall over; they are in {}: make each a test", trials.kept.display());
    }
    Ok(())
}

fn asked(own: &[String]) -> anyhow::Result<Asked> {
    // Another seed each time, unless one is named.
    let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(1, |time| time.as_secs());
    let mut asked = Asked { minutes: MINUTES, seed: now, only: None };
    let mut words = own.iter();
    while let Some(word) = words.next() {
        let number = words.next().with_context(|| format!("{word} needs a number"))?;
        let number: u64 = number.parse().with_context(|| format!("{word} {number}: write a whole number"))?;
        match word.as_str() {
            "--minutes" => asked.minutes = number,
            "--seed" => asked.seed = number,
            "--only" => asked.only = Some(number),
            _ => bail!("`strange` does not know `{word}`"),
        }
    }
    Ok(asked)
}

struct Trials {
    program: PathBuf,
    /// The folder for the files of cases that fell over.
    kept: PathBuf,
    /// Whether the files of a case are kept even if nothing fell over.
    keeps_all: bool,
    sums: Mutex<Sums>,
}

impl Trials {
    /// Writes a case's files into a folder of its own, runs commands on them, and notes how they end.
    fn run(&self, case: &Case, name: &str) -> anyhow::Result<()> {
        let outer = tempfile::tempdir()?;
        let folder = outer.path().join(FILES);
        std::fs::create_dir(&folder)?;
        for (file, bytes) in &case.files {
            std::fs::write(folder.join(file), bytes)?;
        }
        let mut ended = Vec::new();
        for words in &case.commands {
            let words: Vec<&str> = words.iter().map(String::as_str).collect();
            ended.push(trial::run(&self.program, &folder, &words)?);
        }
        let faults = faults(case, &ended, outer.path(), &folder);
        let mut sums = self.sums.lock().map_err(|_| anyhow::anyhow!("a lane panicked"))?;
        sums.add(case, &ended, name);
        let mut is_kept = self.keeps_all;
        for fault in faults {
            println!("{name} {}: {fault}", case.kind);
            // Faults that differ only in a number are of one kind.
            let kind = format!("{}: {fault}", case.kind).replace(|letter: char| letter.is_ascii_digit(), "#");
            let count = sums.faults.entry(kind).or_default();
            *count += 1;
            is_kept |= *count <= KEPT_OF_A_KIND;
        }
        if is_kept {
            let reports: String = ended.iter().map(Ended::report).collect();
            keep(&folder, &self.kept.join(name), &reports)?;
        }
        Ok(())
    }
}

/// What is wrong with a case: with each command, and with all of them together.
fn faults(case: &Case, ended: &[Ended], outer: &Path, folder: &Path) -> Vec<String> {
    let mut faults = Vec::new();
    for command in ended {
        let word = command.words.first().map_or("", String::as_str);
        faults.extend(command.faults(folder).into_iter().map(|fault| format!("{word}: {fault}")));
    }
    if let [check, render, ..] = ended
        && faults.is_empty()
        && check.is_well() != render.is_well()
        && !render.lacks_memory()
    {
        faults.push(format!("check says {}, render {}", word_of(check), word_of(render)));
    }
    let is_ours =
        |name: &str| case.files.iter().any(|(file, _)| file == name) || case.written.contains(&name);
    let strays = trial::names_of(folder).into_iter().filter(|name| !is_ours(name));
    let outside = trial::names_of(outer).into_iter().filter(|name| name != FILES && name != trial::TOLD);
    faults.extend(strays.chain(outside).map(|name| format!("left {name} behind")));
    faults
}

fn word_of(ended: &Ended) -> &'static str {
    if ended.is_well() { "good" } else { "no" }
}

fn keep(folder: &Path, to: &PathBuf, reports: &str) -> anyhow::Result<()> {
    std::fs::create_dir_all(to)?;
    for name in trial::names_of(folder) {
        std::fs::copy(folder.join(&name), to.join(&name))?;
    }
    Ok(std::fs::write(to.join("reports.txt"), reports)?)
}

impl Sums {
    fn add(&mut self, case: &Case, ended: &[Ended], name: &str) {
        let place = match ended.get(1) {
            Some(render) if render.is_well() && !render.has_warned() => 0,
            Some(render) if render.is_well() => 1,
            _ => 2,
        };
        self.kinds.entry(case.kind).or_default()[place] += 1;
        for command in ended {
            let what = format!("{name} {}: {}", case.kind, command.words.join(" "));
            if command.cpu_s > self.slowest.0 {
                self.slowest = (command.cpu_s, what.clone());
            }
            if command.peak_mib > self.largest.0 {
                self.largest = (command.peak_mib, what);
            }
        }
    }

    fn print(&self) {
        println!("{:28} painted  warned  refused", "kind");
        let mut all = [0; 3];
        for (kind, counts) in &self.kinds {
            println!("{kind:28} {:7} {:7} {:8}", counts[0], counts[1], counts[2]);
            (0..3).for_each(|place| all[place] += counts[place]);
        }
        println!("{:28} {:7} {:7} {:8}", "all", all[0], all[1], all[2]);
        println!("slowest: {:.1} s, {}", self.slowest.0, self.slowest.1);
        println!("largest: {} MiB, {}", self.largest.0, self.largest.1);
        for (fault, count) in &self.faults {
            println!("{count} times {fault}");
        }
    }
}
