//! X, Y and Z side by side, each on or off.

use egui::{Align2, Color32, Rect, Response, Role, Sense, Ui, pos2, vec2};

use super::draw;
use crate::theme::{Tokens, measure, type_face};

const HEIGHT: f32 = 26.0;
const INSET: f32 = 2.0;
const PART: f32 = 28.0;

/// The width of a [`toggle_group`], points.
pub const TOGGLE_GROUP: f32 = 3.0 * PART + 2.0 * INSET;

/// X, Y and Z side by side, each on or off; `names` are for screen readers. The response is marked as changed when one
/// is switched.
pub fn toggle_group(ui: &mut Ui, names: [&str; 3], on: &mut [bool; 3]) -> Response {
    let tokens = Tokens::of(ui);
    let (rect, mut whole) = ui.allocate_exact_size(vec2(TOGGLE_GROUP, HEIGHT), Sense::hover());
    ui.painter().rect_filled(rect, draw::group_corner(), tokens.field);
    let mut left = rect.left() + INSET;
    for (index, ((letter, name), on)) in ["X", "Y", "Z"].into_iter().zip(names).zip(on).enumerate() {
        let part = Rect::from_min_size(pos2(left, rect.top()), vec2(PART, HEIGHT));
        left += PART;
        let response = ui.interact(part, whole.id.with(index), Sense::click());
        if response.clicked() {
            *on = !*on;
            whole.mark_changed();
        }
        let (rest, colour) =
            if *on { (tokens.sel, tokens.accent_text) } else { (Color32::TRANSPARENT, tokens.text) };
        let seen = part.shrink2(vec2(0.0, INSET));
        let fill = if *on { rest } else { draw::fill(tokens, &response, rest) };
        ui.painter().rect_filled(seen, draw::corner(), fill);
        draw::words(ui.painter(), seen.center(), Align2::CENTER_CENTER, letter, type_face::small(), colour);
        draw::focus_ring(ui, &response, seen, measure::CORNER);
        draw::named_state(&response, Role::Button, name, *on);
    }
    whole
}
