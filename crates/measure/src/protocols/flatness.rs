//! Measures M8, flatness, on the shot and on a zoom: do strokes keep their length and width on the picture?

use impasto_painting::Rotation;
use impasto_scene::presets;

use crate::cameras::zoomed;
use crate::context::MeasureContext;
use crate::figures::Spread;
use crate::flatness::flatness;
use crate::metric::Metric;
use crate::options::MeasureError;
use crate::report::{Counts, Reading, Row, Verdict};
use crate::strokes::{StrokesByKey, strokes_by_key};
use crate::versions::SceneVersion;

pub(super) fn row(context: &mut MeasureContext<'_>) -> Result<Row, MeasureError> {
    let mut row = Row::new(
        Metric::M8,
        "the shot, and the reference pose from 0.5 to 4 times as near; length and width as they are drawn, all layers",
        "variation over the frames ≤ 0.0001",
    );
    let painting = context.painting(SceneVersion::Board)?;
    let options = context.frame_options(Rotation::On);
    let camera = context.reference_camera();
    let at_rest = context.reference_frame();
    let mut frames: Vec<StrokesByKey> = context
        .frames()
        .into_iter()
        .map(|frame| strokes_by_key(&painting.at(frame, &options), &[]))
        .collect();
    for factor in [0.5, 2.0, 4.0] {
        frames.push(strokes_by_key(&painting.seen_by(&zoomed(&camera, factor), at_rest, &options), &[]));
    }
    // Strokes with `size_follow` are meant to change with their surface. Strokes with keys are meant to change over
    // time.
    let scene = &context.loaded.scene;
    let changes: Vec<bool> = (0..=scene.regions.len())
        .map(|region| {
            let strokes = presets::resolve(scene, Some(region).filter(|&r| r < scene.regions.len()));
            strokes.size_follow > 0.0 || !strokes.keys.is_empty()
        })
        .collect();
    let mut left_out = 0;
    for strokes in &mut frames {
        let all = strokes.len();
        strokes.retain(|_, stroke| !changes[stroke.region as usize]);
        left_out += all - strokes.len();
    }
    if left_out > 0 {
        row.notes.push(format!(
            "left out, since they follow the size of their surface or have keys: {left_out} strokes"
        ));
    }
    let found = flatness(frames.iter());
    let mapped = context.frame_options(Rotation::Mapped);
    let as_texture = [1.0, 2.0, 4.0]
        .map(|factor| strokes_by_key(&painting.seen_by(&zoomed(&camera, factor), at_rest, &mapped), &[]));
    let as_texture = Spread::of(flatness(as_texture.iter()).variation);
    row.counts = Counts { strokes: found.variation.len(), pixels: 0, frames: frames.len() };
    let spread = Spread::of(found.variation);
    row.values.push(Reading::many("variation of a stroke's length or width", "", spread));
    row.baselines.push(Reading::many("as a texture, on the zoom", "", as_texture));
    row.notes.push("strokes are rectangles on the picture: they have no shear".to_owned());
    row.verdict = Verdict::of(spread.max <= 1e-4, row.counts);
    Ok(row)
}
