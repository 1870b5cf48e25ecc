//! The inspector's row for the pigments that the strokes of a region, or of the scene, are mixed from.

use egui::{Popup, Ui, vec2};
use impasto_editor_model::command::{Command, StrokeChange};
use impasto_scene::document::Color;
use impasto_scene::limits::MAX_PALETTE;

use super::Asker;
use super::edited_strokes::EditedStrokes;
use super::parts::{note, reset, row, seen};
use crate::icons;
use crate::widgets::{self, MenuRow, Tip};

/// The first pigment of a palette that had none: a red earth.
const FIRST: Color = Color::from_bytes([0xb3, 0x4a, 0x2e]);

/// Shows a square for each pigment. A click opens a picker, and a right click a menu that takes the pigment out.
pub(super) fn show(ui: &mut Ui, asker: &mut Asker<'_, '_>, place: &EditedStrokes<'_>) {
    let [shown, stored] = place.resolved.each_ref().map(|resolved| resolved.palette.clone());
    let set = |palette: Vec<Color>| place.set(StrokeChange::Palette(Some(palette)));
    let with = |index: usize, color: Color| {
        let mut palette = stored.clone();
        match palette.get_mut(index) {
            Some(pigment) => *pigment = color,
            None => palette.push(color),
        }
        set(palette)
    };
    row(ui, "Palette", |ui| {
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing = vec2(2.0, 2.0);
            for (index, &pigment) in shown.iter().enumerate() {
                pigment_square(ui, asker, (index, pigment), |color| with(index, color), || {
                    let mut left = stored.clone();
                    if index < left.len() {
                        left.remove(index);
                    }
                    set(left)
                });
            }
            if shown.is_empty() {
                note(ui, "any colour");
            }
            if shown.len() < MAX_PALETTE {
                let tip = Tip {
                    name: "Add a pigment to the palette",
                    effect: "Strokes take their hue from the nearest pigments, and keep how light and dark they are.",
                    range: "Without pigments they have any colour.",
                    ..Tip::default()
                };
                let button = widgets::icon_button(ui, icons::ADD, tip.name);
                if tip.on(button).clicked() {
                    asker.ask(with(stored.len(), stored.last().copied().unwrap_or(FIRST)));
                }
            }
            if place.own[0].palette.is_some() && reset(ui, "Palette") {
                asker.ask(place.set(StrokeChange::Palette(None)));
            }
        });
    });
}

fn pigment_square(
    ui: &mut Ui,
    asker: &mut Asker<'_, '_>,
    (index, pigment): (usize, Color),
    with: impl Fn(Color) -> Command,
    without: impl Fn() -> Command,
) {
    let name = format!("Pigment {}", index + 1);
    let response = asker.colour(ui, &name, seen(pigment), with);
    let mut is_taken_out = false;
    // The menu needs an id of its own, because the colour picker uses the square's.
    let menu = Popup::context_menu(&response).id(response.id.with("menu"));
    menu.show(|ui| {
        let row = MenuRow { words: "Take out", ..MenuRow::default() };
        ui.set_width(row.width(ui));
        is_taken_out = row.show(ui).clicked();
    });
    if is_taken_out {
        asker.ask(without());
    }
}
