//! The plain render itself. Targets: none of its own. Passes: encode.

use super::{Style, StyleInput, encode_program, ground};
use crate::gl::{DrawState, Framebuffer, GlError, Gpu, Program, VertexArray, Vertices};

/// The style.
pub(crate) struct Reference {
    gpu: Gpu,
    encode: Program,
    screen: VertexArray,
}

impl Reference {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        Ok(Self { gpu: gpu.clone(), encode: encode_program(gpu)?, screen: VertexArray::empty(gpu)? })
    }
}

impl Style for Reference {
    fn draw(&mut self, input: &StyleInput<'_>, output: &Framebuffer) -> Result<(), GlError> {
        self.gpu.begin_pass(output, DrawState::default());
        let bound =
            self.encode.bind().texture("picture", &input.reference.color).set("ground", ground(input.frame));
        self.gpu.draw(bound, &self.screen, Vertices::Screen)
    }
}
