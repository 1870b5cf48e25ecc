//! Measures how steady a painting is, by the metrics M1 to M17 ([`Metric`] lists them).
//!
//! ```text
//! pictures, strokes ─▶ formulas on plain data     plane, strokes, popping, warp, shower_door, coverage, ...
//! scene ─▶ altered versions of it, fixed camera motions ─▶ a context that prepares and draws them
//!       ─▶ protocols: one row per metric ─▶ report
//! ```

pub mod cameras;
pub mod chatter;
pub mod context;
pub mod correlation;
pub mod coverage;
pub mod covered;
pub mod density;
pub mod figures;
pub mod flatness;
pub mod flicker;
pub mod jitter;
mod metric;
mod options;
pub mod orientation;
pub mod plane;
pub mod plot;
pub mod popping;
mod protocols;
pub mod report;
pub mod reveal;
pub mod roll;
pub mod sheet;
pub mod shot;
pub mod shower_door;
pub mod steps;
pub mod strokes;
pub mod truth;
pub mod turning;
pub mod turns;
mod turntable;
pub mod versions;
pub mod warp;

use std::sync::Arc;
use std::time::Instant;

use impasto_scene::loaded::LoadedScene;

pub use metric::Metric;
pub use options::{MeasureError, MeasureOptions, Progress};
pub use report::{MeasureReport, Row, Verdict};
pub use turntable::turntable;

use context::MeasureContext;

/// Measures a scene. Rows come in the order of the metrics.
///
/// # Errors
/// When no driver can be opened, or a version of the scene cannot be prepared or drawn.
pub fn measure(
    loaded: &Arc<LoadedScene>,
    options: &MeasureOptions,
    progress: &mut dyn FnMut(&Progress),
) -> Result<MeasureReport, MeasureError> {
    let start = Instant::now();
    let mut context = MeasureContext::open(loaded, options)?;
    let mut metrics = options.metrics.clone();
    metrics.sort_unstable();
    metrics.dedup();
    let (mut rows, mut series) = (Vec::new(), Vec::new());
    for (done, &metric) in metrics.iter().enumerate() {
        progress(&Progress { metric, done, of: metrics.len() });
        let since = Instant::now();
        let mut row = protocols::row(metric, &mut context, &mut series)?;
        row.seconds = since.elapsed().as_secs_f64();
        rows.push(row);
        context.forget();
    }
    let faults = context.faults();
    context.warnings.extend(faults);
    Ok(MeasureReport {
        scene: loaded.path.display().to_string(),
        driver: context.renderer.report().to_string(),
        size_px: context.size_px,
        seconds: start.elapsed().as_secs_f64(),
        rows,
        series,
        warnings: context.warnings,
    })
}
