//! Measures M6, reveal coherence: whether strokes that the reference view did not see agree with their neighbours, in
//! views from about 90 and 180 degrees round the target.

use impasto_painting::Rotation;

use super::popping::left_out;
use crate::cameras::orbited;
use crate::context::MeasureContext;
use crate::figures::Spread;
use crate::metric::Metric;
use crate::options::MeasureError;
use crate::report::{LEAST_STROKES, Reading, Row, Verdict};
use crate::reveal::{Difference, NEIGHBOURS, revealed};
use crate::versions::{SceneVersion, TurnSolver};

/// Views from about a quarter of the way round; several, so that there are enough strokes.
const QUARTER_DEG: [f64; 6] = [-90.0, 90.0, -100.0, 100.0, -80.0, 80.0];
/// Views from about half of the way round.
const HALF_DEG: [f64; 5] = [180.0, 170.0, 190.0, 160.0, 200.0];

pub(super) fn row(context: &mut MeasureContext<'_>) -> Result<Row, MeasureError> {
    let mut row = Row::new(
        Metric::M6,
        "camera round its target by 80 to 100 and by 160 to 200 deg; body layer without chance, second families and contour; \
         strokes that the reference view saw from behind, against their 10 nearest visible neighbours of the \
         same region that face the same way and lie within 1.5 lengths; poles are the singular points of the directions",
        "90 deg: median ≤ 3, p95 ≤ 12; 180 deg: median ≤ 6, p95 ≤ 25",
    );
    let versions = [
        ("", SceneVersion::NoChance(TurnSolver::Own)),
        ("the paper's rule, ", SceneVersion::NoChancePaper),
        ("horn, ", SceneVersion::NoChance(TurnSolver::Horn)),
    ];
    let mut judged = Vec::new();
    for (index, (rule, version)) in versions.into_iter().enumerate() {
        let few = if index == 0 { usize::MAX } else { 2 };
        for (angle, views) in [("90 deg", &QUARTER_DEG[..]), ("180 deg", &HALF_DEG[..])] {
            let views = &views[..views.len().min(few)];
            let mut differences = Vec::new();
            for &angle_deg in views {
                let camera = orbited(&context.reference_camera(), angle_deg);
                let shown = context.drawn_view(version, &camera)?;
                let painting = context.painting(version)?;
                differences.extend(revealed(&painting, &shown.strokes, context.size_px));
            }
            let all = spread(&differences, |_| true);
            let spread = spread(&differences, |found| !found.near_pole);
            let what = format!("{rule}{angle}: to a neighbour, away from poles");
            let reading = Reading::many(what, "deg", spread);
            if index == 0 {
                row.values.push(reading);
                row.values.push(Reading::many(format!("{angle}: all"), "deg", all));
                row.notes.push(format!("{angle}: {}", by_object(context, &differences)));
                row.counts.frames += views.len();
                row.counts.strokes += spread.count / NEIGHBOURS;
                judged.push(spread);
            } else {
                row.baselines.push(reading);
            }
        }
    }
    on_shot(context, &mut row)?;
    left_out(context, &mut row);
    row.notes.push("a constant angle scores 0: read it with M3".to_owned());
    let fits = |spread: &Spread, median: f64, p95: f64| spread.median <= median && spread.p95 <= p95;
    let holds = fits(&judged[0], 3.0, 12.0) && fits(&judged[1], 6.0, 25.0);
    row.verdict = Verdict::of(holds, row.counts);
    if judged.iter().any(|spread| spread.count < LEAST_STROKES * NEIGHBOURS) {
        let counts: Vec<String> =
            judged.iter().map(|spread| (spread.count / NEIGHBOURS).to_string()).collect();
        row.verdict = Verdict::TooFew(format!("{} strokes at 90 and 180 deg", counts.join(" and ")));
    }
    Ok(row)
}

fn spread(differences: &[Difference], counts: impl Fn(&Difference) -> bool) -> Spread {
    Spread::of(differences.iter().filter(|found| counts(found)).map(|found| found.apart_deg).collect())
}

/// A note with the figures of each object.
fn by_object(context: &MeasureContext<'_>, differences: &[Difference]) -> String {
    let scene = SceneVersion::Orbit.of(context.loaded, &[]).scene;
    let words = scene.objects.iter().zip(1..).filter_map(|(object, id)| {
        let spread = spread(differences, |found| found.body_id == id && !found.near_pole);
        (spread.count > 0).then(|| {
            format!(
                "{} {:.1} and {:.1} ({})",
                object.name,
                spread.median,
                spread.p95,
                spread.count / NEIGHBOURS
            )
        })
    });
    format!("median and p95 by object: {}", words.collect::<Vec<_>>().join(", "))
}

/// Adds the same measure on the frames of the shot. It is printed but not judged.
fn on_shot(context: &mut MeasureContext<'_>, row: &mut Row) -> Result<(), MeasureError> {
    let version = SceneVersion::NoContour(TurnSolver::Own);
    let painting = context.painting(version)?;
    let mut differences = Vec::new();
    for frame in context.frames() {
        let shown = context.drawn_frame(version, frame, Rotation::On)?;
        differences.extend(revealed(&painting, &shown.strokes, context.size_px));
    }
    if !differences.is_empty() {
        row.values.push(Reading::many(
            "the shot, with its chance: to a neighbour",
            "deg",
            spread(&differences, |_| true),
        ));
    }
    Ok(())
}
