//! Draws a box in place of a mesh that was not found.

use egui::{Color32, Rect, Stroke, pos2, vec2};
use glam::DVec3;

use super::Sheet;
use super::ink::{self, Ink, OVER_PAINT};
use crate::theme::type_face;

/// The box that stands in for a mesh that was not found.
#[derive(Clone, Debug, PartialEq)]
pub struct MissingMesh {
    /// The name of the object.
    pub name: String,
    /// The box's corners, world space: bits 0, 1 and 2 of an index choose the least or greatest X, Y and Z in the
    /// object's own axes.
    pub corners: [DVec3; 8],
}

/// Draws the edges of the box, and a label beside it.
pub fn missing_mesh(sheet: &Sheet<'_>, missing: &MissingMesh) {
    let at = missing.corners.map(|corner| sheet.project(corner));
    let ink = Ink::new(1.6, OVER_PAINT.vermilion, (3.6, ink::black(0.6)));
    for from in 0..8_usize {
        for axis in [1, 2, 4].into_iter().filter(|axis| from & axis == 0) {
            if let (Some(from), Some(to)) = (at[from], at[from | axis]) {
                ink.segment(sheet.painter, [from, to]);
            }
        }
    }
    let seen = at.iter().flatten().fold(Rect::NOTHING, |seen, &at| seen.union(Rect::from_pos(at)));
    if !seen.is_finite() || !seen.intersects(sheet.rect) {
        return;
    }
    let words = format!("{}: mesh missing", missing.name);
    let galley = sheet.painter.layout_no_wrap(words, type_face::small(), OVER_PAINT.vermilion);
    let size = galley.size() + vec2(16.0, 8.0);
    let most = sheet.rect.max - size - vec2(4.0, 4.0);
    let least = sheet.rect.min + vec2(4.0, 4.0);
    let at = pos2((seen.right() + 6.0).min(most.x).max(least.x), (seen.top() - 4.0).min(most.y).max(least.y));
    let label = Rect::from_min_size(at, size);
    let edge = Stroke::new(1.0, OVER_PAINT.vermilion.gamma_multiply(0.5));
    sheet.painter.rect(label, 4.0, LABEL_FILL, edge, egui::StrokeKind::Inside);
    sheet.painter.galley(at + vec2(8.0, 4.0), galley, OVER_PAINT.vermilion);
}

/// The label's fill: dark, so that the words can be read on any paint.
const LABEL_FILL: Color32 = Color32::from_rgb(0x38, 0x1E, 0x1E);
