//! The last pass: encodes a style's finished picture as sRGB bytes, for files of 8 bits a channel and for windows.

use std::rc::Rc;

use crate::gl::{
    DrawState, Filter, Format, Framebuffer, GlError, Gpu, Program, ProgramSource, Texture, VertexArray,
    Vertices,
};
use crate::shader_files::SHARED;

/// A style's target, the finished picture: display-linear with straight alpha, 32 bits a channel, so that it loses
/// nothing on the way to a file of any depth.
pub(crate) struct Painted {
    pub(crate) color: Rc<Texture>,
    pub(crate) pass: Framebuffer,
}

impl Painted {
    /// `before` if it has this size already, else a new target.
    fn of_size(gpu: &Gpu, before: Option<Self>, size_px: [u32; 2]) -> Result<Self, GlError> {
        match before {
            Some(painted) if painted.pass.size_px() == size_px => Ok(painted),
            _ => {
                let color = Rc::new(Texture::target(gpu, Format::Rgba32F, size_px, Filter::Nearest)?);
                Ok(Self { pass: Framebuffer::new(gpu, &[&color], None)?, color })
            }
        }
    }
}

/// Where a style leaves its picture. The target is made when the style asks for the pass.
pub(crate) struct Output<'a> {
    pub(crate) gpu: &'a Gpu,
    pub(crate) size_px: [u32; 2],
    pub(crate) painted: &'a mut Option<Painted>,
}

impl Output<'_> {
    pub(crate) fn pass(&mut self) -> Result<&Framebuffer, GlError> {
        let painted = Painted::of_size(self.gpu, self.painted.take(), self.size_px)?;
        Ok(&self.painted.insert(painted).pass)
    }
}

/// The encoding pass, and the target that it was last used with.
pub(crate) struct Encoder {
    gpu: Gpu,
    program: Program,
    screen: VertexArray,
    target: Option<Framebuffer>,
}

impl Encoder {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        let encode = ProgramSource::screen("shared/encode.frag", &[&["picture", "exposure"]]);
        Ok(Self {
            gpu: gpu.clone(),
            program: Program::new(gpu, &[SHARED], &encode)?,
            screen: VertexArray::empty(gpu)?,
            target: None,
        })
    }

    pub(crate) fn let_go(&mut self) {
        self.target = None;
    }

    /// Encodes a picture, brightened by this factor. Returns the target that holds it as sRGB bytes with straight
    /// alpha.
    pub(crate) fn encode(&mut self, painted: &Painted, exposure: f32) -> Result<&Framebuffer, GlError> {
        let size_px = painted.pass.size_px();
        let target = match self.target.take() {
            Some(target) if target.size_px() == size_px => target,
            _ => byte_target(&self.gpu, size_px)?,
        };
        let target = self.target.insert(target);
        self.gpu.begin_pass(target, DrawState::default());
        let bound = self.program.bind().texture("picture", &painted.color).set("exposure", exposure);
        self.gpu.draw(bound, &self.screen, Vertices::Screen)?;
        self.gpu.lap("encode");
        Ok(target)
    }
}

/// A target for encoded pictures.
pub(crate) fn byte_target(gpu: &Gpu, size_px: [u32; 2]) -> Result<Framebuffer, GlError> {
    let color = Rc::new(Texture::target(gpu, Format::Rgba8, size_px, Filter::Nearest)?);
    Framebuffer::new(gpu, &[&color], None)
}
