//! What can go wrong while drawing.

/// Why drawing stopped without a picture.
#[derive(Debug)]
pub(crate) enum Halt {
    /// The caller no longer wants the picture.
    GivenUp,
    /// The driver refused, or a shader is broken.
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
        /// The driver's message, with its line numbers mapped to our files.
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
    /// The driver could not create something.
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
