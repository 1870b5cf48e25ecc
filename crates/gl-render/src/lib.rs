//! The only crate that draws: Frame -> pixels.
//!
//! ```text
//! Frame ─▶ reference pass: shadow ─▶ surface ─▶ openness ─▶ light      (colour, normal, depth and id)
//!                │
//!                └─▶ a style: its targets and its passes in order ─▶ overlays of a window ─▶ sRGB bytes
//! ```

mod body_program;
pub mod context;
mod gl;
#[cfg(test)]
mod inverse_bilinear_twin;
mod lens;
mod lighting;
mod marks;
mod materials;
mod meshes;
mod motion;
mod noise_tiles;
mod overlays;
mod palettes;
mod reference;
mod reference_targets;
mod renderer;
mod shader_files;
pub mod shader_folder;
mod shadow;
mod stroke_buffers;
mod style_renderer;
mod styles;
mod watch;

pub use gl::{GlError, ShaderTexts};
pub use motion::MotionPixels;
pub use overlays::light_billboards::{BillboardIcon, BillboardSize, LightBillboard};
pub use renderer::{Cost, PassTime, Picture, ReferencePixels, RenderError, Renderer, ResolvedStroke};
