//! Computes the frame of one view for the renderer: as a draft or exactly, painted or only shaded.

use std::borrow::Cow;

use impasto_editor_model::session::Shading;
use impasto_painting::frame::Style;
use impasto_painting::{Frame, FrameOptions, Painting, Quality, Recall, StrokeColors};

use super::ViewJob;

pub(super) struct DrawOptions<'a> {
    /// Width and height of the picture in pixels: those of the view, or less in a draft.
    pub(super) size_px: [u32; 2],
    /// Whether it is drawn as for a file, not as a draft.
    pub(super) is_exact: bool,
    /// Called while an exact picture is drawn: true ends the drawing.
    pub(super) give_up: &'a dyn Fn() -> bool,
}

pub(super) fn frame_options(view: &ViewJob, draw: &DrawOptions<'_>) -> FrameOptions {
    let share = draw.size_px[1] as f32 / view.size_px[1] as f32;
    FrameOptions {
        shot_height_px: Some(view.shot_height_px * share),
        quality: if draw.is_exact { Quality::Exact } else { Quality::Draft },
        colors: match view.shading {
            Shading::Trust => StrokeColors::Trust,
            Shading::Painted | Shading::Shaded => StrokeColors::Scene,
        },
        ..FrameOptions::new(draw.size_px)
    }
}

/// The frame of a view. A draft may leave out strokes that were absent from the picture of `recall`.
pub(super) fn frame_of(
    painting: &Painting,
    view: &ViewJob,
    draw: &DrawOptions<'_>,
    recall: Option<&Recall>,
) -> Frame {
    let painting = styled(painting, view.shading);
    let options = frame_options(view, draw);
    let mut frame = painting.bare(&view.camera, view.frame, &options);
    let recall = recall.filter(|_| !draw.is_exact);
    frame.lay(painting.strokes(&view.camera, view.frame, &options, recall));
    frame
}

/// The painting in the style that a view's shading asks for; prepared data is shared.
pub(super) fn styled(painting: &Painting, shading: Shading) -> Cow<'_, Painting> {
    match shading {
        Shading::Shaded => Cow::Owned(painting.in_style(Style::Reference)),
        Shading::Painted | Shading::Trust => Cow::Borrowed(painting),
    }
}
