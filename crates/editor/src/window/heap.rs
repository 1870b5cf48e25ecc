//! Gives memory back to the system.

/// Gives the free memory of the program back to the system. The allocator of glibc holds freed memory in an arena for
/// each thread; after a long day of painting that is up to a gigabyte. Other allocators give memory back by themselves,
/// so nothing is done for them. Takes some milliseconds; later allocations must get memory from the system again.
pub fn give_back_free_memory() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    #[expect(unsafe_code, reason = "the allocator of the system is a C function")]
    // SAFETY: `malloc_trim` may be called at any time and by any thread; it touches only memory that is free.
    let _gave = unsafe { libc::malloc_trim(0) };
}

#[cfg(all(target_os = "linux", target_env = "gnu"))]
#[cfg(test)]
mod tests {
    use std::process::Command;

    use super::*;

    /// Set in the process that measures itself.
    const ALONE: &str = "IMPASTO_TEST_ALONE";

    fn resident_bytes() -> u64 {
        let status = std::fs::read_to_string("/proc/self/status").unwrap();
        let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap();
        line.trim().trim_end_matches(" kB").parse::<u64>().unwrap() << 10
    }

    /// Other tests of this program take and free memory, so it is measured in a process of its own.
    #[test]
    fn memory_that_was_freed_below_a_part_in_use_goes_back() {
        if std::env::var_os(ALONE).is_none() {
            let test = "window::heap::tests::memory_that_was_freed_below_a_part_in_use_goes_back";
            let mut alone = Command::new(std::env::current_exe().unwrap());
            let output = alone.args(["--exact", test, "--nocapture"]).env(ALONE, "1").output().unwrap();
            let told = String::from_utf8_lossy(&output.stdout);
            return assert!(output.status.success() && told.contains("1 passed"), "{output:?}");
        }
        // Parts of less than 128 KiB come from the arena, which shrinks by itself only at its end.
        let mut parts: Vec<Vec<u8>> = (0..1600).map(|_| vec![1; 100_000]).collect();
        let last = parts.pop();
        drop(parts);
        let before = resident_bytes();
        give_back_free_memory();
        let after = resident_bytes();
        assert!(after + (100 << 20) < before, "{before} bytes before, {after} after");
        drop(last);
    }
}
