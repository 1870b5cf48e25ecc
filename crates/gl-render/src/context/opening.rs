//! What all ways of opening a context have in common: options, result, and the versions to ask for.

use crate::gl::Platform;

/// How to open a context.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OpenOptions {
    /// Asks the driver for its debug output; [`crate::Renderer::render`] then fails if the driver complains.
    pub debug: bool,
}

/// An opened context, and the way to find its functions.
pub(super) struct Opened {
    pub(super) platform: Box<dyn Platform>,
    pub(super) device: String,
}

/// OpenGL versions to ask for, best first. 4.6 is left out: Mesa refuses it where it has only 4.5, and nothing here
/// needs it.
pub(super) const VERSIONS: [(u8, u8); 4] = [(4, 5), (4, 3), (4, 1), (3, 3)];
