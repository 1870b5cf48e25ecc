//! Typing into a number field: text that is no number, or beyond the limits, is marked and rejected.

use egui::{Key, Rect, Response, Role, Stroke, StrokeKind, Ui, UiBuilder, WidgetInfo};

use super::{Memory, NumberField};
use crate::theme::{Tokens, type_face};
use crate::widgets::{draw, keep_focus};

impl NumberField<'_> {
    /// Shows the text field. Returns whether typing has ended, and whether `Esc` ended it.
    pub(super) fn type_in(
        &mut self,
        ui: &mut Ui,
        id: egui::Id,
        frame: Rect,
        memory: &mut Memory,
        editor: &mut Option<Response>,
    ) -> (bool, bool) {
        let mut typed = memory.typed.take().unwrap_or_default();
        let edit_id = id.with("typed");
        let fresh = egui::text_edit::TextEditState::load(ui.ctx(), edit_id).is_none();
        let tokens = Tokens::of(ui);
        let is_wrong = self.wrong_in(&typed).is_some();
        let line = Stroke::new(2.0, if is_wrong { tokens.vermilion } else { tokens.accent_text });
        ui.painter().rect(frame, draw::corner(), tokens.field, line, StrokeKind::Inside);
        let mut inside = ui.new_child(UiBuilder::new().max_rect(frame));
        // The typed text begins where the number is drawn while it is not being edited.
        let before = if self.centred || self.letter.is_empty() { 0 } else { super::LETTER as i8 };
        self.draw_letter(ui, frame);
        let align = if self.centred { egui::Align::Center } else { egui::Align::Min };
        let is_text = |event: &egui::Event| matches!(event, egui::Event::Text(_));
        let at_once = fresh && ui.input(|input| input.events.iter().any(is_text));
        if at_once {
            // Text typed in this same pass replaces the number. In later passes it does so because the whole number is
            // selected.
            ui.memory_mut(|memory| memory.request_focus(edit_id));
            typed.clear();
        }
        let output = egui::TextEdit::singleline(&mut typed)
            .id(edit_id)
            .frame(egui::Frame::NONE)
            .margin(egui::Margin { left: 8 + before, right: 8, top: 4, bottom: 4 })
            .desired_width(frame.width() - 16.0 - f32::from(before))
            .align(egui::Align2([align, egui::Align::Center]))
            .font(type_face::number())
            .show(&mut inside);
        let response = output.response.response;
        let name = self.name;
        response
            .widget_info(|| WidgetInfo { label: Some(name.to_owned()), ..WidgetInfo::new(Role::TextInput) });
        if at_once {
            // To the text field, the click that opened it counts as a click elsewhere, which would end its focus.
            response.request_focus();
            keep_focus(ui.ctx(), edit_id);
        } else if fresh || self.default.is_none() && is_double_click_in(ui, frame) {
            // In a field without a default, a double click selects the whole number.
            response.request_focus();
            let mut state = output.state;
            let all = egui::text::CCursorRange::two(
                egui::text::CCursor::default(),
                egui::text::CCursor::new(egui::text::CharIndex(typed.chars().count())),
            );
            state.cursor.set_char_range(Some(all));
            state.store(ui.ctx(), edit_id);
        }
        let wrong = self.wrong_in(&typed);
        let is_wrong = wrong.is_some();
        if let Some(words) = wrong {
            ui.ctx().accesskit_node_builder(response.id, |node| {
                node.set_invalid(egui::accesskit::Invalid::True);
            });
            let words = egui::RichText::new(words).font(type_face::small());
            egui::Tooltip::always_open(ui.ctx().clone(), ui.layer_id(), id.with("limits"), frame)
                .show(|ui| ui.label(words.color(tokens.vermilion)));
        }
        let mut done = response.lost_focus() && !fresh;
        let cancelled = done && ui.input(|input| input.key_pressed(Key::Escape));
        if done && is_wrong && ui.input(|input| input.key_pressed(Key::Enter)) {
            // The text stays, to be corrected.
            response.request_focus();
            done = false;
        }
        if done {
            ui.data_mut(|data| data.remove::<egui::text_edit::TextEditState>(edit_id));
            if let Some(number) = self.read(&typed).filter(|_| !cancelled && !is_wrong) {
                self.set(number);
            }
        } else {
            memory.typed = Some(typed);
        }
        *editor = Some(response);
        (done, cancelled)
    }

    /// Resets the value after a double click on the text field, and returns whether it did. Without a default it does
    /// nothing. The first click opens the text field, so the second one lands there.
    pub(super) fn is_double_clicked(&mut self, ui: &Ui, id: egui::Id, frame: Rect) -> bool {
        let Some(default) = self.default else { return false };
        let is_here = is_double_click_in(ui, frame);
        if is_here {
            let edit_id = id.with("typed");
            ui.data_mut(|data| data.remove::<egui::text_edit::TextEditState>(edit_id));
            ui.memory_mut(|memory| memory.surrender_focus(edit_id));
            *self.value = default;
        }
        is_here
    }

    /// What is wrong with the typed text, in words; `None` if nothing is.
    fn wrong_in(&self, typed: &str) -> Option<String> {
        match self.read(typed).filter(|number| self.limits.contains(number)) {
            Some(number) => self.refused.and_then(|why| why(number)),
            None => Some(self.limits_in_words()),
        }
    }

    /// Which numbers may be typed, in words: *0 to 1*.
    fn limits_in_words(&self) -> String {
        let (least, most) = (*self.limits.start(), *self.limits.end());
        let unit = self.unit;
        match (least.is_finite(), most.is_finite()) {
            (true, true) => format!("{} to {}{unit}", self.text_of(least), self.text_of(most)),
            (true, false) => format!("{}{unit} or more", self.text_of(least)),
            (false, true) => format!("{}{unit} or less", self.text_of(most)),
            (false, false) => "Any number".to_owned(),
        }
    }
}

fn is_double_click_in(ui: &Ui, frame: Rect) -> bool {
    ui.input(|input| {
        let pointer = &input.pointer;
        pointer.button_double_clicked(egui::PointerButton::Primary)
            && pointer.interact_pos().is_some_and(|at| frame.contains(at))
    })
}

/// Reads a number from typed text, with a decimal comma or point, and with or without the unit.
pub(super) fn number_of(typed: &str, unit: &str) -> Option<f64> {
    let text = typed.trim();
    let text = text.strip_suffix(unit).unwrap_or(text).trim();
    let text = text.replace('\u{2212}', "-").replace(',', ".");
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn typed_numbers_are_read_the_way_people_write_them() {
        assert_eq!(number_of(" 34 px", "px"), Some(34.0));
        assert_eq!(number_of("\u{2212}2,5\u{b0}", "\u{b0}"), Some(-2.5));
        assert_eq!(number_of("", "px"), None);
        assert_eq!(number_of("NaN", ""), None);
        assert_eq!(number_of("inf", ""), None);
        assert_eq!(number_of("four", ""), None);
    }
}
