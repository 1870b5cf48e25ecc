//! Measures M5, the warp error, on neighbouring frames of the shot: with our angles, and to compare, with the paper's
//! rule, with random angles and with fixed ones.

use impasto_painting::Rotation;

use super::ONE_FRAME;
use crate::context::MeasureContext;
use crate::metric::Metric;
use crate::options::MeasureError;
use crate::report::{Counts, Reading, Row, Verdict};
use crate::shower_door::share_moved;
use crate::versions::SceneVersion;
use crate::warp::{Warp, correspondences, warp_error};

/// A body whose pixels all move by less than this stands still.
const STILL_PX: f64 = 0.01;

pub(super) fn row(context: &mut MeasureContext<'_>) -> Result<Row, MeasureError> {
    let mut row = Row::new(
        Metric::M5,
        "neighbouring frames of the shot on a board, else as the scene looks; luma of the encoded picture, exact motion, \
         what is seen in both of bodies that move; all rules on the pixels of ours",
        "below the paper's rule, and ≤ 0.25 of random per frame",
    );
    let pairs = context.pairs();
    if pairs.is_empty() {
        return Ok(row.not_applicable(ONE_FRAME));
    }
    let rules = [
        ("", SceneVersion::Board, Rotation::On),
        ("the paper's rule", SceneVersion::Paper, Rotation::On),
        ("random per frame", SceneVersion::Board, Rotation::Random),
        ("fixed angle", SceneVersion::Board, Rotation::Off),
    ];
    let mut sums = [(0.0, 0usize); 4];
    let mut moves = false;
    for [first, second] in &pairs {
        let now = context.drawn_frame(SceneVersion::Board, *first, Rotation::On)?;
        let then = context.drawn_frame(SceneVersion::Board, *second, Rotation::On)?;
        let motion = context.motion(&now.frame, &then.frame)?;
        let bodies = 0..=now.frame.bodies.len() as u32;
        let moving: Vec<bool> =
            bodies.map(|id| share_moved(&motion, |other| other == id, STILL_PX) > 0.0).collect();
        moves |= moving.contains(&true);
        let mut correspondences = correspondences(&motion, &then.reference);
        for (place, &id) in correspondences.iter_mut().zip(&motion.body_id) {
            *place = place.filter(|_| moving[id as usize]);
        }
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
    let [ours, paper, random, fixed] = sums.map(|(sum, pixels)| sum / pixels.max(1) as f64);
    row.counts = Counts { strokes: 0, pixels: sums[0].1, frames: 2 * pairs.len() };
    row.values = vec![
        Reading::one("W", "squares of levels of 255", ours),
        Reading::one("of the paper's", "", ours / paper),
        Reading::one("of random's", "", ours / random),
    ];
    row.baselines = vec![
        Reading::one(rules[1].0, "", paper),
        Reading::one(rules[2].0, "", random),
        Reading::one(rules[3].0, "", fixed),
    ];
    row.verdict = Verdict::of_pixels(ours < paper && ours <= 0.25 * random, row.counts);
    Ok(row)
}
