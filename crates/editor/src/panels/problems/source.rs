//! The text of the scene beside the list of its problems, to be edited and read again.

use std::sync::Arc;

use egui::text::{LayoutJob, TextFormat};
use egui::{Color32, Context, Id, Rect, RichText, Role, ScrollArea, TextEdit, Ui, WidgetInfo, vec2};
use impasto_editor_model::Document;
use impasto_editor_model::document::Source;
use impasto_editor_model::editor::Mend;
use impasto_editor_model::keymap::{Action, Scope};
use impasto_scene::problem::TextPosition;

use crate::panels::{Ask, PanelInput, row_from_right, within};
use crate::theme::{Tokens, measure, type_face};
use crate::widgets::Button;

/// The height of a line of the source, points.
const LINE: f32 = 18.0;
/// A longer text is shown only around its problem, and cannot be edited here.
const MAX_EDITED_BYTES: usize = 256 << 10;
/// Lines that are shown of a longer text.
const LINES_AROUND: usize = 40;

/// Keeps the edited text from one pass to the next.
#[derive(Clone, Default)]
pub(super) struct Memory {
    /// The text being edited.
    typed: String,
    /// The document's source when `follow` last saw it. Its text is `typed`, unless `typed` has edits.
    begun_from: Option<Arc<Source>>,
    /// The line to scroll to in the next pass.
    pub(super) go_to: Option<usize>,
}

impl Memory {
    fn id() -> Id {
        Id::unique("problems source")
    }

    pub(super) fn load(ctx: &Context) -> Self {
        ctx.data(|data| data.get_temp(Self::id())).unwrap_or_default()
    }

    pub(super) fn store(self, ctx: &Context) {
        ctx.data_mut(|data| data.insert_temp(Self::id(), self));
    }

    /// Whether the text has edits: it differs from that of the source last seen.
    fn is_edited(&self) -> bool {
        self.begun_from.as_ref().is_some_and(|begun| begun.text != self.typed)
    }

    /// Follows the document's source: takes its text, unless edits would be lost. Returns whether the source is new.
    fn follow(&mut self, source: &Arc<Source>) -> bool {
        let is_new = !self.begun_from.as_ref().is_some_and(|begun| Arc::ptr_eq(begun, source));
        if is_new {
            if !self.is_edited() {
                self.typed.clone_from(&source.text);
            }
            self.begun_from = Some(Arc::clone(source));
        }
        is_new
    }
}

/// The text as it was edited beside the list, if it has not been read into the scene yet.
pub fn unread_text(ctx: &Context, document: &Document) -> Option<String> {
    let source = document.source()?;
    let memory = Memory::load(ctx);
    (memory.is_edited() && memory.typed != source.text).then_some(memory.typed)
}

/// Notes that this text was read into the scene. From then on it does not count as an edit, even if the user undoes the
/// reading.
pub fn note_read(ctx: &Context, text: &str) {
    if Memory::load(ctx).typed == text {
        forget_text(ctx);
    }
}

/// Shows this text as edited and not yet read, for a document that was opened from a copy of unsaved work.
pub fn restore_text(ctx: &Context, document: &Document, typed: String) {
    Memory { typed, begun_from: document.source().cloned(), go_to: None }.store(ctx);
}

/// Drops the edited text.
pub fn forget_text(ctx: &Context) {
    Memory::default().store(ctx);
}

/// Shows the scene's text, to be edited, with its lines numbered and the line of the problem marked.
pub(super) fn source(
    ui: &mut Ui,
    shown: &PanelInput<'_>,
    place: Option<TextPosition>,
    memory: &mut Memory,
    asks: &mut Vec<Ask>,
) {
    let tokens = Tokens::of(ui);
    ui.painter().rect_filled(ui.max_rect(), 0.0, tokens.field);
    let Some(source) = shown.document.source() else { return };
    if memory.follow(source) {
        memory.go_to = place.map(|place| place.line);
    }
    let marked = place.filter(|_| memory.typed == source.text);
    if source.text.len() > MAX_EDITED_BYTES {
        return excerpt(ui, &source.text, marked);
    }
    let id = Id::unique("text of the scene");
    let mut area = ScrollArea::both().id_salt("source").auto_shrink(false);
    if let Some(line) = memory.go_to.take() {
        area = area.vertical_scroll_offset((line.saturating_sub(4) as f32 * LINE).max(0.0));
    }
    let typed = &mut memory.typed;
    let is_changed = *typed != source.text;
    area.show(ui, |ui| {
        ui.horizontal_top(|ui| {
            let lines = typed.split('\n').count();
            let numbers: String = (1..=lines).map(|line| format!("{line:>5}\n")).collect();
            let mut plain = LayoutJob::default();
            plain.append(&numbers, 0.0, code(tokens.weak));
            ui.add(egui::Label::new(plain).selectable(false));
            let mut lay_out = |ui: &Ui, text: &dyn egui::TextBuffer, _: f32| {
                ui.painter().layout_job(coloured(text.as_str(), marked, tokens))
            };
            let edit = TextEdit::multiline(typed)
                .id(id)
                .font(type_face::number())
                .frame(egui::Frame::NONE)
                .margin(egui::Margin::ZERO)
                .desired_width(f32::INFINITY)
                .code_editor()
                .layouter(&mut lay_out);
            let edit = ui.add(edit);
            edit.widget_info(|| WidgetInfo::labeled(Role::MultilineTextInput, true, "Source"));
        });
    });
    if is_changed {
        let corner = ui.max_rect().right_bottom() - vec2(14.0, 8.0);
        let rect = Rect::from_min_max(corner - vec2(ui.max_rect().width(), measure::BUTTON), corner);
        within(ui, rect, row_from_right(), |ui| {
            ui.spacing_mut().item_spacing.x = measure::GAP;
            let button = Button::new("Read this text").primary().show(ui);
            let keys = shown.keymap.shortcut_text_in(Action::ReadSource, Scope::Typing);
            let keys = keys.map(|keys| format!(" ({keys})")).unwrap_or_default();
            let tip = format!("Reads the scene from the text above{keys}. The file on disk stays as it is.");
            if button.on_hover_text(tip).clicked() {
                asks.push(Ask::Mend(Mend::ReadText(memory.typed.clone())));
            }
            let button = Button::new("Drop it").name("Drop the edited text").show(ui);
            if button.on_hover_text("Shows the text again as the scene was read from it.").clicked() {
                *memory = Memory::default();
            }
        });
    }
}

/// The format of a line of the source.
fn code(colour: Color32) -> TextFormat {
    TextFormat { line_height: Some(LINE), ..TextFormat::simple(type_face::number(), colour) }
}

/// The text, with the line of a problem marked and what is wrong in it underlined.
fn coloured(text: &str, marked: Option<TextPosition>, tokens: &Tokens) -> LayoutJob {
    let mut job = LayoutJob { break_on_newline: true, ..LayoutJob::default() };
    job.wrap.max_width = f32::INFINITY;
    let plain = code(tokens.text);
    for (index, line) in text.split_inclusive('\n').enumerate() {
        let Some(place) = marked.filter(|place| place.line == index + 1) else {
            job.append(line, 0.0, plain.clone());
            continue;
        };
        let lit = TextFormat { background: tokens.vermilion.gamma_multiply(0.25), ..plain.clone() };
        let colour = tokens.vermilion;
        let wrong = TextFormat { color: colour, underline: egui::Stroke::new(1.0, colour), ..lit.clone() };
        let [before, word, after] = word_at(line, place.column);
        for (part, format) in [(before, lit.clone()), (word, wrong), (after, lit)] {
            job.append(part, 0.0, format);
        }
    }
    job
}

/// Splits a line into three parts: before, in and after the word or quoted text that begins at `column`. Columns count
/// from 1.
fn word_at(line: &str, column: usize) -> [&str; 3] {
    let start = line.char_indices().nth(column.saturating_sub(1)).map_or(line.len(), |(at, _)| at);
    let (before, rest) = line.split_at(start);
    let end = match rest.strip_prefix('"') {
        Some(quoted) => quoted.find('"').map_or(0, |end| end + 2),
        None => rest.find(|c: char| !(c.is_alphanumeric() || "_.-".contains(c))).unwrap_or(rest.len()),
    };
    let (word, after) = rest.split_at(end);
    [before, word, after]
}

/// Shows the lines of a long text around the problem, read-only.
fn excerpt(ui: &mut Ui, text: &str, place: Option<TextPosition>) {
    let tokens = Tokens::of(ui);
    let line = place.map_or(1, |place| place.line);
    let first = line.saturating_sub(4);
    let numbered = text.lines().enumerate().skip(first).take(LINES_AROUND);
    let lines: String = numbered
        .map(|(index, line)| format!("{:>6} {}\n", index + 1, line.chars().take(200).collect::<String>()))
        .collect();
    // Each line begins with its number, in 7 characters.
    let marked = place.map(|place| TextPosition { line: line - first, column: place.column + 7 });
    ScrollArea::both().id_salt("excerpt").auto_shrink(false).show(ui, |ui| {
        let label = ui.add(egui::Label::new(coloured(&lines, marked, tokens)).selectable(false));
        label.widget_info(|| WidgetInfo::labeled(Role::Label, true, "Source"));
        let words = "This text is too long to be edited here. Edit the file; it is read again by itself.";
        ui.label(RichText::new(words).font(type_face::small()).color(tokens.weak));
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_wrong_in_a_line_is_a_word_or_a_quoted_text() {
        assert_eq!(word_at("(mesh: \"a b.obj\", x)", 8), ["(mesh: ", "\"a b.obj\"", ", x)"]);
        assert_eq!(word_at("\u{e4}(widht_px: 19)\n", 3), ["\u{e4}(", "widht_px", ": 19)\n"]);
        assert_eq!(word_at("\"open", 1), ["", "", "\"open"]);
        assert_eq!(word_at("short", 99), ["short", "", ""]);
    }
}
