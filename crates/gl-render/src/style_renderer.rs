//! The trait that every style's renderer implements, and the input that such a renderer draws from.

use std::cell::Cell;

use impasto_painting::Frame;

use crate::drawn::PaintSurface;
use crate::encode::Output;
use crate::fragments::PaintedLayer;
use crate::gl::{GlError, Halt};
use crate::keeps::Keeps;
use crate::lighting::LightSetup;
use crate::meshes::DrawnBody;
use crate::reference_targets::ReferenceTargets;
use crate::samples::Samples;
use crate::watch::Watch;

/// What a style draws a frame from.
pub(crate) struct StyleInput<'a> {
    pub(crate) frame: &'a Frame,
    pub(crate) reference: &'a ReferenceTargets,
    pub(crate) lights: &'a LightSetup,
    /// Taken once, by a style that reads them.
    pub(crate) samples: Cell<Option<Samples>>,
    /// The bodies of the frame, in its order.
    pub(crate) bodies: &'a [DrawnBody<'a>],
    /// Whether the paint's layers and its surface are wanted too, where the style has them.
    pub(crate) gathers: bool,
    pub(crate) keeps: Keeps,
}

/// Draws frames in one style.
pub(crate) trait StyleRenderer {
    /// Runs the style's passes, which leave the picture in `output`: display-linear, straight alpha. If `input.keeps`
    /// is not everything, the style's own targets are freed at the end.
    fn draw(
        &mut self,
        input: &StyleInput<'_>,
        output: &mut Output<'_>,
        watch: &mut Watch<'_>,
    ) -> Result<(), Halt>;

    /// Creates all programs at once, also those that are usually created when first needed.
    fn ready_all(&mut self) -> Result<(), GlError> {
        Ok(())
    }

    /// What the resolve pass found for each stroke of the last frame, eight floats each: colour and presence, its
    /// centre in pixels, a number whose meaning depends on the style, and the turn added to its angle in radians. Empty
    /// for styles without strokes.
    fn read_resolved(&self) -> Vec<[f32; 8]> {
        Vec::new()
    }

    /// Whether the style reads the unlit targets of the reference pass.
    fn reads_unlit(&self) -> bool {
        false
    }

    /// The paint of the last frame, premultiplied and display-linear, without background, bottom row first. Empty for
    /// styles that keep no paint, and if not everything is kept.
    fn read_paint(&self) -> Vec<[f32; 4]> {
        Vec::new()
    }

    /// The layers of paint of the last frame, if they were gathered; they can be taken once.
    fn take_layers(&mut self) -> Vec<PaintedLayer> {
        Vec::new()
    }

    /// The surface of the paint of the last frame, if it was gathered; bottom row first.
    fn read_paint_surface(&self) -> Option<PaintSurface> {
        None
    }
}
