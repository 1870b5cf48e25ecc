//! Measures M15, M16 and M17, chatter, steps and flicker, on every frame of the shot: all three are taken in one pass.

use std::rc::Rc;

use impasto_painting::Rotation;

use super::FEW_FRAMES;
use crate::chatter::{Place, Share};
use crate::context::{DrawnFrame, MeasureContext};
use crate::covered::{covered, overruns_px};
use crate::figures::Spread;
use crate::flicker::{Along, SEEN};
use crate::metric::Metric;
use crate::options::MeasureError;
use crate::plane::Plane;
use crate::report::{Counts, LEAST_STROKES, Reading, Row, Series, Verdict};
use crate::shot::WholeShot;
use crate::steps::Shown;
use crate::versions::SceneVersion;
use crate::warp::correspondences;
use impasto_painting::frame::LayerKind;

/// Standard deviation of the Gaussian that blurs pictures before they are compared: finer detail changes when it shifts
/// by a part of a pixel, which is no flicker.
const BLUR_PX: f64 = 1.0;

/// How many of the worst coats (M15) or bodies (M16) are named.
const NAMED: usize = 3;

/// A frame with what M17 needs of it.
struct Looked {
    drawn: Rc<DrawnFrame>,
    /// Luma of the painted frame and of a plain render of it, both blurred.
    lumas: [Plane; 2],
    /// 1 where paint of a nearer body may lie.
    covered: Plane,
}

/// Draws a frame in two ways: in its style on a smooth canvas ([`SceneVersion::Board`]), and as a plain render.
fn looked_at(context: &mut MeasureContext<'_>, frame: f64) -> Result<Looked, MeasureError> {
    let drawn = context.drawn_once(SceneVersion::Board, frame, Rotation::On)?;
    let plain = context.plain_luma(&drawn.frame)?;
    let ids = &drawn.reference.body_id;
    let lumas = [drawn.luma.blurred_within(ids, BLUR_PX), plain.blurred_within(ids, BLUR_PX)];
    let overruns_px = overruns_px(&drawn.frame.strokes);
    let covered = covered(drawn.luma.size_px, &drawn.reference, &overruns_px);
    Ok(Looked { drawn, lumas, covered })
}

/// For each pixel of a frame, where its surface point is in another frame. `None` where the point is hidden, or may be
/// covered, in one of the two frames.
fn followed(
    context: &mut MeasureContext<'_>,
    now: &Looked,
    other: &Looked,
) -> Result<Vec<Option<[f64; 2]>>, MeasureError> {
    let motion = context.motion(&now.drawn.frame, &other.drawn.frame)?;
    let mut places = correspondences(&motion, &other.drawn.reference);
    for (place, &covered_now) in places.iter_mut().zip(&now.covered.values) {
        let is_free = |[x, y]: &[f64; 2]| covered_now == 0.0 && other.covered.sample(*x, *y) == Some(0.0);
        *place = place.filter(is_free);
    }
    Ok(places)
}

/// Goes through the shot once. Compares each frame with the one before it (M16), and each that has two neighbours with
/// both (M15 and M17).
fn drawn_through(context: &mut MeasureContext<'_>) -> Result<WholeShot, MeasureError> {
    let timeline = &context.loaded.scene.timeline;
    let (first, last) = (timeline.first, timeline.last);
    let mut found = WholeShot::default();
    let mut three: Vec<Looked> = Vec::new();
    let height_px = f64::from(context.size_px[1]);
    for frame in first..=last {
        let frame = frame as f64;
        three.push(looked_at(context, frame)?);
        found.frames += 1;
        if three.len() > 3 {
            three.remove(0);
        }
        if let [.., before, now] = three.as_slice() {
            let steps = found.steps.count();
            let [before, now] = [before, now].map(|looked| shown(&looked.drawn));
            found.steps.add(frame, before, now, context.size_px);
            found.steps_by_frame.push((frame, found.steps.count() - steps));
        }
        let [before, now, after] = three.as_slice() else { continue };
        let middle = frame - 1.0;
        let chatter = found.chatter.whole();
        found.chatter.add(middle, [before, now, after].map(|looked| &looked.drawn.strokes), height_px);
        let all = found.chatter.whole();
        let share = (all.found - chatter.found) / (all.of - chatter.of).max(1) as f64;
        found.chatter_by_frame.push((middle, 100.0 * share));
        let [before_at, after_at] = [before, after].map(|other| followed(context, now, other));
        let along = Along { before: &before_at?, after: &after_at? };
        let flickering = (found.flicker.flickering, found.flicker.pixels);
        let [painted, plain] = [0, 1].map(|which| [before, now, after].map(|looked| &looked.lumas[which]));
        found.flicker.add(middle, painted, &along);
        found.plain_flicker.add(middle, plain, &along);
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
    // The median of fewer than 20 lives says too little to be judged.
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
            "{TAKEN_ON}; second difference of luma, blurred by a pixel, along the motion, where a point is seen in three frames and no paint of a nearer body reaches"
        ),
        "99.9 % of pixels ≤ 0.018; above 6 of 255 ≤ 0.01 %",
    );
    let Some(shot) = whole(context)? else { return Ok(row.not_applicable(FEW_FRAMES)) };
    let found = &shot.flicker;
    row.counts = Counts { strokes: 0, pixels: found.pixels, frames: shot.frames };
    let share = found.flickering as f64 / found.pixels.max(1) as f64;
    let plain = &shot.plain_flicker;
    let plain_share = plain.flickering as f64 / plain.pixels.max(1) as f64;
    row.values = vec![
        Reading::one("99.9 % of pixels are below", "of 1", found.percentile(0.999)),
        Reading::one(format!("pixels above {SEEN} of 255"), "%", 100.0 * share),
    ];
    row.baselines = vec![
        Reading::one("plain render: 99.9 % of pixels are below", "of 1", plain.percentile(0.999)),
        Reading::one(format!("plain render: pixels above {SEEN} of 255"), "%", 100.0 * plain_share),
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
