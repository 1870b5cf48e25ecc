//! Draws the outline of the selected object, and its ghosts: the outlines that it has at other keys.

use egui::Pos2;
use glam::DVec2;

use super::Sheet;
use super::ink::{self, Ink, OVER_PAINT};
use crate::viewport::contour::contours;
use crate::viewport::surface_map::SurfaceMap;

/// The outline of the visible part of an object.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Closed or open lines, in points from the upper left corner of the picture.
    lines: Vec<Vec<DVec2>>,
}

impl Outline {
    /// The outline of the objects of a map for which `is_in` holds.
    pub fn new(map: &SurfaceMap, is_in: impl Fn(usize) -> bool) -> Self {
        let inside = |column, row| map.face(column, row).is_some_and(|face| is_in(face.object as usize));
        let to_points = |line: Vec<DVec2>| line.into_iter().map(|at| at / map.cells_per_point()).collect();
        Self { lines: contours(map.size(), inside).into_iter().map(to_points).collect() }
    }

    pub(super) fn in_window(&self, sheet: &Sheet<'_>) -> Vec<Vec<Pos2>> {
        self.lines.iter().map(|line| line.iter().map(|&at| sheet.at(at)).collect()).collect()
    }

    pub(super) fn of_lines(lines: Vec<Vec<DVec2>>) -> Self {
        Self { lines }
    }
}

/// Draws an outline, 2 points wide; that of a ghost is 1 point wide.
pub fn outline(sheet: &Sheet<'_>, outline: &Outline, ghost: bool) {
    let ink = if ghost {
        Ink::new(1.0, ink::white(0.55), (2.0, ink::black(0.25)))
    } else {
        Ink::new(2.0, OVER_PAINT.accent_text, (4.0, ink::black(0.45)))
    };
    for line in outline.in_window(sheet) {
        ink.line(sheet.painter, &line);
    }
}
