use egui::{Color32, Pos2, Stroke, vec2};
use glam::DVec3;

use super::ink::{self, EDGE, Ink, OVER_PAINT};
use super::{Sheet, Sight};

/// Radius of a handle; it can be gripped within 12.
const HANDLE: f32 = 5.0;

/// A guide on a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct GuideCurve {
    /// The curve, close enough to draw as a line: places and surface normals, world space.
    pub line: Vec<[DVec3; 2]>,
    /// The points that the user set, likewise.
    pub handles: Vec<[DVec3; 2]>,
    /// Whether handles show.
    pub selected: bool,
    /// What the pointer is on, or holds.
    pub lit: Option<CurvePart>,
    /// Whether strokes have a head: then the curve has one.
    pub directed: bool,
    /// Points that are not on the surface any more.
    pub adrift: Vec<DVec3>,
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

/// Draws a guide: where it faces the eye and nothing is before it.
pub fn guide_curve(sheet: &Sheet<'_>, guide: &GuideCurve, sight: &Sight<'_>) {
    let strong = guide.selected || guide.lit.is_some();
    let width = if strong { 3.0 } else { 1.6 };
    let colour = if guide.lit == Some(CurvePart::Line) { ink::WHITE } else { OVER_PAINT.accent_text };
    let line_ink = Ink::new(width, colour, (width + 2.0, EDGE.gamma_multiply(0.85)));
    let seen = |[at, normal]: &[DVec3; 2]| sight.sees(*at, *normal).then(|| sheet.project(*at)).flatten();
    let points: Vec<Option<Pos2>> = guide.line.iter().map(seen).collect();
    for run in points.split(Option::is_none).filter(|run| run.len() > 1) {
        let run: Vec<Pos2> = run.iter().flatten().copied().collect();
        line_ink.line(sheet.painter, &run);
    }
    let end = points.len().checked_sub(2).map(|last| [points[last], points[last + 1]]);
    if let Some([Some(from), Some(to)]) = end.filter(|_| guide.directed && strong) {
        let direction = (to - from).normalized();
        let fill = if guide.lit == Some(CurvePart::Arrow) { ink::WHITE } else { OVER_PAINT.accent_text };
        let tip = to + direction * 8.0;
        sheet.painter.add(ink::head(tip, direction, (12.0, 11.0), (fill, Stroke::new(1.2, EDGE))));
    }
    if guide.selected {
        for (index, handle) in guide.handles.iter().enumerate() {
            let Some(at) = seen(handle) else { continue };
            let fill = if guide.lit == Some(CurvePart::Handle(index)) { OVER_PAINT.accent_text } else { ink::WHITE };
            sheet.painter.circle(at, HANDLE, fill, Stroke::new(1.6, EDGE));
        }
    }
    for at in guide.adrift.iter().filter_map(|&at| sheet.project(at)) {
        sheet.painter.circle_stroke(at, HANDLE, Stroke::new(3.6, ink::black(0.5)));
        sheet.painter.circle_stroke(at, HANDLE, Stroke::new(1.8, OVER_PAINT.vermilion));
        let font = crate::theme::type_face::small();
        ink::edged_words(sheet.painter, at + vec2(0.0, -14.0), ("off the surface", font), Color32::WHITE);
    }
}
