//! The only crate that draws: Frame -> pixels.
//!
//! ```text
//! Frame ─▶ reference pass: shadow ─▶ surface ─▶ openness ─▶ light      (colour, normal, depth and id)
//!                │
//!                └─▶ a style: its targets and its passes in order ─▶ sRGB bytes
//! ```

pub mod context;
mod gl;
mod materials;
mod meshes;
mod motion;
mod reference;
mod renderer;
mod shader_files;
mod styles;
mod watch;

pub use gl::GlError;
pub use motion::MotionPixels;
pub use renderer::{Cost, PassTime, Picture, ReferencePixels, RenderError, Renderer, ResolvedStroke};
