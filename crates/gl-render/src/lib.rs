//! The only crate that draws: Frame -> pixels.
//!
//! ```text
//! Frame ─▶ reference pass: shadow ─▶ surface ─▶ samples ─▶ openness ─▶ light ─▶ noise   (colour, normal, depth and id)
//!                │
//!                └─▶ a style: its targets and its passes in order ─▶ encode: sRGB bytes ─▶ overlays of a window
//! ```
//!
//! Openness is ambient occlusion: 1 in the open, 0 where a place is enclosed. Noise means bodies that noise colours.

mod body_program;
pub mod context;
mod drawn;
mod encode;
mod fragments;
mod gl;
#[cfg(test)]
mod inverse_bilinear_twin;
mod keeps;
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
mod samples;
mod shader_files;
pub mod shader_folder;
mod shadow;
mod stroke_buffers;
mod style_renderer;
mod styles;
mod watch;

pub use drawn::{Cost, PaintSurface, PassTime, Picture, ReferencePixels, ResolvedStroke, SurfacePixels};
pub use fragments::{PaintedLayer, PixelShares, Share};
pub use gl::{GlError, ShaderTexts};
pub use keeps::Keeps;
pub use motion::MotionPixels;
pub use overlays::light_billboards::{BillboardIcon, BillboardSize, LightBillboard};
pub use renderer::{RenderError, Renderer};
