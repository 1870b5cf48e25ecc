//! Draws the needle in a tool's ring, which shows the direction at the pointer, and the label beside the ring.

use egui::{Color32, Stroke, pos2, vec2};
use glam::DVec2;
use impasto_editor_model::tools::Needle;

use super::Sheet;
use super::ink::{self, Ink};
use crate::theme::type_face;

/// How far a needle with a head reaches behind the centre and in front of it, in radii of the ring.
const HEADED: [f32; 2] = [0.5, 1.5];
/// How far a needle without a head reaches behind the centre and in front of it, in radii of the ring.
const HEADLESS: [f32; 2] = [1.0, 1.0];

/// Draws the needle of a ring of this radius.
pub fn needle(sheet: &Sheet<'_>, needle: &Needle, radius_px: f64) {
    let at = sheet.at(needle.at_px);
    let direction = vec2(needle.along.x as f32, needle.along.y as f32);
    let [back, forth] = if needle.headed { HEADED } else { HEADLESS }.map(|share| share * radius_px as f32);
    let (from, to) = (at - direction * back, at + direction * forth);
    let ink = Ink::new(2.2, ink::WHITE, (4.4, ink::black(0.5)));
    if needle.headed {
        ink.segment(sheet.painter, [from, to - direction * 9.0]);
        let edge = Stroke::new(1.2, ink::black(0.5));
        sheet.painter.add(ink::head(to, direction, 12.0, 10.0, ink::WHITE, edge));
    } else {
        ink.segment(sheet.painter, [from, to]);
    }
    sheet.painter.circle(at, 2.6, ink::WHITE, Stroke::new(1.2, ink::black(0.6)));
}

/// Draws the label beside the ring, such as `10°  trust 0.97`. It stays within the picture.
pub fn needle_tag(sheet: &Sheet<'_>, at_px: DVec2, radius_px: f64, words: &str) {
    let galley = sheet.painter.layout_no_wrap(words.to_owned(), type_face::number(), Color32::from_gray(232));
    let size = vec2(galley.size().x + 20.0, 24.0);
    let beside = sheet.at(at_px) + vec2(1.0, 1.0) * radius_px as f32 + vec2(6.0, 0.0);
    let most = sheet.rect.max - size - vec2(4.0, 4.0);
    let least = sheet.rect.min + vec2(4.0, 4.0);
    let at = pos2(beside.x.min(most.x).max(least.x), beside.y.min(most.y).max(least.y));
    sheet.painter.rect_filled(egui::Rect::from_min_size(at, size), 4.0, ink::black(0.82));
    let text_at = at + vec2(10.0, (size.y - galley.size().y) * 0.5);
    sheet.painter.galley(text_at, galley, Color32::WHITE);
}
