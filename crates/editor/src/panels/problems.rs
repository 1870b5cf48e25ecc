//! The panel of problems, at the bottom of the window. It lists what is wrong with the scene, its meshes and its
//! textures, and what failed in the window. Each entry offers what mends it. If parts of the scene could not be read,
//! the text of the scene is shown beside the list.

mod list;
mod source;
mod trouble;

use egui::{Align, Id, Panel, Rect, RichText, Role, Sense, Ui, WidgetInfo, vec2};
use impasto_editor_model::editor::Mend;
use impasto_editor_model::keymap::Action;

use super::{Ask, PanelInput, row, row_from_right, text_width, within};
use crate::icons;
use crate::theme::{Tokens, measure, type_face};
use crate::widgets::{self, Button};

pub use source::{forget_text, note_read, restore_text, unread_text};
pub use trouble::{MeshFor, Settle, Trouble, TroubleOf};

const HEIGHT: f32 = 232.0;
const LEAST_HEIGHT: f32 = 200.0;
/// The share of the window's height that the panel takes, between `LEAST_HEIGHT` and `HEIGHT`.
const MOST_OF_WINDOW: f32 = 0.45;
const HEAD: f32 = 41.0;
const FOOT: f32 = 44.0;
/// The list's share of the width, if the text is beside it.
const LIST: f32 = 0.6;

pub(super) fn count(shown: &PanelInput<'_>) -> usize {
    shown.document.problem_count() + shown.troubles.len()
}

/// The button in the status line that shows the panel. It is there while there are problems, or an edited text that has
/// not been read yet.
pub(super) fn chip(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    let count = count(shown);
    if count == 0 && unread_text(ui.ctx(), shown.document).is_none() {
        return;
    }
    let tokens = Tokens::of(ui);
    let is_error = shown.document.loss_count() > 0 || !shown.troubles.is_empty();
    let (icon, colour) =
        if is_error { (icons::ERROR, tokens.vermilion) } else { (icons::WARNING, tokens.ochre) };
    let words = if count == 0 { "Edited text".to_owned() } else { counted(count) };
    let size = vec2(text_width(ui, &words, type_face::small()) + 30.0, measure::STATUS_LINE);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    if response.hovered() || response.has_focus() {
        ui.painter().rect_filled(rect, measure::CORNER, tokens.hov);
    }
    let middle = rect.left_center();
    let font = type_face::icon(measure::SMALL_ICON);
    ui.painter().text(middle + vec2(12.0, 0.0), egui::Align2::CENTER_CENTER, icon.glyph(), font, colour);
    let at = middle + vec2(24.0, 0.0);
    ui.painter().text(at, egui::Align2::LEFT_CENTER, words, type_face::small(), tokens.text);
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, "Show problems"));
    if response.on_hover_text("Lists what is wrong, with what mends it.").clicked() {
        asks.push(Ask::ShowProblems);
    }
}

/// Shows the panel at the bottom of `ui`. Returns false once it is closed, or once no problem and no unread text is
/// left.
pub fn problems(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) -> bool {
    let rows = shown.document.problems();
    let count = rows.len() + shown.troubles.len();
    let is_text_unread = unread_text(ui.ctx(), shown.document).is_some();
    if count == 0 && !is_text_unread {
        return false;
    }
    let tokens = Tokens::of(ui);
    let mut stays = true;
    let frame = egui::Frame::new().fill(tokens.panel);
    let high = (ui.ctx().content_rect().height() * MOST_OF_WINDOW).clamp(LEAST_HEIGHT, HEIGHT);
    let panel = Panel::bottom("problems").exact_size(high).resizable(false).frame(frame);
    let shown_panel = panel.show(ui, |ui| {
        let whole = ui.max_rect();
        ui.painter().hline(whole.x_range(), whole.top(), (2.0, tokens.vermilion));
        let id = Id::unique("selected problem");
        let selected =
            ui.data(|data| data.get_temp::<usize>(id)).unwrap_or(0).min(rows.len().saturating_sub(1));
        let mut text = source::Memory::load(ui.ctx());
        let has_text = shown.document.source().is_some();
        let split = whole.left() + (whole.width() * if has_text { LIST } else { 1.0 }).round();
        let part = |x: egui::Rangef, top: f32, bottom: f32| Rect::from_x_y_ranges(x, top..=bottom);
        let head_rect = part(whole.x_range(), whole.top() + 2.0, whole.top() + HEAD);
        within(ui, head_rect.shrink2(vec2(12.0, 0.0)), row(), |ui| {
            stays = head(ui, shown, count, asks);
        });
        ui.painter().hline(whole.x_range(), head_rect.bottom(), (1.0, tokens.div));
        let left = egui::Rangef::new(whole.left(), split);
        let certain_count = if is_text_unread { 0 } else { shown.document.certain().len() };
        let foot = if certain_count > 0 { FOOT } else { 0.0 };
        let list_rect = part(left, head_rect.bottom() + 1.0, whole.bottom() - foot);
        within(ui, list_rect, egui::Layout::top_down(Align::Min), |ui| {
            ui.set_clip_rect(ui.clip_rect().intersect(list_rect));
            if let Some(clicked) = list::list(ui, shown, &rows, (selected, is_text_unread), asks) {
                text.go_to = rows[clicked].problem.place.map(|place| place.line);
                ui.data_mut(|data| data.insert_temp(id, clicked));
            }
        });
        if certain_count > 0 {
            let rect = part(left, whole.bottom() - FOOT, whole.bottom()).shrink2(vec2(12.0, 0.0));
            within(ui, rect, row(), |ui| fix_all(ui, shown, certain_count, asks));
        }
        if has_text {
            ui.painter().vline(split, head_rect.bottom()..=whole.bottom(), (1.0, tokens.div));
            let of_text = egui::Rangef::new(split + 1.0, whole.right());
            let source_rect = part(of_text, head_rect.bottom() + 1.0, whole.bottom());
            let place = rows.get(selected).and_then(|row| row.problem.place);
            within(ui, source_rect, egui::Layout::top_down(Align::Min), |ui| {
                source::source(ui, shown, place, &mut text, asks);
            });
        }
        text.store(ui.ctx());
    });
    shown_panel.response.widget_info(|| WidgetInfo::labeled(Role::Group, true, "Problems"));
    stays
}

fn counted(count: usize) -> String {
    if count == 1 { "1 problem".to_owned() } else { format!("{count} problems") }
}

/// Returns false when the panel is closed.
fn head(ui: &mut Ui, shown: &PanelInput<'_>, count: usize, asks: &mut Vec<Ask>) -> bool {
    let tokens = Tokens::of(ui);
    let is_lossy = shown.document.saving_loses();
    let glyph = if shown.document.loss_count() > 0 || !shown.troubles.is_empty() {
        (icons::ERROR, tokens.vermilion)
    } else {
        (icons::WARNING, tokens.ochre)
    };
    ui.spacing_mut().item_spacing.x = 10.0;
    ui.label(RichText::new(glyph.0.glyph()).font(type_face::icon(measure::ICON)).color(glyph.1));
    let of = shown.document.name();
    let words = format!("{} in {of}", counted(count));
    ui.label(RichText::new(words).font(type_face::head()).color(tokens.text));
    if is_lossy && ui.available_width() > 640.0 {
        let calm = "The file on disk stays as it is until you choose.";
        ui.label(RichText::new(calm).font(type_face::body()).color(tokens.weak));
    }
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
        let undo = shown.with_keys_of(Action::Undo, " {} takes it back.");
        if again.on_hover_text(format!("Reads the file on disk once more.{undo}")).clicked() {
            asks.push(Ask::Mend(Mend::ReadAgain));
        }
    });
    stays
}

fn fix_all(ui: &mut Ui, shown: &PanelInput<'_>, count: usize, asks: &mut Vec<Ask>) {
    ui.spacing_mut().item_spacing.x = measure::GAP;
    let words = format!("Fix all that are certain ({count})");
    if Button::new(&words).name("Fix all that are certain").show(ui).clicked() {
        asks.push(Ask::Mend(Mend::FixCertain));
    }
    let undo = shown.with_keys_of(Action::Undo, ", {} takes it back");
    let note = RichText::new(format!("as one step{undo}")).font(type_face::small());
    ui.label(note.color(Tokens::of(ui).weak));
}
