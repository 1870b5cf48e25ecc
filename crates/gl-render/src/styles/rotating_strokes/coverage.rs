//! Finds how much of each pixel is covered by the body in the pixel's middle.

use std::rc::Rc;

use crate::gl::{
    Bound, DrawState, Filter, Format, Framebuffer, GlError, Gpu, Halt, Program, ProgramSource, Texture,
    VertexArray, Vertices,
};
use crate::samples::Samples;
use crate::style_renderer::StyleInput;
use crate::watch::Watch;

use super::programs::FILES;

pub(super) struct Coverage {
    gpu: Gpu,
    borders: Program,
    screen: VertexArray,
    /// The target that has a texel for each pixel.
    surface: Option<Target>,
}

struct Target {
    texture: Rc<Texture>,
    pass: Framebuffer,
}

/// Textures of depth and body id.
#[derive(Clone)]
pub(super) struct Covered {
    /// Of every sample.
    fine: Rc<Texture>,
    /// Of every pixel. The whole part of the id names the body in the pixel's middle. The fraction, below 0.5, is half
    /// the share of the pixel that this body does not cover.
    surface: Rc<Texture>,
    /// How many samples a pixel has along each axis.
    samples: u32,
}

impl Covered {
    /// Sets the uniforms `fine` and `samples`.
    pub(super) fn set_samples<'a>(&self, bound: Bound<'a>) -> Bound<'a> {
        bound.texture("fine", &self.fine).set("samples", self.samples as i32)
    }

    /// Frees the samples. To be called after the last pass that reads them.
    pub(super) fn let_samples_go(&mut self) {
        self.fine = Rc::clone(&self.surface);
        self.samples = 1;
    }

    pub(super) fn set_surface<'a>(&self, bound: Bound<'a>) -> Bound<'a> {
        bound.texture("surface", &self.surface)
    }
}

impl Coverage {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        Ok(Self {
            gpu: gpu.clone(),
            borders: Program::new(gpu, FILES, &BORDERS)?,
            screen: VertexArray::empty(gpu)?,
            surface: None,
        })
    }

    pub(super) fn let_go(&mut self) {
        self.surface = None;
    }

    /// Finds the covered shares from the samples. Without samples, each pixel counts as one sample.
    pub(super) fn draw(&mut self, input: &StyleInput<'_>, watch: &mut Watch<'_>) -> Result<Covered, Halt> {
        let coarse = &input.reference.depth_and_id;
        let Some(Samples { depth_and_id: fine, per_side: samples, .. }) = input.samples.take() else {
            return Ok(Covered { fine: Rc::clone(coarse), surface: Rc::clone(coarse), samples: 1 });
        };
        let size_px = input.frame.size_px;
        let surface = match self.surface.take() {
            Some(target) if target.pass.size_px() == size_px => target,
            _ => Target::new(&self.gpu, size_px)?,
        };
        let surface = self.surface.insert(surface);
        self.gpu.begin_pass(&surface.pass, DrawState::default());
        let covered = Covered { fine, surface: Rc::clone(&surface.texture), samples };
        let bound = covered.set_samples(self.borders.bind().texture("depth_and_id", coarse));
        self.gpu.draw(bound, &self.screen, Vertices::Screen)?;
        watch.passed("coverage")?;
        Ok(covered)
    }
}

impl Target {
    fn new(gpu: &Gpu, size_px: [u32; 2]) -> Result<Self, GlError> {
        let texture = Rc::new(Texture::target(gpu, Format::Rg32F, size_px, Filter::Nearest)?);
        Ok(Self { pass: Framebuffer::new(gpu, &[&texture], None)?, texture })
    }
}

const BORDERS: ProgramSource<'static> =
    ProgramSource::screen("rotating_strokes/borders.frag", &[&["depth_and_id", "fine", "samples"]]);
