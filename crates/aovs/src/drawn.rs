//! The drawn picture that channels are read from, and the channels that were found.

use impasto_frame_files::exr_file::{Channel, Note};
use impasto_painting::{Frame, FrameOptions, Painting};
use impasto_scene::aovs::AovSet;

/// A picture that was drawn, and the AOVs wanted of it.
pub struct Drawn<'a> {
    /// The painting.
    pub painting: &'a Painting,
    /// The frame, with its strokes, as the renderer drew it last.
    pub frame: &'a Frame,
    /// The frame's number.
    pub number: f64,
    /// The options that the frame was made with.
    pub options: &'a FrameOptions,
    /// The AOVs wanted; those that the style lacks are left out.
    pub wanted: AovSet,
}

/// The channels of a picture, and the notes that belong to them.
#[derive(Clone, Debug, Default)]
pub struct Found {
    /// R, G, B and A, then what was wanted.
    pub channels: Vec<Channel>,
    /// Notes by name.
    pub notes: Vec<(String, Note)>,
}
