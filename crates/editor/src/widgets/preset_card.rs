//! A card for a preset: its name under a picture of the scene that is painted with the preset.

use egui::{Rect, Response, Role, Sense, Stroke, StrokeKind, TextureId, Ui, Vec2, pos2, vec2};

use super::draw;
use crate::icons;
use crate::theme::{Tokens, measure, type_face};

/// The size of a card, points.
pub const PRESET_CARD: Vec2 = vec2(152.0, 109.0);

/// The largest size of the picture on the card, points.
const PICTURE: Vec2 = vec2(144.0, 81.0);

/// A card, one of a group. `picture` is a texture and its size in pixels. Without a picture, an icon stands in its
/// place.
pub fn preset_card(ui: &mut Ui, name: &str, picture: Option<(TextureId, Vec2)>, on: bool) -> Response {
    let tokens = Tokens::of(ui);
    let (rect, response) = ui.allocate_exact_size(PRESET_CARD, Sense::click());
    if !ui.is_rect_visible(rect) {
        draw::named_state(&response, Role::MenuItemRadio, name, on);
        return response;
    }
    let fill = if response.hovered() || response.has_focus() { tokens.hov } else { tokens.field };
    let painter = ui.painter();
    painter.rect_filled(rect.shrink(1.0), draw::corner(), fill);
    let place = Rect::from_min_size(rect.min + vec2(4.0, 4.0), PICTURE);
    if let Some((picture, size)) = picture {
        let share = (PICTURE / size.max(vec2(1.0, 1.0))).min_elem();
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        let place = Rect::from_center_size(place.center(), size * share);
        painter.image(picture, place, whole, egui::Color32::WHITE);
    } else {
        draw::icon(painter, place.center(), icons::PAINT, 20.0, tokens.dis);
    }
    let at = pos2(rect.left() + 8.0, (place.bottom() + rect.bottom()) / 2.0);
    draw::words_within(ui, at, name, type_face::body(), tokens.text, PRESET_CARD.x - 32.0);
    if on {
        let at = pos2(rect.right() - 14.0, at.y);
        draw::icon(painter, at, icons::CHECK, 16.0, tokens.accent_text);
        let line = Stroke::new(1.5, tokens.accent_text);
        painter.rect_stroke(rect.shrink(1.0), draw::corner(), line, StrokeKind::Inside);
    }
    draw::focus_ring(ui, &response, rect, measure::CORNER);
    draw::named_state(&response, Role::MenuItemRadio, name, on);
    response
}
