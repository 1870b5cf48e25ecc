//! Runs the search for neighbours with AVX-512 where the processor has it, since one of its instructions packs the near
//! points together. Shorter vectors gain nothing over portable code. With and without AVX-512 the search rounds alike
//! (no fused multiply-add), so results are the same to the bit on every machine.
#![expect(unsafe_code, reason = "a function compiled for vectors may only be called where they were found")]

use super::crowd::OneByOne;
#[cfg(target_arch = "x86_64")]
use super::crowd::{LANES, PackNear};
use super::{Part, Search};

pub(super) fn run(search: &Search<'_>, part: Part<'_>) {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx512f") && std::arch::is_x86_feature_detected!("popcnt") {
        // SAFETY: AVX-512F and POPCNT were found on this processor.
        return unsafe { run_avx512(search, part) };
    }
    search.run::<OneByOne>(part);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,popcnt")]
fn run_avx512(search: &Search<'_>, part: Part<'_>) {
    search.run::<Compressed>(part);
}

/// Packs eight keys at a time with `vpcompressq`. Only [`run_avx512`] may use it.
#[cfg(target_arch = "x86_64")]
struct Compressed;

#[cfg(target_arch = "x86_64")]
impl PackNear for Compressed {
    #[inline(always)]
    fn pack(
        distances_sq: &[f32; LANES],
        numbers: &[u32; LANES],
        radius_sq: f32,
        found: &mut [u64; LANES],
    ) -> usize {
        // SAFETY: only run_avx512 uses this, and it runs only where AVX-512F and POPCNT were found.
        unsafe { compress(distances_sq, numbers, radius_sq, found) }
    }
}

#[cfg(target_arch = "x86_64")]
#[inline]
#[target_feature(enable = "avx512f,popcnt")]
fn compress(
    distances_sq: &[f32; LANES],
    numbers: &[u32; LANES],
    radius_sq: f32,
    found: &mut [u64; LANES],
) -> usize {
    use std::arch::x86_64::*;
    // SAFETY: both arrays hold as many bytes as are read.
    let (distances_sq, numbers) =
        unsafe { (_mm512_loadu_ps(distances_sq.as_ptr()), _mm512_loadu_si512(numbers.as_ptr().cast())) };
    let near = _mm512_cmp_ps_mask::<_CMP_LE_OQ>(distances_sq, _mm512_set1_ps(radius_sq));
    let key = |distances_sq: __m256i, numbers: __m256i| {
        let high = _mm512_slli_epi64::<32>(_mm512_cvtepu32_epi64(distances_sq));
        _mm512_or_si512(high, _mm512_cvtepu32_epi64(numbers))
    };
    let bits = _mm512_castps_si512(distances_sq);
    let lower = key(_mm512_castsi512_si256(bits), _mm512_castsi512_si256(numbers));
    let upper = key(_mm512_extracti64x4_epi64::<1>(bits), _mm512_extracti64x4_epi64::<1>(numbers));
    let (near_lower, near_upper) = (near as u8, (near >> 8) as u8);
    let count = near_lower.count_ones() as usize;
    let (lower, upper) =
        (_mm512_maskz_compress_epi64(near_lower, lower), _mm512_maskz_compress_epi64(near_upper, upper));
    // SAFETY: `found` has sixteen places. The first store fills eight from index 0 on, the second eight from `count`
    // on, which is at most 8.
    unsafe {
        _mm512_storeu_si512(found.as_mut_ptr().cast(), lower);
        _mm512_storeu_si512(found.as_mut_ptr().add(count).cast(), upper);
    }
    count + near_upper.count_ones() as usize
}

/// A build of the search: a function that runs it, with or without AVX-512.
#[cfg(test)]
pub(super) type Build = fn(&Search<'_>, Part<'_>);

/// All builds that this processor can run, by name.
#[cfg(test)]
pub(super) fn builds() -> Vec<(&'static str, Build)> {
    vec![("portable", |search, part| search.run::<OneByOne>(part)), ("widest", run)]
}
