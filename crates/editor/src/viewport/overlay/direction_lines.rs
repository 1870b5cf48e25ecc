//! Draws the overlay of directions: short lines along the strokes. They are plain, have their regions' colours, or
//! show how far each direction can be trusted.

use egui::{Align2, Color32, Painter, Pos2, Shape, Stroke, pos2, vec2};
use glam::DVec2;

use super::Sheet;
use super::ink::{self, Ink, OVER_PAINT};
use crate::theme::{Tokens, type_face};

const LENGTH: f32 = 12.0;
const WIDTH: f32 = 1.4;
/// Above this trust a direction is sure.
const SURE: f32 = 0.90;
/// From this trust up to `SURE` a direction is fair; below, it cannot be trusted.
const FAIR: f32 = 0.72;
/// From the left end of a sign of the legend to its words, and from one row of the legend to the next.
const SIGN: f32 = 24.0;
const ROW: f32 = 18.0;
/// Opacity of faint lines.
const FAINT: f32 = 0.35;

/// One direction line: a short line along the strokes at a place in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionMark {
    /// Its middle, from the upper left corner of the picture.
    pub at_px: DVec2,
    /// Counter-clockwise from +X with Y up, radians.
    pub angle_rad: f32,
    /// How it is drawn.
    pub ink: DirectionInk,
    /// Whether it belongs to another region or object than the one that is painted or posed.
    pub faint: bool,
}

/// How a direction line is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DirectionInk {
    /// White over black.
    Plain,
    /// In the colour of its region.
    Region(Color32),
    /// By trust, κ in 0..=1; 0 where the reference does not see the surface. Both pattern and colour of the line show
    /// the trust.
    Trust(f32),
}

/// Draws direction lines.
pub fn direction_lines(sheet: &Sheet<'_>, marks: &[DirectionMark]) {
    for mark in marks {
        let half = ink::along(mark.angle_rad) * (LENGTH * 0.5);
        let at = sheet.at(mark.at_px);
        draw(sheet.painter, [at - half, at + half], mark.ink, if mark.faint { FAINT } else { 1.0 });
    }
}

fn draw(painter: &Painter, ends: [Pos2; 2], direction_line: DirectionInk, share: f32) {
    let ink = |colour: Color32| {
        Ink::new(WIDTH, colour.gamma_multiply(share), (WIDTH + 1.8, ink::black(0.7 * share)))
    };
    match direction_line {
        DirectionInk::Plain => ink(ink::WHITE).segment(painter, ends),
        DirectionInk::Region(colour) => ink(colour).segment(painter, ends),
        DirectionInk::Trust(kappa) if kappa > SURE => ink(ink::WHITE).segment(painter, ends),
        DirectionInk::Trust(kappa) if kappa >= FAIR => ink(OVER_PAINT.ochre).dashed(painter, &ends, 5.0, 2.0),
        DirectionInk::Trust(_) => {
            let (step, count) = ((ends[1] - ends[0]) / LENGTH, 4);
            for dot in 0..count {
                let at = ends[0] + step * (LENGTH * (dot as f32 + 0.5) / count as f32);
                painter.circle_filled(at, 1.6, ink::black(0.55 * share));
                painter.circle_filled(at, 1.1, OVER_PAINT.pink.gamma_multiply(share));
            }
        }
    }
}

/// Draws the legend of the patterns of trust; `at` is the middle of its left end. What would reach beyond `right` goes
/// into a new row.
pub fn trust_legend(painter: &Painter, at: Pos2, right: f32, tokens: &Tokens) {
    let words = |at: Pos2, text: &str| {
        painter.text(at, Align2::LEFT_CENTER, text, type_face::small(), tokens.weak).right()
    };
    let width_of =
        |text: &str| painter.layout_no_wrap(text.to_owned(), type_face::small(), tokens.weak).size().x;
    let dark = tokens.text.r() > 128;
    let sure = Stroke::new(2.0, if dark { ink::WHITE } else { Color32::BLACK });
    let mut place = pos2(words(at, "Trust") + 14.0, at.y);
    for (sign, text) in ["sure, over 0.90", "fair", "unsure or not seen"].into_iter().enumerate() {
        if place.x + SIGN + width_of(text) > right && place.x > at.x {
            place = pos2(at.x, place.y + ROW);
        }
        let line = [place, place + vec2(18.0, 0.0)];
        match sign {
            0 => _ = painter.line_segment(line, sure),
            1 => painter.extend(Shape::dashed_line(&line, Stroke::new(2.0, tokens.ochre), 7.0, 4.0)),
            _ => (0..5).for_each(|dot| {
                painter.circle_filled(place + vec2(1.5 + 3.8 * dot as f32, 0.0), 1.5, tokens.pink);
            }),
        }
        place.x = words(place + vec2(SIGN, 0.0), text) + 18.0;
    }
}
