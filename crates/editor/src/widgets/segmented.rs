//! A widget: a few choices side by side, one of them on.

use egui::{Align2, Color32, Rect, Response, Role, Sense, Ui, pos2, vec2};

use super::draw;
use crate::theme::{Tokens, measure, type_face};

const HEIGHT: f32 = 26.0;
const INSET: f32 = 2.0;
const PADDING: f32 = 9.0;

/// A few choices side by side, one of them on; each is named by its words. The response is marked as changed when
/// another one is picked.
pub fn segmented(ui: &mut Ui, choices: &[&str], chosen: &mut usize) -> Response {
    let choices: Vec<_> = choices.iter().map(|words| (*words, *words)).collect();
    segmented_named(ui, &choices, chosen)
}

/// The width of a [`segmented`] of these words, points.
pub fn segmented_width<'a>(ui: &Ui, choices: impl IntoIterator<Item = &'a str>) -> f32 {
    choices.into_iter().map(|words| part_width(ui, words)).sum::<f32>() + 2.0 * INSET
}

fn part_width(ui: &Ui, words: &str) -> f32 {
    draw::width(ui, words, type_face::small()).max(8.0) + 2.0 * PADDING
}

/// As [`segmented`], where the words alone would be ambiguous: each choice is named by `of` and its words, as in *Seam
/// soft*.
pub fn segmented_of(ui: &mut Ui, of: &str, choices: &[&str], chosen: &mut usize) -> Response {
    let names: Vec<String> = choices.iter().map(|words| format!("{of} {}", words.to_lowercase())).collect();
    let named: Vec<_> = choices.iter().copied().zip(names.iter().map(String::as_str)).collect();
    segmented_named(ui, &named, chosen)
}

/// As [`segmented`], but each choice is a pair: its words and its name.
pub fn segmented_named(ui: &mut Ui, choices: &[(&str, &str)], chosen: &mut usize) -> Response {
    let tokens = Tokens::of(ui);
    let widths: Vec<f32> = choices.iter().map(|(words, _)| part_width(ui, words)).collect();
    let size = vec2(widths.iter().sum::<f32>() + 2.0 * INSET, HEIGHT);
    let (rect, mut whole) = ui.allocate_exact_size(size, Sense::hover());
    ui.painter().rect_filled(rect, draw::group_corner(), tokens.field);
    let mut left = rect.left() + INSET;
    for (index, ((words, name), wide)) in choices.iter().zip(widths).enumerate() {
        let part = Rect::from_min_size(pos2(left, rect.top()), vec2(wide, HEIGHT));
        left += wide;
        let response = ui.interact(part, whole.id.with(index), Sense::click());
        if response.clicked() && *chosen != index {
            *chosen = index;
            whole.mark_changed();
        }
        let on = *chosen == index;
        let seen = part.shrink2(vec2(0.0, INSET));
        let colour = choice(ui, &response, seen, name, on);
        draw::words(ui.painter(), seen.center(), Align2::CENTER_CENTER, words, type_face::small(), colour);
    }
    whole
}

/// Draws the fill and the focus ring of one of several choices, and gives it its name. Returns the colour for its words
/// or picture.
pub(super) fn choice(ui: &Ui, response: &Response, seen: Rect, name: &str, on: bool) -> Color32 {
    let tokens = Tokens::of(ui);
    let fill = match (on, response.hovered()) {
        (true, _) => tokens.act,
        (false, true) => tokens.hov,
        (false, false) => Color32::TRANSPARENT,
    };
    ui.painter().rect_filled(seen, draw::corner(), fill);
    draw::focus_ring(ui, response, seen, measure::CORNER);
    draw::named_state(response, Role::RadioButton, name, on);
    if on || response.hovered() { tokens.text } else { tokens.weak }
}
