//! The targets that the passes of the ink style draw into, for each `InkRule`.

use std::rc::Rc;

use crate::gl::{Filter, Format, Framebuffer, GlError, Gpu, Texture};

/// Pixels of the picture per texel of the wide blur, along each side.
pub(super) const WIDE: u32 = 4;

/// The targets of `InkRule::Source`, which follows the RenderMonkey effect "Sumi-e Drawing".
pub(super) struct SourceTargets {
    pub(super) silhouette: Rc<Texture>,
    pub(super) blurred_silhouette: Rc<Texture>,
    pub(super) interior: Rc<Texture>,
    pub(super) blurred_interior: Rc<Texture>,
    pub(super) silhouette_pass: Framebuffer,
    pub(super) blurred_silhouette_pass: Framebuffer,
    pub(super) interior_pass: Framebuffer,
    pub(super) blurred_interior_pass: Framebuffer,
}

impl SourceTargets {
    pub(super) fn new(gpu: &Gpu, size_px: [u32; 2]) -> Result<Self, GlError> {
        let target = |format: Format| Texture::target(gpu, format, size_px, Filter::Nearest).map(Rc::new);
        let depth = target(Format::Depth32F)?;
        let [silhouette, blurred_silhouette] = [target(Format::Rgba8)?, target(Format::Rgba8)?];
        let [interior, blurred_interior] = [target(Format::Rgba8)?, target(Format::Rgba8)?];
        Ok(Self {
            silhouette_pass: Framebuffer::new(gpu, &[&silhouette], Some(&depth))?,
            blurred_silhouette_pass: Framebuffer::new(gpu, &[&blurred_silhouette], None)?,
            interior_pass: Framebuffer::new(gpu, &[&interior], Some(&depth))?,
            blurred_interior_pass: Framebuffer::new(gpu, &[&blurred_interior], None)?,
            silhouette,
            blurred_silhouette,
            interior,
            blurred_interior,
        })
    }

    pub(super) fn size_px(&self) -> [u32; 2] {
        self.silhouette_pass.size_px()
    }
}

/// The targets of `InkRule::Painter`, our own rule.
pub(super) struct PainterTargets {
    pub(super) wash: Rc<Texture>,
    pub(super) between: Rc<Texture>,
    pub(super) soft: Rc<Texture>,
    pub(super) wide: [Rc<Texture>; 2],
    pub(super) strokes: Rc<Texture>,
    pub(super) wash_pass: Framebuffer,
    pub(super) between_pass: Framebuffer,
    pub(super) soft_pass: Framebuffer,
    pub(super) wide_passes: [Framebuffer; 2],
    pub(super) strokes_pass: Framebuffer,
}

impl PainterTargets {
    pub(super) fn new(gpu: &Gpu, size_px: [u32; 2]) -> Result<Self, GlError> {
        let target = |size_px: [u32; 2]| {
            Texture::target(gpu, Format::Rgba16F, size_px, Filter::LinearInLevel).map(Rc::new)
        };
        let wide_px = size_px.map(|side| side.div_ceil(WIDE));
        let [wash, between, soft, strokes] =
            [target(size_px)?, target(size_px)?, target(size_px)?, target(size_px)?];
        let wide = [target(wide_px)?, target(wide_px)?];
        let pass = |texture: &Rc<Texture>| Framebuffer::new(gpu, &[texture], None);
        Ok(Self {
            wash_pass: pass(&wash)?,
            between_pass: pass(&between)?,
            soft_pass: pass(&soft)?,
            wide_passes: [pass(&wide[0])?, pass(&wide[1])?],
            strokes_pass: pass(&strokes)?,
            wash,
            between,
            soft,
            wide,
            strokes,
        })
    }

    pub(super) fn size_px(&self) -> [u32; 2] {
        self.wash_pass.size_px()
    }
}
