//! The picture of the viewport that marks are made for, with its camera and frame.

use impasto_scene::motion::CameraPose;

/// A picture of the viewport: the only one, or one of the two that are compared.
pub(super) struct PictureView<'a> {
    /// In a comparison, 0 for the picture at the reference and 1 for the current one; otherwise 0.
    pub(super) index: usize,
    pub(super) camera: &'a CameraPose,
    pub(super) frame: f64,
}
