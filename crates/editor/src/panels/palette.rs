//! The command search: finds any command, tool, setting and control of the inspector by its name.

mod entries;

use std::sync::Arc;

use egui::{Key, RichText, ScrollArea};

use self::entries::{Entry, entries};
use super::{Ask, Control, PanelInput, controls};
use crate::theme::{Tokens, measure, type_face};
use crate::widgets::{MarkKeys, MenuRow, search_field, sheet_with};

const WIDTH: f32 = 480.0;
const ROWS: f32 = 11.0;

/// What the search remembers while it is open.
#[derive(Clone, Debug, Default)]
struct Memory {
    typed: String,
    marked: usize,
    /// The controls of the inspector, once they were listed.
    controls: Option<Arc<Vec<Control>>>,
}

/// Shows the search over everything. Returns true once it closes: a command was run, or `Esc` was pressed.
pub fn palette(ctx: &egui::Context, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) -> bool {
    sheet_with(ctx, "Find a command", WIDTH, |ui, memory| contents(ui, memory, shown, asks))
}

fn contents(ui: &mut egui::Ui, memory: &mut Memory, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) -> bool {
    let pressed = MarkKeys::take(ui);
    let escape = ui.input_mut(|input| input.consume_key(egui::Modifiers::NONE, Key::Escape));
    let field = search_field(ui, &mut memory.typed, "What do you want to do?", "Command");
    if field.changed() {
        memory.marked = 0;
    }
    field.request_focus();
    ui.add_space(measure::GAP);
    let controls = memory.controls.get_or_insert_with(|| Arc::new(controls(ui.ctx(), shown)));
    let found = found(&memory.typed, entries(ui.ctx(), shown, controls));
    memory.marked = pressed.mark(memory.marked, found.len());
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
            for (index, entry) in found.into_iter().enumerate() {
                let Entry { words, keys, on, ask } = entry;
                let marked = index == memory.marked;
                let row = MenuRow { words: &words, keys: &keys, on, marked };
                let mut response = ui.add_enabled_ui(ask.is_ok(), |ui| row.show(ui)).inner;
                if marked && (pressed.moves() || field.changed()) {
                    response.scroll_to_me(None);
                }
                match ask {
                    Err(reason) => response = response.on_disabled_hover_text(reason),
                    Ok(ask) if response.clicked() || marked && pressed.enter => run = Some(ask),
                    Ok(_) => {}
                }
                drop(response);
            }
        },
    );
    let runs = run.is_some();
    asks.extend(run);
    escape || runs
}

/// The entries that match the typed text, the most likely first.
fn found(typed: &str, entries: Vec<Entry>) -> Vec<Entry> {
    let mut found: Vec<_> =
        entries.into_iter().filter_map(|entry| Some((distance(typed, &entry.words)?, entry))).collect();
    found.sort_by_key(|(distance, _)| *distance);
    found.into_iter().map(|(_, entry)| entry).collect()
}

/// How far a name is from the typed text. 0: the name begins with the text. 1: a word of the name begins with it. 2:
/// the text stands anywhere in the name. 3: the name only has the text's letters in order. None: no match.
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
mod tests;
