//! The only crate that draws: Frame -> pixels.
//!
//! ```text
//! Frame ─▶ reference pass: shadow ─▶ surface ─▶ openness ─▶ light      (colour, normal, depth and id)
//!                │
//!                └─▶ a style: its targets and its passes in order ─▶ overlays of a window ─▶ sRGB bytes
//! ```

pub mod context;
mod gl;
#[cfg(test)]
mod inverse_bilinear_twin;
mod marks;
mod materials;
mod meshes;
mod motion;
mod overlays;
mod reference;
mod renderer;
mod shader_files;
pub mod shader_folder;
mod styles;
mod watch;

pub use gl::GlError;
pub use motion::MotionPixels;
pub use overlays::light_billboards::{BillboardIcon, BillboardSize, LightBillboard};
pub use renderer::{Cost, PassTime, Picture, ReferencePixels, RenderError, Renderer, ResolvedStroke};
pub use shader_files::ShaderTexts;
