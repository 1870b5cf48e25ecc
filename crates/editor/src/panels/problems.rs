//! The problems of a scene that could not be read completely: a list with the repairs for each, and the text beside it.

use std::sync::Arc;

use egui::text::{LayoutJob, TextFormat};
use egui::{
    Align, Align2, Color32, Context, FontId, Id, Panel, Rect, RichText, Role, ScrollArea, Sense, TextEdit,
    Ui, WidgetInfo, pos2, vec2,
};
use impasto_editor_model::document::{ProblemRow, Repair, Source};
use impasto_editor_model::editor::Mend;
use impasto_editor_model::{Document, Item, Selection};
use impasto_scene::problem::TextPosition;

use super::{Ask, PanelInput, row, row_from_right, within};
use crate::icons;
use crate::theme::{Tokens, measure, type_face};
use crate::widgets::{self, Button};

const HEIGHT: f32 = 232.0;
const HEAD: f32 = 41.0;
const FOOT: f32 = 44.0;
const ROW: f32 = 44.0;
/// The height of a line of the source.
const LINE: f32 = 18.0;
/// The list's share of the width.
const LIST: f32 = 0.6;
/// A longer text is shown only around its problem, and cannot be edited here.
const MAX_EDITED_BYTES: usize = 256 << 10;
/// Lines that are shown of a longer text.
const LINES_AROUND: usize = 40;

/// What the panel remembers from one pass to the next.
#[derive(Clone, Default)]
struct Memory {
    selected: usize,
    /// The text being edited, and the source that it began as.
    typed: String,
    begun_from: Option<Arc<Source>>,
    /// The line to scroll to in the next pass.
    go_to: Option<usize>,
}

fn memory_id() -> Id {
    Id::unique("problems panel")
}

/// The text as it was edited beside the list, if it has not been read into the scene yet.
pub fn unread_text(ctx: &Context, document: &Document) -> Option<String> {
    let source = document.source()?;
    let memory: Memory = ctx.data(|data| data.get_temp(memory_id()))?;
    let is_of_source = memory.begun_from.is_some_and(|from| from.text == source.text);
    (is_of_source && memory.typed != source.text).then_some(memory.typed)
}

/// Shows the panel, 232 points high, at the bottom of `ui`. Returns false once it is closed or no problem is left.
pub fn problems(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) -> bool {
    let rows = shown.document.problems();
    if rows.is_empty() {
        return false;
    }
    let tokens = Tokens::of(ui);
    let mut stays = true;
    let frame = egui::Frame::new().fill(tokens.panel);
    let panel = Panel::bottom("problems").exact_size(HEIGHT).resizable(false).frame(frame);
    let shown_panel = panel.show(ui, |ui| {
        let whole = ui.max_rect();
        ui.painter().hline(whole.x_range(), whole.top(), (2.0, tokens.vermilion));
        let id = memory_id();
        let mut memory: Memory = ui.data(|data| data.get_temp(id)).unwrap_or_default();
        memory.selected = memory.selected.min(rows.len() - 1);
        let split = whole.left() + (whole.width() * LIST).round();
        let part = |x: egui::Rangef, top: f32, bottom: f32| Rect::from_x_y_ranges(x, top..=bottom);
        let head_rect = part(whole.x_range(), whole.top() + 2.0, whole.top() + HEAD);
        within(ui, head_rect.shrink2(vec2(12.0, 0.0)), row(), |ui| {
            stays = head(ui, shown, rows.len(), asks);
        });
        ui.painter().hline(whole.x_range(), head_rect.bottom(), (1.0, tokens.div));
        let left = egui::Rangef::new(whole.left(), split);
        let certain_count = shown.document.certain().len();
        let foot = if certain_count > 0 { FOOT } else { 0.0 };
        let list_rect = part(left, head_rect.bottom() + 1.0, whole.bottom() - foot);
        within(ui, list_rect, egui::Layout::top_down(Align::Min), |ui| {
            list(ui, &rows, &mut memory, asks);
        });
        if certain_count > 0 {
            let rect = part(left, whole.bottom() - FOOT, whole.bottom()).shrink2(vec2(12.0, 0.0));
            within(ui, rect, row(), |ui| fix_all(ui, certain_count, asks));
        }
        ui.painter().vline(split, head_rect.bottom()..=whole.bottom(), (1.0, tokens.div));
        let source_rect =
            part(egui::Rangef::new(split + 1.0, whole.right()), head_rect.bottom() + 1.0, whole.bottom());
        let place = rows[memory.selected].problem.place;
        within(ui, source_rect, egui::Layout::top_down(Align::Min), |ui| {
            source(ui, shown, place, &mut memory, asks);
        });
        ui.data_mut(|data| data.insert_temp(id, memory));
    });
    shown_panel.response.widget_info(|| WidgetInfo::labeled(Role::Group, true, "Problems"));
    stays
}

/// Returns false when the panel is closed.
fn head(ui: &mut Ui, shown: &PanelInput<'_>, count: usize, asks: &mut Vec<Ask>) -> bool {
    let tokens = Tokens::of(ui);
    let is_lossy = shown.document.loss_count() > 0;
    let glyph = if is_lossy { (icons::ERROR, tokens.vermilion) } else { (icons::WARNING, tokens.ochre) };
    ui.spacing_mut().item_spacing.x = 10.0;
    ui.label(RichText::new(glyph.0.glyph()).font(type_face::icon(measure::ICON)).color(glyph.1));
    let of = shown.document.name();
    let words = if count == 1 { format!("1 problem in {of}") } else { format!("{count} problems in {of}") };
    ui.label(RichText::new(words).font(type_face::head()).color(tokens.text));
    let calm = "The file on disk stays as it is until you choose.";
    ui.label(RichText::new(calm).font(type_face::body()).color(tokens.weak));
    let mut stays = true;
    let rest = ui.available_rect_before_wrap();
    within(ui, rest, row_from_right(), |ui| {
        ui.spacing_mut().item_spacing.x = measure::GAP;
        if !is_lossy && widgets::icon_button(ui, icons::CLOSE, "Close problems").clicked() {
            stays = false;
        }
        if Button::new("Save a copy\u{2026}").name("Save a copy").show(ui).clicked() {
            asks.push(Ask::SaveCopy);
        }
        let again = Button::new("Read again").icon(icons::REFRESH).show(ui);
        if again.on_hover_text("Reads the file on disk once more. Ctrl Z takes it back.").clicked() {
            asks.push(Ask::Mend(Mend::ReadAgain));
        }
    });
    stays
}

fn fix_all(ui: &mut Ui, count: usize, asks: &mut Vec<Ask>) {
    ui.spacing_mut().item_spacing.x = measure::GAP;
    let words = format!("Fix all that are certain ({count})");
    if Button::new(&words).name("Fix all that are certain").show(ui).clicked() {
        asks.push(Ask::Mend(Mend::FixCertain));
    }
    let note = RichText::new("as one step, Ctrl Z takes it back").font(type_face::small());
    ui.label(note.color(Tokens::of(ui).weak));
}

fn list(ui: &mut Ui, rows: &[ProblemRow], memory: &mut Memory, asks: &mut Vec<Ask>) {
    ui.spacing_mut().item_spacing.y = 0.0;
    ScrollArea::vertical().id_salt("problems").auto_shrink(false).show_rows(
        ui,
        ROW,
        rows.len(),
        |ui, range| {
            for index in range {
                let (rect, response) =
                    ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::click());
                line(ui, rect, &response, &rows[index], memory.selected == index, asks);
                if response.clicked() {
                    memory.selected = index;
                    memory.go_to = rows[index].problem.place.map(|place| place.line);
                    asks.extend(concerned(&rows[index]).map(|item| Ask::Select(Selection::only(item))));
                }
            }
        },
    );
}

/// The item that a problem is about, where it can be selected.
fn concerned(row: &ProblemRow) -> Option<Item> {
    row.repairs.iter().find_map(|repair| match repair {
        Repair::Locate { object } => Some(Item::Object(object.clone())),
        Repair::Snap { region, .. } => Some(Item::Region(region.clone())),
        Repair::Fix { .. } => None,
    })
}

/// Draws one problem of the list: its place, its words, its repairs.
fn line(
    ui: &mut Ui,
    rect: Rect,
    response: &egui::Response,
    shown: &ProblemRow,
    is_selected: bool,
    asks: &mut Vec<Ask>,
) {
    let tokens = Tokens::of(ui);
    let ProblemRow { problem, instead, repairs } = shown;
    let is_fatal = problem.severity.is_fatal();
    if is_selected || response.hovered() {
        ui.painter().rect_filled(rect, 0.0, if is_selected { tokens.sel } else { tokens.hov });
    }
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, tokens.div));
    if response.has_focus() {
        ui.painter().rect_stroke(rect.shrink(2.0), 2.0, (2.0, tokens.accent_text), egui::StrokeKind::Inside);
    }
    let (icon, colour, kind) = match is_fatal {
        true => (icons::ERROR, tokens.vermilion, "error"),
        false => (icons::WARNING, tokens.ochre, "warning"),
    };
    let middle = rect.center().y;
    let font = type_face::icon(measure::ICON);
    ui.painter().text(pos2(rect.left() + 21.0, middle), Align2::CENTER_CENTER, icon.glyph(), font, colour);
    let (place, spoken) = match problem.place {
        Some(TextPosition { line, column }) => {
            (format!("{line}:{column}"), format!("line {line} column {column}, "))
        }
        None => (String::new(), String::new()),
    };
    ui.painter().text(
        pos2(rect.left() + 40.0, middle),
        Align2::LEFT_CENTER,
        place,
        type_face::number(),
        tokens.weak,
    );
    let name = format!("{spoken}{kind}, {}", problem.message);
    response.widget_info(|| WidgetInfo::labeled(Role::ListItem, true, &name));
    let words_left = rect.left() + 94.0;
    let buttons = Rect::from_x_y_ranges(words_left..=rect.right() - 12.0, rect.y_range());
    let right = within(ui, buttons, row_from_right(), |ui| {
        ui.spacing_mut().item_spacing.x = measure::GAP;
        for repair in repairs.iter().rev() {
            repair_button(ui, repair, asks);
        }
        if repairs.is_empty() { buttons.right() } else { ui.min_rect().left() - 12.0 }
    });
    let second = match (instead.is_empty(), problem.mend.is_empty()) {
        (false, true) => instead.clone(),
        (true, _) => sentence(&problem.mend),
        // The list of known names is left to the tooltip.
        (false, false) => {
            let mend = problem.mend.split(" Known here").next().unwrap_or_default();
            let mend = mend.split("known here").next().unwrap_or_default();
            format!("{} {instead}", sentence(mend)).trim().to_owned()
        }
    };
    let wide = (right - words_left).max(40.0);
    for (words, font, colour, y) in [
        // Where a file was looked for is left to the tooltip.
        (
            sentence(problem.message.split(" (tried ").next().unwrap_or_default()),
            type_face::body(),
            tokens.text,
            middle - 9.0,
        ),
        (second, type_face::small(), tokens.weak, middle + 9.0),
    ] {
        let mut job = with_code(&words, font, colour);
        job.wrap = egui::text::TextWrapping::truncate_at_width(wide);
        let galley = ui.painter().layout_job(job);
        let at = Align2::LEFT_CENTER.anchor_size(pos2(words_left, y), galley.size()).min;
        ui.painter().galley(at, galley, colour);
    }
    let whole = format!("{}\n{}", sentence(&problem.message), sentence(&problem.mend));
    response.clone().on_hover_ui(|ui| {
        let mut job = with_code(&whole, type_face::body(), tokens.text);
        (job.break_on_newline, job.wrap.max_width) = (true, ui.spacing().tooltip_width);
        ui.label(job);
    });
}

fn repair_button(ui: &mut Ui, repair: &Repair, asks: &mut Vec<Ask>) {
    match repair {
        Repair::Locate { object } => {
            if Button::new("Locate\u{2026}").name("Locate").show(ui).clicked() {
                asks.push(Ask::ChooseMesh(object.clone()));
            }
        }
        Repair::Fix { loss, verb, .. } => {
            let button = Button::new(verb);
            let button = if verb.starts_with("Use ") { button.primary() } else { button };
            if button.show(ui).clicked() {
                asks.push(Ask::Mend(Mend::Fix(*loss)));
            }
        }
        Repair::Snap { region, guide } => {
            if Button::new("Snap to surface").show(ui).clicked() {
                asks.push(Ask::Mend(Mend::Snap(region.clone(), *guide)));
            }
        }
    }
}

/// One line, with text between backticks in the font of the source.
fn with_code(words: &str, font: FontId, colour: Color32) -> LayoutJob {
    let mut job = LayoutJob { break_on_newline: false, ..LayoutJob::default() };
    for (index, part) in words.split('`').enumerate() {
        let font = if index % 2 == 1 { type_face::number() } else { font.clone() };
        job.append(part, 0.0, TextFormat::simple(font, colour));
    }
    job
}

/// The words with a capital and a full stop.
fn sentence(words: &str) -> String {
    let mut characters = words.trim().chars();
    let Some(first) = characters.next() else { return String::new() };
    let end = if words.trim().ends_with(['.', '?', '!']) { "" } else { "." };
    first.to_uppercase().chain(characters).collect::<String>() + end
}

/// Shows the scene's text, to be edited, with its lines numbered and the line of the problem marked.
fn source(
    ui: &mut Ui,
    shown: &PanelInput<'_>,
    place: Option<TextPosition>,
    memory: &mut Memory,
    asks: &mut Vec<Ask>,
) {
    let tokens = Tokens::of(ui);
    ui.painter().rect_filled(ui.max_rect(), 0.0, tokens.field);
    let Some(source) = shown.document.source() else {
        let words = "All of the file was read: its text is no longer needed.";
        ui.add_space(12.0);
        ui.label(RichText::new(words).font(type_face::small()).color(tokens.weak));
        return;
    };
    if !memory.begun_from.as_ref().is_some_and(|before| Arc::ptr_eq(before, source)) {
        // What was typed stays unless the source's text has changed.
        if memory.begun_from.as_ref().is_none_or(|before| before.text != source.text) {
            memory.typed.clone_from(&source.text);
        }
        memory.begun_from = Some(Arc::clone(source));
        memory.go_to = place.map(|place| place.line);
    }
    let marked = place.filter(|_| memory.typed == source.text);
    if source.text.len() > MAX_EDITED_BYTES {
        return excerpt(ui, &source.text, marked);
    }
    let id = Id::unique("problems source");
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
        let button =
            within(ui, rect, row_from_right(), |ui| Button::new("Read this text").primary().show(ui));
        let tip = "Reads the scene from the text above (Ctrl Enter). The file on disk stays as it is.";
        if button.on_hover_text(tip).clicked() {
            asks.push(Ask::Mend(Mend::ReadText(memory.typed.clone())));
        }
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

/// Splits a line into what comes before, in and after the word or quoted text that begins at `column`, from 1.
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
