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

/// The share of strong highlights that the colour of the reference picture has. Of a highlight that passes over a body the
/// strokes below take a part, so that they stay calm; the strokes of highlights, where there are any, add the rest.
pub(crate) fn highlight_in_color(frame: &Frame) -> f32 {
    match frame.style {
        Style::RotatingStrokes(_) if frame.has_highlight_strokes => 0.6,
        Style::RotatingStrokes(_) | Style::SumiE(_) | Style::Reference => 1.0,
    }
}
