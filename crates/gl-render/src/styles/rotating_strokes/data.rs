//! Data of the paint besides its colour: which strokes show where, each layer alone, and the paint's surface.

use std::rc::Rc;

use impasto_painting::Frame;
use impasto_painting::frame::LayerRun;

use crate::drawn::PaintSurface;
use crate::fragments::{FragmentGatherer, MOST_STROKES, PaintedLayer};
use crate::gl::{
    Bound, DrawState, Filter, Format, Framebuffer, GlError, Gpu, Program, Texture, VertexArray, Vertices,
};

use super::programs::DataPrograms;

/// The programs, the notes of fragments, and the target of the paint's surface.
pub(super) struct PaintData {
    gpu: Gpu,
    programs: DataPrograms,
    gatherer: FragmentGatherer,
    target: Option<Framebuffer>,
}

impl PaintData {
    /// Fails where the driver cannot note fragments.
    pub(super) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        // Created first, because its error says in plain words what the driver lacks.
        let gatherer = FragmentGatherer::new(gpu)?;
        Ok(Self { gpu: gpu.clone(), programs: DataPrograms::new(gpu)?, gatherer, target: None })
    }

    pub(super) fn begin(&mut self, frame: &Frame) -> Result<(), GlError> {
        if frame.strokes.len() > MOST_STROKES {
            return Err(GlError::Resource {
                what: "data of strokes".to_owned(),
                reason: format!("{} strokes, {MOST_STROKES} can be told apart", frame.strokes.len()),
            });
        }
        self.gatherer.clear()
    }

    /// The most pixels that the strokes of one piece of a layer may cover, so that all their fragments can be noted. A
    /// stroke's quad has more fragments than the stroke covers pixels; if the stroke is narrow, many more.
    pub(super) fn piece_px(&self) -> f32 {
        const MOST_TIMES: f32 = 4.0;
        self.gatherer.capacity() as f32 / MOST_TIMES
    }

    /// The program that paints strokes and notes their fragments.
    pub(super) fn paint(&self, has_shape: bool) -> &Program {
        if has_shape { &self.programs.shaped_paint } else { &self.programs.paint }
    }

    /// The program that paints lines and notes their fragments.
    pub(super) fn line_paint(&self) -> &Program {
        &self.programs.line_paint
    }

    /// Begins to note the fragments of a piece.
    pub(super) fn begin_noting(&self) {
        self.gatherer.begin();
    }

    /// Takes in the fragments of a piece.
    pub(super) fn end_noting(&mut self) -> Result<(), GlError> {
        self.gatherer.take()
    }

    pub(super) fn end_layer(&mut self, layer: LayerRun, size_px: [u32; 2]) {
        self.gatherer.end_layer(layer, size_px);
    }

    /// Draws the surface of the paint; `bind` sets the uniforms of the program.
    pub(super) fn draw_surface<'a>(
        &'a mut self,
        size_px: [u32; 2],
        screen: &VertexArray,
        bind: impl FnOnce(&'a Program) -> Bound<'a>,
    ) -> Result<(), GlError> {
        let target = match self.target.take() {
            Some(target) if target.size_px() == size_px => target,
            _ => {
                let texture = |format: Format| {
                    Texture::target(&self.gpu, format, size_px, Filter::Nearest).map(Rc::new)
                };
                let colors = [
                    texture(Format::Rgba16F)?,
                    texture(Format::Rgba16F)?,
                    texture(Format::Rgba16F)?,
                    texture(Format::Rg32F)?,
                    texture(Format::Rgba16F)?,
                ];
                Framebuffer::new(&self.gpu, &colors.each_ref(), None)?
            }
        };
        let target = self.target.insert(target);
        self.gpu.begin_pass(target, DrawState::default());
        self.gpu.draw(bind(&self.programs.finish), screen, Vertices::Screen)?;
        self.gpu.lap("surface of the paint");
        Ok(())
    }

    /// The layers of the last picture; they can be taken once.
    pub(super) fn take_layers(&mut self) -> Vec<PaintedLayer> {
        self.gatherer.layers()
    }

    /// The surface of the paint of the last picture, bottom row first.
    pub(super) fn read_surface(&self) -> Option<PaintSurface> {
        let target = self.target.as_ref()?;
        let pairs = target.read_floats(3);
        Some(PaintSurface {
            flat: target.read_halves(1),
            normal_and_height: target.read_halves(2),
            wetness: pairs.iter().step_by(2).copied().collect(),
            is_border: pairs.iter().skip(1).step_by(2).map(|&is_border| is_border != 0.0).collect(),
            ground: target.read_halves(4),
        })
    }
}
