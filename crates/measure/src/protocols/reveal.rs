//! M6: what the reference view did not see.

use std::collections::BTreeMap;

use glam::DVec3;
use impasto_core::angle::wrap_half_pi;
use impasto_painting::frame::LayerKind;
use impasto_painting::{Painting, Rotation};
use impasto_scene::motion::{self, CameraPose};

use super::popping::left_out;
use crate::cameras::orbited;
use crate::figures::Spread;
use crate::looks::{Look, TurnSolver};
use crate::metric::Metric;
use crate::options::MeasureError;
use crate::report::{LEAST_STROKES, Reading, Row, Verdict};
use crate::strokes::{SeenStroke, SeenStrokes, of_layer};
use crate::studio::Studio;
use crate::truth::{BodyView, SurfacePoint, TrueView};

/// A stroke is seen when its surface faces the eye by this cosine, and this much of it was drawn.
const FACED: f64 = 0.2;
const DRAWN: f64 = 0.1;

/// How many neighbours a stroke is compared with.
const NEIGHBOURS: usize = 10;

/// Views about a quarter and a half of the way round; several, for strokes enough.
const QUARTER_DEG: [f64; 6] = [-90.0, 90.0, -100.0, 100.0, -80.0, 80.0];
const HALF_DEG: [f64; 5] = [180.0, 170.0, 190.0, 160.0, 200.0];

pub(super) fn row(studio: &mut Studio<'_>) -> Result<Row, MeasureError> {
    let mut row = Row::new(
        Metric::M6,
        "camera round its target by 80 to 100 and by 160 to 200 deg; body layer without chance, second families and contour; \
         strokes that the reference view saw from behind, against their 10 nearest visible neighbours of the same region",
        "90 deg: median ≤ 3, p95 ≤ 12; 180 deg: median ≤ 6, p95 ≤ 25",
    );
    let looks = [
        ("", Look::Calm(TurnSolver::Own)),
        ("the paper's rule, ", Look::CalmPaper),
        ("horn, ", Look::Calm(TurnSolver::Horn)),
    ];
    let mut judged = Vec::new();
    for (index, (rule, look)) in looks.into_iter().enumerate() {
        let few = if index == 0 { usize::MAX } else { 2 };
        for (angle, views) in [("90 deg", &QUARTER_DEG[..]), ("180 deg", &HALF_DEG[..])] {
            let views = &views[..views.len().min(few)];
            let mut differences = Vec::new();
            for &angle_deg in views {
                let camera = orbited(&studio.reference_camera(), angle_deg);
                let shown = studio.show_from(look, &camera)?;
                let painting = studio.painting(look)?;
                let views = [studio.reference_camera(), camera];
                let frame = studio.reference_frame();
                differences.extend(revealed(studio, &painting, &shown.strokes, (&views, [frame, frame])));
            }
            let spread = Spread::of(differences);
            let reading = Reading::many(format!("{rule}{angle}: to a neighbour"), "deg", spread);
            if index == 0 {
                row.values.push(reading);
                row.counts.frames += views.len();
                row.counts.strokes += spread.count / NEIGHBOURS;
                judged.push(spread);
            } else {
                row.baselines.push(reading);
            }
        }
    }
    on_shot(studio, &mut row)?;
    left_out(studio, &mut row);
    row.notes.push("a constant angle scores 0: read it with M3".to_owned());
    let fits = |spread: &Spread, median: f64, p95: f64| spread.median <= median && spread.p95 <= p95;
    let holds = fits(&judged[0], 3.0, 12.0) && fits(&judged[1], 6.0, 25.0);
    row.verdict = Verdict::of(holds, row.counts);
    if judged.iter().any(|spread| spread.count < LEAST_STROKES * NEIGHBOURS) {
        let counts: Vec<String> =
            judged.iter().map(|spread| (spread.count / NEIGHBOURS).to_string()).collect();
        row.verdict = Verdict::TooFew(format!("{} strokes at 90 and 180 deg", counts.join(" and ")));
    }
    Ok(row)
}

/// What the shot itself reveals; printed, not judged.
fn on_shot(studio: &mut Studio<'_>, row: &mut Row) -> Result<(), MeasureError> {
    let look = Look::Truth(TurnSolver::Own);
    let painting = studio.painting(look)?;
    let mut differences = Vec::new();
    let reference = studio.reference_frame();
    for frame in studio.frames() {
        let shown = studio.show(look, frame, Rotation::On)?;
        let views = [studio.reference_camera(), motion::camera_at(&studio.loaded.scene, frame)];
        differences.extend(revealed(studio, &painting, &shown.strokes, (&views, [reference, frame])));
    }
    if !differences.is_empty() {
        row.values.push(Reading::many(
            "the shot, with its chance: to a neighbour",
            "deg",
            Spread::of(differences),
        ));
    }
    Ok(())
}

/// For each stroke that is seen now and that the reference view saw from behind, how far its neighbours' angles are from
/// its own, degrees.
fn revealed(
    studio: &Studio<'_>,
    painting: &Painting,
    strokes: &SeenStrokes,
    (cameras, frames): (&[CameraPose; 2], [f64; 2]),
) -> Vec<f64> {
    let reference = TrueView::new(&cameras[0], studio.size_px);
    let poses = motion::poses_at(painting.scene(), frames[0]);
    let mut groups: BTreeMap<(u32, u32), Vec<Visible>> = BTreeMap::new();
    for (key, stroke) in of_layer(strokes, LayerKind::Body) {
        let object = key.body_id as usize - 1;
        let particle = painting.particles(object).get(key.particle as usize);
        let Some(particle) = particle.filter(|_| stroke.facing > FACED && stroke.alpha > DRAWN) else {
            continue;
        };
        let point =
            SurfacePoint { position: particle.position.as_dvec3(), normal: particle.normal.as_dvec3() };
        let body = BodyView { view: &reference, world_from_model: poses[object] };
        let visible =
            Visible { position: point.position, stroke: *stroke, was_unseen: body.facing(point) <= 0.0 };
        groups.entry((key.body_id, stroke.region)).or_default().push(visible);
    }
    groups.values().flat_map(|group| neighbour_differences_deg(group)).collect()
}

/// A stroke that is seen.
struct Visible {
    position: DVec3,
    stroke: SeenStroke,
    was_unseen: bool,
}

/// |wrap_π(θᵢ − θⱼ)| over the nearest neighbours on the surface of each stroke that was unseen, degrees.
fn neighbour_differences_deg(group: &[Visible]) -> Vec<f64> {
    let mut differences = Vec::new();
    for (index, stroke) in group.iter().enumerate().filter(|(_, stroke)| stroke.was_unseen) {
        let mut others: Vec<(f64, f64)> = group
            .iter()
            .enumerate()
            .filter(|(other, _)| *other != index)
            .map(|(_, other)| {
                let apart = wrap_half_pi(stroke.stroke.angle_rad - other.stroke.angle_rad);
                (stroke.position.distance_squared(other.position), apart.abs().to_degrees())
            })
            .collect();
        others.sort_by(|a, b| a.0.total_cmp(&b.0));
        differences.extend(others.iter().take(NEIGHBOURS).map(|(_, apart)| apart));
    }
    differences
}
