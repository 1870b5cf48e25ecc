//! Describes the machine that the table of times is measured on, for the table's head.

use std::process::Command;

use crate::floor;

fn words_of(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok()?;
    let words = String::from_utf8_lossy(&output.stdout).lines().next()?.trim().to_owned();
    (output.status.success() && !words.is_empty()).then_some(words)
}

/// The processor's name.
pub fn processor() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = info.lines().find_map(|line| line.strip_prefix("model name"));
    let name = name.and_then(|rest| rest.split_once(':')).map(|(_, name)| name.trim().to_owned());
    name.unwrap_or_else(|| format!("an unnamed {}", std::env::consts::ARCH))
}

/// The widest vectors of this processor, among those that Impasto uses.
fn vectors() -> &'static str {
    #[cfg(target_arch = "x86_64")]
    {
        if std::arch::is_x86_feature_detected!("avx512f") {
            return "AVX-512";
        }
        if std::arch::is_x86_feature_detected!("avx2") {
            return "AVX2";
        }
    }
    "128 bits"
}

/// Bytes of free memory; `None` where the system does not say.
pub fn free_bytes() -> Option<u64> {
    let info = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = info.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    Some(line.trim().trim_end_matches("kB").trim().parse::<u64>().ok()? * 1024)
}

/// The load average of the last minute.
fn load() -> Option<f64> {
    std::fs::read_to_string("/proc/loadavg").ok()?.split(' ').next()?.parse().ok()
}

/// A name for files: the processor and its cores, in letters and digits.
pub fn slug() -> String {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let name = format!("{} {cores} cores", processor()).replace("(R)", "").to_lowercase();
    let words: Vec<&str> =
        name.split(|sign: char| !sign.is_ascii_alphanumeric()).filter(|word| !word.is_empty()).collect();
    words.join("-")
}

/// The head of the table.
pub fn head(mode: &str) -> Vec<(String, String)> {
    let unknown = || "unknown".to_owned();
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let mut head = vec![
        ("processor", format!("{}, {cores} cores, {}", processor(), vectors())),
        (
            "threads",
            format!("{}, and as many for peers unless a row says otherwise", rayon::current_num_threads()),
        ),
        ("memory", format!("triad {:.1} GB/s over 192 MB", floor::triad_bytes_per_sec() * 1e-9)),
        ("compiler", words_of("rustc", &["--version"]).unwrap_or_else(unknown)),
        ("C++", words_of("g++", &["--version"]).unwrap_or_else(|| "none".to_owned())),
        ("date", words_of("date", &["-u", "+%Y-%m-%d %H:%M UTC"]).unwrap_or_else(unknown)),
        ("commit", words_of("git", &["describe", "--always", "--dirty"]).unwrap_or_else(unknown)),
        ("mode", mode.to_owned()),
    ];
    if let Some(load) = load() {
        head.push(("load", format!("{load:.2} when it began")));
    }
    head.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}
