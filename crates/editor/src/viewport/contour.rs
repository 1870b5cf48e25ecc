//! Finds the outlines of a set of grid cells as smooth curves, to draw outlines of objects and regions.

use std::collections::HashMap;

use glam::DVec2;

/// Rounds of smoothing; each moves a point to the mean of itself and its two neighbours.
const ROUNDS: usize = 6;

/// The lines that separate the cells in a set from the other cells. Coordinates are in cells from the upper left
/// corner, Y down. The rim of the grid is no border of the set: a line that reaches the rim ends there. All other lines
/// are closed.
pub fn contours([columns, rows]: [usize; 2], is_in: impl Fn(usize, usize) -> bool) -> Vec<Vec<DVec2>> {
    // Each piece runs along one side of a cell, with the set on its right as seen on the screen. Where two lines meet
    // at a corner, they turn there and do not cross.
    let mut next: HashMap<(usize, usize), Vec<(usize, usize)>> = HashMap::new();
    let mut piece = |from: (usize, usize), to: (usize, usize)| next.entry(from).or_default().push(to);
    for row in 0..rows {
        for column in 0..columns {
            if !is_in(column, row) {
                continue;
            }
            let (x, y) = (column, row);
            if row > 0 && !is_in(column, row - 1) {
                piece((x, y), (x + 1, y));
            }
            if column + 1 < columns && !is_in(column + 1, row) {
                piece((x + 1, y), (x + 1, y + 1));
            }
            if row + 1 < rows && !is_in(column, row + 1) {
                piece((x + 1, y + 1), (x, y + 1));
            }
            if column > 0 && !is_in(column - 1, row) {
                piece((x, y + 1), (x, y));
            }
        }
    }
    // Open lines (those that end at the rim) are followed first, from their beginnings.
    let mut ends: HashMap<(usize, usize), isize> = HashMap::new();
    for (&from, targets) in &next {
        *ends.entry(from).or_default() += targets.len() as isize;
        for &to in targets {
            *ends.entry(to).or_default() -= 1;
        }
    }
    let mut starts: Vec<(usize, usize)> =
        ends.into_iter().filter(|&(_, excess)| excess > 0).map(|(at, _)| at).collect();
    starts.sort_unstable();
    let mut others: Vec<(usize, usize)> = next.keys().copied().collect();
    others.sort_unstable();
    starts.extend(others);
    let mut lines = Vec::new();
    for start in starts {
        while let Some(line) = follow(start, &mut next) {
            lines.push(smooth(&line));
        }
    }
    lines
}

/// Joins the pieces that follow each other from `start` into one line, and removes them from `next`; `None` if no piece
/// begins there.
fn follow(
    start: (usize, usize),
    next: &mut HashMap<(usize, usize), Vec<(usize, usize)>>,
) -> Option<Vec<DVec2>> {
    let mut line = vec![DVec2::new(start.0 as f64, start.1 as f64)];
    let mut at = start;
    while let Some(to) = next.get_mut(&at).and_then(Vec::pop) {
        // The line runs through the middles of the sides, which alone removes half of the stair steps.
        line.push(DVec2::new(at.0 as f64 + to.0 as f64, at.1 as f64 + to.1 as f64) * 0.5);
        at = to;
        if at == start {
            break;
        }
    }
    line.push(DVec2::new(at.0 as f64, at.1 as f64));
    if line.len() <= 2 {
        return None;
    }
    if at == start {
        // A closed line begins and ends with the middle of its first side.
        line.pop();
        line.remove(0);
        line.push(line[0]);
    }
    Some(line)
}

fn smooth(line: &[DVec2]) -> Vec<DVec2> {
    let count = line.len();
    let closed = line[0] == line[count - 1] && count > 3;
    let mut points = line.to_vec();
    for _ in 0..ROUNDS {
        let before = points.clone();
        for index in 1..count - 1 {
            points[index] = (before[index - 1] + before[index] + before[index + 1]) / 3.0;
        }
        if closed {
            points[0] = (before[count - 2] + before[0] + before[1]) / 3.0;
            points[count - 1] = points[0];
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_disc_has_one_closed_line_at_its_radius() {
        let centre = DVec2::splat(40.0);
        let inside =
            |x: usize, y: usize| (DVec2::new(x as f64 + 0.5, y as f64 + 0.5) - centre).length() < 25.0;
        let lines = contours([80, 80], inside);
        assert_eq!(lines.len(), 1);
        assert_eq!(lines[0].first(), lines[0].last());
        for point in &lines[0] {
            assert!(((point - centre).length() - 25.0).abs() < 0.8, "{point}");
        }
    }

    #[test]
    fn a_ring_has_two_lines_and_what_leaves_the_grid_an_open_one() {
        let ring = |x: usize, y: usize| !(4..8).contains(&x) || !(4..8).contains(&y);
        let ring = |x: usize, y: usize| (2..10).contains(&x) && (2..10).contains(&y) && ring(x, y);
        assert_eq!(contours([12, 12], ring).len(), 2);
        let left_half = contours([12, 12], |x, _| x < 5);
        assert_eq!(left_half.len(), 1);
        assert_ne!(left_half[0].first(), left_half[0].last());
        assert!(left_half[0].iter().all(|point| point.x == 5.0));
        assert!(contours([12, 12], |_, _| true).is_empty());
    }
}
