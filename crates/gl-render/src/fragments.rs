//! What every stroke lays in every pixel. While a picture is painted, the paint shader notes each of its fragments in a
//! buffer (pixel, stroke, alpha, colour). The code here sorts these notes and lays them over each other again. The
//! result says for each pixel which strokes show in it, and how much. The notes come from the same fragments that make
//! the picture, so nothing is painted twice.

use half::f16;
use impasto_painting::frame::{LayerKind, LayerRun};
use rayon::prelude::*;

use crate::gl::{Buffer, BufferUse, GlError, Gpu};

/// Bytes of a noted fragment, in three words: its pixel; its stroke and alpha; its colour.
const FRAGMENT_BYTES: usize = 12;

/// Bytes of the fragment count at the start of the buffer.
const COUNT_BYTES: usize = 4;

/// The most bytes that fragments may take on the graphics card at a time.
const MOST_BYTES: usize = 32 << 20;

/// Bits of the alpha. The other bits of its word hold the stroke's index.
const ALPHA_BITS: u32 = 10;

/// The most strokes of a picture that can be told apart.
pub(crate) const MOST_STROKES: usize = 1 << (32 - ALPHA_BITS);

/// Shares of a pixel below this are dropped.
const LEAST_SHARE: f32 = 1.0 / 2048.0;

/// The largest stored value of a channel of paint; larger ones are clamped.
const BRIGHTEST: f32 = 2.0;

/// How much of a pixel shows a stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// Index in `Frame::strokes`.
    pub stroke: u32,
    /// 0..=1.
    pub amount: f32,
}

/// Shares of the pixels of a picture, top row first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PixelShares {
    /// Where the shares of each pixel begin in `shares`; one entry more than there are pixels.
    pub starts: Vec<u32>,
    /// The shares of all pixels, one pixel after the other; within a pixel the topmost stroke first.
    pub shares: Vec<Share>,
}

impl PixelShares {
    /// The shares of a pixel.
    pub fn of(&self, pixel: usize) -> &[Share] {
        &self.shares[self.starts[pixel] as usize..self.starts[pixel + 1] as usize]
    }

    /// Joins rows of pixels. A row is a list of how many shares each of its pixels has, and a list of these shares.
    pub fn from_rows(rows: Vec<(Vec<u32>, Vec<Share>)>) -> Self {
        let mut starts = vec![0];
        let mut shares = Vec::with_capacity(rows.iter().map(|(_, shares)| shares.len()).sum());
        for (counts, of_row) in rows {
            for count in counts {
                starts.push(starts[starts.len() - 1] + count);
            }
            shares.extend(of_row);
        }
        Self { starts, shares }
    }
}

/// One layer of paint of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct PaintedLayer {
    /// The `layer` that the scene states for the regions of its strokes; for touches, the highest of all.
    pub order: i32,
    /// Which of the layers of paint it is.
    pub kind: LayerKind,
    /// Its paint alone, premultiplied, display-linear; top row first.
    pub rgba: Vec<[f16; 4]>,
    /// Which of its strokes each pixel would show, and in what share of the pixel, if no later layer lay over them.
    pub shares: PixelShares,
}

pub(crate) struct FragmentGatherer {
    buffer: Buffer,
    capacity: usize,
    /// The fragments noted so far of the layer that is being painted.
    fragments: Vec<[u32; 3]>,
    layers: Vec<PaintedLayer>,
}

impl FragmentGatherer {
    /// Fails where the driver has no storage buffers.
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        let limits = gpu.limits();
        if !limits.has_storage {
            return Err(GlError::Resource {
                what: "mattes and data of strokes".to_owned(),
                reason: format!(
                    "they need OpenGL 4.3, and this driver has {}; try --driver osmesa",
                    limits.version
                ),
            });
        }
        let capacity = (MOST_BYTES.min(limits.max_storage_bytes) - COUNT_BYTES) / FRAGMENT_BYTES;
        let buffer = Buffer::new(gpu, BufferUse::ReadBack)?;
        Ok(Self { buffer, capacity, fragments: Vec::new(), layers: Vec::new() })
    }

    /// How many fragments may be painted between two calls of [`FragmentGatherer::take`].
    pub(crate) fn capacity(&self) -> usize {
        self.capacity
    }

    /// Forgets the previous picture, and makes room for the next one.
    pub(crate) fn clear(&mut self) -> Result<(), GlError> {
        self.fragments.clear();
        self.layers.clear();
        self.buffer.reserve(COUNT_BYTES + self.capacity * FRAGMENT_BYTES)
    }

    pub(crate) fn begin(&self) {
        self.buffer.begin_storing();
    }

    /// Takes in what was noted since [`FragmentGatherer::begin`].
    pub(crate) fn take(&mut self) -> Result<(), GlError> {
        self.buffer.end_storing();
        let count = self.buffer.read(COUNT_BYTES);
        let count = u32::from_le_bytes([count[0], count[1], count[2], count[3]]) as usize;
        if count > self.capacity {
            return Err(GlError::Resource {
                what: "data of strokes".to_owned(),
                reason: format!(
                    "{count} places of paint at once, {} fit; use a smaller --size",
                    self.capacity
                ),
            });
        }
        let bytes = self.buffer.read(COUNT_BYTES + count * FRAGMENT_BYTES);
        self.fragments.extend(
            bytes[COUNT_BYTES..].chunks_exact(FRAGMENT_BYTES).map(bytemuck::pod_read_unaligned::<[u32; 3]>),
        );
        Ok(())
    }

    pub(crate) fn end_layer(&mut self, run: LayerRun, size_px: [u32; 2]) {
        let fragments = std::mem::take(&mut self.fragments);
        let (rgba, shares) = laid_over(&fragments, size_px);
        self.layers.push(PaintedLayer { order: run.order, kind: run.kind, rgba, shares });
        self.fragments = fragments;
        self.fragments.clear();
    }

    /// The layers of the picture, in the order in which they were laid.
    pub(crate) fn layers(&mut self) -> Vec<PaintedLayer> {
        self.fragments = Vec::new();
        std::mem::take(&mut self.layers)
    }
}

/// A fragment's colour, not premultiplied, display-linear.
fn color(word: u32) -> [f32; 3] {
    let root = |bits: u32, shift: u32| (word >> shift & ((1 << bits) - 1)) as f32 / ((1 << bits) - 1) as f32;
    [root(11, 0), root(11, 11), root(10, 22)].map(|root| root * root * BRIGHTEST)
}

/// Lays the fragments of a layer over each other, in the order of their strokes. The pixels that fragments name are
/// counted from the bottom row.
fn laid_over(fragments: &[[u32; 3]], size_px: [u32; 2]) -> (Vec<[f16; 4]>, PixelShares) {
    let [width, height] = size_px.map(|side| side as usize);
    // Sorts by pixel; the order within a pixel is found below.
    let mut ends = vec![0u32; width * height + 1];
    for fragment in fragments {
        ends[fragment[0] as usize + 1] += 1;
    }
    for pixel in 0..width * height {
        ends[pixel + 1] += ends[pixel];
    }
    let starts = ends;
    let mut next = starts.clone();
    let mut sorted = vec![[0u32; 2]; fragments.len()];
    for fragment in fragments {
        let place = &mut next[fragment[0] as usize];
        sorted[*place as usize] = [fragment[1], fragment[2]];
        *place += 1;
    }
    drop(next);
    let mut rgba = vec![[f16::ZERO; 4]; width * height];
    let rows: Vec<(Vec<u32>, Vec<Share>)> = rgba
        .par_chunks_mut(width)
        .enumerate()
        .map(|(row, colors)| {
            let mut counts = Vec::with_capacity(width);
            let mut shares = Vec::new();
            let mut of_pixel = Vec::new();
            let first = (height - 1 - row) * width;
            for (column, color) in colors.iter_mut().enumerate() {
                let range = starts[first + column] as usize..starts[first + column + 1] as usize;
                of_pixel.clear();
                of_pixel.extend_from_slice(&sorted[range]);
                of_pixel.sort_unstable_by_key(|fragment| std::cmp::Reverse(fragment[0]));
                let before = shares.len();
                *color = pixel(&of_pixel, &mut shares);
                counts.push((shares.len() - before) as u32);
            }
            (counts, shares)
        })
        .collect();
    (rgba, PixelShares::from_rows(rows))
}

/// The colour of a pixel from its fragments, the topmost first. Adds the share of each stroke to `shares`.
fn pixel(fragments: &[[u32; 2]], shares: &mut Vec<Share>) -> [f16; 4] {
    let mut sum = [0.0f32; 4];
    let mut through = 1.0;
    for &[stroke_and_alpha, color_word] in fragments {
        let most = ((1 << ALPHA_BITS) - 1) as f32;
        let alpha = (stroke_and_alpha & ((1 << ALPHA_BITS) - 1)) as f32 / most;
        let amount = alpha * through;
        through *= 1.0 - alpha;
        for (sum, part) in sum.iter_mut().zip(color(color_word)) {
            *sum += part * amount;
        }
        if amount >= LEAST_SHARE {
            shares.push(Share { stroke: stroke_and_alpha >> ALPHA_BITS, amount });
        }
    }
    sum[3] = 1.0 - through;
    sum.map(f16::from_f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fragment(pixel: u32, stroke: u32, alpha: f32, color: [f32; 3]) -> [u32; 3] {
        let bits = |value: f32, most: f32| ((value / BRIGHTEST).sqrt() * most).round() as u32;
        let word = bits(color[0], 2047.0) | bits(color[1], 2047.0) << 11 | bits(color[2], 1023.0) << 22;
        [pixel, stroke << ALPHA_BITS | (alpha * 1023.0).round() as u32, word]
    }

    /// Two strokes of alpha ½ over each other let a quarter through.
    #[test]
    fn strokes_lie_over_each_other_in_their_order_whatever_that_of_their_fragments() {
        let red = fragment(1, 7, 0.5, [1.0, 0.0, 0.0]);
        let green = fragment(1, 9, 0.5, [0.0, 1.0, 0.0]);
        for fragments in [[red, green], [green, red]] {
            let (rgba, shares) = laid_over(&fragments, [2, 2]);
            // The second pixel of the bottom row.
            let at = 3;
            let [r, g, b, a] = rgba[at].map(f32::from);
            assert!((r - 0.25).abs() < 2e-3 && (g - 0.5).abs() < 2e-3 && b == 0.0 && (a - 0.75).abs() < 2e-3);
            let of_pixel = shares.of(at);
            assert_eq!(of_pixel.iter().map(|share| share.stroke).collect::<Vec<_>>(), [9, 7]);
            assert!((of_pixel[0].amount - 0.5).abs() < 1e-3 && (of_pixel[1].amount - 0.25).abs() < 1e-3);
            assert!([0, 1, 2].iter().all(|&other| shares.of(other).is_empty()));
        }
    }

    #[test]
    fn a_colour_comes_back_within_its_steps() {
        for color_in in [[0.0, 0.0, 0.0], [1.0, 0.5, 0.25], [0.003, 2.0, 1.7]] {
            let found = color(fragment(0, 0, 1.0, color_in)[2]);
            for (found, wanted) in found.iter().zip(color_in) {
                assert!((found - wanted).abs() < 0.004, "{found} for {wanted}");
            }
        }
    }
}
