//! Draws the overlay's lines and words so that they are visible on any paint: light over dark.

use egui::{Align2, Color32, FontId, Painter, Pos2, Shape, Stroke, Vec2, pos2};

pub(super) const WHITE: Color32 = Color32::WHITE;
/// The dark edge of what is drawn over paint.
pub(super) const EDGE: Color32 = Color32::from_rgb(0x14, 0x17, 0x20);
/// What is drawn over paint has the dark theme's colours in both themes.
pub(super) use crate::theme::DARK as OVER_PAINT;

pub(super) fn black(share: f32) -> Color32 {
    Color32::from_black_alpha((share * 255.0).round() as u8)
}

pub(super) fn white(share: f32) -> Color32 {
    Color32::from_white_alpha((share * 255.0).round() as u8)
}

/// A line over a wider one.
#[derive(Clone, Copy)]
pub(super) struct Ink {
    pub(super) over: Stroke,
    pub(super) under: Stroke,
}

impl Ink {
    pub(super) fn new(width: f32, colour: Color32, under: (f32, Color32)) -> Self {
        Self { over: Stroke::new(width, colour), under: Stroke::new(under.0, under.1) }
    }

    pub(super) fn segment(&self, painter: &Painter, ends: [Pos2; 2]) {
        painter.line_segment(ends, self.under);
        painter.line_segment(ends, self.over);
    }

    pub(super) fn line(&self, painter: &Painter, points: &[Pos2]) {
        painter.add(Shape::line(points.to_vec(), self.under));
        painter.add(Shape::line(points.to_vec(), self.over));
    }

    pub(super) fn dashed(&self, painter: &Painter, points: &[Pos2], dash: f32, gap: f32) {
        painter.extend(Shape::dashed_line(points, self.under, dash, gap));
        painter.extend(Shape::dashed_line(points, self.over, dash, gap));
    }
}

/// The unit vector (Y down) of an angle that counts counter-clockwise with Y up.
pub(super) fn along(angle_rad: f32) -> Vec2 {
    let (sin, cos) = angle_rad.sin_cos();
    egui::vec2(cos, -sin)
}

/// An arrow's head with its tip at `tip`.
pub(super) fn head(
    tip: Pos2,
    direction: Vec2,
    length: f32,
    width: f32,
    fill: Color32,
    edge: Stroke,
) -> Shape {
    let back = tip - direction * length;
    let side = direction.rot90() * (width * 0.5);
    Shape::convex_polygon(vec![tip, back + side, back - side], fill, edge)
}

/// Words with a black edge on all sides.
pub(super) fn edged_words(painter: &Painter, at: Pos2, text: &str, font: FontId, colour: Color32) {
    for (x, y) in
        [(-1.0, -1.0), (0.0, -1.4), (1.0, -1.0), (-1.4, 0.0), (1.4, 0.0), (-1.0, 1.0), (0.0, 1.4), (1.0, 1.0)]
    {
        painter.text(pos2(at.x + x, at.y + y), Align2::CENTER_CENTER, text, font.clone(), Color32::BLACK);
    }
    painter.text(at, Align2::CENTER_CENTER, text, font, colour);
}
