//! M7 on the shot.

use std::rc::Rc;

use impasto_painting::Rotation;
use impasto_painting::frame::LayerKind;
use impasto_scene::motion;

use super::ONE_FRAME;
use crate::looks::{Look, TurnSolver};
use crate::metric::Metric;
use crate::options::MeasureError;
use crate::report::{Reading, Row, Series, Verdict};
use crate::shower_door::{Lag, Pair, ShowerDoor, lag, share_moved, shower_door};
use crate::strokes::{SeenStrokes, of_layer, seen};
use crate::studio::{Shown, Studio};
use crate::turns::Reference;
use crate::warp::places_then;

/// Mean of several pairs of frames, weighted by pixels.
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

pub(super) fn row(studio: &mut Studio<'_>, series: &mut Vec<Series>) -> Result<Row, MeasureError> {
    let mut row = Row::new(
        Metric::M7,
        "pairs of frames of the shot, so far apart that half of what moves has moved by more than half a stroke; on a board, unlit, \
         luma finer than half a stroke within each body; pixels that moved so far",
        "abs S ≤ 0.1, C printed, abs arg L ≤ 0.1 deg",
    );
    let starts: Vec<f64> = studio.pairs().iter().map(|pair| pair[0]).collect();
    if starts.is_empty() {
        return Ok(row.not_applicable(ONE_FRAME));
    }
    let (mut ours, mut fixed, mut points, mut steps) =
        (Mean::default(), Mean::default(), Vec::new(), Vec::new());
    for &start in &starts {
        let now = studio.show(Look::Unlit, start, Rotation::On)?;
        let stroke_px = median_length_px(&now.strokes);
        let Some(step) = least_step(studio, &now, start, stroke_px)? else { continue };
        let then = studio.show(Look::Unlit, start + step, Rotation::On)?;
        let places = places_then(&studio.motion(&now.frame, &then.frame)?, &then.reference);
        let compare = |now: &Rc<Shown>, then: &Rc<Shown>| {
            shower_door(&Pair {
                pictures: [&now.luma, &then.luma],
                body_ids: [&now.reference.body_id, &then.reference.body_id],
                places: &places,
                stroke_px,
            })
        };
        let found = compare(&now, &then);
        points.push((start, found.same_pixels.abs()));
        steps.push(step);
        ours.add(found);
        let now = studio.show(Look::Unlit, start, Rotation::Off)?;
        let then = studio.show(Look::Unlit, start + step, Rotation::Off)?;
        fixed.add(compare(&now, &then));
    }
    if steps.is_empty() {
        return Ok(row.not_applicable("nothing in the shot moves by half a stroke"));
    }
    let turned = lag_of(studio, Rotation::On)?;
    let unturned = lag_of(studio, Rotation::Off)?;
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

fn median_length_px(strokes: &SeenStrokes) -> f64 {
    let mut lengths: Vec<f64> = of_layer(strokes, LayerKind::Body)
        .filter(|(_, stroke)| stroke.alpha > 0.5)
        .map(|(_, stroke)| stroke.length_px)
        .collect();
    lengths.sort_by(f64::total_cmp);
    lengths.get(lengths.len() / 2).copied().unwrap_or(1.0)
}

/// The least number of frames after which half of the moving bodies' pixels have moved by more than half a stroke.
fn least_step(
    studio: &mut Studio<'_>,
    now: &Shown,
    start: f64,
    stroke_px: f64,
) -> Result<Option<f64>, MeasureError> {
    let painting = studio.painting(Look::Unlit)?;
    let options = studio.frame_options(Rotation::On);
    let most = studio.loaded.scene.timeline.last as f64 - start;
    let mut moved = |step: f64| -> Result<bool, MeasureError> {
        let then = painting.at(start + step, &options);
        let motion = studio.motion(&now.frame, &then)?;
        let bodies = now.frame.bodies.len() as u32;
        let moves: Vec<bool> =
            (0..=bodies).map(|id| share_moved(&motion, |other| other == id, 0.02) > 0.5).collect();
        Ok(share_moved(&motion, |id| moves[id as usize], 0.5 * stroke_px) > 0.5)
    };
    // Far enough by doubling, then the least by halving.
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

/// L over the strokes of the shot that have turned at all.
fn lag_of(studio: &mut Studio<'_>, rotation: Rotation) -> Result<Lag, MeasureError> {
    let painting = studio.painting(Look::Truth(TurnSolver::Own))?;
    let reference = Reference::of(&painting, studio.size_px);
    let options = studio.frame_options(rotation);
    let mut turns = Vec::new();
    for frame in studio.frames() {
        let camera = motion::camera_at(&studio.loaded.scene, frame);
        let now = seen(&painting.at(frame, &options), &[]);
        turns.extend(reference.turns(&painting, &now, (&camera, frame), options.size_px).into_values());
    }
    Ok(lag(turns.iter().filter(|turn| !turn.truth.is_still())))
}
