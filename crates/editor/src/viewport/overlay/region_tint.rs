//! Draws regions tinted in their colours, with their names.

use std::collections::HashMap;

use egui::{Color32, Mesh, Rect, Shape, Vec2, vec2};
use glam::DVec2;

use super::Sheet;
use super::ink::{self, Ink};
use super::outline::Outline;
use crate::theme::type_face;
use crate::viewport::contour::contours;
use crate::viewport::surface_map::{Face, SurfaceMap};

/// Opacity of the tint.
const FILL: f32 = 0.45;

/// The visible part of a region.
#[derive(Clone, Debug, PartialEq)]
pub struct RegionTint {
    name: String,
    colour: Color32,
    /// Runs of cells side by side: row, first column, and the column after the last.
    runs: Vec<[usize; 3]>,
    edge: Outline,
    cells_per_point: f64,
    /// Where its name should be drawn, in points from the picture's upper left corner: the place in its cells that is
    /// nearest to their mean.
    middle_points: DVec2,
}

impl RegionTint {
    /// The visible parts of all regions. `names` are their names and colours; `region_of` gives the index of a face's
    /// region.
    pub fn all(
        map: &SurfaceMap,
        names: &[(&str, Color32)],
        region_of: impl Fn(Face) -> Option<usize>,
    ) -> Vec<Self> {
        let [columns, rows] = map.size();
        let mut cells: Vec<Option<usize>> = Vec::with_capacity(columns * rows);
        let mut runs: Vec<Vec<[usize; 3]>> = vec![Vec::new(); names.len()];
        // Most faces cover several cells, so the region of each face is looked up only once.
        let mut known: HashMap<Face, Option<usize>> = HashMap::new();
        let mut region = |face: Face| *known.entry(face).or_insert_with(|| region_of(face));
        for row in 0..rows {
            let from = cells.len();
            cells.extend((0..columns).map(|column| map.face(column, row).and_then(&mut region)));
            let mut first = 0;
            for run in cells[from..].chunk_by(|one, next| one == next) {
                if let Some(of) = run[0].and_then(|region| runs.get_mut(region)) {
                    of.push([row, first, first + run.len()]);
                }
                first += run.len();
            }
        }
        let shown = runs.into_iter().enumerate().filter(|(_, runs)| !runs.is_empty());
        let scale = 1.0 / map.cells_per_point();
        let tint = |(region, runs): (usize, Vec<[usize; 3]>)| {
            // Only the surroundings of the region are searched for its edge.
            let left = runs.iter().map(|run| run[1]).min().unwrap_or(0).saturating_sub(1);
            let right = (runs.iter().map(|run| run[2]).max().unwrap_or(0) + 1).min(columns);
            let top = runs[0][0].saturating_sub(1);
            let bottom = (runs[runs.len() - 1][0] + 2).min(rows);
            let is_in =
                |column: usize, row: usize| cells[column + left + (row + top) * columns] == Some(region);
            let corner = DVec2::new(left as f64, top as f64);
            let to_points = |line: Vec<DVec2>| line.into_iter().map(|at| (at + corner) * scale).collect();
            let edge = contours([right - left, bottom - top], is_in).into_iter().map(to_points).collect();
            let (mut sum, mut count) = (DVec2::ZERO, 0.0);
            for &[row, first, end] in &runs {
                let length = (end - first) as f64;
                sum += DVec2::new(0.5 * (first + end) as f64, row as f64 + 0.5) * length;
                count += length;
            }
            let middle_points = nearest(&runs, sum / count) * scale;
            Self {
                name: names[region].0.to_owned(),
                colour: names[region].1,
                runs,
                edge: Outline::of_lines(edge),
                cells_per_point: map.cells_per_point(),
                middle_points,
            }
        };
        shown.map(tint).collect()
    }
}

/// The place within the runs that is nearest to `to`, in cells.
fn nearest(runs: &[[usize; 3]], to: DVec2) -> DVec2 {
    let places = runs.iter().map(|&[row, first, end]| {
        DVec2::new(to.x.clamp(first as f64 + 0.5, end as f64 - 0.5), row as f64 + 0.5)
    });
    let near = |place: &DVec2| place.distance_squared(to);
    places.min_by(|one, other| near(one).total_cmp(&near(other))).unwrap_or(to)
}

/// Draws regions in their colours, with their edges and names.
pub fn region_tints(sheet: &Sheet<'_>, tints: &[RegionTint]) {
    for tint in tints {
        fill_and_edge(sheet, tint);
    }
    let sizes: Vec<Vec2> = tints.iter().map(|tint| words_size(sheet, &tint.name)).collect();
    let wanted: Vec<Rect> = (tints.iter().zip(&sizes))
        .map(|(tint, &size)| Rect::from_center_size(sheet.at(tint.middle_points), size))
        .collect();
    let cells: Vec<usize> =
        tints.iter().map(|tint| tint.runs.iter().map(|[_, first, end]| end - first).sum()).collect();
    for (tint, place) in tints.iter().zip(apart(&wanted, &cells)) {
        if let Some(place) = place {
            let at = place.center();
            ink::edged_words(sheet.painter, at, &tint.name, type_face::head(), Color32::WHITE);
        }
    }
}

fn words_size(sheet: &Sheet<'_>, name: &str) -> Vec2 {
    sheet.painter.layout_no_wrap(name.to_owned(), type_face::head(), Color32::WHITE).size()
}

/// Finds places for names so that they do not cover each other. `wanted` is where each name should be, `cells` how many
/// cells its region has. The name of the largest region stays where it is wanted. Others move up or down by up to three
/// lines. A name without a free place is left out.
fn apart(wanted: &[Rect], cells: &[usize]) -> Vec<Option<Rect>> {
    let mut order: Vec<usize> = (0..wanted.len()).collect();
    order.sort_by_key(|&index| std::cmp::Reverse(cells[index]));
    let mut places = vec![None; wanted.len()];
    for index in order {
        let line = vec2(0.0, wanted[index].height());
        places[index] = [0.0, 1.0, -1.0, 2.0, -2.0, 3.0, -3.0]
            .map(|lines| wanted[index].translate(lines * line))
            .into_iter()
            .find(|place| !places.iter().flatten().any(|other: &Rect| other.intersects(place.shrink(0.5))));
    }
    places
}

fn fill_and_edge(sheet: &Sheet<'_>, tint: &RegionTint) {
    let side = 1.0 / tint.cells_per_point as f32;
    let fill = tint.colour.gamma_multiply(FILL);
    let mut mesh = Mesh::default();
    for &[row, first, end] in &tint.runs {
        let at = |column: usize, row: usize| sheet.rect.min + vec2(column as f32, row as f32) * side;
        mesh.add_colored_rect(Rect::from_min_max(at(first, row), at(end, row + 1)), fill);
    }
    sheet.painter.add(Shape::mesh(mesh));
    let edge = Ink::new(1.5, tint.colour, (3.0, ink::black(0.35)));
    for line in tint.edge.in_window(sheet) {
        edge.line(sheet.painter, &line);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_make_room_for_each_other() {
        let at = |x: f32, y: f32| Rect::from_center_size(egui::pos2(x, y), vec2(60.0, 16.0));
        let wanted = [at(100.0, 100.0), at(110.0, 103.0), at(300.0, 100.0), at(90.0, 98.0)];
        let places: Vec<Rect> = apart(&wanted, &[5, 90, 1, 40]).into_iter().flatten().collect();
        // The largest region and one that is alone keep their places.
        assert_eq!([places[1], places[2]], [wanted[1], wanted[2]]);
        for (index, place) in places.iter().enumerate() {
            assert_eq!(place.center().x, wanted[index].center().x);
            for other in &places[index + 1..] {
                assert!(!place.intersects(other.shrink(0.5)), "{place} covers {other}");
            }
        }
        // Of nine in one place, two have no room within three lines.
        assert_eq!(apart(&[at(0.0, 0.0); 9], &[1; 9]).iter().flatten().count(), 7);
    }
}
