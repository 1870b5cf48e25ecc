//! What differs in single layers of paint, from the underpainting to the lights.

use egui::Ui;
use impasto_editor_model::command::StrokeChange;
use impasto_scene::document::LayerSettings;
use impasto_scene::limits::{MAX_COVERAGE, MAX_THICKNESS};
use impasto_scene::presets::{LayerKind, ResolvedLayer};

use super::Asker;
use super::edited_strokes::EditedStrokes;
use super::number::Number;
use super::parts::{pick, row};
use crate::panels::column_state::ColumnState;
use crate::widgets::Tip;

struct LayerField {
    number: Number<'static>,
    resolved: fn(&ResolvedLayer) -> f32,
    own: fn(&mut LayerSettings) -> &mut Option<f64>,
}

/// Takes off what only the step from 32 to 64 bits put there.
fn tidy(value: f32) -> f64 {
    (f64::from(value) * 1e6).round() / 1e6
}

fn fields() -> [LayerField; 5] {
    [
        LayerField {
            number: Number {
                unit: "\u{d7}",
                range: 0.0..=8.0,
                limits: Some(0.0..=MAX_COVERAGE),
                step: (0.1, 2),
                ..Number::new(
                    "Layer coverage",
                    "How many strokes lie over each other; 0 leaves the layer out.",
                )
            },
            resolved: |layer| layer.coverage,
            own: |settings| &mut settings.coverage,
        },
        LayerField {
            number: Number::share("Layer opacity", "How much a stroke hides of what lies under it."),
            resolved: |layer| layer.opacity,
            own: |settings| &mut settings.opacity,
        },
        LayerField {
            number: Number {
                range: 0.0..=2.0,
                limits: Some(0.0..=MAX_THICKNESS),
                ..Number::share("Layer thickness", "How high the paint stands; 1 is the lights' full brush.")
            },
            resolved: |layer| layer.thickness,
            own: |settings| &mut settings.thickness,
        },
        LayerField {
            number: Number::share("Layer dryness", "How much of its mark the brush leaves out."),
            resolved: |layer| layer.dryness,
            own: |settings| &mut settings.dryness,
        },
        LayerField {
            number: Number::share("Layer pickup", "How much wet paint a stroke takes up from below."),
            resolved: |layer| layer.pickup,
            own: |settings| &mut settings.pickup,
        },
    ]
}

pub(super) fn show(ui: &mut Ui, asker: &mut Asker<'_, '_>, place: &EditedStrokes<'_>) {
    let chosen = ColumnState::with(ui.ctx(), |state| state.paint_layer).min(LayerKind::ALL.len() - 1);
    row(ui, "Paint layer", |ui| {
        let names = LayerKind::ALL.map(LayerKind::name);
        let tip = Tip {
            name: "Paint layer",
            effect: "Which layer of paint the next five numbers are of, from below.",
            ..Tip::default()
        };
        if let Some(picked) = pick(ui, tip, &names, chosen) {
            ColumnState::with(ui.ctx(), |state| state.paint_layer = picked);
        }
    });
    let kind = LayerKind::ALL[chosen];
    // The strokes' own coverage is that of the body.
    let is_twin = |name: &str| kind == LayerKind::Body && name == "Layer coverage";
    for field in fields().into_iter().filter(|field| !is_twin(field.number.name)) {
        let known = place.own[1].layers.iter().find(|layer| layer.name == kind.name());
        let empty = LayerSettings { name: kind.name().to_owned(), ..LayerSettings::default() };
        let settings = known.cloned().unwrap_or(empty);
        let values =
            place.resolved.each_ref().map(|resolved| tidy((field.resolved)(resolved.layer_of(kind))));
        let is_own = (field.own)(&mut settings.clone()).is_some();
        let default = is_own.then(|| {
            let mut without = place.own[1].clone();
            for layer in without.layers.iter_mut().filter(|layer| layer.name == kind.name()) {
                *(field.own)(layer) = None;
            }
            tidy((field.resolved)(place.resolve(asker.stored(), without).layer_of(kind)))
        });
        asker.number(ui, &Number { default, ..field.number.clone() }, values, |to| {
            let mut settings = settings.clone();
            *(field.own)(&mut settings) = to;
            place.set(StrokeChange::PaintLayer(Box::new(settings)))
        });
    }
}
