//! The section of the inspector for the style of brush strokes, which holds for the whole scene: how strokes turn, the
//! canvas, the relief of the paint.

use egui::Ui;
use impasto_editor_model::command::{Command, SceneEdit};
use impasto_scene::document::{Canvas, CanvasFollows, RotatingStrokes, SAMPLES, Solver, Style};

use super::Asker;
use super::ink;
use super::number::Number;
use super::parts::{pick, row};
use crate::widgets::{self, Tip};

/// Shows all settings. `shown` includes the change being previewed, `stored` does not.
pub(super) fn show(ui: &mut Ui, asker: &mut Asker<'_, '_>, [shown, stored]: [&RotatingStrokes; 2]) {
    let set = |style: RotatingStrokes, words: String| {
        Command::Scene(SceneEdit::SetStyle(Style::RotatingStrokes(style), words))
    };
    row(ui, "Solver", |ui| {
        let solvers = [Solver::Tangent, Solver::Horn, Solver::HornExact];
        let words = ["Tangent plane", "Neighbours, baked", "Neighbours, exact"];
        let tip = Tip { name: "Solver", effect: "How the turn of a stroke is found.", ..Tip::default() };
        let chosen = solvers.iter().position(|solver| *solver == shown.solver).unwrap_or(0);
        if let Some(picked) = pick(ui, tip, &words, chosen) {
            let words = format!("Solver: {}", words[picked].to_lowercase());
            asker.ask(set(RotatingStrokes { solver: solvers[picked], ..stored.clone() }, words));
        }
    });
    row(ui, "Canvas", |ui| {
        let mut board = usize::from(shown.canvas == Canvas::Board);
        if widgets::segmented_of(ui, "Canvas", &["Linen", "Board"], &mut board).changed() {
            let (canvas, words) =
                if board == 1 { (Canvas::Board, "Canvas: board") } else { (Canvas::Linen, "Canvas: linen") };
            asker.ask(set(RotatingStrokes { canvas, ..stored.clone() }, words.to_owned()));
        }
    });
    row(ui, "Canvas follows", |ui| {
        let mut camera = usize::from(shown.canvas_follows == CanvasFollows::Camera);
        if widgets::segmented_of(ui, "Canvas follows", &["Picture", "Camera"], &mut camera).changed() {
            let (canvas_follows, words) = if camera == 1 {
                (CanvasFollows::Camera, "Canvas follows the camera")
            } else {
                (CanvasFollows::Picture, "Canvas follows the picture")
            };
            asker.ask(set(RotatingStrokes { canvas_follows, ..stored.clone() }, words.to_owned()));
        }
    });
    for of in RotatingStrokes::numbers() {
        let name = ink::sentence(of.field);
        let usual = (of.get)(&RotatingStrokes::default());
        let number = Number {
            range: 0.0..=3.0,
            limits: Some(of.limits.clone()),
            scene_decides: false,
            step: (0.05, 2),
            default: Some(usual),
            ..Number::new(&name, of.effect)
        };
        asker.number(ui, &number, [shown, stored].map(of.get), |to| {
            let mut style = stored.clone();
            let to = to.unwrap_or(usual);
            *(of.of)(&mut style) = to;
            set(style, format!("{name} {to:.2}"))
        });
    }
    row(ui, "Samples", |ui| {
        let words = ["1 × 1", "2 × 2", "4 × 4"];
        let tip = Tip {
            name: "Samples",
            effect: "How finely each pixel looks at where things end. More is steadier and slower.",
            ..Tip::default()
        };
        let chosen = SAMPLES.iter().position(|samples| *samples == shown.samples).unwrap_or(0);
        if let Some(picked) = pick(ui, tip, &words, chosen) {
            let style = RotatingStrokes { samples: SAMPLES[picked], ..stored.clone() };
            asker.ask(set(style, format!("Samples: {}", words[picked])));
        }
    });
    let mut underpainting = shown.underpainting;
    if widgets::checkbox(ui, "Underpainting", &mut underpainting).changed() {
        let words = if underpainting { "Underpainting" } else { "No underpainting" };
        asker.ask(set(RotatingStrokes { underpainting, ..stored.clone() }, words.to_owned()));
    }
}
