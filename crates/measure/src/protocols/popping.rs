//! Measures M4, popping, on the shot, on a turntable and on a zoom: do strokes appear or vanish suddenly?

use impasto_painting::Rotation;
use impasto_scene::document::Scene;
use impasto_scene::motion::CameraPose;

use crate::cameras::{orbited, zoomed};
use crate::context::MeasureContext;
use crate::figures::Spread;
use crate::metric::Metric;
use crate::options::MeasureError;
use crate::popping::{Popping, by_presence, of_moving_bodies, popping};
use crate::report::{LEAST_STROKES, Reading, Row, Series, Verdict};
use crate::strokes::StrokesByKey;
use crate::versions::{SceneVersion, orbit_blockers};

/// Angles round the target at which pairs of views are taken; the two views of a pair are one degree apart.
const AROUND_DEG: [f64; 6] = [0.0, 47.0, 101.0, 180.0, 233.0, 312.0];

/// Zoom factors at which pairs of views are taken; the two views of a pair are one percent apart.
const ZOOMS: [f64; 4] = [1.0, 1.6, 2.7, 5.0];

/// Popping between two neighbouring frames.
struct Pair {
    /// From the strokes as drawn.
    drawn: Popping,
    /// From the strokes' presence alone, as [`by_presence`] gives it.
    counted: Popping,
}

impl Pair {
    fn of(before: &StrokesByKey, after: &StrokesByKey, size_px: [u32; 2]) -> Self {
        Self {
            drawn: popping(before, after, size_px),
            counted: popping(&by_presence(before), &by_presence(after), size_px),
        }
    }
}

pub(super) fn row(context: &mut MeasureContext<'_>, series: &mut Vec<Series>) -> Result<Row, MeasureError> {
    let mut row = Row::new(
        Metric::M4,
        "neighbouring frames as drawn, all layers: the shot, bodies that move; a turntable of the \
         reference pose, 1 deg a frame; a zoom, 1 % a frame; strokes at the picture's border left out",
        "turntable and zoom 0 %; shot ≤ 0.1 %",
    );
    let shot = shot(context, SceneVersion::Board)?;
    let around: Vec<[CameraPose; 2]> = {
        let camera = context.reference_camera();
        AROUND_DEG.map(|angle| [angle, angle + 1.0].map(|angle| orbited(&camera, angle))).to_vec()
    };
    let zooms: Vec<[CameraPose; 2]> = {
        let camera = context.reference_camera();
        ZOOMS.map(|factor| [factor, factor * 1.01].map(|factor| zoomed(&camera, factor))).to_vec()
    };
    let turntable = views(context, SceneVersion::Orbit, &around)?;
    let zoom = views(context, SceneVersion::Board, &zooms)?;
    let papers = [
        ("the shot", self::shot(context, SceneVersion::Paper)?),
        ("turntable", views(context, SceneVersion::OrbitPaper, &around[..3])?),
    ];
    let percent = |found: &[Pair]| Spread::of(found.iter().map(|pair| 100.0 * pair.drawn.share).collect());
    for (name, found) in [("shot", &shot), ("turntable", &turntable), ("zoom", &zoom)] {
        if found.is_empty() {
            continue;
        }
        row.values.push(Reading::many(format!("{name}: strokes that pop, by area"), "%", percent(found)));
        let counted = found.iter().map(|pair| 100.0 * pair.counted.share).fold(0.0, f64::max);
        row.values.push(Reading::one(format!("{name}: by presence alone, worst"), "%", counted));
        let steepest = found.iter().max_by(|a, b| a.drawn.largest_step.total_cmp(&b.drawn.largest_step));
        if let Some(Popping { largest_step, worst: Some(key), .. }) = steepest.map(|pair| pair.drawn) {
            let object = scene_of(context, name).objects[key.body_id as usize - 1].name.clone();
            let what = format!("{name}: largest step of alpha ({} of {object})", key.kind.name());
            row.values.push(Reading::one(what, "", largest_step));
        }
        row.counts.strokes += found.iter().map(|pair| pair.drawn.strokes).sum::<usize>();
        row.counts.frames += 2 * found.len();
        if name != "shot" {
            let fewest = found.iter().map(|pair| pair.drawn.strokes).min().unwrap_or(0);
            row.notes.push(format!("{name}: {fewest} strokes or more in each pair"));
        }
    }
    for (name, found) in papers.iter().filter(|(_, found)| !found.is_empty()) {
        row.baselines.push(Reading::many(format!("the paper's rule on {name}"), "%", percent(found)));
    }
    left_out(context, &mut row);
    let worst = |found: &[Pair]| found.iter().map(|pair| pair.drawn.share).fold(0.0, f64::max);
    let holds = worst(&turntable) == 0.0 && worst(&zoom) == 0.0 && worst(&shot) <= 1e-3;
    let each = [&shot, &turntable, &zoom];
    let enough = each.iter().all(|found| {
        found.is_empty() || found.iter().map(|pair| pair.drawn.strokes).sum::<usize>() >= LEAST_STROKES
    });
    row.verdict = Verdict::of(holds, row.counts);
    if !enough {
        row.verdict = Verdict::TooFew("one of the motions shows fewer than 500 strokes".to_owned());
    }
    let pairs = context.pairs();
    let points = pairs.iter().map(|pair| pair[0]).zip(shot.iter().map(|pair| 100.0 * pair.drawn.share));
    series.push(Series {
        metric: Metric::M4,
        title: "strokes that pop",
        target: 0.1,
        unit: "% of area",
        points: points.collect(),
    });
    Ok(row)
}

/// The version of the scene on which a motion was measured.
fn scene_of(context: &MeasureContext<'_>, motion: &str) -> Scene {
    let version = if motion == "turntable" { SceneVersion::Orbit } else { SceneVersion::Board };
    version.of(context.loaded, &[]).scene
}

/// Notes which objects were left out because they hide the target from a camera that goes round it.
pub(super) fn left_out(context: &MeasureContext<'_>, row: &mut Row) {
    let scene = &context.loaded.scene;
    let blockers = orbit_blockers(context.loaded);
    if !blockers.is_empty() && blockers.len() < scene.objects.len() {
        let names: Vec<&str> = blockers.iter().map(|&index| scene.objects[index].name.as_str()).collect();
        row.notes.push(format!("left out where the camera goes round: {}", names.join(", ")));
    }
}

fn shot(context: &mut MeasureContext<'_>, version: SceneVersion) -> Result<Vec<Pair>, MeasureError> {
    let mut found = Vec::new();
    for [first, second] in context.pairs() {
        let before = context.drawn_frame(version, first, Rotation::On)?;
        let after = context.drawn_frame(version, second, Rotation::On)?;
        let [before, after] = of_moving_bodies(&before.strokes, &after.strokes);
        found.push(Pair::of(&before, &after, context.size_px));
    }
    Ok(found)
}

fn views(
    context: &mut MeasureContext<'_>,
    version: SceneVersion,
    pairs: &[[CameraPose; 2]],
) -> Result<Vec<Pair>, MeasureError> {
    let mut found = Vec::new();
    for [first, second] in pairs {
        let before = context.drawn_view(version, first)?;
        let after = context.drawn_view(version, second)?;
        found.push(Pair::of(&before.strokes, &after.strokes, context.size_px));
    }
    Ok(found)
}
