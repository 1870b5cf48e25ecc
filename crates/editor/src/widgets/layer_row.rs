//! A widget: one row of the list of layers of paint.

use egui::{Color32, Rect, Response, Role, Sense, TextureId, Ui, pos2, vec2};

use super::draw;
use crate::icons;
use crate::theme::{Tokens, measure, type_face};

/// Size of the picture of a brush in a row, points.
const PICTURE: egui::Vec2 = vec2(28.0, 21.0);

/// One layer of paint in a list, as wide as the panel.
pub struct LayerRow<'a> {
    /// Its name.
    pub name: &'a str,
    /// Whether it is selected.
    pub selected: bool,
    /// Whether its eye is shut.
    pub hidden: bool,
    /// Whether the layer would paint nothing even with its eye open; its name is then drawn in the weak colour.
    pub idle: bool,
    /// Pictures of its brushes, at most two.
    pub pictures: Vec<TextureId>,
    /// Its tone, if it has one in place of brushes.
    pub tone: Option<Color32>,
    /// The room at the row's end for a field and what follows it, points.
    pub end: f32,
}

/// What the user did to a [`LayerRow`].
#[derive(Clone, Debug)]
pub struct LayerRowResponse {
    /// The row itself: a click selects the layer, a drag moves it.
    pub response: Response,
    /// The eye was clicked.
    pub eye_clicked: bool,
    /// The room at the row's end.
    pub end: Rect,
}

impl LayerRow<'_> {
    /// Draws it; the caller fills the room at its end.
    pub fn show(&self, ui: &mut Ui) -> LayerRowResponse {
        let tokens = Tokens::of(ui);
        let size = vec2(ui.available_width(), measure::ROW);
        let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
        let rest = if self.selected { tokens.sel } else { Color32::TRANSPARENT };
        let fill = if response.contains_pointer() && !self.selected { tokens.hov } else { rest };
        let end = Rect::from_min_max(pos2(rect.right() - self.end, rect.top()), rect.max);
        // The fill of the row ends before the field, which would not stand out from it.
        let filled = rect.with_max_x(end.left() - measure::GAP / 2.0);
        ui.painter().rect_filled(filled, draw::corner(), fill);
        draw::focus_ring(ui, &response, rect.shrink(1.0), measure::CORNER);
        draw::named_state(&response, Role::ListItem, &format!("Layer {}", self.name), self.selected);
        let middle = rect.center().y;
        let eye_clicked = self.eye(ui, pos2(rect.left() + measure::HIT / 2.0, middle), &response);
        let mut left = rect.left() + measure::HIT + 2.0;
        self.marks(ui, pos2(left, middle));
        left += 2.0 * PICTURE.x + 4.0;
        let colour = if self.hidden || self.idle { tokens.weak } else { tokens.text };
        let room = end.left() - measure::GAP / 2.0 - left;
        draw::words_within(ui, pos2(left, middle), self.name, type_face::body(), colour, room);
        LayerRowResponse { response, eye_clicked, end }
    }

    fn eye(&self, ui: &Ui, at: egui::Pos2, row: &Response) -> bool {
        let hit = Rect::from_center_size(at, vec2(measure::HIT, measure::HIT));
        let response = ui.interact(hit, row.id.with("eye"), Sense::click());
        let tokens = Tokens::of(ui);
        let lit = response.hovered() || self.selected;
        let icon = if self.hidden { icons::HIDDEN } else { icons::VISIBLE };
        let colour = if lit { tokens.text } else { tokens.weak };
        draw::icon(ui.painter(), at, icon, measure::SMALL_ICON, colour);
        draw::focus_ring(ui, &response, hit.shrink(2.0), measure::CORNER);
        draw::named_state(&response, Role::Button, &format!("Hide layer {}", self.name), self.hidden);
        response.clicked()
    }

    /// Draws the brushes, or the tone, from `at` to the right.
    fn marks(&self, ui: &Ui, at: egui::Pos2) {
        let tokens = Tokens::of(ui);
        let faded = if self.hidden || self.idle { 0.45 } else { 1.0 };
        if let Some(tone) = self.tone {
            let square = Rect::from_min_size(at - vec2(-4.0, 8.0), vec2(48.0, 16.0));
            ui.painter().rect_filled(square, draw::corner(), tone.gamma_multiply(faded));
        }
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        let tint = if ui.visuals().dark_mode { Color32::WHITE } else { tokens.text };
        for (index, picture) in self.pictures.iter().take(2).enumerate() {
            let min = at + vec2(index as f32 * PICTURE.x, -PICTURE.y / 2.0);
            let place = Rect::from_min_size(min, PICTURE);
            ui.painter().image(*picture, place, whole, tint.gamma_multiply(faded));
        }
    }
}
