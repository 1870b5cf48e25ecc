//! What strokes of any style are made of on the GPU: their records as inputs of shaders, and brush marks: every mark of every brush
//! a layer of one array, with levels, so that small strokes show no comb.

mod bounds;

use std::sync::Arc;

use impasto_core::brush::{Mark, SIZE, VARIANTS};
use impasto_painting::frame::{Brushes, Stroke};
use rayon::prelude::*;

use crate::gl::{Attribute, Buffer, Format, GlError, Gpu, Texture};

/// The marks of the brushes of some frame, kept while frames use the same.
pub(crate) struct Marks {
    brushes: Arc<Brushes>,
    pub(crate) texture: Texture,
    /// For each mark a row: where there is more paint than so much.
    pub(crate) bounds: Texture,
}

/// Paint, height, tint, unused.
type Texel = [u8; 4];

impl Marks {
    /// Those of `brushes`; uploads them unless `kept` already are.
    pub(crate) fn of(gpu: &Gpu, kept: Option<Self>, brushes: &Arc<Brushes>) -> Result<Self, GlError> {
        if let Some(kept) = kept
            && (Arc::ptr_eq(&kept.brushes, brushes)
                || kept.brushes.names == brushes.names && kept.brushes == *brushes)
        {
            return Ok(kept);
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

/// All marks of a level behind each other, finest level first.
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

/// Box filter to the next level.
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

/// Bytes of what the resolve pass of a style keeps of a stroke: its colour and presence, then what else the style found.
pub(crate) const RESOLVED_BYTES: usize = 32;

/// What was resolved of strokes from number `first` on, one for each billboard.
pub(crate) fn resolved_inputs(resolved: &Buffer, first: i32) -> [Attribute<'_>; 2] {
    let stride = RESOLVED_BYTES as i32;
    [(6, 0), (7, 16)].map(|(location, offset)| Attribute {
        location,
        buffer: resolved,
        components: 4,
        integer: false,
        stride_bytes: stride,
        offset_bytes: first * stride + offset,
        per_instance: true,
    })
}

/// The fields of [`Stroke`] as shader inputs, from stroke `first` on.
pub(crate) fn stroke_inputs(buffer: &Buffer, first: i32, per_instance: bool) -> Vec<Attribute<'_>> {
    let stride = size_of::<Stroke>() as i32;
    let input = |location: u32, components: i32, offset: usize, integer: bool| Attribute {
        location,
        buffer,
        components,
        integer,
        stride_bytes: stride,
        offset_bytes: first * stride + offset as i32,
        per_instance,
    };
    vec![
        input(0, 4, std::mem::offset_of!(Stroke, center_px), false),
        input(1, 4, std::mem::offset_of!(Stroke, length_px), false),
        input(2, 4, std::mem::offset_of!(Stroke, bits), true),
        input(3, 2, std::mem::offset_of!(Stroke, paint), true),
        input(4, 4, std::mem::offset_of!(Stroke, normal_in_world), false),
        input(5, 4, std::mem::offset_of!(Stroke, overrun_px), false),
    ]
}

/// The shape of strokes from number `first` on, beside another of their inputs.
pub(crate) fn shape_input<'a>(beside: &Attribute<'a>, first: i32) -> Attribute<'a> {
    let offset = first * size_of::<Stroke>() as i32 + std::mem::offset_of!(Stroke, taper) as i32;
    Attribute { location: 8, components: 2, offset_bytes: offset, ..*beside }
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
