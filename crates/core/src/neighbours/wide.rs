//! The search, compiled for the widest vectors that the processor has. Every build of it rounds alike (no fused multiply-add),
//! so the bits do not depend on the machine.
#![expect(unsafe_code, reason = "a function compiled for AVX2 may only be called where AVX2 was found")]

use super::{Part, Search};

/// Finds the lists of a part of the queries.
pub(super) fn run(search: &Search<'_>, part: Part<'_>) {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        // SAFETY: AVX2 was found on this processor.
        return unsafe { run_avx2(search, part) };
    }
    search.run(part);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn run_avx2(search: &Search<'_>, part: Part<'_>) {
    search.run(part);
}

/// A build of the search.
#[cfg(test)]
pub(super) type Build = fn(&Search<'_>, Part<'_>);

/// All builds that this processor can run, by name.
#[cfg(test)]
pub(super) fn builds() -> Vec<(&'static str, Build)> {
    vec![("portable", |search, part| search.run(part)), ("widest", run)]
}
