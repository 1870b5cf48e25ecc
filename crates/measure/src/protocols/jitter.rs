//! M10 on the shot.

use std::collections::BTreeMap;

use impasto_painting::Rotation;
use impasto_scene::motion;

use super::ONE_FRAME;
use super::turns::uses_horn;
use crate::jitter::Jitter;
use crate::looks::{Look, TurnSolver};
use crate::metric::Metric;
use crate::options::MeasureError;
use crate::report::{Counts, Reading, Row, Verdict};
use crate::strokes::{StrokeKey, seen};
use crate::studio::Studio;
use crate::turns::{Reference, Turn};

pub(super) fn row(studio: &mut Studio<'_>) -> Result<Row, MeasureError> {
    let mut row = Row::new(
        Metric::M10,
        "three neighbouring frames of the shot; body layer without contour, strokes that the reference faces by cos 0.5",
        "excess over the analytic curve ≤ 5 %",
    );
    let timeline = &studio.loaded.scene.timeline;
    if timeline.last - timeline.first < 2 {
        return Ok(row.not_applicable(ONE_FRAME.replace("one frame", "fewer than three frames")));
    }
    let ours = jitter(studio, Rotation::On)?;
    let random = jitter(studio, Rotation::Random)?;
    row.counts = Counts { strokes: ours.triples, pixels: 0, frames: 3 * studio.pairs().len() };
    row.values = vec![
        Reading::one("acceleration drawn, mean", "deg per frame²", ours.drawn_deg),
        Reading::one("analytic, mean", "deg per frame²", ours.analytic_deg),
        Reading::one("excess", "%", 100.0 * ours.excess()),
    ];
    row.baselines.push(Reading::one("random per frame", "deg per frame²", random.drawn_deg));
    let judged = !uses_horn(studio);
    if !judged {
        row.notes.push("the scene asks for horn: printed, not judged".to_owned());
    }
    row.verdict = Verdict::of(!judged || ours.excess() <= 0.05, row.counts);
    Ok(row)
}

fn jitter(studio: &mut Studio<'_>, rotation: Rotation) -> Result<Jitter, MeasureError> {
    let painting = studio.painting(Look::Truth(TurnSolver::Own))?;
    let reference = Reference::of(&painting, studio.size_px);
    let options = studio.frame_options(rotation);
    let scene = &studio.loaded.scene;
    let last = scene.timeline.last as f64;
    let turns = |frame: f64| -> BTreeMap<StrokeKey, Turn> {
        let camera = motion::camera_at(scene, frame);
        let strokes = seen(&painting.at(frame, &options), &[]);
        reference.turns(&painting, &strokes, (&camera, frame), options.size_px)
    };
    let mut triples = Vec::new();
    for [first, _] in studio.pairs() {
        let first = first.min(last - 2.0);
        let [before, now, after] = [0.0, 1.0, 2.0].map(|step| turns(first + step));
        triples.extend(before.iter().filter_map(|(key, before)| {
            let three = [before, now.get(key)?, after.get(key)?];
            Some((three.map(|turn| turn.angle_rad), three.map(Turn::expected_rad)))
        }));
    }
    Ok(Jitter::of(triples.into_iter()))
}
