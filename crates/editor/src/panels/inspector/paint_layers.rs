//! The rows of the inspector for the settings of one layer of paint. The user chooses the layer, from the underpainting
//! to the lights.

use egui::Ui;
use impasto_editor_model::command::StrokeChange;
use impasto_scene::document::{LayerNumber, LayerSettings, ResolvedStrokes};
use impasto_scene::presets::LayerKind;

use super::Asker;
use super::edited_strokes::EditedStrokes;
use super::number::Number;
use super::parts::{pick, row};
use crate::panels::column_state::ColumnState;
use crate::widgets::Tip;

/// Rounds away the digits that only the conversion from 32 to 64 bits added.
fn tidy(value: f32) -> f64 {
    (f64::from(value) * 1e6).round() / 1e6
}

/// The numbers of a layer that are shown, each with its field. The size of a layer is not shown: it keeps its
/// proportion to the size of the body layer.
fn shown() -> impl Iterator<Item = (&'static LayerNumber, Number<'static>)> {
    LayerSettings::NUMBERS.iter().filter_map(|of| {
        let share = |name| Number::share(name, of.number.effect);
        let shown = match of.number.field {
            "coverage" => {
                Number { unit: "\u{d7}", range: 0.0..=8.0, step: (0.1, 2), ..share("Layer coverage") }
            }
            "opacity" => share("Layer opacity"),
            "thickness" => Number { range: 0.0..=2.0, ..share("Layer thickness") },
            "dryness" => share("Layer dryness"),
            "pickup" => share("Layer pickup"),
            _ => return None,
        };
        Some((of, Number { limits: Some(of.number.limits.clone()), scene_decides: false, ..shown }))
    })
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
    // The body layer's coverage is already shown, as that of the strokes.
    let is_twin = |name: &str| kind == LayerKind::Body && name == "Layer coverage";
    for (of, number) in shown().filter(|(_, number)| !is_twin(number.name)) {
        let known = place.own[1].layers.iter().find(|layer| layer.name == kind.name());
        let empty = LayerSettings { name: kind.name().to_owned(), ..LayerSettings::default() };
        let settings = known.cloned().unwrap_or(empty);
        let value_in =
            |resolved: &ResolvedStrokes| tidy(*(of.resolved)(&mut resolved.layer_of(kind).clone()));
        let values = place.resolved.each_ref().map(value_in);
        let is_own = (of.number.get)(&settings).is_some();
        let default = is_own.then(|| {
            let mut without = place.own[1].clone();
            for layer in without.layers.iter_mut().filter(|layer| layer.name == kind.name()) {
                *(of.number.of)(layer) = None;
            }
            value_in(&place.resolve(asker.stored(), &without))
        });
        asker.number(ui, &Number { default, ..number }, values, |to| {
            let mut settings = settings.clone();
            *(of.number.of)(&mut settings) = to;
            place.set(StrokeChange::PaintLayer(Box::new(settings)))
        });
    }
}
