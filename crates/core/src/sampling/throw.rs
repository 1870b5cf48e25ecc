//! The random numbers of one candidate of dart throwing.

use super::barycentric;
use crate::hash;

/// The random numbers of one candidate.
#[derive(Clone, Copy)]
pub(super) struct Throw {
    /// With the faces lined up, `high + low` is the share of their area, 0..1, that lies before the candidate. It has
    /// 53 random bits, so that a tiny face beside a huge one still gets its share.
    high: f64,
    low: f64,
    /// Where on its face the candidate lies: two numbers in 0..1.
    on_face: [f32; 2],
}

impl Throw {
    #[inline(always)]
    pub(super) fn new(seed: u32, number: u32) -> Self {
        let seed = hash::combine(seed, number);
        Self {
            high: f64::from(hash::combine(seed, 0)) / 4_294_967_296.0,
            low: f64::from(hash::combine(seed, 1) >> 11) / 9_007_199_254_740_992.0,
            on_face: [hash::unit(hash::combine(seed, 2)), hash::unit(hash::combine(seed, 3))],
        }
    }

    /// The area that lies before the candidate, on a surface of area `total`.
    #[inline(always)]
    pub(super) fn area(&self, total: f64) -> f64 {
        (self.high + self.low) * total
    }

    /// In which of `steps` equal steps of area the candidate is, or the one before that, since `low` is ignored.
    #[inline(always)]
    pub(super) fn step(&self, steps: usize) -> i32 {
        ((self.high * steps as f64) as i32).min(steps as i32 - 1)
    }

    /// Weights of the second and third corner.
    #[inline(always)]
    pub(super) fn barycentric(&self) -> [f32; 2] {
        let [first, second] = self.on_face;
        barycentric(first, second)
    }
}
