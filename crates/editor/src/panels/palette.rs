//! The command search: finds any command by its name.

use egui::{Id, Key, RichText, Role, ScrollArea, TextEdit, WidgetInfo};
use impasto_editor_model::keymap::Action;

use super::{Ask, PanelInput, menus};
use crate::theme::{Tokens, measure, type_face};
use crate::widgets::{MenuRow, sheet};

const WIDTH: f32 = 480.0;
const ROWS: f32 = 11.0;

/// What the search remembers while it is open.
#[derive(Clone, Debug, Default)]
struct Memory {
    typed: String,
    marked: usize,
}

/// Shows the search over everything. True once it closes: a command was run, or `Esc` was pressed.
pub fn palette(ctx: &egui::Context, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) -> bool {
    let id = Id::unique("command search");
    let mut memory = ctx.data(|data| data.get_temp::<Memory>(id)).unwrap_or_default();
    let close = sheet(ctx, "Find a command", WIDTH, |ui| contents(ui, &mut memory, shown, asks));
    ctx.data_mut(|data| {
        if close {
            data.remove::<Memory>(id);
        } else {
            data.insert_temp(id, memory);
        }
    });
    close
}

fn contents(ui: &mut egui::Ui, memory: &mut Memory, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) -> bool {
    let (up, down, enter, escape) = ui.input_mut(|input| {
        let none = egui::Modifiers::NONE;
        (
            input.consume_key(none, Key::ArrowUp),
            input.consume_key(none, Key::ArrowDown),
            input.consume_key(none, Key::Enter),
            input.consume_key(none, Key::Escape),
        )
    });
    let field = TextEdit::singleline(&mut memory.typed)
        .hint_text("What do you want to do?")
        .desired_width(f32::INFINITY)
        .margin(egui::Margin::symmetric(8, 7))
        .show(ui);
    let field = field.response.response;
    field
        .widget_info(|| WidgetInfo { label: Some("Command".to_owned()), ..WidgetInfo::new(Role::TextInput) });
    if field.changed() {
        memory.marked = 0;
    }
    field.request_focus();
    ui.add_space(measure::GAP);
    let found = found(&memory.typed);
    let last = found.len().saturating_sub(1);
    memory.marked = match (up, down) {
        (true, _) => memory.marked.saturating_sub(1),
        (_, true) => memory.marked + 1,
        _ => memory.marked,
    };
    memory.marked = memory.marked.min(last);
    let mut run = None;
    ui.spacing_mut().item_spacing.y = 0.0;
    let high = ROWS * measure::ROW;
    ScrollArea::vertical().max_height(high).min_scrolled_height(high).auto_shrink([false, false]).show(
        ui,
        |ui| {
            if found.is_empty() {
                ui.add_space(6.0);
                let words = RichText::new("No command has that name.").font(type_face::body());
                ui.label(words.color(Tokens::of(ui).weak));
            }
            for (index, action) in found.iter().enumerate() {
                let keys = shown.keys_of(*action);
                let marked = index == memory.marked;
                let row = MenuRow { words: action.name(), keys: &keys, on: false, marked };
                let reason = shown.why_not(*action);
                let mut response = ui.add_enabled_ui(reason.is_none(), |ui| row.show(ui)).inner;
                if marked && (up || down || field.changed()) {
                    response.scroll_to_me(None);
                }
                if let Some(reason) = reason {
                    response = response.on_disabled_hover_text(reason);
                }
                if reason.is_none() && (response.clicked() || marked && enter) {
                    run = Some(*action);
                }
            }
        },
    );
    asks.extend(run.map(Ask::Act));
    escape || run.is_some()
}

/// The commands that may be meant by what was typed, the most likely first.
fn found(typed: &str) -> Vec<Action> {
    let mut found: Vec<_> = menus::actions()
        .into_iter()
        .filter(|action| *action != Action::Palette)
        .filter_map(|action| Some((distance(typed, action.name())?, action)))
        .collect();
    found.sort_by_key(|(distance, _)| *distance);
    found.into_iter().map(|(_, action)| action).collect()
}

/// How far a name is from what was typed: 0 if the name begins with it, 1 if a word of the name does, 2 if it stands
/// anywhere in the name, 3 if the name only has its letters in order. None if there is no match.
fn distance(typed: &str, name: &str) -> Option<u8> {
    let (typed, name) = (typed.trim().to_lowercase(), name.to_lowercase());
    if name.starts_with(&typed) {
        return Some(0);
    }
    if name.split(' ').any(|word| word.starts_with(&typed)) || name.contains(&format!(" {typed}")) {
        return Some(1);
    }
    if name.contains(&typed) {
        return Some(2);
    }
    let mut letters = name.chars();
    let in_order = typed
        .chars()
        .filter(|letter| !letter.is_whitespace())
        .all(|letter| letters.any(|other| other == letter));
    in_order.then_some(3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_most_likely_command_comes_first() {
        assert_eq!(found("comb").first(), Some(&Action::Comb));
        assert_eq!(found("sel").first(), Some(&Action::SelectAll), "menu order among equals");
        assert_eq!(found("frame s").first(), Some(&Action::FrameSelected));
        assert_eq!(found("camera").first(), Some(&Action::CameraFromView));
        assert_eq!(found("gdcv").first(), Some(&Action::GuideCurve), "letters in order are enough");
        assert_eq!(found("zzz"), []);
        assert_eq!(found("").len() + 1, menus::actions().len(), "all but itself");
    }
}
