//! Tries a strange file: runs commands on it, and judges how they end.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use anyhow::Context as _;

/// The most seconds of processor time that a command may take, and the seconds after which it is killed.
const MOST_CPU_S: f64 = 10.0;
const MOST_WALL_S: f64 = 120.0;

/// The most memory that a command may take, MiB. Mesa's driver alone takes some 150 of them.
const MOST_MIB: u64 = 700;

/// The longest line that a message may have, bytes.
const LONGEST_LINE: usize = 2000;

/// The file for what a command prints.
pub const TOLD: &str = "told.txt";

/// How a command ended.
pub struct Ended {
    pub words: Vec<String>,
    /// The exit code; none where a signal ended it.
    code: Option<i32>,
    told: String,
    pub cpu_s: f64,
    pub peak_mib: u64,
    was_ended: bool,
}

/// Runs the program in a folder. What it prints goes to a file beside that folder, so that the program never waits for
/// a reader.
pub fn run(program: &Path, folder: &Path, words: &[&str]) -> anyhow::Result<Ended> {
    let told_at = folder.with_file_name(TOLD);
    let told = std::fs::File::create(&told_at)?;
    let mut child = Command::new(program)
        .args(words)
        .current_dir(folder)
        .env("LP_NUM_THREADS", "1")
        .stdin(Stdio::null())
        .stdout(told.try_clone()?)
        .stderr(told)
        .spawn()
        .with_context(|| program.display().to_string())?;
    let (start, process) = (Instant::now(), PathBuf::from(format!("/proc/{}", child.id())));
    let (mut cpu_s, mut peak_mib, mut was_ended) = (0.0, 0, false);
    let status = loop {
        cpu_s = processor_s(&process).unwrap_or(cpu_s);
        peak_mib = peak_of(&process).unwrap_or(peak_mib);
        if let Some(status) = child.try_wait()? {
            break status;
        }
        if !was_ended && start.elapsed().as_secs_f64() > MOST_WALL_S {
            was_ended = true;
            child.kill()?;
        }
        std::thread::sleep(Duration::from_millis(4));
    };
    let told = String::from_utf8_lossy(&std::fs::read(&told_at)?).into_owned();
    let words = words.iter().map(|&word| word.to_owned()).collect();
    Ok(Ended { words, code: status.code(), told, cpu_s, peak_mib, was_ended })
}

/// Seconds of processor time so far; the system counts in hundredths.
fn processor_s(process: &Path) -> Option<f64> {
    let stat = std::fs::read_to_string(process.join("stat")).ok()?;
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |at: usize| fields.get(at)?.parse::<f64>().ok();
    Some((ticks(11)? + ticks(12)?) / 100.0)
}

fn peak_of(process: &Path) -> Option<u64> {
    let status = std::fs::read_to_string(process.join("status")).ok()?;
    let kib = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(kib.split_whitespace().next()?.parse::<u64>().ok()? / 1024)
}

impl Ended {
    /// Whether the command did what it was asked to.
    pub fn is_well(&self) -> bool {
        self.code == Some(0)
    }

    /// Whether it refused the file.
    pub fn is_refused(&self) -> bool {
        self.code == Some(3)
    }

    /// Whether it was refused for lack of memory, which `check` cannot know.
    pub fn lacks_memory(&self) -> bool {
        self.told.contains("--memory")
    }

    /// Whether there was a warning.
    pub fn has_warned(&self) -> bool {
        self.told.contains("warning")
    }

    /// What is wrong with how it ended.
    pub fn faults(&self, folder: &Path) -> Vec<String> {
        let mut faults = Vec::new();
        if self.was_ended {
            faults.push(format!("did not end within {MOST_WALL_S} s"));
        } else if self.told.contains("panicked at") {
            let at = self.told.lines().find(|line| line.contains("panicked at")).unwrap_or_default();
            faults.push(format!("panic: {at}"));
        } else {
            match self.code {
                None => faults.push("ended by a signal".to_owned()),
                Some(0 | 3) => {}
                Some(code) => faults.push(format!("code {code}")),
            }
        }
        if self.cpu_s > MOST_CPU_S {
            faults.push(format!("took {:.0} s of processor time", self.cpu_s));
        }
        if self.peak_mib > MOST_MIB {
            faults.push(format!("took {} MiB", self.peak_mib));
        }
        if self.told.chars().any(|letter| letter.is_control() && !"\n\t".contains(letter)) {
            faults.push("printed control characters".to_owned());
        }
        // JSON is printed as one line, however long.
        if self.told.lines().any(|line| line.len() > LONGEST_LINE && !line.starts_with('{')) {
            faults.push("printed a line without an end".to_owned());
        }
        let names_a_file = names_of(folder).iter().any(|name| self.told.contains(name));
        if self.is_refused() && !self.lacks_memory() && !names_a_file {
            faults.push("refused, but named no file".to_owned());
        }
        faults
    }

    /// What it printed, and how it ended.
    pub fn report(&self) -> String {
        format!(
            "$ impasto {}\n{}\n-> code {:?}, {:.2} s of processor time, {} MiB\n\n",
            self.words.join(" "),
            self.told,
            self.code,
            self.cpu_s,
            self.peak_mib
        )
    }
}

/// The names of the files in a folder.
pub fn names_of(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_must_never_happen_is_a_fault() {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("m.obj"), "").expect("written");
        let faults = |code: Option<i32>, told: &str, cpu_s: f64, peak_mib: u64| {
            let told = told.to_owned();
            Ended { words: Vec::new(), code, told, cpu_s, peak_mib, was_ended: false }.faults(folder.path())
        };
        assert!(faults(Some(0), "1 frame in 0.1 s", 1.0, 200).is_empty());
        assert!(faults(Some(3), "m.obj:1:1: error: no face", 0.1, 20).is_empty());
        assert_eq!(faults(Some(3), "error: no face", 0.1, 20), ["refused, but named no file"]);
        assert_eq!(faults(Some(101), "thread 'main' panicked at a.rs:1:2:", 0.1, 20).len(), 1);
        assert_eq!(faults(Some(1), "m.obj", 0.1, 20), ["code 1"]);
        assert_eq!(faults(None, "", 0.1, 20), ["ended by a signal"]);
        assert_eq!(faults(Some(0), "\u{1b}[31m", 0.1, 20), ["printed control characters"]);
        assert_eq!(faults(Some(0), &"a".repeat(3000), 0.1, 20), ["printed a line without an end"]);
        assert_eq!(faults(Some(0), "", 11.0, 900).len(), 2);
    }
}
