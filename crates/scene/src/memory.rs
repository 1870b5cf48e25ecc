//! Available memory and this process's peak, as Linux reports them; `None` on other systems.

use std::sync::atomic::{AtomicU64, Ordering};

/// The largest peak that [`peak_since_last_bytes`] has read. That function resets the system's own record of the peak.
static MOST: AtomicU64 = AtomicU64::new(0);

/// Bytes that can still be allocated: what the system has free or can free, within the limits of the control group and
/// of the process (`ulimit -v`, `ulimit -d`).
pub fn available_bytes() -> Option<u64> {
    let of_system = field_bytes("/proc/meminfo", "MemAvailable:");
    let number = |path: &str| std::fs::read_to_string(path).ok()?.trim().parse::<u64>().ok();
    let left = |most: &str, now: &str| Some(number(most)?.saturating_sub(number(now)?));
    let of_group = left("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current").or_else(|| {
        left("/sys/fs/cgroup/memory/memory.limit_in_bytes", "/sys/fs/cgroup/memory/memory.usage_in_bytes")
    });
    [of_system, of_group, left_of_process_bytes()].into_iter().flatten().min()
}

/// Bytes that this process may still allocate, whatever the system has free; `None` if it has no limit (`ulimit -v`,
/// `ulimit -d`).
pub fn left_of_process_bytes() -> Option<u64> {
    let left = |(most, now)| Some(limit_bytes(most)?.saturating_sub(field_bytes("/proc/self/status", now)?));
    [("Max address space", "VmSize:"), ("Max data size", "VmData:")].into_iter().filter_map(left).min()
}

/// The bytes that may be allocated: `wanted`, or all available memory if `wanted` is `None`. Never more than the
/// process's own limits leave.
pub fn granted_bytes(wanted: Option<u64>) -> Option<u64> {
    match wanted {
        Some(wanted) => Some(left_of_process_bytes().map_or(wanted, |left| left.min(wanted))),
        None => available_bytes(),
    }
}

/// A limit of this process, as `/proc/self/limits` names it; `None` where it has none.
fn limit_bytes(name: &str) -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/limits").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    // The soft limit, which is in force, comes first; "unlimited" is no number.
    line.split_whitespace().next()?.parse().ok()
}

/// The most memory that this process has had at once, bytes.
pub fn peak_bytes() -> Option<u64> {
    field_bytes("/proc/self/status", "VmHWM:").map(|now| now.max(MOST.load(Ordering::Relaxed)))
}

/// The most memory that this process has had at once since the last call of this function, bytes.
pub fn peak_since_last_bytes() -> Option<u64> {
    let peak = field_bytes("/proc/self/status", "VmHWM:")?;
    MOST.fetch_max(peak, Ordering::Relaxed);
    // Writing "5" resets the system's peak to the current use. Where that is not allowed, the peak only grows.
    let _ = std::fs::write("/proc/self/clear_refs", "5");
    Some(peak)
}

/// The value of a line such as `VmHWM:  1234 kB` in a file of the system, bytes.
fn field_bytes(path: &str, name: &str) -> Option<u64> {
    let text = std::fs::read_to_string(path).ok()?;
    let line = text.lines().find(|line| line.starts_with(name))?;
    Some(line.split_whitespace().nth(1)?.parse::<u64>().ok()? * 1024)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn asking_for_the_peak_resets_it() {
        let before = peak_since_last_bytes().unwrap();
        assert!(available_bytes().unwrap() > 0);
        let held = std::hint::black_box(vec![1u8; 64 << 20]);
        drop(held);
        let with = peak_since_last_bytes().unwrap();
        assert!(with >= 64 << 20 && peak_bytes().unwrap() >= with.max(before), "{before} {with}");
    }
}
