use egui::{Color32, Mesh, Rect, Shape, pos2};
use glam::DVec2;

use super::Sheet;
use super::ink::{self, Ink};
use super::outline::Outline;
use crate::theme::type_face;
use crate::viewport::contour::contours;
use crate::viewport::surface_map::{Face, SurfaceMap};

/// How much of a region's colour covers the paint.
const FILL: f32 = 0.45;

/// What shows of a region.
#[derive(Clone, Debug, PartialEq)]
pub struct RegionTint {
    name: String,
    colour: Color32,
    /// Row, first column and the one after the last, in cells.
    runs: Vec<[usize; 3]>,
    edge: Outline,
    cells_per_point: f64,
    /// Mean of its cells, points.
    middle_px: DVec2,
}

impl RegionTint {
    /// What shows of the regions in `names` (with their colours). `region_of` tells the index of a face's region.
    pub fn all(
        map: &SurfaceMap,
        names: &[(&str, Color32)],
        region_of: impl Fn(Face) -> Option<usize>,
    ) -> Vec<Self> {
        let [columns, rows] = map.size();
        let mut cells: Vec<Option<usize>> = Vec::with_capacity(columns * rows);
        for row in 0..rows {
            cells.extend((0..columns).map(|column| map.face(column, row).and_then(&region_of)));
        }
        let tint = |(region, (name, colour)): (usize, &(&str, Color32))| {
            let is_in = |column: usize, row: usize| cells[column + row * columns] == Some(region);
            let (mut runs, mut sum, mut count) = (Vec::new(), DVec2::ZERO, 0);
            for row in 0..rows {
                let mut column = 0;
                while column < columns {
                    let first = column;
                    while column < columns && is_in(column, row) {
                        column += 1;
                    }
                    if column > first {
                        runs.push([row, first, column]);
                        let length = (column - first) as f64;
                        sum += DVec2::new(0.5 * (first + column) as f64, row as f64 + 0.5) * length;
                        count += column - first;
                    }
                    column += 1;
                }
            }
            let scale = 1.0 / map.cells_per_point();
            let to_points = |line: Vec<DVec2>| line.into_iter().map(|at| at * scale).collect();
            let edge =
                Outline::of_lines(contours([columns, rows], is_in).into_iter().map(to_points).collect());
            (count > 0).then(|| Self {
                name: (*name).to_owned(),
                colour: *colour,
                runs,
                edge,
                cells_per_point: map.cells_per_point(),
                middle_px: sum * scale / count as f64,
            })
        };
        names.iter().enumerate().filter_map(tint).collect()
    }

    /// The middle of what shows.
    pub fn middle_px(&self) -> DVec2 {
        self.middle_px
    }

    /// How many cells show.
    pub fn cells(&self) -> usize {
        self.runs.iter().map(|[_, first, end]| end - first).sum()
    }
}

/// Draws a region in its colour, with its edge and its name.
pub fn region_tint(sheet: &Sheet<'_>, tint: &RegionTint) {
    let side = 1.0 / tint.cells_per_point as f32;
    let fill = tint.colour.gamma_multiply(FILL);
    let mut mesh = Mesh::default();
    for &[row, first, end] in &tint.runs {
        let at = |column: usize, row: usize| sheet.rect.min + egui::vec2(column as f32, row as f32) * side;
        mesh.add_colored_rect(Rect::from_min_max(at(first, row), at(end, row + 1)), fill);
    }
    sheet.painter.add(Shape::mesh(mesh));
    let edge = Ink::new(1.5, tint.colour, (3.0, ink::black(0.35)));
    for line in tint.edge.in_window(sheet) {
        edge.line(sheet.painter, &line);
    }
    let at = sheet.at(tint.middle_px);
    ink::edged_words(sheet.painter, pos2(at.x, at.y), (&tint.name, type_face::head()), Color32::WHITE);
}
