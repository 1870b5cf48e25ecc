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

/// Ink on paper.
pub(crate) const SUMI_E: &[ShaderFile] = shader_files![
    "sumi_e/ramp.glsl",
    "sumi_e/paper.glsl",
    "sumi_e/surface.vert",
    "sumi_e/silhouette.frag",
    "sumi_e/low_pass.frag",
    "sumi_e/interior.frag",
    "sumi_e/mix.frag",
    "sumi_e/wash.frag",
    "sumi_e/soften.frag",
    "sumi_e/resolve.vert",
    "sumi_e/paint.vert",
    "sumi_e/paint.frag",
    "sumi_e/lay.frag",
];
