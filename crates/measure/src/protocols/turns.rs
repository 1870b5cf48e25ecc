//! M3, angles in general: measures how exactly strokes turn, on the shot and on fixed views of the reference pose.

use impasto_painting::Rotation;
use impasto_scene::motion::{self, CameraPose};

use crate::cameras::{moved_sideways, orbited, zoomed};
use crate::context::MeasureContext;
use crate::figures::Spread;
use crate::metric::Metric;
use crate::options::MeasureError;
use crate::report::{Counts, Reading, Row, Series, Verdict};
use crate::strokes::strokes_by_key;
use crate::turns::{Reference, Turn};
use crate::versions::{SceneVersion, TurnSolver};

fn fixed_views(camera: &CameraPose) -> Vec<CameraPose> {
    vec![
        orbited(camera, 10.0),
        orbited(camera, -30.0),
        orbited(camera, 50.0),
        moved_sideways(camera, [0.15, 0.0]),
        moved_sideways(camera, [-0.1, 0.12]),
        zoomed(camera, 2.0),
    ]
}

/// Angle errors of one way of turning strokes, on the shot and on the fixed views.
#[derive(Default)]
struct TurnErrors {
    errors_deg: Vec<f64>,
    material_deg: Vec<f64>,
    frames: usize,
    max_of_frame: Vec<(f64, f64)>,
}

fn turn_errors(
    context: &mut MeasureContext<'_>,
    solver: TurnSolver,
    rotation: Rotation,
) -> Result<TurnErrors, MeasureError> {
    let painting = context.painting(SceneVersion::NoContour(solver))?;
    let reference = Reference::of(&painting, context.size_px);
    let options = context.frame_options(rotation);
    let scene = &context.loaded.scene;
    let at_rest = context.reference_frame();
    let shot = context.frames().into_iter().map(|frame| (motion::camera_at(scene, frame), frame, true));
    let fixed = fixed_views(&context.reference_camera()).into_iter().map(|camera| (camera, at_rest, false));
    let mut found = TurnErrors::default();
    for (camera, frame, is_shot) in shot.chain(fixed) {
        let strokes = strokes_by_key(&painting.seen_by(&camera, frame, &options), &[]);
        let turns = reference.turns(&painting, &strokes, &camera, frame, options.size_px);
        let errors: Vec<f64> = turns.values().map(Turn::error_deg).collect();
        if is_shot {
            found.max_of_frame.push((frame, errors.iter().copied().fold(0.0, f64::max)));
        }
        found.material_deg.extend(turns.values().map(Turn::material_error_deg));
        found.errors_deg.extend(errors);
        found.frames += 1;
    }
    Ok(found)
}

pub(super) fn row(context: &mut MeasureContext<'_>, series: &mut Vec<Series>) -> Result<Row, MeasureError> {
    let mut row = Row::new(
        Metric::M3,
        "the shot, and the reference pose seen from 10, 30, 50 deg aside, moved sideways, twice as near; body layer without \
         contour (which follows the view by design), strokes that the reference faces by cos 0.5",
        "tangent: max ≤ 0.01 deg; horn as it is",
    );
    let ours = turn_errors(context, TurnSolver::Own, Rotation::On)?;
    row.counts = Counts { strokes: ours.errors_deg.len(), pixels: 0, frames: ours.frames };
    let spread = Spread::of(ours.errors_deg);
    row.values = vec![
        Reading::many("against φ(A)", "deg", spread),
        Reading::many("against the material line arg(A d), inherent", "deg", Spread::of(ours.material_deg)),
    ];
    for (name, solver) in [("horn", TurnSolver::Horn), ("horn-exact", TurnSolver::HornExact)] {
        let errors = turn_errors(context, solver, Rotation::On)?.errors_deg;
        row.baselines.push(Reading::many(name, "deg", Spread::of(errors)));
    }
    let fixed = turn_errors(context, TurnSolver::Own, Rotation::Off)?.errors_deg;
    row.baselines.push(Reading::many("fixed angle", "deg", Spread::of(fixed)));
    let flatness = impasto_scene::presets::resolve(&context.loaded.scene, None).flatness;
    let is_horn = uses_horn(context);
    if flatness < 1.0 {
        row.notes
            .push("flatness below 1 lets strokes follow material lines: the error to φ(A) is wanted".into());
    }
    if is_horn {
        row.notes.push("the scene asks for horn: printed, not judged".to_owned());
    }
    row.verdict = Verdict::of(is_horn || flatness < 1.0 || spread.max <= 0.01, row.counts);
    series.push(Series {
        metric: Metric::M3,
        title: "largest angle error",
        target: 0.01,
        unit: "deg",
        points: ours.max_of_frame,
    });
    Ok(row)
}

/// Whether the scene itself asks for the source paper's solver.
pub(super) fn uses_horn(context: &MeasureContext<'_>) -> bool {
    use impasto_scene::document::{Solver, Style};
    let scene = &context.loaded.scene;
    let by_style = matches!(&scene.style, Style::RotatingStrokes(style) if style.solver != Solver::Tangent);
    by_style || impasto_scene::presets::is_paper(scene)
}
