//! The plain render itself. Targets: none of its own. Passes: encode.

use super::{Style, StyleInput, ground};
use crate::gl::{DrawState, Framebuffer, GlError, Gpu, Halt, Program, ProgramSource, VertexArray, Vertices};
use crate::shader_files::SHARED;
use crate::watch::Watch;

/// The style.
pub(crate) struct Reference {
    gpu: Gpu,
    encode: Program,
    screen: VertexArray,
}

impl Reference {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        let encode = ProgramSource {
            vertex: "shared/screen.vert",
            fragment: Some("shared/encode.frag"),
            captured: &[],
            uniforms: &["picture", "ground"],
            defined: &[],
        };
        Ok(Self {
            gpu: gpu.clone(),
            encode: Program::new(gpu, &[SHARED], &encode)?,
            screen: VertexArray::empty(gpu)?,
        })
    }
}

impl Style for Reference {
    fn draw(
        &mut self,
        input: &StyleInput<'_>,
        output: &Framebuffer,
        watch: &mut Watch<'_>,
    ) -> Result<(), Halt> {
        self.gpu.begin_pass(output, DrawState::default());
        let bound =
            self.encode.bind().texture("picture", &input.reference.color).set("ground", ground(input.frame));
        self.gpu.draw(bound, &self.screen, Vertices::Screen)?;
        watch.passed("encode")
    }
}
