//! Draws the overlay's lines and words so that they are visible on any paint: light over dark.

use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Shape, Stroke, Vec2, pos2};

pub(super) const WHITE: Color32 = Color32::WHITE;
/// The dark edge of what is drawn over paint.
pub(super) const EDGE: Color32 = Color32::from_rgb(0x14, 0x17, 0x20);
/// What is drawn over paint has the dark theme's colours in both themes.
pub(super) use crate::theme::DARK as OVER_PAINT;

pub(super) fn black(share: f32) -> Color32 {
    Color32::from_black_alpha((share * 255.0).round() as u8)
}

pub(super) fn white(share: f32) -> Color32 {
    Color32::from_white_alpha((share * 255.0).round() as u8)
}

/// A line over a wider one.
#[derive(Clone, Copy)]
pub(super) struct Ink {
    pub(super) over: Stroke,
    pub(super) under: Stroke,
}

impl Ink {
    pub(super) fn new(width: f32, colour: Color32, under: (f32, Color32)) -> Self {
        Self { over: Stroke::new(width, colour), under: Stroke::new(under.0, under.1) }
    }

    pub(super) fn segment(&self, painter: &Painter, ends: [Pos2; 2]) {
        painter.line_segment(ends, self.under);
        painter.line_segment(ends, self.over);
    }

    pub(super) fn line(&self, painter: &Painter, points: &[Pos2]) {
        painter.add(Shape::line(points.to_vec(), self.under));
        painter.add(Shape::line(points.to_vec(), self.over));
    }

    /// Draws a line in dashes, and only where it lies within the painter's area: a ring that reaches behind the eye has
    /// vertices millions of points away, and dashes all the way there would hold up the window.
    pub(super) fn dashed(&self, painter: &Painter, points: &[Pos2], dash: f32, gap: f32) {
        for run in runs_in_sight(painter, points) {
            painter.extend(Shape::dashed_line(&run, self.under, dash, gap));
            painter.extend(Shape::dashed_line(&run, self.over, dash, gap));
        }
    }
}

/// The parts of a line that the painter shows, and a little more.
pub(super) fn runs_in_sight(painter: &Painter, points: &[Pos2]) -> Vec<Vec<Pos2>> {
    runs_within(points, painter.clip_rect().expand(8.0))
}

/// The parts of a line that lie within an area. Segments with a point that is not finite are left out.
fn runs_within(points: &[Pos2], area: Rect) -> Vec<Vec<Pos2>> {
    let mut runs: Vec<Vec<Pos2>> = Vec::new();
    for pair in points.windows(2) {
        let Some([from, to]) = segment_within([pair[0], pair[1]], area) else { continue };
        match runs.last_mut().filter(|run| run.last() == Some(&from)) {
            Some(run) => run.push(to),
            None => runs.push(vec![from, to]),
        }
    }
    runs
}

/// The part of a segment within an area (Liang and Barsky 1984); `None` if no part of it is.
fn segment_within([from, to]: [Pos2; 2], area: Rect) -> Option<[Pos2; 2]> {
    if !(from.is_finite() && to.is_finite()) {
        return None;
    }
    let along = |axis: usize| {
        let (start, way) = (f64::from(from[axis]), f64::from(to[axis]) - f64::from(from[axis]));
        [(-way, start - f64::from(area.min[axis])), (way, f64::from(area.max[axis]) - start)]
    };
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    for (way, room) in along(0).into_iter().chain(along(1)) {
        if way == 0.0 {
            if room < 0.0 {
                return None;
            }
        } else if way < 0.0 {
            first = first.max(room / way);
        } else {
            last = last.min(room / way);
        }
    }
    // An end that is not cut stays exact, so that the next segment joins it.
    let at = |share: f64| {
        let place = |axis: usize| {
            (f64::from(from[axis]) + (f64::from(to[axis]) - f64::from(from[axis])) * share) as f32
        };
        pos2(place(0), place(1))
    };
    let start = if first > 0.0 { at(first) } else { from };
    let end = if last < 1.0 { at(last) } else { to };
    (first < last).then_some([start, end])
}

/// The unit vector (Y down) at an angle that is measured counter-clockwise with Y up.
pub(super) fn along(angle_rad: f32) -> Vec2 {
    let (sin, cos) = angle_rad.sin_cos();
    egui::vec2(cos, -sin)
}

/// An arrow's head with its tip at `tip`.
pub(super) fn head(
    tip: Pos2,
    direction: Vec2,
    length: f32,
    width: f32,
    fill: Color32,
    edge: Stroke,
) -> Shape {
    let back = tip - direction * length;
    let side = direction.rot90() * (width * 0.5);
    Shape::convex_polygon(vec![tip, back + side, back - side], fill, edge)
}

/// Words with a black edge on all sides.
pub(super) fn edged_words(painter: &Painter, at: Pos2, text: &str, font: FontId, colour: Color32) {
    for (x, y) in
        [(-1.0, -1.0), (0.0, -1.4), (1.0, -1.0), (-1.4, 0.0), (1.4, 0.0), (-1.0, 1.0), (0.0, 1.4), (1.0, 1.0)]
    {
        painter.text(pos2(at.x + x, at.y + y), Align2::CENTER_CENTER, text, font.clone(), Color32::BLACK);
    }
    painter.text(at, Align2::CENTER_CENTER, text, font, colour);
}

#[cfg(test)]
mod tests {
    use super::*;

    const AREA: Rect = Rect { min: pos2(0.0, 0.0), max: pos2(100.0, 50.0) };

    #[test]
    fn a_line_is_cut_to_the_area() {
        let inside = vec![pos2(10.0, 10.0), pos2(20.0, 40.0), pos2(90.0, 5.0)];
        assert_eq!(runs_within(&inside, AREA), std::slice::from_ref(&inside));
        let through = [pos2(-50.0, 25.0), pos2(150.0, 25.0), pos2(150.0, 10.0), pos2(50.0, 10.0)];
        let parts = [vec![pos2(0.0, 25.0), pos2(100.0, 25.0)], vec![pos2(100.0, 10.0), pos2(50.0, 10.0)]];
        assert_eq!(runs_within(&through, AREA), parts);
        // Past a corner, and beside the area.
        assert!(runs_within(&[pos2(-10.0, 5.0), pos2(5.0, -20.0)], AREA).is_empty());
        assert!(runs_within(&[pos2(-10.0, 60.0), pos2(110.0, 60.0)], AREA).is_empty());
    }

    /// A ring that passes just in front of the eye has points this far away. In single precision, dashes along it
    /// never come to an end.
    #[test]
    fn a_line_to_the_end_of_the_world_has_few_dashes() {
        let far = [pos2(50.0, 25.0), pos2(3e12, -7e11), pos2(-2e20, 1e19), pos2(50.0, 26.0)];
        let runs = runs_within(&far, AREA);
        let length = |run: &Vec<Pos2>| run.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f32>();
        assert!(!runs.is_empty() && runs.iter().map(length).sum::<f32>() < 250.0, "{runs:?}");
        let broken = [pos2(50.0, 25.0), pos2(f32::INFINITY, 3.0), pos2(f32::NAN, 2.0), pos2(50.0, 26.0)];
        assert!(runs_within(&broken, AREA).is_empty());
    }
}
