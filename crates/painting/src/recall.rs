//! Remembers which strokes the last picture of a moving view had, so that the next one is computed more quickly. Few
//! strokes are present in a picture, and the next picture has mostly the same ones. So only a share of the other
//! strokes is computed.

use std::ops::Range;
use std::sync::Arc;

use impasto_scene::presets::LayerKind;

use crate::frame::Frame;
use crate::order::PaintingOrder;
use crate::painting::Painting;

/// Each picture computes a different 32nd part of the small strokes that were absent: nobody notices if these appear
/// late.
const SMALL: u64 = 0x0000_0001_0000_0001;

/// Each picture computes a different half of the large strokes that were absent: if these appear late, they leave
/// holes.
const LARGE: u64 = 0x5555_5555_5555_5555;

/// Which strokes the next picture computes: those that were present in the last one, and a share of the others.
pub struct Recall {
    order: Arc<PaintingOrder>,
    /// A bit for each particle in painting order: whether its stroke is to be computed.
    words: Vec<u64>,
}

impl Recall {
    /// How many particles have their bits in one number of `words`.
    pub(crate) const WORD: usize = 64;

    /// What is remembered of a picture of this painting for the next one. `is_present` says, by a stroke's index in
    /// the frame, whether anything of that stroke was painted. `turn` counts the pictures.
    pub fn of(painting: &Painting, frame: &Frame, is_present: impl Fn(usize) -> bool, turn: u32) -> Self {
        let order = Arc::clone(&painting.order);
        let lacks_underpainting = painting.drafts_lack_underpainting();
        let pattern = |number: u32| match painting.coats[order.entry(number).coat as usize].kind {
            LayerKind::Form | LayerKind::Accents | LayerKind::Contour | LayerKind::Lights => {
                SMALL << (turn % 32)
            }
            // Touches have no coat.
            LayerKind::Touches => 0,
            LayerKind::Underpainting if lacks_underpainting => 0,
            LayerKind::Body | LayerKind::Scumble | LayerKind::Underpainting => LARGE << (turn % 2),
        };
        // A word may hold particles of several layers.
        let word = |numbers: &[u32]| match (pattern(numbers[0]), pattern(numbers[numbers.len() - 1])) {
            (first, last) if first == last => first,
            _ => numbers.iter().fold(0, |asked, &number| asked | pattern(number)),
        };
        let mut words: Vec<u64> = order.numbers().chunks(Self::WORD).map(word).collect();
        for (index, source) in frame.sources.iter().enumerate() {
            // Touches have no place among the particles, and are always asked for.
            if let Some(word) = words.get_mut(source.place as usize / Self::WORD)
                && is_present(index)
            {
                *word |= 1 << (source.place as usize % Self::WORD);
            }
        }
        Self { order, words }
    }

    /// Whether it was made from the particles of this painting.
    pub(crate) fn is_of(&self, painting: &Painting) -> bool {
        Arc::ptr_eq(&self.order, &painting.order)
    }

    /// Which of the `count` particles from the place `first` on are to be computed, counted from `first`. `first` is a
    /// multiple of [`Recall::WORD`].
    pub(crate) fn asked(&self, first: usize, count: usize) -> impl Iterator<Item = usize> {
        let words: Range<usize> = first / Self::WORD..(first + count).div_ceil(Self::WORD);
        self.words[words].iter().enumerate().flat_map(move |(index, &word)| {
            let mut left = word;
            std::iter::from_fn(move || {
                let bit = (left != 0).then(|| left.trailing_zeros() as usize)?;
                left &= left - 1;
                Some(index * Self::WORD + bit)
            })
            .filter(move |&offset| offset < count)
        })
    }
}
