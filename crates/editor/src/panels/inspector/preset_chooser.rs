//! The control that chooses the preset of a region or of the scene: a built-in one, or one of the user's own.

use egui::{Popup, ScrollArea, Ui};
use impasto_editor_model::command::StrokeChange;
use impasto_scene::presets;

use super::Asker;
use super::edited_strokes::EditedStrokes;
use super::parts::{note, reset, row};
use crate::panels::Ask;
use crate::widgets::{self, MenuRow, Tip};

/// What the control shows for a region without a preset of its own.
const AS_SCENE: &str = "As the scene";

/// Width of the menu, and the most height of the list of presets in it, points.
const MENU: f32 = 168.0;
const LIST: f32 = 320.0;

pub(super) fn show(ui: &mut Ui, asker: &mut Asker<'_, '_>, place: &EditedStrokes<'_>) {
    let is_region = place.index.is_some();
    let own = place.own[0].preset.as_deref();
    let usual = asker.scene().style.info().preset.unwrap_or(presets::DEFAULT_PRESET);
    let shown = own.unwrap_or(if is_region { AS_SCENE } else { usual });
    row(ui, "Preset", |ui| {
        let face = widgets::drop_down_face(ui, "Preset", shown);
        if face.clicked() {
            asker.asks.push(Ask::ListPresets);
        }
        Popup::menu(&face).width(MENU).show(|ui| menu(ui, asker, place, shown));
        let effect = "The set of values that everything begins with.";
        Tip { name: "Preset", effect, ..Tip::default() }.on(face);
        if own.is_some_and(|own| is_region || own != usual) && reset(ui, "Preset") {
            asker.ask(place.set(StrokeChange::Preset(None)));
        }
    });
}

fn menu(ui: &mut Ui, asker: &mut Asker<'_, '_>, place: &EditedStrokes<'_>, chosen: &str) {
    let asks = [
        ("Save as preset\u{2026}", Ask::SavePreset(place.of.clone())),
        ("Load preset\u{2026}", Ask::LoadPreset(place.of.clone())),
    ];
    for (words, ask) in asks {
        if (MenuRow { words, ..MenuRow::default() }).show(ui).clicked() {
            asker.asks.push(ask);
        }
    }
    ui.add_space(4.0);
    // There may be many presets.
    let area = ScrollArea::vertical().max_height(LIST).min_scrolled_height(LIST).auto_shrink([false, true]);
    area.show(ui, |ui| list(ui, asker, place, chosen));
}

fn list(ui: &mut Ui, asker: &mut Asker<'_, '_>, place: &EditedStrokes<'_>, chosen: &str) {
    let is_region = place.index.is_some();
    if is_region && widgets::choice_row(ui, AS_SCENE, chosen == AS_SCENE).clicked() {
        asker.ask(place.set(StrokeChange::Preset(None)));
    }
    // The rule of the published paper holds only for a whole scene.
    for name in presets::names().filter(|name| !is_region || *name != presets::PAPER_PRESET) {
        if widgets::choice_row(ui, name, chosen == name).clicked() && chosen != name {
            asker.ask(place.set(StrokeChange::Preset(Some(name.to_owned()))));
        }
    }
    if !asker.shown.presets.is_empty() {
        ui.add_space(4.0);
        note(ui, "Your own");
    }
    for preset in asker.shown.presets {
        let row = MenuRow { words: &preset.name, ..MenuRow::default() }.show(ui);
        let effect = "Replaces all stroke settings here, in one step.";
        if (Tip { name: &preset.name, effect, ..Tip::default() }).on(row).clicked() {
            asker.asks.push(Ask::UsePreset(place.of.clone(), preset.path.clone()));
        }
    }
}
