//! Draws the motion path of the selected object, with its keys.

use egui::{Pos2, Shape, Stroke, Vec2, vec2};
use glam::DVec3;

use super::Sheet;
use super::ink::{self, OVER_PAINT};
use crate::theme::type_face;

/// If two neighbouring keys are closer than this, in points, all keys are drawn smaller.
const CROWDED: f32 = 16.0;
/// The space that a number needs, in points.
const NUMBER: Vec2 = vec2(28.0, 16.0);

/// The motion path of an object.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionPath {
    /// Where the object's origin is along the path, in world space.
    pub places: Vec<DVec3>,
    /// The object's keys: the frame of each, and its place in world space.
    pub keys: Vec<(f64, DVec3)>,
}

/// Draws a dotted path with a diamond for each key, and with the frame numbers of as many keys as there is room for.
pub fn motion_path(sheet: &Sheet<'_>, path: &MotionPath) {
    let points: Vec<Option<Pos2>> = path.places.iter().map(|&place| sheet.project(place)).collect();
    for run in points.split(Option::is_none).filter(|run| run.len() > 1) {
        let run: Vec<Pos2> = run.iter().flatten().copied().collect();
        // A path that passes close to the eye leads far out of the window. Dots all along it would freeze the editor,
        // so only the parts in sight get dots.
        for run in ink::runs_in_sight(sheet.painter, &run) {
            sheet.painter.extend(Shape::dotted_line(&run, ink::black(0.6), 6.0, 1.9));
            sheet.painter.extend(Shape::dotted_line(&run, OVER_PAINT.key, 6.0, 1.3));
        }
    }
    let keys: Vec<(f64, Pos2)> =
        path.keys.iter().filter_map(|&(frame, place)| Some((frame, sheet.project(place)?))).collect();
    let places: Vec<Pos2> = keys.iter().map(|&(_, at)| at).collect();
    let crowded = places.windows(2).any(|pair| pair[0].distance(pair[1]) < CROWDED);
    let half = if crowded { 4.5 } else { 7.0 };
    for &at in &places {
        let corners = [vec2(0.0, -half), vec2(half, 0.0), vec2(0.0, half), vec2(-half, 0.0)];
        let corners = corners.map(|corner| at + corner).to_vec();
        let edge = Stroke::new(1.4, ink::EDGE);
        sheet.painter.add(Shape::convex_polygon(corners, OVER_PAINT.key, edge));
    }
    for index in numbered(&places) {
        let (frame, at) = keys[index];
        let number = format!("{frame:.0}");
        let at = at + vec2(0.0, half + 12.0);
        ink::edged_words(sheet.painter, at, &number, type_face::number(), ink::WHITE);
    }
}

/// Indices of the keys that show their number. The first and the last key are tried first, then the others in order; a
/// key whose number would overlap another is left out.
fn numbered(places: &[Pos2]) -> Vec<usize> {
    let last = places.len().saturating_sub(1);
    let mut chosen: Vec<usize> = Vec::new();
    for index in [0, last].into_iter().chain(0..places.len()).take_while(|_| !places.is_empty()) {
        let is_free = |other: &usize| {
            let apart = (places[*other] - places[index]).abs();
            apart.x >= NUMBER.x || apart.y >= NUMBER.y
        };
        if chosen.iter().all(is_free) {
            chosen.push(index);
        }
    }
    chosen
}

#[cfg(test)]
mod tests {
    use egui::pos2;

    use super::*;

    #[test]
    fn numbers_never_lie_over_one_another_and_the_ends_come_first() {
        let row = |steps: &[f32]| steps.iter().map(|&x| pos2(x, 100.0)).collect::<Vec<_>>();
        assert_eq!(numbered(&row(&[0.0, 10.0, 40.0, 70.0, 90.0])), [0, 4, 2]);
        assert_eq!(numbered(&row(&[0.0, 5.0])), [0], "two keys this close have room for one number only");
        assert_eq!(numbered(&[pos2(0.0, 0.0), pos2(2.0, 40.0)]), [0, 1], "keys far apart have room for both");
        assert!(numbered(&[]).is_empty());
    }
}
