//! Tooltips of one form: name, key, effect, range.

use egui::{Response, RichText, Ui};

use crate::theme::{Tokens, type_face};

/// What a tooltip says: the control's name and key, its effect in one sentence, and its range and default.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tip<'a> {
    /// The control's name.
    pub name: &'a str,
    /// Its key, empty if it has none.
    pub key: &'a str,
    /// One sentence on what it does.
    pub effect: &'a str,
    /// Range and default, such as *0 to 1, default 1.* Empty if there is no range.
    pub range: &'a str,
}

impl Tip<'_> {
    /// Shows the tooltip while the pointer rests on `response`.
    pub fn on(self, response: Response) -> Response {
        response.on_hover_ui(|ui| self.show(ui))
    }

    /// Shows the tooltip while the pointer rests on `response`, a control that is disabled.
    pub fn on_disabled(self, response: Response) -> Response {
        response.on_disabled_hover_ui(|ui| self.show(ui))
    }

    fn show(self, ui: &mut Ui) {
        let tokens = Tokens::of(ui);
        ui.horizontal(|ui| {
            ui.label(RichText::new(self.name).font(type_face::head()).color(tokens.text));
            if !self.key.is_empty() {
                ui.label(RichText::new(self.key).font(type_face::number()).color(tokens.weak));
            }
        });
        for (line, colour) in [(self.effect, tokens.text), (self.range, tokens.weak)] {
            if !line.is_empty() {
                ui.label(RichText::new(line).font(type_face::small()).color(colour));
            }
        }
    }
}
