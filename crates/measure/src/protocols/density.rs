//! Measures M14, the density of strokes: on the largest object while the camera zooms in, and on a tilted flat sheet
//! whose strokes have the size and coverage of those on that object.

use std::sync::Arc;

use impasto_painting::FrameOptions;
use impasto_painting::frame::{LayerKind, Stroke};
use impasto_scene::document::Selector;
use impasto_scene::presets;

use crate::cameras::zoomed;
use crate::context::{DrawnFrame, MeasureContext, prepare_anywhere};
use crate::density::{PlacedStroke, shown_over_wanted, spacing_over_ideal};
use crate::metric::Metric;
use crate::options::MeasureError;
use crate::report::{Counts, Reading, Row, Verdict};
use crate::sheet;
use crate::strokes::{of_layer, strokes_by_key};
use crate::versions::{SceneVersion, orbit_blockers};

const ZOOMS: [f64; 9] = [1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 9.0, 13.0, 20.0];

const TILTS_DEG: [f64; 6] = [0.0, 20.0, 40.0, 60.0, 70.0, 80.0];

/// Side of the sheet's picture, large enough for thousands of strokes.
const SHEET_PX: u32 = 2048;

/// Strokes are counted only within this share of the sheet's sides: those nearer to the border lack neighbours beyond
/// it.
const WINDOW: f64 = 0.85;

/// Above this many wanted strokes per particle, particles run out: too few strokes show. For w wanted strokes per
/// particle, strokes fade out from the rank 0.52 w to 1.6 w. But no particle has a rank above 1, so the strokes of this
/// range that lie above 1 are missing.
const RUN_OUT: f64 = 0.82;

/// The strokes of an object in one view.
struct ObjectDensity {
    /// Strokes shown over strokes wanted.
    density: f64,
    /// Strokes wanted per particle, as found at each stroke: the 90th percentile.
    demand: f64,
    strokes: usize,
    pixels: usize,
}

pub(super) fn row(context: &mut MeasureContext<'_>) -> Result<Row, MeasureError> {
    let mut row = Row::new(
        Metric::M14,
        "body layer of the object that fills most of the reference picture (backdrops aside), zoomed in up \
         to 20 times; a flat sheet with its strokes, tilted up to 80 deg",
        "density 0.9 to 1.1 until particles run out; spacing ≥ 0.6 to 60 deg, ≥ 0.5 to 80 deg",
    );
    let camera = context.reference_camera();
    let reference = context.drawn_view(SceneVersion::Body, &camera)?;
    let Some(object) = largest(&reference.reference.body_id, &orbit_blockers(context.loaded)) else {
        row.verdict = Verdict::TooFew("no object is seen in the reference picture".to_owned());
        return Ok(row);
    };
    let name = context.loaded.scene.objects[object].name.clone();
    row.notes.push(format!("the object is {name}"));
    let (mut holds, mut run_out) = (true, None);
    for zoom in ZOOMS {
        let seen = of_object(context, object, zoom)?;
        if seen.strokes < 30 {
            break;
        }
        row.counts.frames += 1;
        row.counts.strokes += seen.strokes;
        row.counts.pixels += seen.pixels;
        let supplied = run_out.is_none() && seen.demand <= RUN_OUT;
        let words = if supplied { "" } else { ", particles run out" };
        row.values.push(Reading::one(format!("density at zoom {zoom}{words}"), "", seen.density));
        if supplied {
            holds &= (0.9..=1.1).contains(&seen.density);
        } else if run_out.is_none() {
            run_out = Some((zoom, seen.demand));
        }
    }
    if let Some((zoom, demand)) = run_out {
        let count = context.painting(SceneVersion::Body)?.particle_counts()[object];
        context.warnings.push(format!(
            "the particles of object {name:?} run out from zoom {zoom} on; {count} are too few there by a factor of {:.1}: \
             raise `particles`",
            demand / RUN_OUT
        ));
    }
    holds &= on_sheet(context, object, &mut row)?;
    row.verdict = Verdict::of(holds, row.counts);
    Ok(row)
}

/// The object with the most pixels; a backdrop only where there is nothing else.
fn largest(body_ids: &[u32], backdrops: &[usize]) -> Option<usize> {
    let bodies = body_ids.iter().copied().max().unwrap_or(0);
    let pixels = |id: u32| body_ids.iter().filter(|&&other| other == id).count();
    let is_backdrop = |id: u32| backdrops.contains(&(id as usize - 1));
    (1..=bodies).max_by_key(|&id| (pixels(id) > 0 && !is_backdrop(id), pixels(id))).map(|id| id as usize - 1)
}

fn of_object(
    context: &mut MeasureContext<'_>,
    object: usize,
    zoom: f64,
) -> Result<ObjectDensity, MeasureError> {
    let camera = zoomed(&context.reference_camera(), zoom);
    let shown = context.drawn_view(SceneVersion::EqualSizes, &camera)?;
    let id = object as u32 + 1;
    let pixels = shown.reference.body_id.iter().filter(|&&other| other == id).count();
    let scene = &context.loaded.scene;
    let coverages: Vec<f32> = (0..=scene.regions.len())
        .map(|region| {
            let region = Some(region).filter(|&region| region < scene.regions.len());
            presets::resolve(scene, region).body().coverage
        })
        .collect();
    let (mut placed, mut demands) = (Vec::new(), Vec::new());
    for (index, (stroke, source)) in shown.frame.strokes.iter().zip(&shown.frame.sources).enumerate() {
        let run = shown.frame.layers.iter().find(|run| {
            run.kind == LayerKind::Body && (run.first..run.first + run.count).contains(&(index as u32))
        });
        if stroke.body_id != id || run.is_none() || !is_seen(&shown, stroke) {
            continue;
        }
        let coverage = coverages[source.region as usize];
        let area_px = f64::from(stroke.length_px * stroke.width_px);
        placed.push(PlacedStroke {
            center_px: stroke.center_px.map(f64::from),
            alpha: f64::from(stroke.presence()),
            wanted_area_px: area_px / f64::from(coverage.max(f32::MIN_POSITIVE)),
        });
        if source.facing > 0.3 {
            demands.push(f64::from(stroke.supply_ln + source.rank.ln()).exp());
        }
    }
    demands.sort_by(f64::total_cmp);
    Ok(ObjectDensity {
        density: shown_over_wanted(&placed, pixels),
        demand: demands.get(demands.len() * 9 / 10).copied().unwrap_or(0.0),
        strokes: placed.len(),
        pixels,
    })
}

/// Within a pixel, depths of one surface differ by less than this share of the depth.
const DEPTH_SHARE: f32 = 0.004;

/// Whether the pixel under a stroke's centre shows the surface that the stroke lies on, not one in front of it.
fn is_seen(shown: &DrawnFrame, stroke: &Stroke) -> bool {
    let [x, y] = stroke.center_px;
    let [width, height] = shown.frame.size_px.map(|side| side as i64);
    let (column, row) = (x.floor() as i64, height - 1 - y.floor() as i64);
    let inside = (0..width).contains(&column) && (0..height).contains(&row);
    let at = (row * width + column) as usize;
    inside
        && shown.reference.body_id[at] == stroke.body_id
        && shown.reference.depth[at] >= stroke.depth * (1.0 - DEPTH_SHARE)
}

fn on_sheet(context: &mut MeasureContext<'_>, object: usize, row: &mut Row) -> Result<bool, MeasureError> {
    let scene = &context.loaded.scene;
    let name = &scene.objects[object].name;
    let region = scene.regions.iter().rposition(|region| match &region.on {
        Selector::Everything => true,
        Selector::Object(_) | Selector::Collection(_) => region.on.reaches(&scene.stage, name),
        _ => false,
    });
    let Some(version) = sheet::sheet(context.loaded, region, SHEET_PX) else { return Ok(false) };
    let wanted = presets::resolve(&version.scene, None).body().wanted_per_px();
    let painting = prepare_anywhere(Arc::new(version))?;
    let options = FrameOptions::new([SHEET_PX, SHEET_PX]);
    let mut holds = true;
    for tilt_deg in TILTS_DEG {
        let strokes = strokes_by_key(&painting.seen_by(&sheet::camera(tilt_deg), 0.0, &options), &[]);
        let side = f64::from(SHEET_PX);
        let half = [0.5 * side * WINDOW, 0.5 * side * WINDOW * tilt_deg.to_radians().cos()];
        let placed: Vec<PlacedStroke> = of_layer(&strokes, LayerKind::Body)
            .filter(|(_, stroke)| {
                [0, 1].into_iter().all(|axis| (stroke.center_px[axis] - 0.5 * side).abs() < half[axis])
            })
            .map(|(_, stroke)| PlacedStroke {
                center_px: stroke.center_px,
                alpha: stroke.alpha,
                wanted_area_px: 1.0 / f64::from(wanted),
            })
            .collect();
        let pixels = (4.0 * half[0] * half[1]) as usize;
        let density = shown_over_wanted(&placed, pixels);
        let (spacing, shown) = spacing_over_ideal(&placed, pixels);
        row.values.push(Reading::one(format!("sheet at {tilt_deg} deg: density"), "", density));
        row.values.push(Reading::one(format!("sheet at {tilt_deg} deg: spacing"), "", spacing));
        row.counts =
            Counts { strokes: row.counts.strokes + shown, frames: row.counts.frames + 1, ..row.counts };
        let least = if tilt_deg <= 60.0 { 0.6 } else { 0.5 };
        holds &= (0.9..=1.1).contains(&density) && spacing >= least;
    }
    Ok(holds)
}
