//! Measures M7, the shower door effect: does the brushwork stand still on the picture while the surface moves under
//! it? It compares pairs of frames of the shot that are far enough apart for strokes to have moved.

use std::rc::Rc;

use impasto_painting::Rotation;
use impasto_painting::frame::LayerKind;
use impasto_scene::motion;

use super::ONE_FRAME;
use crate::context::{DrawnFrame, MeasureContext};
use crate::metric::Metric;
use crate::options::MeasureError;
use crate::report::{Reading, Row, Series, Verdict};
use crate::shower_door::{Lag, Pair, ShowerDoor, lag, share_moved, shower_door};
use crate::strokes::{StrokesByKey, of_layer, strokes_by_key};
use crate::turns::Reference;
use crate::versions::{SceneVersion, TurnSolver};
use crate::warp::correspondences;

/// Sums over several pairs of frames, weighted by pixels; `values` gives the means.
#[derive(Default)]
struct Mean {
    same_pixels: f64,
    same_points: f64,
    pixels: usize,
}

impl Mean {
    fn add(&mut self, found: ShowerDoor) {
        let weight = found.pixels as f64;
        self.same_pixels += found.same_pixels * weight;
        self.same_points += found.same_points * weight;
        self.pixels += found.pixels;
    }

    fn values(&self) -> [f64; 2] {
        [self.same_pixels, self.same_points].map(|sum| sum / self.pixels.max(1) as f64)
    }
}

pub(super) fn row(context: &mut MeasureContext<'_>, series: &mut Vec<Series>) -> Result<Row, MeasureError> {
    let mut row = Row::new(
        Metric::M7,
        "pairs of frames of the shot, so far apart that half of what moves has moved by more than half a stroke; on a board, unlit, \
         luma finer than half a stroke within each body; pixels that moved so far",
        "abs S ≤ 0.1, C printed, abs arg L ≤ 0.1 deg",
    );
    let starts: Vec<f64> = context.pairs().iter().map(|pair| pair[0]).collect();
    if starts.is_empty() {
        return Ok(row.not_applicable(ONE_FRAME));
    }
    let (mut ours, mut fixed, mut points, mut steps) =
        (Mean::default(), Mean::default(), Vec::new(), Vec::new());
    for &start in &starts {
        let now = context.drawn_frame(SceneVersion::Unlit, start, Rotation::On)?;
        let stroke_px = median_length_px(&now.strokes);
        let Some(step) = least_step(context, &now, start, stroke_px)? else { continue };
        let then = context.drawn_frame(SceneVersion::Unlit, start + step, Rotation::On)?;
        let correspondences = correspondences(&context.motion(&now.frame, &then.frame)?, &then.reference);
        let compare = |now: &Rc<DrawnFrame>, then: &Rc<DrawnFrame>| {
            shower_door(&Pair {
                pictures: [&now.luma, &then.luma],
                body_ids: [&now.reference.body_id, &then.reference.body_id],
                correspondences: &correspondences,
                stroke_px,
            })
        };
        let found = compare(&now, &then);
        points.push((start, found.same_pixels.abs()));
        steps.push(step);
        ours.add(found);
        let now = context.drawn_frame(SceneVersion::Unlit, start, Rotation::Off)?;
        let then = context.drawn_frame(SceneVersion::Unlit, start + step, Rotation::Off)?;
        fixed.add(compare(&now, &then));
    }
    if steps.is_empty() {
        return Ok(row.not_applicable("nothing in the shot moves by half a stroke"));
    }
    let turned = lag_of(context, Rotation::On)?;
    let unturned = lag_of(context, Rotation::Off)?;
    let [same_pixels, same_points] = ours.values();
    row.counts.pixels = ours.pixels;
    row.counts.strokes = turned.strokes;
    row.counts.frames = 2 * steps.len();
    row.values = vec![
        Reading::one("S, at the same pixels", "", same_pixels),
        Reading::one("C, at the same surface points", "", same_points),
        Reading::one("arg L, angles against the analytic turn", "deg", turned.arg_deg),
        Reading::one("|L|", "", turned.length),
    ];
    let [fixed_pixels, fixed_points] = fixed.values();
    row.baselines = vec![
        Reading::one("fixed angle: S", "", fixed_pixels),
        Reading::one("fixed angle: C", "", fixed_points),
        Reading::one("fixed angle: arg L", "deg", unturned.arg_deg),
        Reading::one("fixed angle: |L|", "", unturned.length),
    ];
    let distances: Vec<String> = steps.iter().map(|step| format!("{step}")).collect();
    row.notes.push(format!("frames between the pictures of a pair: {}", distances.join(", ")));
    row.verdict = Verdict::of(same_pixels.abs() <= 0.1 && turned.arg_deg <= 0.1, row.counts);
    if row.verdict == Verdict::Holds {
        row.verdict = Verdict::of_pixels(true, row.counts);
    }
    series.push(Series { metric: Metric::M7, title: "shower door |S|", target: 0.1, unit: "", points });
    Ok(row)
}

fn median_length_px(strokes: &StrokesByKey) -> f64 {
    let mut lengths: Vec<f64> = of_layer(strokes, LayerKind::Body)
        .filter(|(_, stroke)| stroke.alpha > 0.5)
        .map(|(_, stroke)| stroke.length_px)
        .collect();
    lengths.sort_by(f64::total_cmp);
    lengths.get(lengths.len() / 2).copied().unwrap_or(1.0)
}

/// The least number of frames after which half of the pixels of moving bodies have moved by more than half a stroke;
/// `None` if the shot ends before that.
fn least_step(
    context: &mut MeasureContext<'_>,
    now: &DrawnFrame,
    start: f64,
    stroke_px: f64,
) -> Result<Option<f64>, MeasureError> {
    let painting = context.painting(SceneVersion::Unlit)?;
    let options = context.frame_options(Rotation::On);
    let most = context.loaded.scene.timeline.last as f64 - start;
    let mut moved = |step: f64| -> Result<bool, MeasureError> {
        let then = painting.at(start + step, &options);
        let motion = context.motion(&now.frame, &then)?;
        let bodies = now.frame.bodies.len() as u32;
        let moves: Vec<bool> =
            (0..=bodies).map(|id| share_moved(&motion, |other| other == id, 0.02) > 0.5).collect();
        Ok(share_moved(&motion, |id| moves[id as usize], 0.5 * stroke_px) > 0.5)
    };
    // Doubles the step until it is far enough, then bisects.
    let mut far = 1.0;
    while !moved(f64::min(far, most))? {
        if far >= most {
            return Ok(None);
        }
        far *= 2.0;
    }
    let (mut near, mut far) = ((far * 0.5).floor(), far.min(most));
    while far - near > 1.0 {
        let middle = ((near + far) * 0.5).floor();
        if moved(middle)? { far = middle } else { near = middle }
    }
    Ok(Some(far))
}

/// The lag over those strokes of the shot whose surface has turned or changed shape in the picture since the reference
/// picture.
fn lag_of(context: &mut MeasureContext<'_>, rotation: Rotation) -> Result<Lag, MeasureError> {
    let painting = context.painting(SceneVersion::NoContour(TurnSolver::Own))?;
    let reference = Reference::of(&painting, context.size_px);
    let options = context.frame_options(rotation);
    let mut turns = Vec::new();
    for frame in context.frames() {
        let camera = motion::camera_at(&context.loaded.scene, frame);
        let now = strokes_by_key(&painting.at(frame, &options), &[]);
        turns.extend(reference.turns(&painting, &now, &camera, frame, options.size_px).into_values());
    }
    Ok(lag(turns.iter().filter(|turn| !turn.truth.is_still())))
}
