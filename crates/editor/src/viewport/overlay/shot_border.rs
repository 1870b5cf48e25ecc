//! Draws the border of the shot, and a veil over the picture outside it.

use egui::{Color32, Painter, Rect, StrokeKind};

use super::ink;

/// Opacity of the veil.
const VEIL: f32 = 0.66;

/// Draws the veil outside the shot and the border around it. `background` is the colour of the viewport where it shows
/// no picture.
pub fn shot_border(painter: &Painter, viewport: Rect, shot: Rect, background: Color32) {
    let veil = background.gamma_multiply(VEIL);
    let above = Rect::from_min_max(viewport.min, egui::pos2(viewport.max.x, shot.min.y));
    let below = Rect::from_min_max(egui::pos2(viewport.min.x, shot.max.y), viewport.max);
    let left = Rect::from_min_max(egui::pos2(viewport.min.x, shot.min.y), egui::pos2(shot.min.x, shot.max.y));
    let right =
        Rect::from_min_max(egui::pos2(shot.max.x, shot.min.y), egui::pos2(viewport.max.x, shot.max.y));
    for part in [above, below, left, right].into_iter().filter(Rect::is_positive) {
        painter.rect_filled(part, 0.0, veil);
    }
    painter.rect_stroke(shot, 0.0, (1.0, ink::white(0.45)), StrokeKind::Inside);
}
