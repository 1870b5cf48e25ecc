//! From a scene to a row: which views are taken, and what is said of them.

mod authoring;
mod coverage;
mod density;
mod flatness;
mod guides;
mod jitter;
mod popping;
mod replay;
mod reveal;
mod roll;
mod shower_door;
mod speed;
mod turns;
mod warp;

use crate::metric::Metric;
use crate::options::MeasureError;
use crate::report::{Row, Series};
use crate::studio::Studio;

/// What is said of a shot of one frame.
pub(crate) const ONE_FRAME: &str = "the shot has one frame";

/// Measures one metric.
pub(crate) fn row(
    metric: Metric,
    studio: &mut Studio<'_>,
    series: &mut Vec<Series>,
) -> Result<Row, MeasureError> {
    match metric {
        Metric::M1 => roll::pictures(studio),
        Metric::M2 => roll::angles(studio),
        Metric::M3 => turns::row(studio, series),
        Metric::M4 => popping::row(studio, series),
        Metric::M5 => warp::row(studio),
        Metric::M6 => reveal::row(studio),
        Metric::M7 => shower_door::row(studio, series),
        Metric::M8 => flatness::row(studio),
        Metric::M9 => coverage::row(studio),
        Metric::M10 => jitter::row(studio),
        Metric::M11 => authoring::row(studio),
        Metric::M12 => speed::row(studio),
        Metric::M13 => replay::row(studio),
        Metric::M14 => density::row(studio),
    }
}
