//! The list of problems: each with its place, its words (on as many lines as they need), and what mends it.

use std::path::Path;
use std::sync::Arc;

use egui::text::{LayoutJob, TextFormat};
use egui::{
    Align2, Color32, FontId, Galley, Rect, Response, Role, ScrollArea, Sense, Ui, WidgetInfo, pos2, vec2,
};
use impasto_editor_model::document::{ProblemRow, Repair};
use impasto_editor_model::editor::Mend;
use impasto_editor_model::{Item, Selection};
use impasto_scene::problem::TextPosition;

use super::trouble::{Settle, Trouble};
use crate::icons;
use crate::panels::{Ask, PanelInput, row_from_right, within};
use crate::theme::{Tokens, measure, type_face};
use crate::widgets::Button;

/// The least height of a row, points.
const ROW: f32 = 44.0;
/// Where the words of a row begin, points from its left end.
const WORDS: f32 = 94.0;
/// Buttons that take more than this share of a row's width stand under its words.
const MOST_BUTTONS: f32 = 0.45;

/// A button of a row: `words` are on it, `name` is its name for screen readers.
struct Verb {
    words: String,
    name: String,
    is_best: bool,
    ask: Ask,
}

struct Row<'a> {
    is_error: bool,
    place: Option<TextPosition>,
    message: String,
    second: String,
    /// Everything that is known, for the tooltip.
    whole: String,
    verbs: Vec<Verb>,
    of: Option<&'a ProblemRow>,
}

/// Shows the troubles of the window and the problems of the document. Returns the index of the problem that was
/// clicked.
pub(super) fn list(
    ui: &mut Ui,
    shown: &PanelInput<'_>,
    rows: &[ProblemRow],
    (selected, is_text_unread): (usize, bool),
    asks: &mut Vec<Ask>,
) -> Option<usize> {
    let mut clicked = None;
    ui.spacing_mut().item_spacing.y = 0.0;
    ScrollArea::vertical().id_salt("problems").auto_shrink(false).show(ui, |ui| {
        for (index, trouble) in shown.troubles.iter().enumerate() {
            show(ui, of_trouble(trouble, index), false, asks);
        }
        for (index, row) in rows.iter().enumerate() {
            let can_fix = !is_text_unread;
            let response = show(ui, of_problem(row, can_fix), selected == index, asks);
            if response.clicked() {
                clicked = Some(index);
                asks.extend(concerned(row).map(|item| Ask::Select(Selection::only(item))));
            }
        }
    });
    clicked
}

fn of_trouble(trouble: &Trouble, index: usize) -> Row<'_> {
    let verb = |settle: Settle| {
        let (words, name) = settle.words();
        let is_best = settle == trouble.settles[0];
        Verb { words: words.to_owned(), name: name.to_owned(), is_best, ask: Ask::Settle(index, settle) }
    };
    Row {
        is_error: true,
        place: None,
        message: sentence(&trouble.words),
        second: sentence(&trouble.mend),
        whole: String::new(),
        verbs: trouble.settles.iter().map(|settle| verb(*settle)).collect(),
        of: None,
    }
}

fn of_problem(row: &ProblemRow, can_fix: bool) -> Row<'_> {
    let ProblemRow { problem, instead, repairs } = row;
    let mend = match problem.missing_file() {
        Some(_) => "locate it, or put it there and press *Retry*".to_owned(),
        // The list of known names is left to the tooltip.
        None => {
            let mend = problem.mend.split(" Known here").next().unwrap_or_default();
            mend.split("known here").next().unwrap_or_default().to_owned()
        }
    };
    let second = format!("{} {instead}", sentence(&mend)).trim().to_owned();
    let needs_no_edit = |repair: &&Repair| !matches!(repair, Repair::Fix { .. } | Repair::Snap { .. });
    Row {
        is_error: problem.severity.is_fatal(),
        place: problem.place,
        // Where a file was looked for is left to the tooltip.
        message: sentence(&in_one_line(problem.message.split(" (tried ").next().unwrap_or_default())),
        second: second.replace('*', ""),
        whole: format!(
            "{}\n{}\n{}",
            problem.path.display(),
            sentence(&problem.message),
            sentence(&problem.mend)
        ),
        verbs: repairs
            .iter()
            .filter(|repair| can_fix || needs_no_edit(repair))
            .map(|repair| verb_of(repair, &problem.missing_file().unwrap_or_default()))
            .collect(),
        of: Some(row),
    }
}

/// The button of a repair; `missing` is the file that is missing, if one is.
fn verb_of(repair: &Repair, missing: &Path) -> Verb {
    let verb = |words: &str, name: &str, is_best: bool, ask: Ask| Verb {
        words: words.to_owned(),
        name: name.to_owned(),
        is_best,
        ask,
    };
    let name = missing.file_name().unwrap_or_default().to_string_lossy();
    match repair {
        Repair::Locate { object } => verb("Locate\u{2026}", "Locate", false, Ask::ChooseMesh(object.clone())),
        Repair::Bring { to } => {
            verb("Locate\u{2026}", &format!("Locate {name}"), true, Ask::BringFile(to.clone()))
        }
        Repair::Retry => verb("Retry", &format!("Retry {name}"), false, Ask::Mend(Mend::ReadFiles)),
        Repair::Fix { loss, verb: words, .. } => {
            verb(words, words, words.starts_with("Use "), Ask::Mend(Mend::Fix(*loss)))
        }
        Repair::Snap { region, guide } => {
            let name = "Snap to surface";
            verb(name, name, false, Ask::Mend(Mend::Snap(region.clone(), *guide)))
        }
    }
}

/// The item that a problem is about, if it can be selected.
fn concerned(row: &ProblemRow) -> Option<Item> {
    row.repairs.iter().find_map(|repair| match repair {
        Repair::Locate { object } => Some(Item::Object(object.clone())),
        Repair::Snap { region, .. } => Some(Item::Region(region.clone())),
        Repair::Fix { .. } | Repair::Bring { .. } | Repair::Retry => None,
    })
}

fn show(ui: &mut Ui, row: Row<'_>, is_selected: bool, asks: &mut Vec<Ask>) -> Response {
    let tokens = Tokens::of(ui);
    let wide = ui.available_width();
    let of_verb = |verb: &Verb| {
        let font = if verb.is_best { type_face::head() } else { type_face::body() };
        super::super::text_width(ui, &verb.words, font) + 24.0 + measure::GAP
    };
    let verbs_wide: f32 = row.verbs.iter().map(of_verb).sum();
    let is_below = verbs_wide > MOST_BUTTONS * wide;
    let room = wide - WORDS - 12.0 - if is_below { 0.0 } else { verbs_wide + 4.0 };
    let lines = [
        laid_out(ui, &row.message, type_face::body(), tokens.text, room),
        laid_out(ui, &row.second, type_face::small(), tokens.weak, room),
    ];
    let words_high: f32 = lines.iter().map(|galley| galley.size().y).sum::<f32>() + 2.0;
    let verbs_high = if is_below { measure::BUTTON + 6.0 } else { 0.0 };
    let high = (words_high + 14.0 + verbs_high).max(ROW);
    let (rect, response) = ui.allocate_exact_size(vec2(wide, high), Sense::click());
    if is_selected || response.hovered() {
        ui.painter().rect_filled(rect, 0.0, if is_selected { tokens.sel } else { tokens.hov });
    }
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, tokens.div));
    if response.has_focus() {
        ui.painter().rect_stroke(rect.shrink(2.0), 2.0, (2.0, tokens.accent_text), egui::StrokeKind::Inside);
    }
    let (icon, colour, kind) = match row.is_error {
        true => (icons::ERROR, tokens.vermilion, "error"),
        false => (icons::WARNING, tokens.ochre, "warning"),
    };
    let first_line = rect.top() + (high - verbs_high - words_high) / 2.0;
    let middle = first_line + 9.0;
    let font = type_face::icon(measure::ICON);
    ui.painter().text(pos2(rect.left() + 21.0, middle), Align2::CENTER_CENTER, icon.glyph(), font, colour);
    let (place, spoken) = match row.place {
        Some(TextPosition { line, column }) => {
            (format!("{line}:{column}"), format!("line {line} column {column}, "))
        }
        None => (String::new(), String::new()),
    };
    let at = pos2(rect.left() + 40.0, middle);
    ui.painter().text(at, Align2::LEFT_CENTER, place, type_face::number(), tokens.weak);
    let message = row.of.map_or(row.message.clone(), |of| of.problem.message.clone());
    let name = format!("{spoken}{kind}, {message}");
    response.widget_info(|| WidgetInfo::labeled(Role::ListItem, true, &name));
    let mut at = pos2(rect.left() + WORDS, first_line);
    for (galley, colour) in lines.into_iter().zip([tokens.text, tokens.weak]) {
        let next = at.y + galley.size().y + 2.0;
        ui.painter().galley(at, galley, colour);
        at.y = next;
    }
    let verbs_top = if is_below { rect.bottom() - 6.0 - measure::BUTTON } else { rect.top() };
    let verbs_rect =
        Rect::from_min_max(pos2(rect.left() + WORDS, verbs_top), rect.right_bottom() - vec2(12.0, 0.0));
    within(ui, verbs_rect, row_from_right(), |ui| {
        ui.spacing_mut().item_spacing.x = measure::GAP;
        for verb in row.verbs.into_iter().rev() {
            let button = Button::new(&verb.words).name(&verb.name);
            let button = if verb.is_best { button.primary() } else { button };
            if button.show(ui).clicked() {
                asks.push(verb.ask);
            }
        }
    });
    if row.whole.is_empty() {
        return response;
    }
    response.on_hover_ui(|ui| {
        let mut job = with_code(&row.whole, type_face::body(), tokens.text);
        job.wrap.max_width = ui.spacing().tooltip_width;
        ui.label(job);
    })
}

fn laid_out(ui: &Ui, words: &str, font: FontId, colour: Color32, room: f32) -> Arc<Galley> {
    let mut job = with_code(words, font, colour);
    job.wrap.max_width = room.max(80.0);
    ui.painter().layout_job(job)
}

/// Words, with text between backticks in the font of the source.
fn with_code(words: &str, font: FontId, colour: Color32) -> LayoutJob {
    let mut job = LayoutJob { break_on_newline: true, ..LayoutJob::default() };
    for (index, part) in words.split('`').enumerate() {
        let font = if index % 2 == 1 { type_face::number() } else { font.clone() };
        job.append(part, 0.0, TextFormat::simple(font, colour));
    }
    job
}

/// Joins the words with single spaces. A message may quote a piece of the file together with its line breaks.
fn in_one_line(words: &str) -> String {
    words.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Makes a sentence of the words: adds a full stop, and a capital unless they begin with the name of a file.
fn sentence(words: &str) -> String {
    let mut characters = words.trim().chars();
    let Some(first) = characters.next() else { return String::new() };
    let end = if words.trim().ends_with(['.', '?', '!']) { "" } else { "." };
    let begins_with_name = words.split_whitespace().next().is_some_and(|word| word.contains(['/', '.']));
    let first: String = if begins_with_name { first.to_string() } else { first.to_uppercase().collect() };
    first + characters.as_str() + end
}
