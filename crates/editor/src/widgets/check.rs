//! Check boxes and radio buttons.

use egui::{Align2, Rect, Response, Role, Sense, Stroke, StrokeKind, Ui, pos2, vec2};

use super::draw;
use crate::icons;
use crate::theme::{Tokens, measure, type_face};

const BOX: f32 = 16.0;

/// A box to tick, with its name beside it.
pub fn checkbox(ui: &mut Ui, name: &str, on: &mut bool) -> Response {
    checkbox_named(ui, name, name, on)
}

/// As [`checkbox`], but shows `words`; `name` is for screen readers.
pub fn checkbox_named(ui: &mut Ui, words: &str, name: &str, on: &mut bool) -> Response {
    let (mark, mut response) = row(ui, words);
    if response.clicked() {
        *on = !*on;
        response.mark_changed();
    }
    let tokens = Tokens::of(ui);
    let painter = ui.painter();
    if *on {
        painter.rect_filled(mark, 3.0, tokens.accent);
        draw::icon(painter, mark.center(), icons::CHECK, 14.0, tokens.on_accent);
    } else {
        let fill = draw::fill(tokens, &response, tokens.field);
        painter.rect(mark, 3.0, fill, Stroke::new(1.0, tokens.out), StrokeKind::Inside);
    }
    draw::focus_ring(ui, &response, mark, 3.0);
    draw::named_state(&response, Role::CheckBox, name, *on);
    response
}

/// A radio button, with its name beside it.
pub fn radio(ui: &mut Ui, name: &str, on: bool) -> Response {
    radio_named(ui, name, name, on)
}

/// As [`radio`], but shows `words`; `name` is for screen readers.
pub fn radio_named(ui: &mut Ui, words: &str, name: &str, on: bool) -> Response {
    let (mark, response) = row(ui, words);
    let tokens = Tokens::of(ui);
    let painter = ui.painter();
    if on {
        painter.circle_filled(mark.center(), BOX / 2.0, tokens.accent);
        painter.circle_filled(mark.center(), 3.0, tokens.on_accent);
    } else {
        let fill = draw::fill(tokens, &response, tokens.field);
        painter.circle(mark.center(), BOX / 2.0 - 0.5, fill, Stroke::new(1.0, tokens.out));
    }
    draw::focus_ring(ui, &response, mark, BOX / 2.0);
    draw::named_state(&response, Role::RadioButton, name, on);
    response
}

fn row(ui: &mut Ui, words: &str) -> (Rect, Response) {
    let size = vec2(BOX + measure::GAP + draw::width(ui, words, type_face::body()), measure::HIT);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let mark = Rect::from_center_size(pos2(rect.left() + BOX / 2.0, rect.center().y), vec2(BOX, BOX));
    let at = pos2(mark.right() + measure::GAP, rect.center().y);
    draw::words(ui.painter(), at, Align2::LEFT_CENTER, words, type_face::body(), Tokens::of(ui).text);
    (mark, response)
}
