//! What the viewport says while the scene has nothing in it.

use egui::{Align, Layout, Rect, RichText, vec2};
use impasto_editor_model::keymap::Action;

use super::{Ask, PanelInput, row, text_width, within};
use crate::icons;
use crate::theme::{Tokens, measure, type_face};
use crate::widgets::Button;

/// Shows a hint in the middle of `ui` if the scene has no objects, otherwise nothing.
pub fn empty(ui: &mut egui::Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    if !shown.document.scene().objects.is_empty() {
        return;
    }
    let words = "Drop a mesh here, or open a scene";
    let verbs = [
        ("Open a mesh\u{2026}", "Open a mesh", Action::ImportMesh),
        ("Open a scene\u{2026}", "Open a scene", Action::OpenScene),
    ];
    let fonts = [type_face::head(), type_face::body()];
    let buttons = verbs.iter().zip(fonts).map(|((words, ..), font)| text_width(ui, words, font) + 32.0);
    let buttons = buttons.sum::<f32>() + measure::GAP;
    let wide = buttons.max(text_width(ui, words, type_face::title()));
    let rect = Rect::from_center_size(ui.max_rect().center(), vec2(wide, 128.0));
    let tokens = Tokens::of(ui);
    within(ui, rect, Layout::top_down(Align::Center), |ui| {
        ui.label(RichText::new(icons::OBJECT.glyph()).font(type_face::icon(32.0)).color(tokens.weak));
        ui.add_space(8.0);
        ui.label(RichText::new(words).font(type_face::title()).color(tokens.text));
        ui.add_space(16.0);
        let middle = egui::pos2(rect.center().x, ui.cursor().top() + 17.0);
        within(ui, Rect::from_center_size(middle, vec2(buttons, 34.0)), row(), |ui| {
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
