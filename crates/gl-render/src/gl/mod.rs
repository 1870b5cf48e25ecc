//! The OpenGL that Impasto needs, as safe types: nothing above this module can call OpenGL any other way.

#![expect(
    unsafe_code,
    reason = "every OpenGL call is an unsafe function; this module wraps the few that are needed"
)]

mod buffer;
mod framebuffer;
mod gpu;
mod pass;
mod program;
mod shader_text;
mod texture;
mod vertex_array;

pub(crate) use buffer::{Buffer, BufferUse};
pub(crate) use framebuffer::Framebuffer;
pub(crate) use gpu::{Gpu, Limits};
pub(crate) use pass::{Blend, DrawState, Records, Vertices};
pub(crate) use program::{Bound, Program, ProgramSource};
pub(crate) use shader_text::ShaderFile;
pub(crate) use texture::{Filter, Format, Texture};
pub(crate) use vertex_array::{Attribute, VertexArray};

/// Why drawing came to no picture.
#[derive(Debug)]
pub(crate) enum Halt {
    /// Nobody wants it any more.
    GivenUp,
    /// It cannot be drawn.
    Gl(GlError),
}

impl From<GlError> for Halt {
    fn from(error: GlError) -> Self {
        Self::Gl(error)
    }
}

/// What can go wrong between Impasto and the driver.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GlError {
    /// A shader does not compile or link; `log` names files and lines.
    #[error("shader {program}: {log}")]
    Shader {
        /// The program's name.
        program: String,
        /// The driver's words, with its line numbers mapped to our files.
        log: String,
    },
    /// The shader and the Rust side disagree about a uniform.
    #[error("shader {program}: uniform {uniform} {fault}")]
    Uniform {
        /// The program's name.
        program: String,
        /// The uniform's name.
        uniform: String,
        /// What is wrong with it.
        fault: &'static str,
    },
    /// The driver could not make something.
    #[error("the driver cannot make {what}: {reason}")]
    Resource {
        /// What was wanted.
        what: String,
        /// Why not.
        reason: String,
    },
    /// Debug output of the driver.
    #[error("the driver complains: {}", .0.join("; "))]
    Driver(Vec<String>),
    /// The context went away.
    #[error("the OpenGL context is lost: {0}")]
    Context(String),
}
