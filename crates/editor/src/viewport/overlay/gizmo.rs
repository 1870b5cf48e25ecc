//! Draws the gizmo over the picture: the handles that move, turn and scale what is selected.

use egui::{Color32, Pos2, Shape, Stroke};
use glam::DVec2;
use impasto_editor_model::gizmo::{Gizmo, Handle, HandleShape};
use impasto_editor_model::transform::{Axis, Constraint, Operation};

use super::Sheet;
use super::ink::{self, EDGE, Ink, OVER_PAINT};
use crate::theme::type_face;

/// Draws handles, the farthest first; the one with the constraint `lit` is highlighted.
pub fn gizmo(sheet: &Sheet<'_>, gizmo: &Gizmo, lit: Option<&Constraint>) {
    for handle in gizmo.handles() {
        draw(
            sheet,
            handle,
            if lit == Some(&handle.constraint) { ink::WHITE } else { colour(&handle.constraint) },
        );
    }
}

fn draw(sheet: &Sheet<'_>, handle: &Handle, colour: Color32) {
    let ink = Ink::new(3.0, colour, (5.0, EDGE.gamma_multiply(0.75)));
    match &handle.shape {
        HandleShape::Arm { from_px, to_px, letter } => {
            let (from, to) = (sheet.at(*from_px), sheet.at(*to_px));
            let direction = (to - from).normalized();
            ink.segment(sheet.painter, [from, to - direction * 10.0]);
            let edge = Stroke::new(1.2, EDGE);
            if handle.operation == Operation::Scale {
                let (along, side) = (direction * 6.0, direction.rot90() * 6.0);
                let corners =
                    vec![to - along - side, to + along - side, to + along + side, to - along + side];
                sheet.painter.add(Shape::convex_polygon(corners, colour, edge));
            } else {
                sheet.painter.add(ink::head(to, direction, 15.0, 13.0, colour, edge));
            }
            let font = egui::FontId { size: 14.0, ..type_face::head() };
            ink::edged_words(sheet.painter, to + direction * 12.0, &letter.to_string(), font, ink::WHITE);
        }
        HandleShape::Square { corners_px } => {
            let corners: Vec<Pos2> = corners_px.iter().map(|&at| sheet.at(at)).collect();
            let edge = Stroke::new(1.2, colour);
            sheet.painter.add(Shape::convex_polygon(corners, colour.gamma_multiply(0.45), edge));
        }
        HandleShape::Ring { points_px } => {
            let points: Vec<Pos2> = points_px.iter().map(|&at: &DVec2| sheet.at(at)).collect();
            Ink::new(2.2, colour, (4.0, EDGE.gamma_multiply(0.6))).line(sheet.painter, &points);
        }
        HandleShape::Centre { at_px } => {
            sheet.painter.circle(sheet.at(*at_px), 8.0, ink::WHITE, Stroke::new(1.4, EDGE));
        }
    }
}

fn colour(constraint: &Constraint) -> Color32 {
    let axis = |axis: &Axis| OVER_PAINT.axis[*axis as usize];
    match constraint {
        Constraint::Axis(of) => axis(of),
        Constraint::Plane(of) => axis(of),
        _ => OVER_PAINT.axis[2],
    }
}
