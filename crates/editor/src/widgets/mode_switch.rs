//! The switch between Arrange, Paint and Animate.

use egui::{Align2, Color32, Rect, Response, Role, Sense, Ui, pos2, vec2};

use super::draw;
use crate::icons::{self, Icon};
use crate::theme::{Tokens, measure, type_face};

const MODES: [(&str, Icon); 3] =
    [("Arrange", icons::ARRANGE), ("Paint", icons::PAINT), ("Animate", icons::ANIMATE)];
const HEIGHT: f32 = 28.0;
const INSET: f32 = 2.0;

/// Arrange, Paint, Animate; `mode` is 0, 1 or 2. The response is marked as changed when another is picked.
pub fn mode_switch(ui: &mut Ui, mode: &mut usize) -> Response {
    let tokens = Tokens::of(ui);
    // As wide as the bold words, so that nothing moves when the mode changes.
    let widths =
        MODES.map(|(words, _)| draw::width(ui, words, type_face::head()) + measure::SMALL_ICON + 30.0);
    let size = vec2(widths.iter().sum::<f32>() + 2.0 * INSET, HEIGHT);
    let (rect, mut whole) = ui.allocate_exact_size(size, Sense::hover());
    ui.painter().rect_filled(rect, draw::group_corner(), tokens.field);
    let mut left = rect.left() + INSET;
    for (index, ((words, icon), wide)) in MODES.into_iter().zip(widths).enumerate() {
        let part = Rect::from_min_size(pos2(left, rect.top()), vec2(wide, HEIGHT)).shrink2(vec2(0.0, INSET));
        left += wide;
        let response = ui.interact(part, whole.id.with(index), Sense::click());
        if response.clicked() && *mode != index {
            *mode = index;
            whole.mark_changed();
        }
        let on = *mode == index;
        let (fill, colour, font) = match (on, response.hovered()) {
            (true, _) => (tokens.accent, tokens.on_accent, type_face::head()),
            (false, true) => (tokens.hov, tokens.text, type_face::body()),
            (false, false) => (Color32::TRANSPARENT, tokens.weak, type_face::body()),
        };
        ui.painter().rect_filled(part, draw::corner(), fill);
        let glyph = part.left_center() + vec2(11.0 + measure::SMALL_ICON / 2.0, 0.0);
        draw::icon(ui.painter(), glyph, icon, measure::SMALL_ICON, colour);
        let at = part.left_center() + vec2(11.0 + measure::SMALL_ICON + 6.0, 0.0);
        draw::words(ui.painter(), at, Align2::LEFT_CENTER, words, font, colour);
        draw::focus_ring(ui, &response, part, measure::CORNER);
        draw::named_state(&response, Role::RadioButton, words, on);
    }
    whole
}
