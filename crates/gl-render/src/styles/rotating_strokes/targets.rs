//! The render targets of the style: they hold where small strokes are wanted, the paint, and its height.

use std::rc::Rc;

use impasto_painting::Quality;

use crate::gl::{Filter, Format, Framebuffer, GlError, Gpu, Texture};

/// Where small strokes are wanted, block by block.
pub(super) struct DetailTargets {
    size_px: [u32; 2],
    pub(super) block_px: u32,
    pub(super) detail: [Rc<Texture>; 2],
    pub(super) passes: [Framebuffer; 2],
}

impl DetailTargets {
    pub(super) fn new(gpu: &Gpu, size_px: [u32; 2], block_px: u32) -> Result<Self, GlError> {
        let blocks = size_px.map(|side| side.div_ceil(block_px));
        // 32 bits, because one channel holds both a body's id and its share of the block.
        let target = || Texture::target(gpu, Format::Rgba32F, blocks, Filter::Nearest).map(Rc::new);
        let detail = [target()?, target()?];
        let passes =
            [Framebuffer::new(gpu, &[&detail[0]], None)?, Framebuffer::new(gpu, &[&detail[1]], None)?];
        Ok(Self { size_px, block_px, detail, passes })
    }

    pub(super) fn fit(&self, size_px: [u32; 2], block_px: u32) -> bool {
        (self.size_px, self.block_px) == (size_px, block_px)
    }
}

pub(super) struct PaintTargets {
    pub(super) paint: Rc<Texture>,
    /// Height of the paint, and how wet it is.
    pub(super) height: Rc<Texture>,
    pub(super) below: Rc<Texture>,
    pub(super) soft_height: Rc<Texture>,
    pub(super) paint_pass: Framebuffer,
    /// The pass for paint without height.
    flat_pass: Framebuffer,
    pub(super) below_pass: Framebuffer,
    pub(super) soften_pass: Framebuffer,
}

impl PaintTargets {
    pub(super) fn new(gpu: &Gpu, size_px: [u32; 2]) -> Result<Self, GlError> {
        let target = |format: Format, size_px: [u32; 2], filter: Filter| {
            Texture::target(gpu, format, size_px, filter).map(Rc::new)
        };
        let paint = target(Format::Rgba16F, size_px, Filter::Nearest)?;
        let height = target(Format::Rg16F, size_px, Filter::LinearInLevel)?;
        let below = target(Format::Rgba16F, size_px, Filter::Nearest)?;
        let half = size_px.map(|side| side.div_ceil(2));
        let soft_height = target(Format::R16F, half, Filter::LinearInLevel)?;
        Ok(Self {
            paint_pass: Framebuffer::new(gpu, &[&paint, &height], None)?,
            flat_pass: Framebuffer::new(gpu, &[&paint], None)?,
            below_pass: Framebuffer::new(gpu, &[&below], None)?,
            soften_pass: Framebuffer::new(gpu, &[&soft_height], None)?,
            paint,
            height,
            below,
            soft_height,
        })
    }

    /// The pass that strokes are painted in.
    pub(super) fn strokes_pass(&self, quality: Quality) -> &Framebuffer {
        match quality {
            Quality::Exact => &self.paint_pass,
            Quality::Draft => &self.flat_pass,
        }
    }
}
