use egui::{Color32, Stroke, pos2, vec2};
use glam::DVec2;

use super::Sheet;
use super::ink::{self, Ink};
use crate::theme::type_face;

/// How far the needle reaches behind the dot and before it, in radii of the ring.
const REACH: [f32; 2] = [0.5, 1.5];

/// The direction under the dot, or the one that the hand states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Needle {
    /// The dot.
    pub at_px: DVec2,
    /// Radius of the ring.
    pub radius_px: f64,
    /// Counter-clockwise from +X with Y up, radians.
    pub angle_rad: f32,
    /// Whether strokes here have a head; only then has the needle one.
    pub directed: bool,
}

/// Draws the needle of a ring.
pub fn needle(sheet: &Sheet<'_>, needle: &Needle) {
    let (at, direction) = (sheet.at(needle.at_px), ink::along(needle.angle_rad));
    let radius = needle.radius_px as f32;
    let reach = if needle.directed { REACH } else { [1.0; 2] };
    let (from, to) = (at - direction * (radius * reach[0]), at + direction * (radius * reach[1]));
    let ink = Ink::new(2.2, ink::WHITE, (4.4, ink::black(0.5)));
    if needle.directed {
        ink.segment(sheet.painter, [from, to - direction * 9.0]);
        let edge = Stroke::new(1.2, ink::black(0.5));
        sheet.painter.add(ink::head(to, direction, (12.0, 10.0), (ink::WHITE, edge)));
    } else {
        ink.segment(sheet.painter, [from, to]);
    }
    sheet.painter.circle(at, 2.6, ink::WHITE, Stroke::new(1.2, ink::black(0.6)));
}

/// What the needle says, beside the ring: `10°  trust 0.97`.
pub fn needle_tag(sheet: &Sheet<'_>, needle: &Needle, kappa: Option<f32>) {
    let degrees = needle.angle_rad.to_degrees();
    // Of strokes without a head, one half turn is as good as the other.
    let degrees = if needle.directed { degrees } else { degrees.rem_euclid(180.0) };
    let degrees = if degrees.round() == 0.0 { 0.0 } else { degrees.round() };
    let trust = kappa.map_or_else(String::new, |kappa| format!("  trust {kappa:.2}"));
    let words = format!("{degrees:.0}°{trust}");
    let galley = sheet.painter.layout_no_wrap(words, type_face::number(), Color32::from_gray(232));
    let size = vec2(galley.size().x + 20.0, 24.0);
    let beside = sheet.at(needle.at_px) + vec2(1.0, 1.0) * needle.radius_px as f32 + vec2(6.0, 0.0);
    // It stays within the picture.
    let most = sheet.rect.max - size - vec2(4.0, 4.0);
    let least = sheet.rect.min + vec2(4.0, 4.0);
    let at = pos2(beside.x.min(most.x).max(least.x), beside.y.min(most.y).max(least.y));
    sheet.painter.rect_filled(egui::Rect::from_min_size(at, size), 4.0, ink::black(0.82));
    let text_at = at + vec2(10.0, (size.y - galley.size().y) * 0.5);
    sheet.painter.galley(text_at, galley, Color32::WHITE);
}
