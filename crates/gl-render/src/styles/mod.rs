//! Styles: each is a list of targets and an ordered list of passes, in a file of its own.

mod reference;
mod rotating_strokes;
mod sumi_e;

use std::rc::Rc;

use impasto_painting::Frame;
use impasto_painting::frame::{FrameBody, FrameStyle};

use crate::gl::{Framebuffer, GlError, Gpu, Halt};
use crate::meshes::MeshOnGpu;
use crate::reference::{LightSetup, ReferenceTargets};
use crate::watch::Watch;

pub(crate) use rotating_strokes::RotatingStrokes;

/// What a style starts from.
pub(crate) struct StyleInput<'a> {
    pub(crate) frame: &'a Frame,
    pub(crate) reference: &'a ReferenceTargets,
    pub(crate) lights: &'a LightSetup,
    /// The bodies of the frame with their surfaces.
    pub(crate) bodies: &'a [(&'a FrameBody, Rc<MeshOnGpu>)],
}

/// A way of drawing a frame.
pub(crate) trait Style {
    /// Runs the style's passes; the last one writes sRGB bytes with straight alpha into `output`.
    fn draw(
        &mut self,
        input: &StyleInput<'_>,
        output: &Framebuffer,
        watch: &mut Watch<'_>,
    ) -> Result<(), Halt>;

    /// Makes at once every program that otherwise waits until it is needed.
    fn ready_all(&mut self) -> Result<(), GlError> {
        Ok(())
    }

    /// For styles of strokes, what was painted.
    fn as_strokes(&self) -> Option<&RotatingStrokes> {
        None
    }

    /// Of every stroke of the last frame: colour and alpha, then its place, eight floats each.
    fn read_resolved(&self) -> Vec<[f32; 8]> {
        self.as_strokes().map_or_else(Vec::new, RotatingStrokes::read_resolved)
    }
}

/// Makes a style ready.
pub(crate) fn open(gpu: &Gpu, style: FrameStyle) -> Result<Box<dyn Style>, GlError> {
    Ok(match style {
        FrameStyle::RotatingStrokes => Box::new(RotatingStrokes::new(gpu)?),
        FrameStyle::SumiE => Box::new(sumi_e::SumiE::new(gpu)?),
        FrameStyle::Reference => Box::new(reference::Reference::new(gpu)?),
    })
}

/// The ground under the picture, premultiplied.
pub(crate) fn ground(frame: &Frame) -> glam::Vec4 {
    frame.background.map_or(glam::Vec4::ZERO, |[r, g, b]| glam::Vec4::new(r, g, b, 1.0))
}
