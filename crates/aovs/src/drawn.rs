//! What channels are found from, and what is found.

use impasto_frame_files::exr_file::{Channel, Note};
use impasto_painting::{Frame, FrameOptions, Painting};
use impasto_scene::aovs::AovSet;

/// A picture that was drawn, and what is wanted of it.
pub struct Drawn<'a> {
    /// The painting.
    pub painting: &'a Painting,
    /// The frame, with its strokes, as the renderer drew it last.
    pub frame: &'a Frame,
    /// Its number.
    pub number: f64,
    /// How it was made.
    pub options: &'a FrameOptions,
    /// What is wanted; what the style lacks is left out.
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
