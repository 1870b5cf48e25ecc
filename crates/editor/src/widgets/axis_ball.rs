//! The ball in the corner of the picture: it shows how the view is turned, and takes drags and clicks that turn it.

use egui::{Align2, Color32, FontId, Response, Role, Sense, Stroke, Ui, Vec2, vec2};
use glam::{Mat3, Vec3};

use super::draw;
use crate::theme::Tokens;

const SIDE: f32 = 68.0;
const REACH: f32 = 22.0;
const KNOB: f32 = 8.0;
const LETTERS: [&str; 3] = ["X", "Y", "Z"];

/// The ball in the corner of the picture that shows how the view is turned.
pub struct AxisBall {
    /// Turns the world's axes into the view's (X right, Y up, Z towards the eye).
    pub view_from_world: Mat3,
}

/// What the user did to an [`AxisBall`].
#[derive(Clone, Debug)]
pub struct BallResponse {
    /// The whole ball.
    pub response: Response,
    /// The end of an axis that was clicked, as a unit vector in world space: the view is to look from there to the
    /// centre.
    pub clicked_axis: Option<Vec3>,
    /// How far the ball was dragged in this pass, in points: the view is to orbit by as much.
    pub dragged: Vec2,
}

impl AxisBall {
    /// Draws it, 68 points wide.
    pub fn show(&self, ui: &mut Ui, name: &str) -> BallResponse {
        let tokens = Tokens::of(ui);
        let (rect, response) = ui.allocate_exact_size(vec2(SIDE, SIDE), Sense::click_and_drag());
        draw::named(&response, Role::Canvas, name);
        let painter = ui.painter();
        let centre = rect.center();
        painter.circle_filled(centre, SIDE / 2.0, tokens.chip);
        draw::focus_ring(ui, &response, rect, SIDE / 2.0);

        let mut ends: Vec<(usize, f32, Vec3, Vec2)> = Vec::new();
        for (axis, direction) in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().enumerate() {
            for (sign, direction) in [(1.0, direction), (-1.0, -direction)] {
                let seen = self.view_from_world * direction;
                ends.push((axis, sign, direction, vec2(seen.x, -seen.y) * REACH));
            }
        }
        // Ends that lie farther from the eye are drawn first.
        ends.sort_by(|one, other| {
            let depth = |direction: Vec3| (self.view_from_world * direction).z;
            depth(one.2).total_cmp(&depth(other.2))
        });
        let pointer = response.hover_pos();
        let mut over = None;
        for (axis, sign, direction, offset) in ends {
            let at = centre + offset;
            let colour = tokens.axis[axis];
            let near = pointer.is_some_and(|pointer| pointer.distance(at) <= 12.0);
            if near {
                over = Some(direction);
            }
            if sign > 0.0 {
                painter.line_segment([centre, at], Stroke::new(2.0, colour));
                painter.circle_filled(at, KNOB, colour);
                let font =
                    FontId::new(10.0, egui::FontFamily::Name(crate::theme::type_face::SEMIBOLD.into()));
                draw::words(painter, at, Align2::CENTER_CENTER, LETTERS[axis], font, Color32::from_gray(27));
            } else if near {
                painter.circle(at, KNOB - 2.0, tokens.chip, Stroke::new(1.5, colour));
            }
        }
        let clicked_axis = over.filter(|_| response.clicked());
        let dragged = if response.dragged() { response.drag_delta() } else { Vec2::ZERO };
        BallResponse { response, clicked_axis, dragged }
    }
}
