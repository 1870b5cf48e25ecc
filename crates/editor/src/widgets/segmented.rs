use egui::{Align2, Color32, Rect, Response, Role, Sense, Ui, pos2, vec2};

use super::draw;
use crate::theme::{Tokens, measure, type_face};

const HEIGHT: f32 = 26.0;
const INSET: f32 = 2.0;
const PADDING: f32 = 9.0;

/// A few choices side by side, one of them on; each is found by its words. Changed where another was picked.
pub fn segmented(ui: &mut Ui, choices: &[&str], chosen: &mut usize) -> Response {
    let on = *chosen;
    let parts = choices.iter().enumerate().map(|(index, words)| (*words, *words, index == on));
    let (mut whole, clicked) = group(ui, Role::RadioButton, &parts.collect::<Vec<_>>());
    if let Some(index) = clicked.filter(|index| *index != on) {
        *chosen = index;
        whole.mark_changed();
    }
    whole
}

/// A few switches side by side, each with its words, its name and whether it is on. Returns the one that was clicked.
pub fn switches(ui: &mut Ui, parts: &[(&str, &str, bool)]) -> Option<usize> {
    group(ui, Role::Button, parts).1
}

fn group(ui: &mut Ui, role: Role, parts: &[(&str, &str, bool)]) -> (Response, Option<usize>) {
    let tokens = Tokens::of(ui);
    let wide = |(words, ..): &(&str, &str, bool)| {
        draw::width(ui, words, type_face::small()).max(8.0) + 2.0 * PADDING
    };
    let widths: Vec<f32> = parts.iter().map(wide).collect();
    let size = vec2(widths.iter().sum::<f32>() + 2.0 * INSET, HEIGHT);
    let (rect, whole) = ui.allocate_exact_size(size, Sense::hover());
    ui.painter().rect_filled(rect, draw::group_corner(), tokens.field);
    let mut left = rect.left() + INSET;
    let mut clicked = None;
    for (index, ((words, name, on), wide)) in parts.iter().zip(widths).enumerate() {
        let part = Rect::from_min_size(pos2(left, rect.top()), vec2(wide, HEIGHT));
        left += wide;
        let response = ui.interact(part, whole.id.with(index), Sense::click());
        if response.clicked() {
            clicked = Some(index);
        }
        let seen = part.shrink2(vec2(0.0, INSET));
        let (fill, colour) = match (*on, role, response.hovered()) {
            (true, Role::Button, _) => (tokens.sel, tokens.accent_text),
            (true, ..) => (tokens.act, tokens.text),
            (false, _, true) => (tokens.hov, tokens.text),
            (false, _, false) => (Color32::TRANSPARENT, tokens.weak),
        };
        ui.painter().rect_filled(seen, draw::corner(), fill);
        draw::words(ui.painter(), seen.center(), Align2::CENTER_CENTER, (words, type_face::small()), colour);
        draw::focus_ring(ui, &response, seen, measure::CORNER);
        draw::named_state(&response, role, name, *on);
    }
    (whole, clicked)
}
