use egui::{Pos2, Shape, Stroke, vec2};
use glam::DVec3;

use super::Sheet;
use super::ink::{self, OVER_PAINT};
use crate::theme::type_face;

/// Where an object goes.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionPath {
    /// Its origin, frame by frame, world space.
    pub places: Vec<DVec3>,
    /// Its keys: frame and place.
    pub keys: Vec<(f64, DVec3)>,
}

/// Draws a dotted path with a mark and a number for each key.
pub fn motion_path(sheet: &Sheet<'_>, path: &MotionPath) {
    let points: Vec<Option<Pos2>> = path.places.iter().map(|&place| sheet.project(place)).collect();
    for run in points.split(Option::is_none).filter(|run| run.len() > 1) {
        let run: Vec<Pos2> = run.iter().flatten().copied().collect();
        sheet.painter.extend(Shape::dotted_line(&run, ink::black(0.6), 6.0, 1.9));
        sheet.painter.extend(Shape::dotted_line(&run, OVER_PAINT.key, 6.0, 1.3));
    }
    for &(frame, place) in &path.keys {
        let Some(at) = sheet.project(place) else { continue };
        let corners =
            [vec2(0.0, -7.0), vec2(7.0, 0.0), vec2(0.0, 7.0), vec2(-7.0, 0.0)].map(|corner| at + corner);
        let edge = Stroke::new(1.4, ink::EDGE);
        sheet.painter.add(Shape::convex_polygon(corners.to_vec(), OVER_PAINT.key, edge));
        let number = format!("{frame:.0}");
        ink::edged_words(sheet.painter, at + vec2(0.0, 19.0), (&number, type_face::number()), ink::WHITE);
    }
}
