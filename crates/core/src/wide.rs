//! Work compiled for the widest vectors that the processor has: the fence round code that only some processors run, but for what
//! names an instruction itself (`neighbours::wide`).
//!
//! Every build of it rounds alike (the compiler fuses no multiplication with an addition), so the bits do not depend on the
//! machine.

/// A loop over plain arrays. `run` is marked `#[inline(always)]`, and so is all that its loops call: what is not inlined is
/// compiled for any processor.
pub(crate) trait Wide {
    /// What comes of it.
    type Output;

    /// Does it.
    fn run(self) -> Self::Output;
}

/// Runs the work.
#[inline]
#[expect(unsafe_code, reason = "a function compiled for vectors may only be called where they were found")]
pub(crate) fn widest<W: Wide>(work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::is_x86_feature_detected as found;
        if found!("avx512f") && found!("avx512vl") && found!("avx512dq") && found!("avx512bw") {
            // SAFETY: all four were found on this processor.
            return unsafe { with_avx512(work) };
        }
        if found!("avx2") {
            // SAFETY: AVX2 was found on this processor.
            return unsafe { with_avx2(work) };
        }
    }
    work.run()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw")]
fn with_avx512<W: Wide>(work: W) -> W::Output {
    work.run()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn with_avx2<W: Wide>(work: W) -> W::Output {
    work.run()
}
