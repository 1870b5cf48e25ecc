//! A square that shows a colour and opens its picker.

use egui::color_picker::{Alpha, color_picker_color32};
use egui::{Color32, Popup, PopupCloseBehavior, Response, Role, Sense, StrokeKind, Ui, vec2};

use super::draw;
use crate::theme::{Tokens, measure};

/// A square that shows a colour; a click opens egui's colour picker. The response counts as changed while the user
/// picks.
pub fn color_square(ui: &mut Ui, name: &str, colour: &mut Color32) -> Response {
    let (rect, mut response) = ui.allocate_exact_size(vec2(measure::HIT, measure::HIT), Sense::click());
    let seen = egui::Rect::from_center_size(rect.center(), vec2(16.0, 16.0));
    ui.painter().rect_filled(seen, 3.0, *colour);
    // The edge makes even a colour close to the panel's own visible.
    let edge = if response.hovered() { Tokens::of(ui).text } else { Tokens::of(ui).out };
    ui.painter().rect_stroke(seen, 3.0, (1.0, edge), StrokeKind::Outside);
    draw::focus_ring(ui, &response, seen, 3.0);
    draw::named(&response, Role::ColorWell, name);
    let mut changed = false;
    Popup::menu(&response).close_behavior(PopupCloseBehavior::CloseOnClickOutside).show(|ui| {
        ui.spacing_mut().slider_width = 240.0;
        changed = color_picker_color32(ui, colour, Alpha::Opaque);
    });
    if changed {
        response.mark_changed();
    }
    response
}
