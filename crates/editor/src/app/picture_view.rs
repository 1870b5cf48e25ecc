//! Which of the viewport's pictures marks are made for, and how it looks at the scene.

use impasto_scene::motion::CameraPose;

/// One of the two pictures of a comparison; one alone is the first.
pub(super) struct PictureView<'a> {
    pub(super) index: usize,
    pub(super) camera: &'a CameraPose,
    pub(super) frame: f64,
}
