//! What the last picture of a moving view tells the next: of the thousands of strokes in question few are there, and those
//! that are there now were mostly there before.

use std::ops::Range;
use std::sync::Arc;

use impasto_scene::presets::LayerKind;

use crate::frame::Frame;
use crate::order::PaintingOrder;
use crate::prepare::Painting;

/// Of those that were absent, every sixteenth is asked, others in each picture: small strokes come late without being missed.
const SMALL: u64 = 0x0001_0001_0001_0001;

/// Every other: large strokes that come late leave holes.
const LARGE: u64 = 0x5555_5555_5555_5555;

/// Which strokes there were in a picture.
pub struct Recall {
    order: Arc<PaintingOrder>,
    /// A bit a particle, in painting order.
    words: Vec<u64>,
}

impl Recall {
    /// Particles a word.
    pub(crate) const WORD: usize = 64;

    /// Of a picture of this painting, for the next. `is_there` says of a stroke of the frame, by index, whether anything of
    /// it was painted; `turn` counts the pictures.
    pub fn of(painting: &Painting, frame: &Frame, is_there: impl Fn(usize) -> bool, turn: u32) -> Self {
        let order = Arc::clone(&painting.order);
        let pattern = |number: u32| match painting.coats[order.entry(number).coat as usize].kind {
            LayerKind::Form | LayerKind::Accents | LayerKind::Lights => SMALL << (turn % 16),
            LayerKind::Body | LayerKind::Scumble => LARGE << (turn % 2),
            // A draft has none.
            LayerKind::Underpainting => 0,
        };
        // Layers may share a word.
        let word = |numbers: &[u32]| match (pattern(numbers[0]), pattern(numbers[numbers.len() - 1])) {
            (first, last) if first == last => first,
            _ => numbers.iter().fold(0, |asked, &number| asked | pattern(number)),
        };
        let mut words: Vec<u64> = order.numbers().chunks(Self::WORD).map(word).collect();
        for (index, source) in frame.sources.iter().enumerate() {
            if is_there(index) {
                words[source.place as usize / Self::WORD] |= 1 << (source.place as usize % Self::WORD);
            }
        }
        Self { order, words }
    }

    /// Whether the particles of a painting are still those.
    pub(crate) fn is_of(&self, painting: &Painting) -> bool {
        Arc::ptr_eq(&self.order, &painting.order)
    }

    /// Of `count` particles from the place `first` on (a multiple of [`Recall::WORD`]), those that may be there, counted
    /// from `first`.
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
