//! Brush marks on the GPU: an array texture with a layer for each mark of each brush. It has mipmap levels, so that the
//! bristles of small strokes do not alias.

mod bounds;

use std::sync::Arc;

use impasto_core::brush::{Mark, SIZE, VARIANTS};
use impasto_painting::frame::Brushes;
use rayon::prelude::*;

use crate::gl::{Format, GlError, Gpu, Texture};
use bounds::Texel;

/// The marks of a frame's brushes; uploaded again only when the brushes change.
pub(crate) struct Marks {
    brushes: Arc<Brushes>,
    pub(crate) texture: Texture,
    /// A row for each mark. For each threshold of paint, the row has the box around all texels of the mark that have
    /// more paint than the threshold.
    pub(crate) bounds: Texture,
}

impl Marks {
    /// The marks of `brushes`: `before` if it has the same brushes, else newly uploaded ones.
    pub(crate) fn of(gpu: &Gpu, before: Option<Self>, brushes: &Arc<Brushes>) -> Result<Self, GlError> {
        if let Some(before) = before
            && (Arc::ptr_eq(&before.brushes, brushes)
                || before.brushes.names == brushes.names && before.brushes == *brushes)
        {
            return Ok(before);
        }
        let marks: Vec<&Mark> = brushes.marks.iter().flat_map(|marks| marks.iter()).collect();
        let texels = |mark: &&Mark| -> Vec<Texel> {
            mark.texels.iter().map(|&[paint, height, tint]| [paint, height, tint, 0]).collect()
        };
        let layers: Vec<Vec<Texel>> = marks.par_iter().map(texels).collect();
        let count = layers.len().max(1);
        let limit = gpu.limits().max_array_layers as usize;
        if count > limit {
            let what = format!("{} brushes of {VARIANTS} marks", brushes.names.len());
            return Err(GlError::Resource { what, reason: format!("this driver's limit is {limit} marks") });
        }
        let size = [SIZE[0] as u32, SIZE[1] as u32, count as u32];
        let bounds = bounds::texture(gpu, &layers)?;
        let texture = Texture::array_with_levels(gpu, Format::Rgba8, size, &levels(layers))?;
        gpu.lap("marks");
        Ok(Self { brushes: Arc::clone(brushes), texture, bounds })
    }
}

/// For each level, finest first, the texels of all marks one after the other.
fn levels(mut layers: Vec<Vec<Texel>>) -> Vec<Vec<u8>> {
    if layers.is_empty() {
        layers.push(vec![[0; 4]; SIZE[0] * SIZE[1]]);
    }
    let mut size = SIZE;
    let mut levels = Vec::new();
    loop {
        let mut level = Vec::with_capacity(layers.len() * size_of::<Texel>() * size[0] * size[1]);
        layers.iter().for_each(|texels| level.extend_from_slice(bytemuck::cast_slice(texels)));
        levels.push(level);
        if size == [1, 1] {
            return levels;
        }
        let half = size.map(|side| (side / 2).max(1));
        layers = layers.par_iter().map(|texels| halved(texels, size, half)).collect();
        size = half;
    }
}

/// The next coarser level: means of four texels.
fn halved(texels: &[Texel], size: [usize; 2], half: [usize; 2]) -> Vec<Texel> {
    let mut smaller = Vec::with_capacity(half[0] * half[1]);
    for y in 0..half[1] {
        for x in 0..half[0] {
            let mut sum = [2u16; 4];
            for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                let at = [(2 * x + dx).min(size[0] - 1), (2 * y + dy).min(size[1] - 1)];
                for (sum, value) in sum.iter_mut().zip(texels[at[1] * size[0] + at[0]]) {
                    *sum += u16::from(value);
                }
            }
            smaller.push(sum.map(|value| (value / 4) as u8));
        }
    }
    smaller
}

#[cfg(test)]
mod tests {
    use super::*;
    use impasto_core::brush::marks_of;

    #[test]
    fn levels_halve_down_to_one_texel_and_keep_the_mean() {
        let mark = &marks_of("filbert").unwrap()[0];
        let texels: Vec<Texel> = mark.texels.iter().map(|&[a, b, c]| [a, b, c, 0]).collect();
        let mean = |bytes: &[u8], channel: usize| {
            let values: Vec<f64> = bytes.chunks_exact(4).map(|texel| f64::from(texel[channel])).collect();
            values.iter().sum::<f64>() / values.len() as f64
        };
        let levels = levels(vec![texels]);
        assert_eq!(levels.len(), 9);
        assert_eq!(levels.last().map(Vec::len), Some(4));
        for channel in 0..3 {
            let finest = mean(&levels[0], channel);
            assert!(
                levels.iter().take(5).all(|level| (mean(level, channel) - finest).abs() < 2.0),
                "{channel}"
            );
        }
    }
}
