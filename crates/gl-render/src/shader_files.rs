//! The shader files, part of the binary, so that an install cannot lose them.

use crate::gl::ShaderFile;

macro_rules! shader_files {
    ($($path:literal),* $(,)?) => {
        &[$(ShaderFile { path: $path, text: include_str!(concat!("../../../shaders/", $path)) }),*]
    };
}

/// What every style may include.
pub(crate) const SHARED: &[ShaderFile] = shader_files![
    "shared/screen.vert",
    "shared/encode.glsl",
    "shared/encode.frag",
    "shared/lens.glsl",
    "shared/oklab.glsl",
];

/// Bodies that noise displaces and colours.
pub(crate) const NOISE_DISPLACE: &[ShaderFile] = shader_files![
    "noise_displace/look.vert",
    "noise_displace/look.frag",
    "noise_displace/place.frag",
    "noise_displace/ground.frag",
    "noise_displace/gather.frag",
    "noise_displace/spread.frag",
    "noise_displace/bloom.frag",
];

/// The reference pass, and how its surfaces move from one picture to another.
pub(crate) const REFERENCE: &[ShaderFile] = shader_files![
    "reference/lighting.glsl",
    "reference/surface.vert",
    "reference/surface.frag",
    "reference/shadow.vert",
    "reference/shadow.frag",
    "reference/openness.frag",
    "reference/light.frag",
    "reference/motion.vert",
    "reference/motion.frag",
    "noise_displace/displace.glsl",
];

/// Brush strokes.
pub(crate) const ROTATING_STROKES: &[ShaderFile] = shader_files![
    "rotating_strokes/layers.glsl",
    "rotating_strokes/surroundings.glsl",
    "rotating_strokes/mixing.glsl",
    "rotating_strokes/resolve.vert",
    "rotating_strokes/paint.vert",
    "rotating_strokes/paint.frag",
    "rotating_strokes/soften.frag",
    "rotating_strokes/detail.frag",
    "rotating_strokes/spread.frag",
    "rotating_strokes/encode.frag",
];
