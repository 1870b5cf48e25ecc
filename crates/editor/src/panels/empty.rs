//! What the viewport says while the scene has nothing in it.

use egui::{Align, Layout, RichText, vec2};
use impasto_editor_model::keymap::Action;

use super::{Ask, Shown, text_width, within};
use crate::icons;
use crate::theme::{Tokens, type_face};
use crate::widgets::Button;

/// Stands in the middle of `ui`, where a scene has no objects; else nothing.
pub fn empty(ui: &mut egui::Ui, shown: &Shown<'_>, asks: &mut Vec<Ask>) {
    if !shown.document.scene().objects.is_empty() {
        return;
    }
    let words = "Drop an OBJ here, or open a scene";
    let verbs = [
        ("Open a mesh\u{2026}", "Open a mesh", Action::ImportMesh),
        ("Open a scene\u{2026}", "Open a scene", Action::OpenScene),
    ];
    let wide =
        verbs.iter().map(|(words, ..)| text_width(ui, words, type_face::head()) + 32.0).sum::<f32>() + 32.0;
    let wide = wide.max(text_width(ui, words, type_face::title()));
    let rect = egui::Rect::from_center_size(ui.max_rect().center(), vec2(wide, 128.0));
    let tokens = Tokens::of(ui);
    within(ui, rect, Layout::top_down(Align::Center), |ui| {
        ui.label(RichText::new(icons::OBJECT.glyph()).font(type_face::icon(32.0)).color(tokens.weak));
        ui.add_space(8.0);
        ui.label(RichText::new(words).font(type_face::title()).color(tokens.text));
        ui.add_space(16.0);
        ui.horizontal(|ui| {
            for (index, (words, name, action)) in verbs.into_iter().enumerate() {
                let button = Button::new(words).name(name).on_sheet();
                let button = if index == 0 { button.primary() } else { button };
                if button.show(ui).clicked() {
                    asks.push(Ask::Act(action));
                }
            }
        });
    });
}
