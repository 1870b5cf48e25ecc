//! Draws a tint where an amount is painted: warm where the painted factor is above 1, cool where it is below.

use egui::{Color32, Mesh, Rect, Shape};

use super::Sheet;
use super::ink::OVER_PAINT;
use crate::viewport::surface_map::{Face, FacePlace, SurfaceMap};

/// Steps of colour for factors above 1, and as many for factors below 1.
const LEVELS: f32 = 12.0;

/// The colour is fullest for factors of 2^`FULL_LOG2` and more, and for factors of 2^−`FULL_LOG2` and less.
const FULL_LOG2: f32 = 2.0;

/// Opacity of the fullest colour.
const FILL: f32 = 0.72;

/// The tint of the visible surfaces, in cells of a grid.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AmountTint {
    /// Runs of neighbouring cells with the same tint: its strength, from −1 (fullest cool) to 1 (fullest warm), then
    /// the row, the first column, and the column after the last. Cells without a tint are in no run.
    runs: Vec<(f32, [usize; 3])>,
    cells_per_point: f64,
}

impl AmountTint {
    /// The tint of the surfaces of `map`. `factor` gives the factor that is painted at a place.
    pub fn of(map: &SurfaceMap, factor: impl Fn(Face, FacePlace) -> f32) -> Self {
        let [columns, rows] = map.size();
        let mut runs = Vec::new();
        for row in 0..rows {
            let levels: Vec<i32> = (0..columns)
                .map(|column| map.place(column, row).map_or(0, |(face, place)| level(factor(face, place))))
                .collect();
            let mut first = 0;
            for run in levels.chunk_by(|one, next| one == next) {
                if run[0] != 0 {
                    runs.push((run[0] as f32 / LEVELS, [row, first, first + run.len()]));
                }
                first += run.len();
            }
        }
        Self { runs, cells_per_point: map.cells_per_point() }
    }
}

/// The step of colour of a factor, from −`LEVELS` to `LEVELS`; 0 for no colour.
fn level(factor: f32) -> i32 {
    ((factor.max(1e-6).log2() / FULL_LOG2).clamp(-1.0, 1.0) * LEVELS).round() as i32
}

/// Draws the tint over the picture.
pub fn amount_tint(sheet: &Sheet<'_>, tint: &AmountTint) {
    let side = 1.0 / tint.cells_per_point as f32;
    let mut mesh = Mesh::default();
    for &(level, [row, first, end]) in &tint.runs {
        let at = |column: usize, row: usize| sheet.rect.min + egui::vec2(column as f32, row as f32) * side;
        mesh.add_colored_rect(Rect::from_min_max(at(first, row), at(end, row + 1)), colour(level));
    }
    sheet.painter.add(Shape::mesh(mesh));
}

fn colour(level: f32) -> Color32 {
    let colour = if level > 0.0 { OVER_PAINT.ochre } else { OVER_PAINT.accent_text };
    // Even the first step is plainly visible.
    colour.gamma_multiply(FILL * (0.25 + 0.75 * level.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_painted_has_no_colour_and_more_and_less_are_told_apart() {
        assert_eq!([level(1.0), level(1.02), level(0.98)], [0; 3]);
        assert_eq!([level(4.0), level(400.0), level(0.25), level(0.0)], [12, 12, -12, -12]);
        assert_eq!([level(2.0), level(0.5)], [6, -6]);
        assert_ne!(colour(0.5), colour(-0.5));
        assert!(colour(1.0).a() > colour(0.1).a());
    }
}
