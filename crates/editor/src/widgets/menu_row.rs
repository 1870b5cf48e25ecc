//! A widget: a row of a menu that shows a command and its keys.

use egui::{Align2, Color32, Response, Role, Sense, Ui, vec2};

use super::draw;
use crate::icons;
use crate::theme::{Tokens, measure, type_face};

/// A command in a menu or a list of commands, with its keys at the right end.
#[derive(Clone, Copy, Debug, Default)]
pub struct MenuRow<'a> {
    /// What it says, which is also its name.
    pub words: &'a str,
    /// Its keys, empty if it has none.
    pub keys: &'a str,
    /// Whether a tick stands before it.
    pub on: bool,
    /// Whether `Enter` would run it.
    pub marked: bool,
}

impl MenuRow<'_> {
    /// The least width of the row, points.
    pub fn width(&self, ui: &Ui) -> f32 {
        let words = draw::width(ui, self.words, type_face::body());
        words + draw::width(ui, self.keys, type_face::number()) + 28.0 + 36.0
    }

    /// Draws it, as wide as the menu.
    pub fn show(&self, ui: &mut Ui) -> Response {
        let tokens = Tokens::of(ui);
        let wide = ui.available_width().max(self.width(ui));
        let (rect, response) = ui.allocate_exact_size(vec2(wide, measure::ROW), Sense::click());
        let rest = if self.marked || response.has_focus() { tokens.hov } else { Color32::TRANSPARENT };
        ui.painter().rect_filled(rect, draw::corner(), draw::fill(tokens, &response, rest));
        let lit = self.marked || response.hovered() || response.has_focus();
        let weak = if lit { tokens.text } else { tokens.weak };
        if self.on {
            let at = rect.left_center() + vec2(14.0, 0.0);
            draw::icon(ui.painter(), at, icons::CHECK, measure::SMALL_ICON, tokens.text);
        }
        let at = rect.left_center() + vec2(28.0, 0.0);
        draw::words(ui.painter(), at, Align2::LEFT_CENTER, self.words, type_face::body(), tokens.text);
        let end = rect.right_center() - vec2(12.0, 0.0);
        draw::words(ui.painter(), end, Align2::RIGHT_CENTER, self.keys, type_face::number(), weak);
        draw::named_state(&response, Role::MenuItem, self.words, self.on);
        response
    }
}
