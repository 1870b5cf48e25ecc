//! M9, coverage and bleed: measures, on frames of the shot, how much of the surfaces is painted, and how much of that
//! paint has the colour of another object.

use std::collections::BTreeMap;

use impasto_core::color::linear_from_srgb;
use impasto_painting::Rotation;

use crate::context::MeasureContext;
use crate::coverage::{Bodies, Holes, bleed};
use crate::metric::Metric;
use crate::options::MeasureError;
use crate::report::{Counts, Reading, Row, Verdict};
use crate::versions::{SceneVersion, flat_color};

/// The most objects for which bleed is measured: [`flat_color`] has no more colours.
const MOST_COLORS: usize = 26;

/// How many frames are measured, at most.
const FRAMES: usize = 4;

pub(super) fn row(context: &mut MeasureContext<'_>) -> Result<Row, MeasureError> {
    let mut row = Row::new(
        Metric::M9,
        "frames of the shot, pixels where a body shows; bleed in a version with one flat colour for each object, cut edges \
         and no mixing, 2 px from borders",
        "holes ≤ 0.5 % (body layer alone ≤ 8 %), bleed 0, overdraw 2 to 8",
    );
    let all = context.frames();
    let step = all.len().div_ceil(FRAMES);
    let frames: Vec<f64> = all.into_iter().step_by(step.max(1)).collect();
    let (mut overdraw, mut surface_px) = (0.0, 0usize);
    let mut by_body: BTreeMap<u32, Holes> = BTreeMap::new();
    let painting = context.painting(SceneVersion::Board)?;
    let options = context.frame_options(Rotation::On);
    for &frame in &frames {
        let drawn = painting.at(frame, &options);
        row.counts.strokes += drawn.strokes.len();
        let (_, cost) = context.renderer.render_timed(&drawn)?;
        let ids = context.renderer.read_reference().body_id;
        let alpha: Vec<f32> = context.renderer.read_paint().iter().map(|paint| paint[3]).collect();
        for (id, holes) in Holes::by_body(&alpha, &ids) {
            let sum = by_body.entry(id).or_default();
            *sum = sum.and(holes);
        }
        surface_px += ids.iter().filter(|&&id| id > 0).count();
        overdraw += cost.overdraw * ids.len() as f64;
    }
    let holes = by_body.values().copied().fold(Holes::default(), Holes::and);
    let overdraw = overdraw / surface_px.max(1) as f64;
    let body_alone = holes_of(context, SceneVersion::Body, &frames)?;
    let paper = holes_of(context, SceneVersion::Paper, &frames)?;
    let (bled, flat_px) = bleeding(context, &frames)?;
    row.counts.pixels = holes.pixels;
    row.counts = Counts { frames: frames.len(), ..row.counts };
    row.values = vec![
        Reading::one("holes, all layers", "%", 100.0 * holes.share()),
        Reading::one("holes, body layer alone", "%", 100.0 * body_alone.share()),
        Reading::one("overdraw: strokes on a pixel of a body", "", overdraw),
    ];
    row.baselines.push(Reading::one("the paper's rule: holes", "%", 100.0 * paper.share()));
    row.notes.push(by_object(context, &by_body));
    let mut holds = holes.share() <= 0.005 && body_alone.share() <= 0.08 && (2.0..=8.0).contains(&overdraw);
    match (context.loaded.scene.objects.len(), flat_px) {
        (0..=1, _) => row.notes.push("one object: nothing to bleed from".to_owned()),
        (2..=MOST_COLORS, 1..) => {
            let percent = 100.0 * bled as f64 / flat_px as f64;
            row.values.push(Reading::one("bleed", "% of painted pixels", percent));
            holds &= bled == 0;
        }
        (2..=MOST_COLORS, _) => holds = false,
        _ => row.notes.push(format!("more than {MOST_COLORS} objects: bleed is not measured")),
    }
    row.verdict = Verdict::of_pixels(holds, row.counts);
    Ok(row)
}

/// A note that names the objects with holes.
fn by_object(context: &MeasureContext<'_>, by_body: &BTreeMap<u32, Holes>) -> String {
    let objects = &context.loaded.scene.objects;
    let words: Vec<String> = by_body
        .iter()
        .filter(|(_, holes)| holes.holes > 0)
        .map(|(&id, holes)| format!("{} {:.2} %", objects[id as usize - 1].name, 100.0 * holes.share()))
        .collect();
    format!("holes by object: {}", if words.is_empty() { "none".to_owned() } else { words.join(", ") })
}

fn holes_of(
    context: &mut MeasureContext<'_>,
    version: SceneVersion,
    frames: &[f64],
) -> Result<Holes, MeasureError> {
    let mut holes = Holes::default();
    for &frame in frames {
        let shown = context.drawn_frame(version, frame, Rotation::On)?;
        holes = holes.and(Holes::of(&shown.paint_alpha, &shown.reference.body_id));
    }
    Ok(holes)
}

fn bleeding(context: &mut MeasureContext<'_>, frames: &[f64]) -> Result<(usize, usize), MeasureError> {
    let painting = context.painting(SceneVersion::Flat)?;
    let options = context.frame_options(Rotation::On);
    let colors: Vec<[f32; 3]> = (0..painting.scene().objects.len())
        .map(|object| flat_color(object).0.map(linear_from_srgb))
        .collect();
    let (mut bled, mut pixels) = (0, 0);
    for &frame in frames {
        context.picture(&painting.at(frame, &options))?;
        let ids = context.renderer.read_reference().body_id;
        let bodies = Bodies { size_px: options.size_px.map(|side| side as usize), ids: &ids };
        let (of_frame, in_frame) = bleed(&bodies, &context.renderer.read_paint(), &colors);
        bled += of_frame;
        pixels += in_frame;
    }
    Ok((bled, pixels))
}
