//! Puts the palettes of a frame into a texture, from which the stroke shaders read their pigments.

use impasto_painting::Frame;

use crate::gl::{Format, GlError, Gpu, Texture};

/// Texels in a row: the most pigments that a palette has.
const PIGMENTS: usize = 16;

/// A texture with a row for each palette of a frame, or one empty row if it has none. `encode` converts the linear
/// colours. Alpha is 1 for a pigment and 0 past the last one.
pub(crate) fn palette_texture(
    gpu: &Gpu,
    frame: &Frame,
    encode: impl Fn([f32; 3]) -> [f32; 3],
) -> Result<Texture, GlError> {
    let mut texels: Vec<[f32; 4]> = Vec::new();
    for palette in frame.palettes.iter() {
        texels.extend(palette.iter().take(PIGMENTS).map(|&linear| {
            let [a, b, c] = encode(linear);
            [a, b, c, 1.0]
        }));
        texels.resize(texels.len().next_multiple_of(PIGMENTS), [0.0; 4]);
    }
    texels.resize(texels.len().max(PIGMENTS), [0.0; 4]);
    let size_px = [PIGMENTS as u32, (texels.len() / PIGMENTS) as u32];
    Texture::from_texels(gpu, Format::Rgba32F, size_px, bytemuck::cast_slice(&texels))
}
