//! Measures M13, loop and replay: whether a frame gives the same picture after other frames, alone, and with the other
//! driver, and whether a closed shot ends as it begins.

use impasto_gl_render::Renderer;
use impasto_gl_render::context::{Driver, OpenOptions, open};
use impasto_painting::Rotation;
use impasto_scene::motion;

use crate::context::{MeasureContext, prepare_anywhere};
use crate::metric::Metric;
use crate::options::MeasureError;
use crate::report::{Counts, Reading, Row, Verdict};
use crate::strokes::{degrees_apart, strokes_by_key};
use crate::versions::SceneVersion;

pub(super) fn row(context: &mut MeasureContext<'_>) -> Result<Row, MeasureError> {
    let mut row = Row::new(
        Metric::M13,
        "a middle frame of the shot, drawn after others, alone, and by the other driver; both ends of a closed shot",
        "equal bytes; angles ≤ 1e-5 rad",
    );
    let painting = context.painting(SceneVersion::Unchanged)?;
    let options = context.frame_options(Rotation::On);
    let frames = context.frames();
    let middle = frames[frames.len() / 2];
    let mut pixels = 0;
    for &frame in frames.iter().take(2) {
        context.picture(&painting.at(frame, &options))?;
    }
    let after_others = context.picture(&painting.at(middle, &options))?;
    let alone_painting = prepare_anywhere(context.loaded.clone())?;
    let driver = context.renderer.report().driver;
    let mut drivers = vec![driver];
    drivers.push(if driver == Driver::Osmesa { Driver::Egl } else { Driver::Osmesa });
    let mut holds = true;
    for (index, &driver) in drivers.iter().enumerate() {
        let Ok(gl_context) = open(driver, &OpenOptions::default()) else {
            row.notes.push(format!("{driver} is not here: not compared"));
            continue;
        };
        if gl_context.report().renderer != context.renderer.report().renderer {
            row.notes.push(format!("{driver} draws with {}: not compared", gl_context.report().renderer));
            continue;
        }
        let alone = Renderer::new(gl_context)?.render(&alone_painting.at(middle, &options))?;
        let differing = differing_bytes(&after_others.rgba8, &alone.rgba8);
        pixels += alone.rgba8.len() / 4;
        holds &= differing == 0;
        let what = if index == 0 { "alone".to_owned() } else { format!("by {driver}") };
        row.values.push(Reading::one(format!("bytes that differ, {what}"), "", differing as f64));
    }
    let scene = &context.loaded.scene;
    let ends = [scene.timeline.first, scene.timeline.last].map(|frame| frame as f64);
    let closed = ends[0] < ends[1]
        && motion::camera_at(scene, ends[0]) == motion::camera_at(scene, ends[1])
        && motion::poses_at(scene, ends[0]) == motion::poses_at(scene, ends[1]);
    let mut strokes = 0;
    if closed {
        let both = ends.map(|frame| painting.at(frame, &options));
        let angles = both.each_ref().map(|frame| strokes_by_key(frame, &[]));
        let apart_deg = angles[0].iter().map(|(key, first)| {
            angles[1].get(key).map_or(180.0, |last| degrees_apart(first.angle_rad, last.angle_rad))
        });
        let largest_rad = apart_deg.fold(0.0, f64::max).to_radians();
        strokes = angles[0].len();
        let [first, last] = both;
        let differing = differing_bytes(&context.picture(&first)?.rgba8, &context.picture(&last)?.rgba8);
        row.values.push(Reading::one("ends of the shot: largest difference of angles", "rad", largest_rad));
        row.values.push(Reading::one("ends of the shot: bytes that differ", "", differing as f64));
        holds &= largest_rad <= 1e-5 && differing == 0;
    } else {
        row.notes.push("the shot is not closed: its ends are not compared".to_owned());
    }
    row.counts = Counts { strokes, pixels, frames: 1 + drivers.len() };
    row.verdict = Verdict::of_pixels(holds, row.counts);
    Ok(row)
}

fn differing_bytes(first: &[u8], second: &[u8]) -> usize {
    first.iter().zip(second).filter(|(a, b)| a != b).count() + first.len().abs_diff(second.len())
}
