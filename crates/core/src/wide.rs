//! Runs a loop in the version that is compiled for the widest vectors of this processor. All `unsafe` code for that is
//! here, except in `neighbours::wide`, which uses one instruction by name.
//!
//! All versions round alike, since the compiler fuses no multiplication with an addition: results are the same on every
//! machine, to the bit.

/// A loop over plain arrays. `run` and all functions that it calls are marked `#[inline(always)]`: what is not inlined
/// is compiled for the oldest processor.
pub(crate) trait Wide {
    type Output;

    fn run(self) -> Self::Output;
}

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

#[cfg(test)]
mod tests {
    use super::*;

    /// Products and sums that would round differently if they were fused.
    #[derive(Clone, Copy)]
    struct Sums<'a>(&'a [[f32; 3]]);

    impl Wide for Sums<'_> {
        type Output = Vec<u32>;

        #[inline(always)]
        fn run(self) -> Vec<u32> {
            self.0.iter().map(|[a, b, c]| (a * b + c).sqrt().to_bits()).collect()
        }
    }

    #[test]
    #[cfg(target_arch = "x86_64")]
    #[expect(unsafe_code, reason = "each build is run where the processor has what it needs")]
    fn every_build_gives_the_same_bits() {
        use std::arch::is_x86_feature_detected as found;
        let number = |index: u32| crate::hash::unit(crate::hash::scramble(index));
        let numbers: Vec<[f32; 3]> =
            (0..999).map(|index| [0, 1, 2].map(|place| number(3 * index + place))).collect();
        let fused: Vec<u32> = numbers.iter().map(|[a, b, c]| a.mul_add(*b, *c).sqrt().to_bits()).collect();
        let (work, expected) = (Sums(&numbers), Sums(&numbers).run());
        assert_ne!(expected, fused, "fused sums have the same bits, so this test cannot notice fusing");
        assert_eq!(widest(work), expected);
        if found!("avx2") {
            // SAFETY: AVX2 was found on this processor.
            assert_eq!(unsafe { with_avx2(work) }, expected);
        }
        if found!("avx512f") && found!("avx512vl") && found!("avx512dq") && found!("avx512bw") {
            // SAFETY: all four were found on this processor.
            assert_eq!(unsafe { with_avx512(work) }, expected);
        }
    }
}
