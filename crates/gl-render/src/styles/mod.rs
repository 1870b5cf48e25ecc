//! The styles: each draws with its own targets and passes, and knows no other style.

mod reference;
mod rotating_strokes;
mod sumi_e;

use impasto_painting::frame::{Frame, Style};

use crate::gl::{GlError, Gpu};
use crate::style_renderer::StyleRenderer;

/// Creates the renderer of a style.
pub(crate) fn open(gpu: &Gpu, style: &Style) -> Result<Box<dyn StyleRenderer>, GlError> {
    Ok(match style {
        Style::RotatingStrokes(_) => Box::new(rotating_strokes::RotatingStrokes::new(gpu)?),
        Style::SumiE(_) => Box::new(sumi_e::SumiE::new(gpu)?),
        Style::Reference => Box::new(reference::Reference::new(gpu)?),
    })
}

/// How many samples the style wants in each pixel along each axis.
pub(crate) fn samples(frame: &Frame, max_side_px: u32) -> u32 {
    match frame.style {
        Style::RotatingStrokes(_) => frame.samples(max_side_px),
        Style::SumiE(_) | Style::Reference => 1,
    }
}

/// How much of a strong highlight is in the lit colour that strokes are painted with, 0..=1. It is below 1 where
/// highlights have strokes of their own, which add the rest. The strokes below them then stay calm when a highlight
/// passes over a body.
pub(crate) fn highlight_in_color(frame: &Frame) -> f32 {
    match frame.style {
        Style::RotatingStrokes(_) if frame.has_highlight_strokes => 0.6,
        Style::RotatingStrokes(_) | Style::SumiE(_) | Style::Reference => 1.0,
    }
}
