//! What to measure, and how finely.

use impasto_gl_render::context::Driver;

use crate::metric::Metric;

/// What to measure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeasureOptions {
    /// Width and height of the pictures; half the scene's own where it is `None`.
    pub size_px: Option<[u32; 2]>,
    /// How many pairs of neighbouring frames of the shot are looked at.
    pub pairs: usize,
    /// Which metrics.
    pub metrics: Vec<Metric>,
    /// Which library draws.
    pub driver: Driver,
}

impl Default for MeasureOptions {
    fn default() -> Self {
        Self { size_px: None, pairs: 8, metrics: Metric::ALL.to_vec(), driver: Driver::Auto }
    }
}

/// How far a run has come.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Progress {
    /// The metric at hand.
    pub metric: Metric,
    /// How many are done.
    pub done: usize,
    /// How many there are.
    pub of: usize,
}

/// Why nothing was measured.
#[derive(Debug, thiserror::Error)]
pub enum MeasureError {
    /// No driver.
    #[error(transparent)]
    Context(#[from] impasto_gl_render::context::ContextError),
    /// A frame was not drawn.
    #[error(transparent)]
    Render(#[from] impasto_gl_render::RenderError),
    /// The scene, or a version of it, was not prepared.
    #[error(transparent)]
    Prepare(#[from] impasto_painting::PrepareError),
}
