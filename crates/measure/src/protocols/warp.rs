//! Measures M5, the warp error. On neighbouring frames of the shot it compares our angles with the paper's rule and
//! with random angles. It also compares our angles with fixed angles. Fixed angles are hardly wrong over one frame, so
//! this comparison takes frames so far apart that strokes turn by several degrees between them.

use impasto_gl_render::MotionPixels;
use impasto_painting::Rotation;

use super::ONE_FRAME;
use crate::context::MeasureContext;
use crate::figures::Spread;
use crate::metric::Metric;
use crate::options::MeasureError;
use crate::popping::of_moving_bodies;
use crate::report::{Counts, Reading, Row, Verdict};
use crate::shower_door::share_moved;
use crate::strokes::{degrees_apart, strokes_by_key};
use crate::versions::SceneVersion;
use crate::warp::{Warp, correspondences, warp_error};

/// A body whose pixels all move by less than this stands still.
const STILL_PX: f64 = 0.01;

/// Fixed angles are compared over the number of frames in which half of the strokes turn by `TURN_DEG`. They are not
/// compared if that takes more than `MOST_FRAMES`.
const TURN_DEG: f64 = 12.0;
const MOST_FRAMES: u32 = 48;

pub(super) fn row(context: &mut MeasureContext<'_>) -> Result<Row, MeasureError> {
    let mut row = Row::new(
        Metric::M5,
        "neighbouring frames of the shot on a board, else as the scene looks; luma of the encoded picture, exact motion, \
         what is seen in both of bodies that move; all rules on the pixels of ours",
        "below the paper's rule, ≤ 0.25 of random per frame, ≤ 0.8 of fixed angles where strokes turn",
    );
    let pairs = context.pairs();
    if pairs.is_empty() {
        return Ok(row.not_applicable(ONE_FRAME));
    }
    let rules = [
        ("", SceneVersion::Board, Rotation::On),
        ("the paper's rule", SceneVersion::Paper, Rotation::On),
        ("random per frame", SceneVersion::Board, Rotation::Random),
    ];
    let mut sums = [(0.0, 0usize); 3];
    let mut moves = false;
    for [first, second] in &pairs {
        let now = context.drawn_frame(SceneVersion::Board, *first, Rotation::On)?;
        let then = context.drawn_frame(SceneVersion::Board, *second, Rotation::On)?;
        let motion = context.motion(&now.frame, &then.frame)?;
        moves |= share_moved(&motion, |id| id > 0, STILL_PX) > 0.0;
        let mut correspondences = correspondences(&motion, &then.reference);
        keep_moving(&mut correspondences, &motion);
        for (sum, (_, version, rotation)) in sums.iter_mut().zip(rules) {
            let now = context.drawn_frame(version, *first, rotation)?;
            let then = context.drawn_frame(version, *second, rotation)?;
            let Warp { error, pixels } = warp_error(&now.luma, &then.luma, &correspondences);
            *sum = (sum.0 + error * pixels as f64, sum.1 + pixels);
        }
    }
    if !moves {
        return Ok(row.not_applicable("nothing moves in the shot"));
    }
    let [ours, paper, random] = sums.map(|(sum, pixels)| sum / pixels.max(1) as f64);
    row.counts = Counts { strokes: 0, pixels: sums[0].1, frames: 2 * pairs.len() };
    row.values = vec![
        Reading::one("W", "squares of levels of 255", ours),
        Reading::one("of the paper's", "", ours / paper),
        Reading::one("of random's", "", ours / random),
    ];
    row.baselines = vec![Reading::one(rules[1].0, "", paper), Reading::one(rules[2].0, "", random)];
    let turned = turned(context)?;
    if let Some(Turned { frames, median_deg, ours, fixed }) = turned {
        let what = format!(
            "over {frames} frames, in which half of the strokes turn by {median_deg:.0} deg, of fixed angles'"
        );
        row.values.push(Reading::one(what, "", ours / fixed));
    } else {
        row.notes.push(format!(
            "strokes turn by less than {TURN_DEG} deg within {MOST_FRAMES} frames: fixed angles are right"
        ));
    }
    let beats_fixed = turned.is_none_or(|turned| turned.ours <= 0.8 * turned.fixed);
    row.verdict = Verdict::of_pixels(ours < paper && ours <= 0.25 * random && beats_fixed, row.counts);
    Ok(row)
}

/// Leaves out the bodies that stand still.
fn keep_moving(correspondences: &mut [Option<[f64; 2]>], motion: &MotionPixels) {
    let most = motion.body_id.iter().copied().max().unwrap_or(0);
    let moving: Vec<bool> =
        (0..=most).map(|id| share_moved(motion, |other| other == id, STILL_PX) > 0.0).collect();
    for (place, &id) in correspondences.iter_mut().zip(&motion.body_id) {
        *place = place.filter(|_| moving[id as usize]);
    }
}

/// The warp errors of our angles and of fixed angles between pictures `frames` apart, each summed over pixels: only the
/// ratio of the two has a meaning.
#[derive(Clone, Copy)]
struct Turned {
    frames: u32,
    median_deg: f64,
    ours: f64,
    fixed: f64,
}

/// The warp error over the number of frames in which half of the strokes turn by [`TURN_DEG`]; `None` if that takes
/// more frames than the shot has, or more than [`MOST_FRAMES`].
fn turned(context: &mut MeasureContext<'_>) -> Result<Option<Turned>, MeasureError> {
    let timeline = &context.loaded.scene.timeline;
    let (first, last) = (timeline.first as f64, timeline.last as f64);
    let painting = context.painting(SceneVersion::Unlit)?;
    let options = context.frame_options(Rotation::On);
    // Strokes on bodies that stand still do not count.
    let median_deg = |frame: f64, frames: f64| {
        let [before, after] =
            [frame, frame + frames].map(|frame| strokes_by_key(&painting.at(frame, &options), &[]));
        let [before, after] = of_moving_bodies(&before, &after);
        let apart = before
            .iter()
            .filter_map(|(key, then)| Some(degrees_apart(then.angle_rad, after.get(key)?.angle_rad)));
        Spread::of(apart.collect()).median
    };
    let mut found = None;
    for frames in 1..=MOST_FRAMES {
        let span = f64::from(frames);
        if first + span > last {
            break;
        }
        let median_deg = median_deg(first, span);
        if median_deg >= TURN_DEG {
            found = Some((frames, median_deg));
            break;
        }
    }
    let Some((frames, median_deg)) = found else { return Ok(None) };
    let mut sums = [0.0, 0.0];
    for place in 0..3 {
        let room = last - first - f64::from(frames);
        let start = first + (room * f64::from(place) / 2.0).floor();
        let [now, then] = [start, start + f64::from(frames)];
        let ours = [now, then].map(|frame| context.drawn_once(SceneVersion::Unlit, frame, Rotation::On));
        let fixed = [now, then].map(|frame| context.drawn_once(SceneVersion::Unlit, frame, Rotation::Off));
        let ([now, then], [fixed_now, fixed_then]) = (both(ours)?, both(fixed)?);
        let motion = context.motion(&now.frame, &then.frame)?;
        let mut correspondences = correspondences(&motion, &then.reference);
        keep_moving(&mut correspondences, &motion);
        for (sum, pair) in sums.iter_mut().zip([[&now, &then], [&fixed_now, &fixed_then]]) {
            let Warp { error, pixels } = warp_error(&pair[0].luma, &pair[1].luma, &correspondences);
            *sum += error * pixels as f64;
        }
    }
    let [ours, fixed] = sums;
    Ok(Some(Turned { frames, median_deg, ours, fixed: fixed.max(f64::MIN_POSITIVE) }))
}

fn both<T, E>([first, second]: [Result<T, E>; 2]) -> Result<[T; 2], E> {
    Ok([first?, second?])
}
