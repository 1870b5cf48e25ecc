//! The plain render: shows the reference picture as it is. Targets: none of its own. Passes: encode.

use crate::gl::{DrawState, Framebuffer, GlError, Gpu, Halt, Program, ProgramSource, VertexArray, Vertices};
use crate::shader_files::SHARED;
use crate::style_renderer::{StyleInput, StyleRenderer};
use crate::watch::Watch;

/// Draws the plain render.
pub(crate) struct Reference {
    gpu: Gpu,
    encode: Program,
    screen: VertexArray,
}

impl Reference {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        let encode = ProgramSource::screen("shared/encode.frag", &[&["picture", "background"]]);
        Ok(Self {
            gpu: gpu.clone(),
            encode: Program::new(gpu, &[SHARED], &encode)?,
            screen: VertexArray::empty(gpu)?,
        })
    }
}

impl StyleRenderer for Reference {
    fn draw(
        &mut self,
        input: &StyleInput<'_>,
        output: &Framebuffer,
        watch: &mut Watch<'_>,
    ) -> Result<(), Halt> {
        self.gpu.begin_pass(output, DrawState::default());
        let bound = self
            .encode
            .bind()
            .texture("picture", &input.reference.color)
            .set("background", input.frame.background_premultiplied());
        self.gpu.draw(bound, &self.screen, Vertices::Screen)?;
        watch.passed("encode")
    }
}
