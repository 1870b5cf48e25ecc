//! Measures M1 and M2: do the picture, and the strokes' angles, turn as they should when the camera rolls about its
//! gaze?

use impasto_gl_render::Picture;
use impasto_painting::{FrameOptions, Rotation};

use crate::cameras::rolled;
use crate::context::MeasureContext;
use crate::figures::Spread;
use crate::metric::Metric;
use crate::options::MeasureError;
use crate::orientation::{Tensors, error_rad};
use crate::plane::Plane;
use crate::report::{Counts, Reading, Row, Verdict};
use crate::roll::{quarter_difference, roll_errors_deg};
use crate::strokes::strokes_by_key;
use crate::turning::disk;
use crate::versions::SceneVersion;

/// Side of M1's picture.
const SIDE_PX: u32 = 400;

/// Only a disk in the middle is compared, where the picture's border has no influence. This is its radius as a share
/// of the largest possible.
const DISK: f64 = 0.85;

/// Standard deviation of the Gaussian over which structure tensors are averaged, pixels.
const TENSOR_PX: f64 = 2.0;

/// Rolls by angles that are not quarter turns, degrees.
const ODD_DEG: [f64; 3] = [7.0, 30.0, 137.0];

/// With more particles than this, M2 measures each roll angle at one picture size only.
const MANY_PARTICLES: usize = 120_000;

/// How the pictures of a rolled camera differ from the picture of the unrolled camera, turned to match.
#[derive(Default)]
struct Turned {
    mean: f64,
    over_16: f64,
    orientation_deg: Vec<f64>,
    pixels: usize,
}

pub(super) fn pictures(context: &mut MeasureContext<'_>) -> Result<Row, MeasureError> {
    let mut row = Row::new(
        Metric::M1,
        "camera rolled at the reference frame, square picture on a board, no relief, no varnish; surfaces within a disk",
        "90, 180, 270: mean ≤ 2 of 255, ≤ 1 % over 16; 7, 30, 137: streaks ≤ 0.5 deg",
    );
    let ours = turned(context, Rotation::On, &ODD_DEG)?;
    row.counts = Counts { pixels: ours.pixels, frames: 1 + 3 + ODD_DEG.len(), strokes: 0 };
    row.values = vec![
        Reading::one("quarter turns: mean difference", "of 255", ours.mean),
        Reading::one("over 16 of 255", "%", 100.0 * ours.over_16),
    ];
    for (angle_deg, error) in ODD_DEG.iter().zip(&ours.orientation_deg) {
        row.values.push(Reading::one(format!("streaks at {angle_deg} off by"), "deg", *error));
    }
    let fixed = turned(context, Rotation::Off, &ODD_DEG[1..2])?;
    row.baselines = vec![
        Reading::one("fixed angle: mean difference", "of 255", fixed.mean),
        Reading::one("fixed angle: streaks at 30 off by", "deg", fixed.orientation_deg[0]),
    ];
    let streaks = ours.orientation_deg.iter().all(|&error| error <= 0.5);
    row.verdict = Verdict::of_pixels(ours.mean <= 2.0 && ours.over_16 <= 0.01 && streaks, row.counts);
    Ok(row)
}

fn turned(
    context: &mut MeasureContext<'_>,
    rotation: Rotation,
    odd_deg: &[f64],
) -> Result<Turned, MeasureError> {
    let painting = context.painting(SceneVersion::Bare)?;
    let options = FrameOptions { rotation, ..FrameOptions::new([SIDE_PX, SIDE_PX]) };
    let (camera, frame) = (context.reference_camera(), context.reference_frame());
    let side = SIDE_PX as usize;
    let inside = disk([side, side], DISK);
    let mut take = |roll_deg: f64| -> Result<(Picture, Vec<bool>), MeasureError> {
        let camera = rolled(&camera, roll_deg.to_radians());
        let picture = context.picture(&painting.seen_by(&camera, frame, &options))?;
        let ids = context.renderer.read_reference().body_id;
        let mask = ids.iter().zip(&inside).map(|(&id, &inside)| id > 0 && inside).collect();
        Ok((picture, mask))
    };
    let (straight, _) = take(0.0)?;
    let mut found = Turned::default();
    let (mut sum, mut over) = (0.0, 0usize);
    for quarters in 1..=3 {
        let (picture, mask) = take(90.0 * f64::from(quarters))?;
        let difference = quarter_difference(&straight, &picture, quarters, &mask);
        sum += difference.mean * difference.pixels as f64;
        over += difference.over_16;
        found.pixels += difference.pixels;
    }
    found.mean = sum / found.pixels.max(1) as f64;
    found.over_16 = over as f64 / found.pixels.max(1) as f64;
    let tensors = Tensors::of(&Plane::luma(&straight), TENSOR_PX);
    for &roll_deg in odd_deg {
        let (picture, mask) = take(roll_deg)?;
        let other = Tensors::of(&Plane::luma(&picture), TENSOR_PX);
        let (error, pixels) = error_rad(&tensors, &other, -roll_deg.to_radians(), &mask);
        found.orientation_deg.push(error.to_degrees().abs());
        found.pixels += pixels;
    }
    Ok(found)
}

pub(super) fn angles(context: &mut MeasureContext<'_>) -> Result<Row, MeasureError> {
    let painting = context.painting(SceneVersion::Body)?;
    let height = context.size_px[1].max(2);
    let sizes = [[height, height], [(height * 16 / 9).max(2), height], [(height * 9 / 21).max(2), height]];
    let all = painting.particle_total() <= MANY_PARTICLES;
    let mut row = Row::new(
        Metric::M2,
        "camera rolled at the reference frame by every degree at 1:1, 16:9 and 9:21; body layer, strokes present in both",
        "max ≤ 0.001 deg",
    );
    if !all {
        row.notes.push(format!(
            "{} particles: each degree is taken at one of the three sizes, in turn",
            painting.particle_total()
        ));
    }
    let camera = context.reference_camera();
    let frame = context.reference_frame();
    let mut errors = Vec::new();
    let mut fixed = Vec::new();
    for (which, &size_px) in sizes.iter().enumerate() {
        let strokes = |roll_deg: f64, rotation: Rotation| {
            let options = FrameOptions { rotation, ..FrameOptions::new(size_px) };
            let camera = rolled(&camera, roll_deg.to_radians());
            strokes_by_key(&painting.seen_by(&camera, frame, &options), &[])
        };
        let straight = strokes(0.0, Rotation::On);
        row.counts.strokes += straight.len();
        for degree in (1..=360u32).filter(|degree| all || *degree as usize % sizes.len() == which) {
            let roll_deg = f64::from(degree);
            errors.extend(roll_errors_deg(&straight, &strokes(roll_deg, Rotation::On), roll_deg));
            row.counts.frames += 1;
        }
        fixed.extend(roll_errors_deg(&straight, &strokes(30.0, Rotation::Off), 30.0));
    }
    let spread = Spread::of(errors);
    row.values.push(Reading::many("error", "deg", spread));
    row.baselines.push(Reading::many("fixed angle at 30:", "deg", Spread::of(fixed)));
    row.verdict = Verdict::of(spread.max <= 1e-3, row.counts);
    Ok(row)
}
