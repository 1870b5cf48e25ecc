//! Gives memory back to the system.

/// Gives the free memory of the program back to the system. The allocator of glibc keeps what was freed, in an arena of
/// each thread, and a long day of painting adds up to a gigabyte there. Other allocators give it back by themselves:
/// nothing is done for them. Takes some milliseconds; what is allocated next must be fetched again.
pub fn give_back_free_memory() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    #[expect(unsafe_code, reason = "the allocator of the system is a C function")]
    // SAFETY: `malloc_trim` may be called at any time and by any thread; it touches only memory that is free.
    let _gave = unsafe { libc::malloc_trim(0) };
}

#[cfg(all(target_os = "linux", target_env = "gnu"))]
#[cfg(test)]
mod tests {
    use super::*;

    fn resident_bytes() -> u64 {
        let statm = std::fs::read_to_string("/proc/self/statm").unwrap();
        statm.split(' ').nth(1).unwrap().parse::<u64>().unwrap() * 4096
    }

    #[test]
    fn memory_that_was_freed_below_a_part_in_use_goes_back() {
        // Parts of less than 128 KiB come from the arena, which shrinks by itself at its end only.
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
