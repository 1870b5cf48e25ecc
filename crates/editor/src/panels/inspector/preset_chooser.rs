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

/// How many cards stand in each row.
const CARDS: usize = 3;
/// The gap between cards, points.
const GAP: f32 = 4.0;
/// The greatest height of the list of presets in the menu, points.
const LIST: f32 = 480.0;

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
        let wide = CARDS as f32 * (widgets::PRESET_CARD.x + GAP) + 8.0;
        Popup::menu(&face).width(wide).show(|ui| {
            asker.asks.push(Ask::PicturePresets(place.of.clone()));
            menu(ui, asker, place, shown);
        });
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
    // There may be many presets, and the window may be low.
    let most = LIST.min(ui.ctx().content_rect().height() * 0.65);
    let area = ScrollArea::vertical().max_height(most).min_scrolled_height(most).auto_shrink([false, true]);
    area.show(ui, |ui| list(ui, asker, place, chosen));
}

fn list(ui: &mut Ui, asker: &mut Asker<'_, '_>, place: &EditedStrokes<'_>, chosen: &str) {
    let is_region = place.index.is_some();
    if is_region && widgets::choice_row(ui, AS_SCENE, chosen == AS_SCENE).clicked() {
        asker.ask(place.set(StrokeChange::Preset(None)));
    }
    let shown = asker.shown;
    let picture =
        |key: &str| shown.preset_pictures.get(key).map(|picture| (picture.id(), picture.size_vec2()));
    // The preset that follows the published paper works only for a whole scene.
    let built_in = presets::names().filter(|name| !is_region || *name != presets::PAPER_PRESET);
    cards(ui, built_in, |ui, name| {
        if widgets::preset_card(ui, name, picture(name), chosen == name).clicked() && chosen != name {
            asker.ask(place.set(StrokeChange::Preset(Some(name.to_owned()))));
        }
    });
    if !shown.presets.is_empty() {
        ui.add_space(4.0);
        note(ui, "Your own");
    }
    cards(ui, shown.presets, |ui, preset| {
        let card = widgets::preset_card(ui, &preset.name, picture(&preset.key()), false);
        let effect = "Replaces all stroke settings here, in one step.";
        if (Tip { name: &preset.name, effect, ..Tip::default() }).on(card).clicked() {
            asker.asks.push(Ask::UsePreset(place.of.clone(), preset.path.clone()));
        }
    });
}

fn cards<T>(ui: &mut Ui, all: impl IntoIterator<Item = T>, mut card: impl FnMut(&mut Ui, T)) {
    let mut rest = all.into_iter().peekable();
    while rest.peek().is_some() {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = GAP;
            rest.by_ref().take(CARDS).for_each(|item| card(ui, item));
        });
    }
}
