//! Draws a line for each sun, and lines and an icon for the shot camera: these have no surface of their own.

use egui::{Align2, Color32, Stroke};
use glam::DVec3;

use super::Sheet;
use super::ink::{self, OVER_PAINT};
use crate::icons;
use crate::theme::type_face;

/// What is drawn for something that has no surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StandIn {
    /// A parallel light: a line along its direction. The renderer draws its icon.
    Sun {
        /// Where its icon is, world space.
        at: DVec3,
        /// The direction of its light, world space, unit.
        direction: DVec3,
    },
    /// The shot camera.
    Camera {
        /// Its eye, world space.
        eye: DVec3,
        /// The corners of its picture at some depth, in order round it, world space.
        corners: [DVec3; 4],
    },
}

/// Draws the stand-ins. The flag beside each says whether it is selected.
pub fn stand_ins(sheet: &Sheet<'_>, all: &[(StandIn, bool)]) {
    for &(stand_in, selected) in all {
        let colour = if selected { OVER_PAINT.accent_text } else { ink::WHITE };
        match stand_in {
            StandIn::Sun { at, direction } => {
                let reach = 44.0 / sheet.view.px_per_unit(at);
                segment(sheet, [at + direction * (reach * 0.4), at + direction * reach], colour);
            }
            StandIn::Camera { eye, corners } => {
                for index in 0..4 {
                    segment(sheet, [eye, corners[index]], colour);
                    segment(sheet, [corners[index], corners[(index + 1) % 4]], colour);
                }
                icon(sheet, eye, icons::CAMERA, colour);
            }
        }
    }
}

fn segment(sheet: &Sheet<'_>, ends: [DVec3; 2], colour: Color32) {
    if let [Some(from), Some(to)] = ends.map(|end| sheet.project(end)) {
        sheet.painter.line_segment([from, to], Stroke::new(3.0, ink::black(0.4)));
        sheet.painter.line_segment([from, to], Stroke::new(1.3, colour));
    }
}

fn icon(sheet: &Sheet<'_>, at: DVec3, icon: icons::Icon, colour: Color32) {
    let Some(at) = sheet.project(at) else { return };
    sheet.painter.circle_filled(at, 13.0, ink::black(0.55));
    let font = type_face::icon(18.0);
    sheet.painter.text(at, Align2::CENTER_CENTER, icon.glyph(), font, colour);
}
