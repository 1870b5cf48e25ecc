//! Draws the points where strokes have no direction.

use egui::{Color32, Shape, Stroke, vec2};
use glam::DVec3;

use super::ink::{self, OVER_PAINT};
use super::{Sheet, Sight};

/// A point where strokes have no direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SingularPoint {
    /// Its place, world space.
    pub position_in_world: DVec3,
    /// The unit vector that the visibility test takes for the surface normal. It points to the eye, so that only a
    /// surface in front of the point hides the mark.
    pub normal_in_world: DVec3,
    /// How many turns the strokes make on a small loop around it, such as +½, +1 or −½.
    pub index: f32,
}

/// Draws the visible points: a circle where the index is positive (strokes go round), a triangle where it is negative
/// (strokes part).
pub fn singular_points(sheet: &Sheet<'_>, points: &[SingularPoint], sight: &Sight<'_>) {
    for point in points.iter().filter(|point| sight.sees(point.position_in_world, point.normal_in_world)) {
        let Some(at) = sheet.project(point.position_in_world) else { continue };
        for stroke in [Stroke::new(4.0, ink::black(0.5)), Stroke::new(1.8, OVER_PAINT.ochre)] {
            sheet.painter.add(if point.index > 0.0 {
                Shape::circle_stroke(at, 5.0, stroke)
            } else {
                let corners = [vec2(0.0, -6.0), vec2(5.6, 4.0), vec2(-5.6, 4.0)].map(|corner| at + corner);
                Shape::convex_polygon(corners.to_vec(), Color32::TRANSPARENT, stroke)
            });
        }
    }
}
