//! The part of OpenGL that Impasto needs, as safe types. The rest of the crate calls OpenGL only through them.

#![expect(
    unsafe_code,
    reason = "every OpenGL call is an unsafe function; this module wraps the few that are needed"
)]

mod buffer;
mod driver_messages;
mod error;
mod framebuffer;
mod gpu;
mod pass;
mod platform;
mod program;
mod shader_text;
mod texture;
mod vertex_array;

pub(crate) use buffer::{Buffer, BufferUse};
pub(crate) use driver_messages::DriverMessages;
pub use error::GlError;
pub(crate) use error::Halt;
pub(crate) use framebuffer::Framebuffer;
pub(crate) use gpu::{Gpu, Limits};
pub(crate) use pass::{Blend, DrawState, Records, Vertices};
pub(crate) use platform::Platform;
pub(crate) use program::{Bound, Program, ProgramSource};
pub(crate) use shader_text::ShaderFile;
pub use shader_text::ShaderTexts;
pub(crate) use texture::{Filter, Format, Texture};
pub(crate) use vertex_array::{Attribute, VertexArray};
