//! A part of M11, authoring: do strokes on a guide follow its line, when seen from the view in which the guide was
//! drawn?

use glam::DVec3;
use impasto_painting::frame::LayerKind;
use impasto_scene::document::{Falloff, Guide, GuideMode, Scene};
use impasto_scene::motion::{self, CameraPose};

use crate::context::MeasureContext;
use crate::figures::Spread;
use crate::options::MeasureError;
use crate::report::{Reading, Row};
use crate::strokes::{of_layer, strokes_by_key};
use crate::truth::TrueView;
use crate::versions::SceneVersion;

/// Strokes within this share of a guide's radius count as lying on it.
const ON_IT: f64 = 0.05;

/// Strokes are left out if the cosine between their surface's normal and the direction to the eye is smaller than this.
const FACED: f64 = 0.35;

/// The largest difference allowed between a stroke on a guide and the guide as drawn, degrees.
const MOST_DEG: f64 = 0.5;

/// Adds the result to the row of M11. It covers only guides that comb at full strength on their line and less away
/// from it (not [`Falloff::Flat`]). Returns false if a stroke on such a guide does not show as drawn, or if there are
/// such guides but no stroke lies on them.
pub(super) fn add(context: &mut MeasureContext<'_>, row: &mut Row) -> Result<bool, MeasureError> {
    let scene = context.loaded.scene.clone();
    let (mut errors, mut guides) = (Vec::new(), 0);
    for (region, guide) in scene
        .regions
        .iter()
        .enumerate()
        .flat_map(|(index, region)| region.guides.iter().map(move |g| (index, g)))
    {
        let combs = guide.mode == GuideMode::Comb && guide.strength >= 1.0;
        if combs && guide.falloff != Falloff::Flat {
            errors.extend(at_guide(context, &scene, region, guide)?);
            guides += 1;
        }
    }
    if guides == 0 {
        row.notes.push("no guide of full strength: painted against shown is not measured".to_owned());
        return Ok(true);
    }
    let spread = Spread::of(errors);
    row.values.push(Reading::many("painted against shown at the guides", "deg", spread));
    row.notes.push(format!("{guides} guides, each from the view that it was drawn in"));
    Ok(spread.count > 0 && spread.max <= MOST_DEG)
}

/// The angles between the strokes on a guide and the guide as drawn, degrees.
fn at_guide(
    context: &mut MeasureContext<'_>,
    scene: &Scene,
    region: usize,
    guide: &Guide,
) -> Result<Vec<f64>, MeasureError> {
    let name = guide.object.as_deref().or(scene.regions[region].on.object());
    let Some(object) = scene.objects.iter().position(|object| Some(object.name.as_str()) == name) else {
        return Ok(Vec::new());
    };
    let frame = context.reference_frame();
    let pose = motion::poses_at(scene, frame)[object];
    let camera = match &guide.view {
        None => context.reference_camera(),
        Some(view) => CameraPose {
            eye: pose.transform_point3(DVec3::from(view.eye)),
            target: pose.transform_point3(DVec3::from(view.target)),
            ..context.reference_camera()
        },
    };
    let painting = context.painting(SceneVersion::NoAngleChance)?;
    let options = context.frame_options(impasto_painting::Rotation::On);
    let strokes = strokes_by_key(&painting.seen_by(&camera, frame, &options), &[]);
    let view = TrueView::new(&camera, context.size_px);
    let others: Vec<&Guide> = scene.regions[region].guides.iter().filter(|other| *other != guide).collect();
    let mut errors = Vec::new();
    for (key, stroke) in of_layer(&strokes, LayerKind::Body) {
        let is_of_region = key.body_id as usize == object + 1 && stroke.region as usize == region;
        if !is_of_region || stroke.facing < FACED {
            continue;
        }
        let at = painting.particles(object).at(key.particle as usize).position.as_dvec3();
        let Some((distance, along, turn_deg)) = nearest(guide, at) else { continue };
        let is_combed_again = others
            .iter()
            .any(|other| nearest(other, at).is_some_and(|(distance, ..)| distance < other.radius));
        if distance > ON_IT * guide.radius || is_combed_again {
            continue;
        }
        let step = along * 1e-5;
        let pixel = |at: DVec3| view.pixel(pose.transform_point3(at));
        let drawn = pixel(at + step) - pixel(at - step);
        let turned_rad = (turn_deg + scene.regions[region].turn_deg).to_radians();
        let off = impasto_core::angle::wrap_half_pi(stroke.angle_rad - drawn.y.atan2(drawn.x) - turned_rad);
        errors.push(off.abs().to_degrees());
    }
    Ok(errors)
}

/// The distance of a point to a guide's line, the direction of the line there, and by how many degrees strokes are
/// turned from that direction. At each of the guide's points, the direction is the mean of the two pieces that meet
/// there. Along a piece it changes evenly.
fn nearest(guide: &Guide, at: DVec3) -> Option<(f64, DVec3, f64)> {
    let points: Vec<DVec3> = guide.points.iter().map(|point| DVec3::from(point.at)).collect();
    let pieces: Vec<DVec3> = points.windows(2).map(|pair| (pair[1] - pair[0]).normalize_or_zero()).collect();
    let at_point = |index: usize| {
        let before = pieces[index.saturating_sub(1)];
        let after = pieces[index.min(pieces.len() - 1)];
        (before + after).normalize_or_zero()
    };
    let on_piece = |index: usize| {
        let (from, to) = (points[index], points[index + 1]);
        let t = ((at - from).dot(to - from) / (to - from).length_squared()).clamp(0.0, 1.0);
        let along = at_point(index) * (1.0 - t) + at_point(index + 1) * t;
        let [turn, next] = [index, index + 1].map(|point| guide.points[point].turn_deg);
        ((from + (to - from) * t - at).length(), along.normalize_or_zero(), turn + (next - turn) * t)
    };
    (0..pieces.len()).map(on_piece).min_by(|a, b| a.0.total_cmp(&b.0))
}
