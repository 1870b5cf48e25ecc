//! What all widgets do in the same way: draw fills, focus rings, icons and words, and tell screen readers their names.

use egui::{
    Align2, Color32, CornerRadius, FontId, Painter, Pos2, Rect, Response, Role, Stroke, StrokeKind, Ui,
    WidgetInfo,
};

use super::reach::reached;
use crate::icons::Icon;
use crate::theme::{Tokens, measure, type_face};

/// The fill of a control: `rest`, unless the pointer is over it or presses it.
pub(super) fn fill(tokens: &Tokens, response: &Response, rest: Color32) -> Color32 {
    if response.is_pointer_button_down_on() {
        tokens.act
    } else if response.hovered() {
        tokens.hov
    } else {
        rest
    }
}

pub(super) fn focus_ring(ui: &Ui, response: &Response, rect: Rect, corner: f32) {
    if response.has_focus() {
        let ring = Stroke::new(2.0, Tokens::of(ui).accent_text);
        ui.painter().rect_stroke(rect.expand(1.0), corner + 1.0, ring, StrokeKind::Outside);
    }
}

pub(super) fn icon(painter: &Painter, centre: Pos2, icon: Icon, size: f32, colour: Color32) {
    words(painter, centre, Align2::CENTER_CENTER, icon.glyph(), type_face::icon(size), colour);
}

/// Draws text with its box anchored at `at` by `align`. Returns the box.
pub(super) fn words(
    painter: &Painter,
    at: Pos2,
    align: Align2,
    text: &str,
    font: FontId,
    colour: Color32,
) -> Rect {
    let galley = painter.layout_no_wrap(text.to_owned(), font, colour);
    let rect = align.anchor_size(at, galley.size());
    painter.galley(rect.min, galley, colour);
    rect
}

/// Draws text in one line, which ends with an ellipsis if it would pass `width`. Returns its box.
pub(super) fn words_within(ui: &Ui, at: Pos2, text: &str, font: FontId, colour: Color32, width: f32) -> Rect {
    let mut job = egui::text::LayoutJob::simple_singleline(text.to_owned(), font, colour);
    job.wrap = egui::text::TextWrapping::truncate_at_width(width.max(0.0));
    let galley = ui.painter().layout_job(job);
    let rect = Align2::LEFT_CENTER.anchor_size(at, galley.size());
    ui.painter().galley(rect.min, galley, colour);
    rect
}

/// The text, shortened to fit into `room` points. An ellipsis replaces its middle, because names that begin alike often
/// differ at their ends.
pub(super) fn without_middle(ui: &Ui, text: &str, font: FontId, room: f32) -> String {
    let characters: Vec<char> = text.chars().collect();
    let shortened = |kept: usize| -> String {
        let (head, tail) = (kept.div_ceil(2), kept / 2);
        let [head, tail] = [&characters[..head], &characters[characters.len() - tail..]];
        head.iter().chain(&['\u{2026}']).chain(tail).collect()
    };
    if characters.is_empty() || width(ui, text, font.clone()) <= room {
        return text.to_owned();
    }
    // Bisection finds the most characters that fit.
    let (mut fits, mut too_long) = (1, characters.len());
    while too_long - fits > 1 {
        let kept = (fits + too_long) / 2;
        if width(ui, &shortened(kept), font.clone()) <= room {
            fits = kept;
        } else {
            too_long = kept;
        }
    }
    shortened(fits.min(characters.len()))
}

pub(super) fn width(ui: &Ui, text: &str, font: FontId) -> f32 {
    ui.painter().layout_no_wrap(text.to_owned(), font, Color32::WHITE).size().x
}

/// Tells screen readers the role and the name of a control. Also lets `reach` find the control by that name.
pub(super) fn named(response: &Response, role: Role, name: &str) {
    reached(response, name);
    response.widget_info(|| WidgetInfo::labeled(role, response.enabled(), name));
}

/// As [`named`], for a control that is on or off.
pub(super) fn named_state(response: &Response, role: Role, name: &str, on: bool) {
    reached(response, name);
    response.widget_info(|| WidgetInfo::selected(role, response.enabled(), on, name));
}

pub(super) fn corner() -> CornerRadius {
    CornerRadius::same(measure::CORNER as u8)
}

pub(super) fn group_corner() -> CornerRadius {
    CornerRadius::same(measure::GROUP_CORNER as u8)
}
