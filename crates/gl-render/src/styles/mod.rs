//! The styles: each draws with its own targets and passes, and knows no other style.

mod reference;
mod rotating_strokes;
mod sumi_e;

use impasto_painting::frame::Style;

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
