//! The picture of the viewport that marks are made for: which one, its camera and its frame.

use impasto_scene::motion::CameraPose;

/// A picture of the viewport: index 0, or in a comparison 0 (the reference) and 1 (now).
pub(super) struct PictureView<'a> {
    pub(super) index: usize,
    pub(super) camera: &'a CameraPose,
    pub(super) frame: f64,
}
