//! Measures M15, M16 and M17, chatter, steps and flicker, on every frame of the shot: all three are taken in one pass.

use std::rc::Rc;

use impasto_painting::Rotation;

use super::FEW_FRAMES;
use crate::chatter::{Place, Share};
use crate::context::{DrawnFrame, MeasureContext};
use crate::figures::Spread;
use crate::flicker::{Along, SEEN};
use crate::metric::Metric;
use crate::options::MeasureError;
use crate::report::{Counts, LEAST_STROKES, Reading, Row, Series, Verdict};
use crate::shot::WholeShot;
use crate::steps::Shown;
use crate::versions::SceneVersion;
use crate::warp::correspondences;
use impasto_painting::frame::LayerKind;

/// Standard deviation of the Gaussian that blurs pictures before they are compared: finer detail changes when it shifts
/// by a part of a pixel, which is no flicker.
const BLUR_PX: f64 = 1.0;

/// How many of the worst coats are named.
const NAMED: usize = 3;

/// Draws every frame of the shot once and looks at each with its neighbours.
fn drawn_through(context: &mut MeasureContext<'_>) -> Result<WholeShot, MeasureError> {
    let timeline = &context.loaded.scene.timeline;
    let (first, last) = (timeline.first, timeline.last);
    let mut found = WholeShot::default();
    let mut drawn: Vec<Rc<DrawnFrame>> = Vec::new();
    let height_px = f64::from(context.size_px[1]);
    for frame in first..=last {
        let frame = frame as f64;
        drawn.push(context.drawn_once(SceneVersion::Board, frame, Rotation::On)?);
        found.frames += 1;
        if drawn.len() > 3 {
            drawn.remove(0);
        }
        if let [.., before, now] = drawn.as_slice() {
            let steps = found.steps.count();
            let [before, now] = [before, now].map(|drawn| shown(drawn));
            found.steps.add(frame, before, now, context.size_px);
            found.steps_by_frame.push((frame, found.steps.count() - steps));
        }
        let [before, now, after] = drawn.as_slice() else { continue };
        let middle = frame - 1.0;
        let chatter = found.chatter.whole();
        let strokes = [before, now, after].map(|drawn| &drawn.strokes);
        found.chatter.add(middle, strokes, height_px);
        let all = found.chatter.whole();
        let share = (all.found - chatter.found) / (all.of - chatter.of).max(1) as f64;
        found.chatter_by_frame.push((middle, 100.0 * share));
        let places = [before, after].map(|other| -> Result<_, MeasureError> {
            let motion = context.motion(&now.frame, &other.frame)?;
            Ok(correspondences(&motion, &other.reference))
        });
        let [before_at, after_at] = places;
        let along = Along { before: &before_at?, after: &after_at? };
        let flickering = (found.flicker.flickering, found.flicker.pixels);
        let lumas =
            [before, now, after].map(|drawn| drawn.luma.blurred_within(&drawn.reference.body_id, BLUR_PX));
        found.flicker.add(middle, lumas.each_ref(), &along);
        let pixels = (found.flicker.pixels - flickering.1).max(1);
        let share = (found.flicker.flickering - flickering.0) as f64 / pixels as f64;
        found.flicker_by_frame.push((middle, 100.0 * share));
    }
    Ok(found)
}

fn shown(drawn: &DrawnFrame) -> Shown<'_> {
    let view = &drawn.frame.view;
    let height = f64::from(drawn.frame.size_px[1]);
    let at_1 = 2.0 / (height * f64::from(view.clip_from_view.y_axis.y));
    Shown {
        strokes: &drawn.strokes,
        reference: &drawn.reference,
        units_per_px_at_1: if view.orthographic { 0.0 } else { at_1 },
    }
}

/// Where the worst was found, in words.
fn place_words(context: &MeasureContext<'_>, place: Place) -> String {
    let [x, y] = place.at_px;
    let stroke = place.stroke.map_or_else(String::new, |key| {
        let object = &context.loaded.scene.objects[key.body_id as usize - 1].name;
        format!(", stroke {} in {} of {object}", key.particle, key.kind.name())
    });
    format!("worst at frame {}, x {x:.0}, y {y:.0}{stroke}", place.frame)
}

/// What is found on the whole shot; `None` if it has fewer than three frames.
fn whole(context: &mut MeasureContext<'_>) -> Result<Option<Rc<WholeShot>>, MeasureError> {
    let shot = match &context.whole_shot {
        Some(shot) => Rc::clone(shot),
        None => {
            let shot = Rc::new(drawn_through(context)?);
            context.whole_shot = Some(Rc::clone(&shot));
            shot
        }
    };
    Ok((shot.frames >= 3).then_some(shot))
}

const TAKEN_ON: &str = "every frame of the shot, on a board, as drawn";

pub(super) fn chatter(
    context: &mut MeasureContext<'_>,
    series: &mut Vec<Series>,
) -> Result<Row, MeasureError> {
    let mut row = Row::new(
        Metric::M15,
        format!("{TAKEN_ON}; strokes whose luma reverses by more than 0.02"),
        "≤ 3 % of the stroke-frames of each layer of each object",
    );
    let Some(shot) = whole(context)? else { return Ok(row.not_applicable(FEW_FRAMES)) };
    let found = &shot.chatter;
    let all = found.whole();
    row.counts = Counts { strokes: all.of, pixels: 0, frames: shot.frames };
    row.values.push(Reading::one("all strokes", "%", 100.0 * all.share()));
    let mut coats: Vec<(&(u32, LayerKind), &Share)> =
        found.by_coat.iter().filter(|(_, share)| share.of >= LEAST_STROKES).collect();
    coats.sort_by(|a, b| b.1.share().total_cmp(&a.1.share()));
    let worst = coats.first().map_or(0.0, |(_, share)| share.share());
    row.values.push(Reading::one("worst layer of an object", "%", 100.0 * worst));
    for ((body, kind), share) in coats.iter().take(NAMED) {
        let object = &context.loaded.scene.objects[*body as usize - 1].name;
        let what = format!("{} of {object} ({} stroke-frames)", kind.name(), share.of);
        row.values.push(Reading::one(what, "%", 100.0 * share.share()));
    }
    row.notes
        .extend(found.worst.map(|place| format!("{}: by {:.2}", place_words(context, place), place.amount)));
    let holds = worst <= 0.03;
    row.verdict = Verdict::of(holds, row.counts);
    series.push(Series {
        metric: Metric::M15,
        title: "strokes that chatter",
        target: 3.0,
        unit: "% of strokes",
        points: shot.chatter_by_frame.clone(),
    });
    Ok(row)
}

pub(super) fn steps(context: &mut MeasureContext<'_>, series: &mut Vec<Series>) -> Result<Row, MeasureError> {
    let mut row = Row::new(
        Metric::M16,
        format!(
            "{TAKEN_ON}; strokes whose alpha changes by more than 0.35 in a frame, times the share of them that is seen"
        ),
        "≤ 0.01 % of stroke-frames; highlights ≤ 1 %, half of them live 12 frames",
    );
    let Some(shot) = whole(context)? else { return Ok(row.not_applicable(FEW_FRAMES)) };
    let found = &shot.steps;
    let of = found.by_layer.values().map(|share| share.of).sum::<usize>();
    row.counts = Counts { strokes: of, pixels: 0, frames: shot.frames };
    let share = found.count() / of.max(1) as f64;
    row.values.push(Reading::one("strokes that step", "", found.count()));
    row.values.push(Reading::one("of stroke-frames", "%", 100.0 * share));
    for (kind, share) in found.by_layer.iter().filter(|(_, share)| share.found > 0.0) {
        row.values.push(Reading::one(format!("in {}", kind.name()), "", share.found));
    }
    let mut bodies: Vec<_> = found.by_body.iter().filter(|(_, share)| share.found > 0.0).collect();
    bodies.sort_by(|a, b| b.1.found.total_cmp(&a.1.found));
    for (body, share) in bodies.into_iter().take(NAMED) {
        let object = &context.loaded.scene.objects[*body as usize - 1].name;
        row.values.push(Reading::one(format!("on {object}"), "", share.found));
    }
    let lights = found.by_layer.get(&LayerKind::Lights).copied().unwrap_or_default();
    let lives = Spread::of(found.lives_of_highlights());
    if lights.of > 0 {
        row.values.push(Reading::one(
            "steps of highlights",
            "% of their stroke-frames",
            100.0 * lights.share(),
        ));
        row.values.push(Reading::many("frames that a highlight lives:", "", lives));
    }
    row.notes
        .extend(found.worst.map(|place| format!("{}: by {:.2}", place_words(context, place), place.amount)));
    // Few lives are no evidence.
    let live_long = lives.count < 20 || lives.median >= 12.0;
    let holds = share <= 1e-4 && lights.share() <= 0.01 && live_long;
    row.verdict = Verdict::of(holds, row.counts);
    series.push(Series {
        metric: Metric::M16,
        title: "strokes that step",
        target: 1.0,
        unit: "strokes",
        points: shot.steps_by_frame.clone(),
    });
    Ok(row)
}

pub(super) fn flicker(
    context: &mut MeasureContext<'_>,
    series: &mut Vec<Series>,
) -> Result<Row, MeasureError> {
    let mut row = Row::new(
        Metric::M17,
        format!(
            "{TAKEN_ON}; second difference of luma, blurred by a pixel, along the motion, where a point is seen in three frames"
        ),
        "99.9 % of pixels ≤ 0.018; above 6 of 255 ≤ 0.01 %",
    );
    let Some(shot) = whole(context)? else { return Ok(row.not_applicable(FEW_FRAMES)) };
    let found = &shot.flicker;
    row.counts = Counts { strokes: 0, pixels: found.pixels, frames: shot.frames };
    let share = found.flickering as f64 / found.pixels.max(1) as f64;
    row.values = vec![
        Reading::one("99.9 % of pixels are below", "of 1", found.percentile(0.999)),
        Reading::one(format!("pixels above {SEEN} of 255"), "%", 100.0 * share),
    ];
    row.notes.extend(
        found.worst.map(|place| format!("{}: by {:.0} of 255", place_words(context, place), place.amount)),
    );
    row.verdict = Verdict::of_pixels(found.percentile(0.999) <= 0.018 && share <= 1e-4, row.counts);
    series.push(Series {
        metric: Metric::M17,
        title: "pixels that flicker",
        target: 0.01,
        unit: "% of pixels",
        points: shot.flicker_by_frame.clone(),
    });
    Ok(row)
}
