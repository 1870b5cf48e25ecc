//! The status line, at the bottom of the window: what is going on, what the mouse and the keys would do now, background
//! work, a few numbers, and how many problems there are.

use egui::{Panel, RichText, Role, WidgetInfo, accesskit};

use super::{Ask, Numbers, PanelInput, row, row_from_right, within};
use crate::theme::{Tokens, measure, type_face};
use crate::widgets;

/// A piece of the status text: words, and the key that they explain, if any.
#[derive(Debug, PartialEq, Eq)]
struct Part<'a> {
    key: Option<&'a str>,
    words: &'a str,
}

/// Shows the status line in the lowest 24 points of `ui`.
pub fn status_line(ui: &mut egui::Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    let frame = egui::Frame::new().fill(Tokens::of(ui).alt);
    Panel::bottom("status line").exact_size(measure::STATUS_LINE).resizable(false).frame(frame).show(
        ui,
        |ui| {
            let mut free = ui.max_rect().shrink2(egui::vec2(10.0, 0.0));
            let right = within(ui, free, row_from_right(), |ui| {
                ui.spacing_mut().item_spacing.x = 14.0;
                // First the problems, at the right end of the line, where they do not move as numbers come and go.
                super::problems::chip(ui, shown, asks);
                for words in numbers(&shown.numbers) {
                    note(ui, &words);
                }
                for work in shown.numbers.works {
                    super::work::show(ui, work, asks);
                }
                ui.min_rect().left()
            });
            free.max.x = right - 14.0;
            let whole = ui.interact(free, ui.scope_id().with("status"), egui::Sense::hover());
            whole.widget_info(|| WidgetInfo::labeled(Role::Status, true, "Status"));
            ui.ctx().accesskit_node_builder(whole.id, |node| {
                node.set_live(accesskit::Live::Polite);
                node.set_value(shown.status);
            });
            within(ui, free, row(), |ui| {
                ui.set_clip_rect(ui.clip_rect().intersect(free));
                ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Extend);
                for part in parts(shown.status) {
                    match part.key {
                        Some(key) => widgets::key_hint(ui, key, part.words),
                        None => {
                            note(ui, part.words);
                            ui.add_space(6.0);
                        }
                    }
                }
            });
        },
    );
}

fn note(ui: &mut egui::Ui, words: &str) {
    ui.label(RichText::new(words).font(type_face::small()).color(Tokens::of(ui).weak));
}

/// The driver's name, and the numbers as words; the rightmost first.
fn numbers(numbers: &Numbers<'_>) -> Vec<String> {
    let mut words = Vec::new();
    if !numbers.driver.is_empty() {
        words.push(numbers.driver.to_owned());
    }
    words.extend(numbers.pictures_per_second.map(|rate| format!("{rate:.0} fps")));
    if numbers.strokes > 0 {
        words.push(format!("{} strokes", grouped(numbers.strokes)));
    }
    words
}

/// A count with commas between thousands: *5,774*.
pub(super) fn grouped(count: usize) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// Splits a status text into pieces, each `[Key] words` or plain words. A piece ends at two spaces, or where the next
/// `[Key]` begins.
fn parts(mut text: &str) -> Vec<Part<'_>> {
    let mut parts = Vec::new();
    loop {
        let open = text.find('[').filter(|open| text[*open..].contains(']'));
        let before = &text[..open.unwrap_or(text.len())];
        let words = before.split("  ").map(str::trim).filter(|words| !words.is_empty());
        parts.extend(words.map(|words| Part { key: None, words }));
        let Some(open) = open else { return parts };
        let rest = &text[open + 1..];
        let Some((key, rest)) = rest.split_once(']') else { return parts };
        let end = rest.find('[').unwrap_or(rest.len()).min(rest.find("  ").unwrap_or(rest.len()));
        parts.push(Part { key: Some(key.trim()), words: rest[..end].trim() });
        text = &rest[end..];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Vec<(&str, &str)> {
        parts(text).into_iter().map(|part| (part.key.unwrap_or(""), part.words)).collect()
    }

    #[test]
    fn status_texts_fall_into_keys_and_words() {
        assert_eq!(read("[Drag] comb  [Shift] smooth"), [("Drag", "comb"), ("Shift", "smooth")]);
        assert_eq!(
            read("Move apple  X 0.80   [X Y Z] axis  [Shift X] plane  type a number  [Enter] keep"),
            [
                ("", "Move apple"),
                ("", "X 0.80"),
                ("X Y Z", "axis"),
                ("Shift X", "plane"),
                ("", "type a number"),
                ("Enter", "keep"),
            ]
        );
        assert_eq!(read("skin is locked. [L] unlocks it"), [("", "skin is locked."), ("L", "unlocks it")]);
        assert_eq!(read("a[3 is no key"), [("", "a[3 is no key")]);
        assert_eq!(read(""), []);
    }

    #[test]
    fn counts_are_grouped_by_thousands() {
        assert_eq!([0, 999, 5_774, 1_234_567].map(grouped), ["0", "999", "5,774", "1,234,567"]);
    }
}
