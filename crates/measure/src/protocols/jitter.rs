//! Measures M10, angular jitter: how much more unevenly strokes turn over three neighbouring frames than the analytic
//! turn does.

use std::collections::BTreeMap;

use impasto_painting::Rotation;
use impasto_scene::motion;

use super::FEW_FRAMES;
use super::turns::uses_horn;
use crate::context::MeasureContext;
use crate::jitter::Jitter;
use crate::metric::Metric;
use crate::options::MeasureError;
use crate::report::{Counts, Reading, Row, Verdict};
use crate::strokes::{StrokeKey, strokes_by_key};
use crate::turns::{Reference, Turn};
use crate::versions::{SceneVersion, TurnSolver};

pub(super) fn row(context: &mut MeasureContext<'_>) -> Result<Row, MeasureError> {
    let mut row = Row::new(
        Metric::M10,
        "three neighbouring frames of the shot; body layer without contour, strokes that the reference faces by cos 0.5",
        "excess over the analytic curve ≤ 5 %",
    );
    let timeline = &context.loaded.scene.timeline;
    if timeline.last - timeline.first < 2 {
        return Ok(row.not_applicable(FEW_FRAMES));
    }
    let ours = jitter(context, Rotation::On)?;
    let random = jitter(context, Rotation::Random)?;
    row.counts = Counts { strokes: ours.triples, pixels: 0, frames: 3 * context.pairs().len() };
    row.values = vec![
        Reading::one("acceleration drawn, mean", "deg per frame²", ours.drawn_deg),
        Reading::one("analytic, mean", "deg per frame²", ours.analytic_deg),
        Reading::one("excess", "%", 100.0 * ours.excess()),
    ];
    row.baselines.push(Reading::one("random per frame", "deg per frame²", random.drawn_deg));
    let judged = !uses_horn(context);
    if !judged {
        row.notes.push("the scene asks for horn: printed, not judged".to_owned());
    }
    row.verdict = Verdict::of(!judged || ours.excess() <= 0.05, row.counts);
    Ok(row)
}

fn jitter(context: &mut MeasureContext<'_>, rotation: Rotation) -> Result<Jitter, MeasureError> {
    let painting = context.painting(SceneVersion::NoContour(TurnSolver::Own))?;
    let reference = Reference::of(&painting, context.size_px);
    let options = context.frame_options(rotation);
    let scene = &context.loaded.scene;
    let last = scene.timeline.last as f64;
    let turns = |frame: f64| -> BTreeMap<StrokeKey, Turn> {
        let camera = motion::camera_at(scene, frame);
        let strokes = strokes_by_key(&painting.at(frame, &options), &[]);
        reference.turns(&painting, &strokes, &camera, frame, options.size_px)
    };
    let mut triples = Vec::new();
    for [first, _] in context.pairs() {
        let first = first.min(last - 2.0);
        let [before, now, after] = [0.0, 1.0, 2.0].map(|step| turns(first + step));
        triples.extend(before.iter().filter_map(|(key, before)| {
            let three = [before, now.get(key)?, after.get(key)?];
            Some((three.map(|turn| turn.angle_rad), three.map(Turn::expected_rad)))
        }));
    }
    Ok(Jitter::of(triples.into_iter()))
}
