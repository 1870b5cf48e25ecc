//! Where pictures lie in the viewport. A single picture fills it. The two of a comparison lie side by side or one above
//! the other, whichever makes them larger.

use egui::{Align2, Painter, Rect, pos2, vec2};

use super::overlay::trust_legend;
use super::{Badge, Framing, Now, ViewportInput};
use crate::theme::{Tokens, type_face};

/// Space to the left and right of each picture of a comparison, points.
const MARGIN: f32 = 12.0;
/// Space above each picture of a comparison, for its title, points.
const TITLE: f32 = 28.0;
/// Space above and below the two pictures of a comparison, for the chips (floating buttons), points.
const CHIPS: f32 = 52.0;

/// The places of the pictures in the viewport.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    area: Rect,
    framings: Vec<Framing>,
    stacked: bool,
}

impl Layout {
    /// The layout of a single picture.
    pub fn single(area: Rect, scene_size: (u32, u32), pixels_per_point: f32) -> Self {
        Self { area, framings: vec![Framing::new(area, scene_size, pixels_per_point)], stacked: false }
    }

    /// The layout of a comparison: the reference, and the frame that is shown.
    pub fn compare(area: Rect, scene_size: (u32, u32), pixels_per_point: f32) -> Self {
        let aspect = scene_size.0.max(1) as f32 / scene_size.1.max(1) as f32;
        let half = |at: Rect, above: f32, below: f32| {
            let inner = Rect::from_min_max(
                at.min + vec2(MARGIN, above + TITLE),
                pos2(
                    (at.max.x - MARGIN).max(at.min.x + MARGIN + 1.0),
                    (at.max.y - below).max(at.min.y + above + TITLE + 1.0),
                ),
            );
            let width = inner.width().min(inner.height() * aspect);
            Rect::from_center_size(inner.center(), vec2(width, width / aspect))
        };
        let (left, right) = area.split_left_right_at_fraction(0.5);
        let (top, bottom) = area.split_top_bottom_at_fraction(0.5);
        let beside = [left, right].map(|at| half(at, CHIPS, CHIPS));
        let stacked = [half(top, CHIPS, 4.0), half(bottom, 4.0, CHIPS)];
        // The upper and the lower half may differ by rounding, so both pictures get the smaller size.
        let least = stacked[0].width().min(stacked[1].width());
        let stacked = stacked.map(|at| Rect::from_center_size(at.center(), vec2(least, least / aspect)));
        let is_stacked = least > beside[0].width();
        let pictures = if is_stacked { stacked } else { beside };
        let framings = pictures.map(|at| Framing::new(snapped(at), scene_size, pixels_per_point));
        Self { area, framings: framings.to_vec(), stacked: is_stacked }
    }

    /// The whole viewport.
    pub fn area(&self) -> Rect {
        self.area
    }

    /// The framings of the pictures. A comparison has two: first the reference, then the frame that is shown.
    pub fn framings(&self) -> &[Framing] {
        &self.framings
    }
}

fn snapped(at: Rect) -> Rect {
    Rect::from_min_size(at.min.round(), at.size().round())
}

/// Draws what a comparison adds: titles, outlines, the line between the halves, and the legend of Trust if it is on.
pub(super) fn titles(
    painter: &Painter,
    layout: &Layout,
    now: &Now<'_>,
    input: &ViewportInput<'_>,
    tokens: &Tokens,
) {
    let reference = match input.badge {
        Badge::Reference(frame) | Badge::Turned { reference: frame, .. } | Badge::Free(frame) => frame,
    };
    let words = [
        (format!("Reference, frame {reference:.0}"), "as painted"),
        (format!("Now, frame {:.0}", now.frame), now.note),
    ];
    let area = layout.area;
    if layout.stacked {
        painter.hline(area.x_range(), area.center().y, (2.0, tokens.div));
    } else {
        painter.vline(area.center().x, area.y_range(), (2.0, tokens.div));
    }
    for (framing, (title, note)) in layout.framings.iter().zip(&words) {
        let at = framing.viewport();
        painter.rect_stroke(at, 0.0, (1.0, tokens.out), egui::StrokeKind::Outside);
        let line = at.min.y - 17.0;
        painter.text(pos2(at.min.x, line), Align2::LEFT_CENTER, title, type_face::head(), tokens.text);
        painter.text(pos2(at.max.x, line), Align2::RIGHT_CENTER, note, type_face::small(), tokens.weak);
    }
    if input.session.overlays.trust
        && let Some(framing) = layout.framings.get(1)
    {
        let picture = framing.viewport();
        trust_legend(painter, picture.left_bottom() + vec2(0.0, 22.0), picture.right(), tokens);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pictures(width: f32, height: f32) -> (Layout, [Rect; 2]) {
        let area = Rect::from_min_size(pos2(48.0, 80.0), vec2(width, height));
        let layout = Layout::compare(area, (1280, 720), 1.0);
        let pictures = [layout.framings[0].viewport(), layout.framings[1].viewport()];
        (layout, pictures)
    }

    #[test]
    fn two_pictures_of_one_size_lie_where_they_are_larger() {
        let (wide, [left, right]) = pictures(1231.0, 652.0);
        assert!(!wide.stacked);
        assert!(left.max.x < right.min.x && left.size() == right.size());
        assert!((left.width() - 591.0).abs() < 2.0, "{left:?}");
        let (high, [top, bottom]) = pictures(700.0, 1000.0);
        assert!(high.stacked);
        assert!(top.max.y < bottom.min.y && top.size() == bottom.size());
        for (layout, both) in [(wide, [left, right]), (high, [top, bottom])] {
            assert!(both.iter().all(|picture| layout.area.contains_rect(*picture)));
        }
    }

    #[test]
    fn no_area_is_too_small() {
        for (width, height) in [(0.0, 0.0), (30.0, 400.0), (400.0, 60.0)] {
            let (_, both) = pictures(width, height);
            assert!(both.iter().all(|picture| picture.is_finite() && picture.width() >= 1.0), "{both:?}");
        }
    }
}
