//! Draws keys as they are printed on a keyboard, for hints of shortcuts.

use egui::{Align2, Response, Role, Sense, Stroke, StrokeKind, Ui, vec2};

use super::draw;
use crate::theme::{Tokens, type_face};

/// A key or a mouse button, drawn as a key cap: `Ctrl`, `F`, `Middle`.
pub fn key_cap(ui: &mut Ui, key: &str) -> Response {
    let tokens = Tokens::of(ui);
    let size = vec2(draw::width(ui, key, small_number()) + 10.0, 16.0);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    let line = Stroke::new(1.0, tokens.div);
    ui.painter().rect(rect, 3.0, egui::Color32::TRANSPARENT, line, StrokeKind::Inside);
    draw::words(ui.painter(), rect.center(), Align2::CENTER_CENTER, key, small_number(), tokens.weak);
    draw::named(&response, Role::Label, key);
    response
}

/// A key and what it does, as on the status line.
pub fn key_hint(ui: &mut Ui, key: &str, does: &str) {
    ui.spacing_mut().item_spacing.x = 7.0;
    key_cap(ui, key);
    ui.label(egui::RichText::new(does).font(type_face::small()).color(Tokens::of(ui).weak));
    ui.add_space(5.0);
}

fn small_number() -> egui::FontId {
    egui::FontId::monospace(11.0)
}
