//! Measures M11, authoring: strokes must not change when the scene is saved and read again, or when its frames are made
//! in another order. They must keep their directions at twice the particles, and strokes on a guide must lie as drawn.

use std::path::Path;
use std::sync::Arc;

use impasto_painting::frame::LayerKind;
use impasto_painting::{Frame, Rotation};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::{load, save};

use super::guides;
use crate::context::{MeasureContext, prepare_anywhere};
use crate::figures::Spread;
use crate::metric::Metric;
use crate::options::MeasureError;
use crate::report::{Reading, Row, Verdict};
use crate::strokes::{degrees_apart, of_layer, strokes_by_key};
use crate::versions::SceneVersion;

pub(super) fn row(context: &mut MeasureContext<'_>) -> Result<Row, MeasureError> {
    let mut row = Row::new(
        Metric::M11,
        "frames of the shot: after saving and reading, in another order, and the reference picture with twice the particles \
         (without chance in the angle)",
        "strokes bit-equal after saving and in any order; at twice the density angles on average ≤ 3 deg apart; \
         at a guide, as drawn within 0.5 deg",
    );
    let painting = context.painting(SceneVersion::Unchanged)?;
    let options = context.frame_options(Rotation::On);
    let frames: Vec<f64> = context.frames().into_iter().take(3).collect();
    let in_order: Vec<Frame> = frames.iter().map(|&frame| painting.at(frame, &options)).collect();

    let text = save::to_ron(&context.loaded.scene);
    let saved = load::parse(Path::new("saved.ron"), &text).ok();
    let reread = match &saved {
        Some(scene) => {
            let again = prepare_anywhere(Arc::new(LoadedScene {
                scene: scene.clone(),
                ..LoadedScene::clone(context.loaded)
            }))?;
            let same = |(frame, before): (&f64, &Frame)| again.at(*frame, &options).strokes == before.strokes;
            frames.iter().zip(&in_order).all(same) && save::to_ron(scene) == text
        }
        None => false,
    };
    let alone = prepare_anywhere(Arc::clone(context.loaded))?;
    let scrubbed = frames
        .iter()
        .zip(&in_order)
        .rev()
        .all(|(&frame, before)| alone.at(frame, &options).strokes == before.strokes);

    let at_rest = context.reference_frame();
    let [once, twice] = [SceneVersion::NoAngleChance, SceneVersion::NoAngleChanceTwice]
        .map(|version| context.painting(version));
    let [once, twice] = [once?, twice?].map(|painting| strokes_by_key(&painting.at(at_rest, &options), &[]));
    let changes: Vec<f64> = of_layer(&once, LayerKind::Body)
        .filter_map(|(key, stroke)| Some(degrees_apart(stroke.angle_rad, twice.get(key)?.angle_rad)))
        .collect();
    row.counts.frames = frames.len();
    row.counts.strokes = changes.len();
    let spread = Spread::of(changes);
    let yes = |holds: bool| if holds { 1.0 } else { 0.0 };
    row.values = vec![
        Reading::one("bit-equal after saving and reading (1 is yes)", "", yes(reread)),
        Reading::one("bit-equal in any order (1 is yes)", "", yes(scrubbed)),
        Reading::many("change of angles at twice the density", "deg", spread),
    ];
    let guides = guides::add(context, &mut row)?;
    row.verdict = Verdict::of(reread && scrubbed && guides && spread.mean <= 3.0, row.counts);
    Ok(row)
}
