//! The protocols: for each metric, which frames and views are measured, and the row of the report.

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
mod whole_shot;

use crate::context::MeasureContext;
use crate::metric::Metric;
use crate::options::MeasureError;
use crate::report::{Row, Series};

/// The reason to give where a metric needs several frames and the shot has only one.
pub(crate) const ONE_FRAME: &str = "the shot has one frame";

/// The reason to give where a metric needs three frames and the shot has fewer.
pub(crate) const FEW_FRAMES: &str = "the shot has fewer than three frames";

/// Measures one metric; may add series over the frames of the shot.
pub(crate) fn row(
    metric: Metric,
    context: &mut MeasureContext<'_>,
    series: &mut Vec<Series>,
) -> Result<Row, MeasureError> {
    match metric {
        Metric::M1 => roll::pictures(context),
        Metric::M2 => roll::angles(context),
        Metric::M3 => turns::row(context, series),
        Metric::M4 => popping::row(context, series),
        Metric::M5 => warp::row(context),
        Metric::M6 => reveal::row(context),
        Metric::M7 => shower_door::row(context, series),
        Metric::M8 => flatness::row(context),
        Metric::M9 => coverage::row(context),
        Metric::M10 => jitter::row(context),
        Metric::M11 => authoring::row(context),
        Metric::M12 => speed::row(context),
        Metric::M13 => replay::row(context),
        Metric::M14 => density::row(context),
        Metric::M15 => whole_shot::chatter(context, series),
        Metric::M16 => whole_shot::steps(context, series),
        Metric::M17 => whole_shot::flicker(context, series),
    }
}
