use egui::color_picker::{Alpha, color_picker_color32};
use egui::{Color32, Popup, PopupCloseBehavior, Response, Role, Sense, Ui, vec2};

use super::draw;
use crate::theme::measure;

/// A square of a region's colour; a click opens egui's colour picker. Changed while the user picks.
pub fn color_square(ui: &mut Ui, name: &str, colour: &mut Color32) -> Response {
    let (rect, mut response) = ui.allocate_exact_size(vec2(measure::HIT, measure::HIT), Sense::click());
    let seen = egui::Rect::from_center_size(rect.center(), vec2(16.0, 16.0));
    ui.painter().rect_filled(seen, 3.0, *colour);
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
