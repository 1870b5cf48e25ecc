//! Cuts polygons into triangles: convex ones into a fan, others by ear clipping in the polygon's plane.

use std::collections::VecDeque;

use glam::{DVec2, DVec3};

/// The most point-in-triangle tests for all polygons of one file together; polygons after that are cut without tests.
pub(super) const MAX_TESTS: u64 = 300_000_000;

/// The triangles of one polygon, as numbers of its corners.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Cut {
    pub triangles: Vec<[usize; 3]>,
    /// The polygon crosses itself, or no tests were left for it: some triangles may lie outside it.
    pub is_rough: bool,
}

/// Twice the vector area of a polygon (Newell's method): its direction is the polygon's normal.
pub(super) fn newell(corners: &[DVec3]) -> DVec3 {
    let Some(&origin) = corners.first() else { return DVec3::ZERO };
    corners.windows(2).map(|pair| (pair[0] - origin).cross(pair[1] - origin)).sum()
}

/// Cuts a polygon of at least three corners; winding is kept. The work is taken from `tests_left`, see [`MAX_TESTS`].
pub(super) fn cut(corners: &[DVec3], tests_left: &mut u64) -> Cut {
    let count = corners.len();
    let fan = || (1..count - 1).map(|second| [0, second, second + 1]).collect::<Vec<_>>();
    let normal = newell(corners).normalize_or_zero();
    if count == 3 || normal == DVec3::ZERO {
        return Cut { triangles: fan(), is_rough: count > 3 };
    }
    let (along, across) = normal.any_orthonormal_pair();
    let points: Vec<DVec2> = corners
        .iter()
        .map(|at| at - corners[0])
        .map(|at| DVec2::new(at.dot(along), at.dot(across)))
        .collect();
    // The pair may be left-handed with the normal. Then the points are mirrored, so that the polygon is
    // counter-clockwise.
    let is_mirrored = along.cross(across).dot(normal) < 0.0;
    let points = if is_mirrored { points.iter().map(|at| DVec2::new(at.x, -at.y)).collect() } else { points };
    let is_convex = (0..count)
        .all(|at| turn(points[(at + count - 1) % count], points[at], points[(at + 1) % count]) >= 0.0)
        && (is_plain_quad(&points) || winds_once(&points));
    if is_convex { Cut { triangles: fan(), is_rough: false } } else { Ears::new(&points, tests_left).clip() }
}

/// Whether a polygon has four corners that all turn left by far more than rounding. Then it winds once: four turns of
/// less than 180 degrees each can only add up to 360.
fn is_plain_quad(points: &[DVec2]) -> bool {
    let &[a, b, c, d] = points else { return false };
    let longest = [b - a, c - b, d - c, a - d].into_iter().map(DVec2::length_squared).fold(0.0, f64::max);
    [turn(a, b, c), turn(b, c, d), turn(c, d, a), turn(d, a, b)].into_iter().all(|turn| turn > 1e-9 * longest)
}

/// Whether a polygon that only turns left goes round once, and not twice as a pentagram does.
fn winds_once(points: &[DVec2]) -> bool {
    let count = points.len();
    let edge = |at: usize| points[(at + 1) % count] - points[at];
    let total: f64 = (0..count).map(|at| edge(at).angle_to(edge((at + 1) % count))).sum();
    total < 1.5 * std::f64::consts::TAU
}

/// Twice the signed area of a triangle.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

struct Ears<'a> {
    points: &'a [DVec2],
    before: Vec<usize>,
    after: Vec<usize>,
    is_reflex: Vec<bool>,
    /// Corners that do not turn left: only these can rule out an ear. Those that have become convex are skipped, and
    /// taken out of a cell once they are more than half of it.
    reflex: Grid,
    tests_left: &'a mut u64,
}

impl<'a> Ears<'a> {
    fn new(points: &'a [DVec2], tests_left: &'a mut u64) -> Self {
        let count = points.len();
        let before = (0..count).map(|at| (at + count - 1) % count).collect();
        let after = (0..count).map(|at| (at + 1) % count).collect();
        let is_reflex = vec![false; count];
        let mut ears = Self { points, before, after, is_reflex, reflex: Grid::default(), tests_left };
        for at in 0..count {
            ears.is_reflex[at] = ears.turn_at(at) <= 0.0;
        }
        let reflex: Vec<usize> = (0..count).filter(|&at| ears.is_reflex[at]).collect();
        ears.reflex = Grid::new(points, &reflex);
        ears
    }

    fn turn_at(&self, at: usize) -> f64 {
        turn(self.points[self.before[at]], self.points[at], self.points[self.after[at]])
    }

    /// Whether the triangle at a convex corner holds no other corner of the polygon (Meisters 1975).
    fn is_ear(&mut self, at: usize) -> bool {
        if self.is_reflex[at] {
            return false;
        }
        let [a, b, c] = [self.before[at], at, self.after[at]].map(|corner| self.points[corner]);
        let is_reflex = &self.is_reflex;
        let rules_out = |corner: usize| {
            let point = self.points[corner];
            // Other corners at the same place as one of the triangle's own come from bridges to holes: they do not
            // count.
            let is_own = point == a || point == b || point == c;
            !is_own && turn(a, b, point) >= 0.0 && turn(b, c, point) >= 0.0 && turn(c, a, point) >= 0.0
        };
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        for cell in self.reflex.cells_over(low, high) {
            let corners = &mut self.reflex.cells[cell];
            let from = corners.partition_point(|&corner| self.points[corner].x < low.x);
            let to = corners.partition_point(|&corner| self.points[corner].x <= high.x);
            *self.tests_left = self.tests_left.saturating_sub(1 + (to - from) as u64);
            let mut convex = 0;
            for &corner in &corners[from..to] {
                match is_reflex[corner] {
                    true if rules_out(corner) => return false,
                    true => {}
                    false => convex += 1,
                }
            }
            if 2 * convex > corners.len() {
                corners.retain(|&corner| is_reflex[corner]);
            }
        }
        true
    }

    fn clip(mut self) -> Cut {
        let mut left = self.points.len();
        let mut cut = Cut::default();
        let mut is_gone = vec![false; left];
        let mut candidates: VecDeque<usize> = (0..left).collect();
        let mut start = 0;
        while left > 3 {
            let next = candidates.pop_front();
            let at = match next {
                Some(at) if is_gone[at] || (*self.tests_left > 0 && !self.is_ear(at)) => continue,
                Some(at) if *self.tests_left > 0 => at,
                // No ear is left, so the polygon crosses itself; or no tests are left. Cut on regardless.
                _ => {
                    let stuck = start;
                    cut.is_rough |= self.turn_at(stuck) != 0.0;
                    stuck
                }
            };
            let (before, after) = (self.before[at], self.after[at]);
            cut.triangles.push([before, at, after]);
            is_gone[at] = true;
            self.is_reflex[at] = false;
            self.after[before] = after;
            self.before[after] = before;
            left -= 1;
            start = after;
            for corner in [before, after] {
                self.is_reflex[corner] = self.is_reflex[corner] && self.turn_at(corner) <= 0.0;
                candidates.push_back(corner);
            }
        }
        cut.triangles.push([self.before[start], start, self.after[start]]);
        cut
    }
}

/// Corners of a polygon in square cells; those of a cell are sorted by x.
#[derive(Default)]
struct Grid {
    cells: Vec<Vec<usize>>,
    low: DVec2,
    cell_size: f64,
    columns: usize,
    rows: usize,
}

impl Grid {
    /// A grid with at most about three times as many cells as corners.
    fn new(points: &[DVec2], corners: &[usize]) -> Self {
        let of_corners = || corners.iter().map(|&corner| points[corner]);
        let low = of_corners().fold(DVec2::INFINITY, DVec2::min);
        let size = of_corners().fold(DVec2::NEG_INFINITY, DVec2::max) - low;
        let along = |size: f64, cell_size: f64| (size / cell_size) as usize + 1;
        // Where the box is nearly a line, its area says nothing: then its length decides.
        let cell_size =
            (size.x * size.y / corners.len() as f64).sqrt().max(size.max_element() / corners.len() as f64);
        let mut grid = Self { cells: Vec::new(), low, cell_size, columns: 1, rows: 1 };
        if cell_size > 0.0 && cell_size.is_finite() {
            (grid.columns, grid.rows) = (along(size.x, cell_size), along(size.y, cell_size));
        }
        grid.cells = vec![Vec::new(); grid.columns * grid.rows];
        for &corner in corners {
            let [column, row] = grid.place(points[corner]);
            grid.cells[row * grid.columns + column].push(corner);
        }
        let by_x = |a: &usize, b: &usize| points[*a].x.total_cmp(&points[*b].x);
        grid.cells.iter_mut().for_each(|corners| corners.sort_by(by_x));
        grid
    }

    /// Column and row of the cell at a point; of the nearest cell for a point beside the grid.
    fn place(&self, point: DVec2) -> [usize; 2] {
        let at = (point - self.low) / self.cell_size;
        // The casts turn NaN and negative numbers into 0.
        [(at.x as usize).min(self.columns - 1), (at.y as usize).min(self.rows - 1)]
    }

    /// The cells that a box touches.
    fn cells_over(&self, low: DVec2, high: DVec2) -> impl Iterator<Item = usize> + use<> {
        let ([left, bottom], [right, top], columns) = (self.place(low), self.place(high), self.columns);
        (bottom..=top).flat_map(move |row| (left..=right).map(move |column| row * columns + column))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A round polygon with waves on it, where long ears pass many corners; the same with one corner far off; a comb;
    /// and all of them wound the other way.
    #[test]
    fn large_polygons_are_cut_whole_with_few_tests_for_each_corner() {
        let count = 20_000;
        let corners_of_comb = 500;
        let wavy = |at: usize| {
            let angle = at as f64 / f64::from(count) * std::f64::consts::TAU;
            let radius = 1.0 + 0.1 * (37.0 * angle).sin() + 0.01 * (1777.0 * angle).sin();
            DVec3::new(radius * angle.cos(), radius * angle.sin(), 0.0)
        };
        let comb = |at: usize| match at {
            0 => DVec3::new(0.0, -1.0, 0.0),
            1 => DVec3::new(f64::from(corners_of_comb), -1.0, 0.0),
            _ => DVec3::new(f64::from(corners_of_comb) - at as f64, (at % 2) as f64, 0.0),
        };
        let far = |at: usize| if at == 5 { DVec3::new(1e6, 1.0, 0.0) } else { wavy(at) };
        let polygons: [Vec<DVec3>; 3] = [
            (0..count as usize).map(wavy).collect(),
            (0..count as usize).map(far).collect(),
            (0..corners_of_comb as usize).map(comb).collect(),
        ];
        for polygon in polygons {
            for turned in [false, true] {
                let mut polygon = polygon.clone();
                if turned {
                    polygon.reverse();
                }
                let mut tests_left = MAX_TESTS;
                let cut = cut(&polygon, &mut tests_left);
                assert!(!cut.is_rough && cut.triangles.len() == polygon.len() - 2);
                let normal = newell(&polygon).normalize();
                let area_of = |&[a, b, c]: &[usize; 3]| {
                    (polygon[b] - polygon[a]).cross(polygon[c] - polygon[a]).dot(normal)
                };
                // No triangle is turned over, and together they fill the polygon: so none lies outside.
                let areas: Vec<f64> = cut.triangles.iter().map(area_of).collect();
                let whole = newell(&polygon).length();
                assert!(areas.iter().all(|&area| area >= -1e-12 * whole), "a triangle is turned over");
                assert!((areas.iter().sum::<f64>() / whole - 1.0).abs() < 1e-9);
                let tests = MAX_TESTS - tests_left;
                assert!(tests < 300 * polygon.len() as u64, "{tests} tests");
            }
        }
    }
}
