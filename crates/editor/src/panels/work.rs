//! Background work in the status line: a thin bar, words, and a way to stop it.

use egui::{Rect, RichText, Role, Sense, Ui, WidgetInfo, vec2};
use impasto_editor_model::keymap::Action;

use super::{Ask, text_width};
use crate::theme::{Tokens, measure, type_face};

/// Work that runs in the background.
#[derive(Clone, Debug, PartialEq)]
pub struct Work {
    /// What it is: *Preparing bunny…*, *Rendering 47 of 120*.
    pub words: String,
    /// How much of it is done, 0 to 1; none if that is unknown.
    pub share: Option<f32>,
    /// The kind of work.
    pub kind: WorkKind,
}

/// The kinds of work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WorkKind {
    /// Frames are written; a click opens the sheet for rendering.
    Rendering,
    /// Files are read.
    Reading,
    /// The painting is prepared.
    Preparing,
}

const BAR: f32 = 72.0;

/// Shows one piece of work, in a row that is laid out from right to left.
pub(super) fn show(ui: &mut Ui, work: &Work, asks: &mut Vec<Ask>) {
    if work.kind == WorkKind::Rendering {
        if chip(ui, work, Sense::click()).clicked() {
            asks.push(Ask::Act(Action::Render));
        }
        return;
    }
    let stop = egui::Button::new(RichText::new("Stop").font(type_face::small())).frame(false);
    let name = format!("Stop: {}", work.words.trim_end_matches('\u{2026}').to_lowercase());
    let response = ui.add(stop.min_size(vec2(36.0, measure::HIT)));
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
    if response.clicked() {
        asks.push(Ask::StopWork(work.kind));
    }
    chip(ui, work, Sense::hover());
}

fn chip(ui: &mut Ui, work: &Work, sense: Sense) -> egui::Response {
    let tokens = Tokens::of(ui);
    let wide = text_width(ui, &work.words, type_face::small()) + BAR + 20.0;
    let (rect, response) = ui.allocate_exact_size(vec2(wide, measure::HIT), sense);
    let is_button = sense.senses_click();
    if is_button && response.hovered() {
        ui.painter().rect_filled(rect, measure::CORNER, tokens.hov);
    }
    let colour = if is_button { tokens.text } else { tokens.weak };
    let at = rect.left_center() + vec2(6.0, 0.0);
    ui.painter().text(at, egui::Align2::LEFT_CENTER, &work.words, type_face::small(), colour);
    let whole = Rect::from_min_size(rect.right_center() - vec2(BAR + 6.0, 2.0), vec2(BAR, 4.0));
    ui.painter().rect_filled(whole, 2.0, tokens.act);
    let done = match work.share {
        Some(share) => whole.with_max_x(whole.left() + BAR * share.clamp(0.0, 1.0)),
        None => {
            // While the share is unknown, a short piece moves back and forth.
            let time = ui.input(|input| input.time);
            ui.ctx().request_repaint_after(std::time::Duration::from_millis(50));
            let at = (time * 0.8).fract() as f32;
            let left = (1.0 - (2.0 * at - 1.0).abs()) * BAR * 0.7;
            Rect::from_min_size(whole.min + vec2(left, 0.0), vec2(BAR * 0.3, 4.0))
        }
    };
    ui.painter().rect_filled(done, 2.0, tokens.accent);
    if response.has_focus() {
        let ring = egui::Stroke::new(2.0, tokens.accent_text);
        ui.painter().rect_stroke(rect, measure::CORNER, ring, egui::StrokeKind::Inside);
    }
    let role = if is_button { Role::Button } else { Role::Status };
    response.widget_info(|| WidgetInfo::labeled(role, true, &work.words));
    response
}
