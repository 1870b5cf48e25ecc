//! Puts the palettes of a frame into a texture, from which the stroke shaders read their pigments.

use impasto_painting::Frame;

use crate::gl::{Format, GlError, Gpu, Texture};

/// Texels in a row: the most pigments that a palette has.
const PIGMENTS: usize = 16;

/// Alpha of the pigments in a palette whose mix is 0: an alpha of 0 would mean that there is no pigment.
const LEAST_MIX: f32 = 1e-3;

/// A texture with a row for each palette of a frame, or one empty row if it has none. `encode` converts the linear
/// colours. Alpha is how far colours keep to the palette, and 0 past the last pigment.
pub(crate) fn palette_texture(
    gpu: &Gpu,
    frame: &Frame,
    encode: impl Fn([f32; 3]) -> [f32; 3],
) -> Result<Texture, GlError> {
    let mut texels: Vec<[f32; 4]> = Vec::new();
    for palette in frame.palettes.iter() {
        let mix = palette.mix.clamp(LEAST_MIX, 1.0);
        texels.extend(palette.pigments.iter().take(PIGMENTS).map(|&linear| {
            let [a, b, c] = encode(linear);
            [a, b, c, mix]
        }));
        texels.resize(texels.len().next_multiple_of(PIGMENTS), [0.0; 4]);
    }
    texels.resize(texels.len().max(PIGMENTS), [0.0; 4]);
    let size_px = [PIGMENTS as u32, (texels.len() / PIGMENTS) as u32];
    Texture::from_texels(gpu, Format::Rgba32F, size_px, bytemuck::cast_slice(&texels))
}
