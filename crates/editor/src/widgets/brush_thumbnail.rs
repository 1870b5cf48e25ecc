//! A button with the picture of a brush.

use egui::{Color32, Rect, Response, Role, Sense, Stroke, StrokeKind, TextureId, Ui, pos2, vec2};

use super::draw;
use crate::theme::{Tokens, measure};

/// A button with the picture of a brush, one of a group, 48 by 40 points. `picture` should be white on transparent:
/// the dark theme shows it as it is, the light theme tints it with its text colour.
pub fn brush_thumbnail(ui: &mut Ui, name: &str, picture: TextureId, on: bool) -> Response {
    let tokens = Tokens::of(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(48.0, 40.0), Sense::click());
    let seen = rect.shrink2(vec2(0.5, 2.0));
    let rest = if on { tokens.sel } else { tokens.field };
    let fill = if on { rest } else { draw::fill(tokens, &response, rest) };
    ui.painter().rect_filled(seen, draw::corner(), fill);
    let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    let tint = if ui.visuals().dark_mode { Color32::WHITE } else { tokens.text };
    ui.painter().image(picture, Rect::from_center_size(seen.center(), vec2(40.0, 30.0)), whole, tint);
    if on {
        let line = Stroke::new(1.5, tokens.accent_text);
        ui.painter().rect_stroke(seen, draw::corner(), line, StrokeKind::Outside);
    }
    if response.has_focus() && on {
        let line = Stroke::new(2.0, tokens.text);
        ui.painter().rect_stroke(seen.expand(2.0), draw::corner(), line, StrokeKind::Outside);
    } else {
        draw::focus_ring(ui, &response, seen, measure::CORNER);
    }
    draw::named_state(&response, Role::RadioButton, name, on);
    response
}
