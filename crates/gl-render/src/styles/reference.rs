//! The plain render: shows the reference picture as it is. Targets: none of its own. Passes: lay over.

use crate::encode::Output;
use crate::gl::{DrawState, GlError, Gpu, Halt, Program, ProgramSource, VertexArray, Vertices};
use crate::shader_files::SHARED;
use crate::style_renderer::{StyleInput, StyleRenderer};
use crate::watch::Watch;

pub(crate) struct Reference {
    gpu: Gpu,
    lay_over: Program,
    screen: VertexArray,
}

impl Reference {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        let lay_over = ProgramSource::screen("shared/lay_over.frag", &[&["picture", "background"]]);
        Ok(Self {
            gpu: gpu.clone(),
            lay_over: Program::new(gpu, &[SHARED], &lay_over)?,
            screen: VertexArray::empty(gpu)?,
        })
    }
}

impl StyleRenderer for Reference {
    fn draw(
        &mut self,
        input: &StyleInput<'_>,
        output: &mut Output<'_>,
        watch: &mut Watch<'_>,
    ) -> Result<(), Halt> {
        self.gpu.begin_pass(output.pass()?, DrawState::default());
        let bound = self
            .lay_over
            .bind()
            .texture("picture", &input.reference.color)
            .set("background", input.frame.background_premultiplied());
        self.gpu.draw(bound, &self.screen, Vertices::Screen)?;
        watch.passed("lay over")
    }
}
