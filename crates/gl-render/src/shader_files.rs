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
    "shared/inverse_bilinear.glsl",
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
];

/// Lights as icons that face the camera.
pub(crate) const LIGHT_BILLBOARDS: &[ShaderFile] =
    shader_files!["light_billboards/billboard.vert", "light_billboards/billboard.frag",];

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
