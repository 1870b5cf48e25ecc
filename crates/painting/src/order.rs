//! The order in which particles are painted.

use rayon::prelude::*;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct OrderEntry {
    pub(crate) coat: u32,
    pub(crate) particle: u32,
}

/// All particles in painting order, each stored as a number. The particles of a coat have consecutive numbers, and the
/// numbers of the next coat follow.
#[derive(Debug, Default)]
pub(crate) struct PaintingOrder {
    numbers: Vec<u32>,
    /// The number of the first particle of each coat, a multiple of [`PaintingOrder::WORD`].
    firsts: Vec<u32>,
}

impl PaintingOrder {
    /// Culling (`candidates`) has a bit for each number, in words of this many bits. The numbers of each coat begin at
    /// a multiple of it, so that no two coats share a word. So some numbers between coats may be unused.
    pub(crate) const WORD: usize = u64::BITS as usize;

    /// The painting order from the arrays that [`PaintingOrder::to_keep`] gave; `None` if they do not fit coats with
    /// `counts` particles.
    pub(crate) fn of_kept(numbers: Vec<u32>, firsts: Vec<u32>, counts: &[usize]) -> Option<Self> {
        let (begins, end) = begins(counts.iter().copied());
        let mut coat_of_word = Vec::with_capacity(end / Self::WORD);
        for (coat, count) in counts.iter().enumerate() {
            coat_of_word.resize(coat_of_word.len() + count.div_ceil(Self::WORD), coat);
        }
        let is_particle = |&number: &u32| {
            let coat = coat_of_word.get(number as usize / Self::WORD);
            coat.is_some_and(|&coat| ((number - begins[coat]) as usize) < counts[coat])
        };
        let fits = firsts == begins
            && numbers.len() == counts.iter().sum::<usize>()
            && numbers.par_iter().with_min_len(4096).all(is_particle);
        fits.then_some(Self { numbers, firsts })
    }

    /// From `numbers` in painting order; `firsts` is the number of each coat's first particle, as [`begins`] gives it.
    pub(crate) fn new(numbers: Vec<u32>, firsts: Vec<u32>) -> Self {
        Self { numbers, firsts }
    }

    /// The arrays to be stored for another process.
    pub(crate) fn to_keep(&self) -> [&[u32]; 2] {
        [&self.numbers, &self.firsts]
    }

    pub(crate) fn numbers(&self) -> &[u32] {
        &self.numbers
    }

    #[inline]
    pub(crate) fn entry(&self, number: u32) -> OrderEntry {
        let coat = self.firsts.partition_point(|&first| first <= number) - 1;
        OrderEntry { coat: coat as u32, particle: number - self.firsts[coat] }
    }
}

/// The number of the first particle of each coat, and the number at which a further coat would begin.
pub(crate) fn begins(counts: impl Iterator<Item = usize>) -> (Vec<u32>, usize) {
    let mut next = 0;
    let mut begin = |count: usize| {
        let first = next as u32;
        next = (next + count).next_multiple_of(PaintingOrder::WORD);
        first
    };
    let firsts = counts.map(&mut begin).collect();
    (firsts, next)
}
