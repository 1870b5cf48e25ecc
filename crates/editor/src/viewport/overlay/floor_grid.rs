//! The grid on the floor.

use egui::Stroke;
use glam::DVec3;

use super::Sheet;
use super::ink::{self, OVER_PAINT};

/// Lines on each side of the middle one.
const REACH: i32 = 20;
/// Each half of a line is drawn in this many pieces; pieces behind the eye are left out.
const PIECES: i32 = 10;
/// Lines are at least this far apart at the camera's target, points.
const LEAST_GAP: f64 = 12.0;

/// Draws a grid on the floor (Y = 0) around the camera's target, with the X and Z axes in their colours. The step is a
/// power of ten world units, chosen so that lines are neither crowded nor far apart. Objects do not hide the grid.
pub fn floor_grid(sheet: &Sheet<'_>) {
    let target = sheet.view.camera.target * DVec3::new(1.0, 0.0, 1.0);
    let px_per_unit = sheet.view.px_per_unit(sheet.view.camera.target).max(1e-9);
    let step = 10.0_f64.powf((LEAST_GAP / px_per_unit).log10().ceil()).clamp(1e-4, 1e4);
    let centre = (target / step).round();
    for (line_axis, cross_axis, middle) in [(DVec3::X, DVec3::Z, centre.z), (DVec3::Z, DVec3::X, centre.x)] {
        for offset in -REACH..=REACH {
            let number = middle as i64 + i64::from(offset);
            let stroke = match number {
                0 => Stroke::new(
                    1.4,
                    OVER_PAINT.axis[if line_axis == DVec3::X { 0 } else { 2 }].gamma_multiply(0.8),
                ),
                _ if number % 10 == 0 => Stroke::new(1.0, ink::white(0.30)),
                _ => Stroke::new(1.0, ink::white(0.13)),
            };
            let along = line_axis * centre.dot(line_axis);
            let at = |piece: i32| {
                let share = f64::from(piece) / f64::from(PIECES);
                (cross_axis * number as f64 + along + line_axis * (share * f64::from(REACH))) * step
            };
            for piece in -PIECES..PIECES {
                if let (Some(from), Some(to)) = (sheet.project(at(piece)), sheet.project(at(piece + 1))) {
                    sheet.painter.line_segment([from, to], stroke);
                }
            }
        }
    }
}
