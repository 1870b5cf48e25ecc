//! M12, speed: wall clock times of preparing, solving and drawing; printed, not judged.

use std::time::Instant;

use impasto_painting::{Rotation, prepare};

use crate::context::MeasureContext;
use crate::figures::Spread;
use crate::metric::Metric;
use crate::options::MeasureError;
use crate::report::{Counts, Reading, Row};

pub(super) fn row(context: &mut MeasureContext<'_>) -> Result<Row, MeasureError> {
    let mut row = Row::new(
        Metric::M12,
        "wall clock on this machine, the scene as it is; what the driver waits for is in the frame",
        "none; the benchmarks have tables",
    );
    let start = Instant::now();
    let painting = prepare(context.loaded.clone())?;
    let prepared = start.elapsed().as_secs_f64();
    let options = context.frame_options(Rotation::On);
    let (mut solves, mut draws) = (Vec::new(), Vec::new());
    for frame in context.frames().into_iter().take(4) {
        let start = Instant::now();
        let frame = painting.at(frame, &options);
        solves.push(start.elapsed().as_secs_f64() * 1e3);
        let start = Instant::now();
        context.renderer.render(&frame)?;
        draws.push(start.elapsed().as_secs_f64() * 1e3);
        row.counts.strokes += frame.strokes.len();
    }
    row.counts = Counts { frames: solves.len(), ..row.counts };
    row.values = vec![
        Reading::one(format!("prepare {} particles", painting.particle_total()), "s", prepared),
        Reading::many("solve a frame", "ms", Spread::of(solves)),
        Reading::many("draw it", "ms", Spread::of(draws)),
    ];
    Ok(row)
}
