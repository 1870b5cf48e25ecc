//! Draws guides as lines with an arrow and handles.

use egui::{Color32, Pos2, Stroke, vec2};
use glam::{DVec2, DVec3};

use super::ink::{self, EDGE, Ink, OVER_PAINT};
use super::{Sheet, Sight};

/// Radius of a handle, points. The pointer grips a handle from up to 12 points away.
const HANDLE: f32 = 5.0;

/// The visible parts of a guide, in points from the upper left corner of the picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GuideCurve {
    /// The visible pieces of the line.
    pub runs_px: Vec<Vec<DVec2>>,
    /// The visible points that the user set, each with its index.
    pub handles_px: Vec<(usize, DVec2)>,
    /// Whether the end of the guide is visible. If it is not, no arrow is drawn.
    pub end_shows: bool,
    /// Whether the guide is selected. Handles are drawn only on a selected guide; the arrow, only on a guide that is
    /// selected or has a lit part.
    pub selected: bool,
    /// The part that the pointer is on, or holds.
    pub lit: Option<CurvePart>,
    /// Points that are no longer on the surface.
    pub adrift_px: Vec<DVec2>,
}

/// A part of a guide.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurvePart {
    /// The line.
    Line,
    /// A handle, by index.
    Handle(usize),
    /// The arrow at its end.
    Arrow,
}

impl GuideCurve {
    /// The visible parts of a guide: where its surface faces the eye and nothing is in front. Each item of `line` and
    /// `handles` is a place and the surface normal there, world space.
    pub fn seen(line: &[[DVec3; 2]], handles: &[[DVec3; 2]], sight: &Sight<'_>) -> Self {
        let seen = |[at, normal]: &[DVec3; 2]| {
            sight.view.project(*at).filter(|at_px| at_px.is_finite() && sight.sees(*at, *normal))
        };
        let points: Vec<Option<DVec2>> = line.iter().map(seen).collect();
        let runs = points.split(Option::is_none).filter(|run| run.len() > 1);
        Self {
            runs_px: runs.map(|run| run.iter().flatten().copied().collect()).collect(),
            handles_px: handles
                .iter()
                .enumerate()
                .filter_map(|(index, at)| Some((index, seen(at)?)))
                .collect(),
            end_shows: points.len() > 1 && points[points.len() - 2..].iter().all(Option::is_some),
            ..Self::default()
        }
    }
}

/// Draws a guide.
pub fn guide_curve(sheet: &Sheet<'_>, guide: &GuideCurve) {
    let strong = guide.selected || guide.lit.is_some();
    let width = if strong { 3.0 } else { 1.6 };
    let colour = if guide.lit == Some(CurvePart::Line) { ink::WHITE } else { OVER_PAINT.accent_text };
    let line_ink = Ink::new(width, colour, (width + 2.0, EDGE.gamma_multiply(0.85)));
    let mut arrow = None;
    for run in &guide.runs_px {
        let run: Vec<Pos2> = run.iter().map(|&at| sheet.at(at)).collect();
        line_ink.line(sheet.painter, &run);
        arrow = run.last_chunk::<2>().copied();
    }
    if let Some([from, to]) = arrow.filter(|_| guide.end_shows && strong) {
        let direction = (to - from).normalized();
        let fill = if guide.lit == Some(CurvePart::Arrow) { ink::WHITE } else { OVER_PAINT.accent_text };
        let tip = to + direction * 8.0;
        sheet.painter.add(ink::head(tip, direction, 12.0, 11.0, fill, Stroke::new(1.2, EDGE)));
    }
    for &(index, at_px) in guide.handles_px.iter().filter(|_| guide.selected) {
        let lit = guide.lit == Some(CurvePart::Handle(index));
        let fill = if lit { OVER_PAINT.accent_text } else { ink::WHITE };
        sheet.painter.circle(sheet.at(at_px), HANDLE, fill, Stroke::new(1.6, EDGE));
    }
    for &at_px in &guide.adrift_px {
        let at = sheet.at(at_px);
        sheet.painter.circle_stroke(at, HANDLE, Stroke::new(3.6, ink::black(0.5)));
        sheet.painter.circle_stroke(at, HANDLE, Stroke::new(1.8, OVER_PAINT.vermilion));
        let font = crate::theme::type_face::small();
        ink::edged_words(sheet.painter, at + vec2(0.0, -14.0), "off the surface", font, Color32::WHITE);
    }
}
