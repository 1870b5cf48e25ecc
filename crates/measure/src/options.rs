//! The options of a measurement, its progress, and why it may fail.

use impasto_gl_render::context::Driver;

use crate::metric::Metric;

/// What to measure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeasureOptions {
    /// Width and height of the pictures; half the scene's own where it is `None`.
    pub size_px: Option<[u32; 2]>,
    /// How many pairs of neighbouring frames of the shot are measured, at most.
    pub pairs: usize,
    /// Which metrics.
    pub metrics: Vec<Metric>,
    /// The driver that draws.
    pub driver: Driver,
}

impl Default for MeasureOptions {
    fn default() -> Self {
        Self { size_px: None, pairs: 8, metrics: Metric::ALL.to_vec(), driver: Driver::Auto }
    }
}

/// How far a measurement has come.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Progress {
    /// The metric being measured.
    pub metric: Metric,
    /// How many metrics are done.
    pub done: usize,
    /// How many metrics there are.
    pub of: usize,
}

/// Why nothing was measured.
#[derive(Debug, thiserror::Error)]
pub enum MeasureError {
    /// No driver could be opened.
    #[error(transparent)]
    Context(#[from] impasto_gl_render::context::ContextError),
    /// A frame could not be drawn.
    #[error(transparent)]
    Render(#[from] impasto_gl_render::RenderError),
    /// The scene, or a version of it, could not be prepared.
    #[error(transparent)]
    Prepare(#[from] impasto_painting::PrepareError),
}
