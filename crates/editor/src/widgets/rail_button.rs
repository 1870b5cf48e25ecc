//! The button of a tool on the rail, the column of tools beside the viewport.

use egui::{Align2, Color32, Response, Role, Sense, Ui, vec2};

use super::draw;
use crate::icons::Icon;
use crate::theme::{Tokens, measure, type_face};

/// The button of a tool on the rail, with the letter of its key in the corner.
pub fn rail_button(ui: &mut Ui, icon: Icon, name: &str, letter: &str, on: bool) -> Response {
    let tokens = Tokens::of(ui);
    let (rect, response) =
        ui.allocate_exact_size(vec2(measure::RAIL_BUTTON, measure::RAIL_BUTTON), Sense::click());
    let (fill, colour, weak) = if on {
        (tokens.accent, tokens.on_accent, tokens.on_accent)
    } else {
        (draw::fill(tokens, &response, Color32::TRANSPARENT), tokens.text, tokens.weak)
    };
    ui.painter().rect_filled(rect, draw::group_corner(), fill);
    draw::icon(ui.painter(), rect.center(), icon, measure::RAIL_ICON, colour);
    let corner = rect.right_bottom() - vec2(3.0, 0.0);
    draw::words(ui.painter(), corner, Align2::RIGHT_BOTTOM, letter, type_face::ruler(), weak);
    draw::focus_ring(ui, &response, rect, measure::GROUP_CORNER);
    draw::named_state(&response, Role::RadioButton, name, on);
    response
}
