//! Draws the ring round the pointer that shows how far a brush tool reaches on the surface.

use egui::{Color32, Pos2};
use glam::DVec2;
use impasto_editor_model::tools::Ring;

use super::Sheet;
use super::ink::{self, Ink};

/// Draws a ring: white over black, or grey when it is off the surface.
pub fn ring(sheet: &Sheet<'_>, ring: &Ring) {
    let line = |points_px: &[DVec2]| -> Vec<Pos2> { points_px.iter().map(|&at| sheet.at(at)).collect() };
    let share = if ring.mirrored { 0.6 } else { 1.0 };
    let outline = line(&ring.points_px);
    if ring.hollow {
        let ink =
            Ink::new(1.4, Color32::from_gray(165).gamma_multiply(share), (3.0, ink::black(0.35 * share)));
        return ink.line(sheet.painter, &outline);
    }
    Ink::new(1.8, ink::white(share), (4.2, ink::black(0.7 * share))).line(sheet.painter, &outline);
    let inner = Ink::new(1.0, ink::white(0.55 * share), (2.0, ink::black(0.25 * share)));
    inner.dashed(sheet.painter, &line(&ring.half_px), 4.0, 5.0);
    let centre = sheet.at(ring.at_px);
    sheet.painter.circle_filled(centre, 3.4, ink::black(0.5 * share));
    sheet.painter.circle_filled(centre, 2.2, ink::white(share));
}
