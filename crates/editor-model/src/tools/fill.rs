//! The fill tool: a click sets one direction for a whole region, and dragging a needle sets a constant angle.

use glam::{DMat2, DVec2, DVec3};
use impasto_scene::document::{Bend, Direction};

use super::ring::Needle;
use super::{Paintable, Surroundings, ToolEvent, ToolOutput, waiting_words};
use crate::command::{Command, Directions};
use crate::keymap::Action;
use crate::picking::Hit;
use crate::session::{FillKind, Tool, ToolOptions};

/// A needle shorter than this is a click.
const LEAST_NEEDLE_PX: f64 = 6.0;

#[derive(Clone, Debug, Default)]
pub(super) struct Fill {
    filling: Option<Filling>,
}

#[derive(Clone, Debug)]
struct Filling {
    on: Paintable,
    hit: Hit,
    from_px: DVec2,
    at_px: DVec2,
}

impl Fill {
    pub(super) fn is_busy(&self) -> bool {
        self.filling.is_some()
    }

    pub(super) fn take(&mut self, event: &ToolEvent, around: &Surroundings) -> ToolOutput {
        match *event {
            ToolEvent::Hover { at_px, .. } => waiting(at_px, around),
            ToolEvent::Press { at_px, .. } => {
                let hit = around.hit(at_px);
                match (around.paintable(hit.as_ref()), hit) {
                    (Ok(on), Some(hit)) => {
                        self.filling = Some(Filling { on, hit, from_px: at_px, at_px });
                        self.under_way(around)
                    }
                    (Err(refusal), _) => ToolOutput::refusing(refusal),
                    (Ok(_), None) => ToolOutput::default(),
                }
            }
            ToolEvent::Move { at_px, .. } => {
                if let Some(filling) = self.filling.as_mut().filter(|_| at_px.is_finite()) {
                    filling.at_px = at_px;
                }
                self.under_way(around)
            }
            ToolEvent::Release { .. } => {
                let Some(filling) = self.filling.take() else { return ToolOutput::default() };
                // The dragged angle becomes an option, so that the tool's bar and the needle before a press show it.
                let options = match filling.direction(around) {
                    Direction::Angle(fill_angle_deg) if filling.needle(around).is_some() => {
                        Some(ToolOptions { fill_angle_deg, ..around.options.clone() })
                    }
                    _ => None,
                };
                ToolOutput { commit: Some(filling.command(around)), options, ..ToolOutput::default() }
            }
            ToolEvent::Cancel | ToolEvent::FocusLost | ToolEvent::Key(Action::Cancel) => {
                self.filling = None;
                ToolOutput::default()
            }
            ToolEvent::Key(_) => self.under_way(around),
        }
    }

    fn under_way(&self, around: &Surroundings) -> ToolOutput {
        let Some(filling) = &self.filling else { return ToolOutput::default() };
        let needle =
            filling.needle(around).map(|along| Needle { at_px: filling.from_px, along, headed: false });
        let angle = match filling.direction(around) {
            Direction::Angle(angle_deg) => format!(", {angle_deg}°"),
            _ => String::new(),
        };
        let status = format!("Filling {}{angle}   [Esc] take it back", filling.on.name);
        ToolOutput { preview: Some(filling.command(around)), needle, ..ToolOutput::saying(status) }
    }
}

impl Filling {
    /// The direction of the drag, unit, Y down. `None` for fills other than a constant angle. Also `None` for a click,
    /// for which the fill takes the angle of the options.
    fn needle(&self, around: &Surroundings) -> Option<DVec2> {
        let drawn = self.at_px - self.from_px;
        (around.options.fill == FillKind::Angle && drawn.length() >= LEAST_NEEDLE_PX)
            .then(|| drawn.normalize())
    }

    fn command(&self, around: &Surroundings) -> Command {
        let (region, direction) = (self.on.target.clone(), self.direction(around));
        Command::Directions(Directions::SetBase { region, direction })
    }

    fn direction(&self, around: &Surroundings) -> Direction {
        match around.options.fill {
            FillKind::Automatic => Direction::Auto,
            FillKind::Curvature => Direction::Curvature(Bend::Min),
            FillKind::Up => Direction::Up,
            FillKind::Along => Direction::Along(self.longest_axis(around)),
            FillKind::Around => Direction::Around(self.longest_axis(around)),
            FillKind::Angle => {
                let Some(along) = self.needle(around) else {
                    return Direction::Angle(around.options.fill_angle_deg);
                };
                let shown = (along * DVec2::new(1.0, -1.0)).to_angle();
                let turned = to_reference_rad(&self.hit, self.on.region, around).unwrap_or(0.0);
                let angle_deg = (shown + turned).to_degrees();
                // Both ends of a line are alike, so its angle is from −90° to 90°.
                let angle_deg = angle_deg - 180.0 * (angle_deg / 180.0).round();
                Direction::Angle((angle_deg * 10.0).round() / 10.0)
            }
        }
    }

    /// The object's own axis, unit, along which the box round the region is longest.
    fn longest_axis(&self, around: &Surroundings) -> [f64; 3] {
        let object = self.hit.object;
        let own = self.on.region;
        let within = |hit: &Hit| own.is_none() || around.painted.region_at(hit) == own;
        let bounds =
            around.picker.bounds_where(object, within).or_else(|| around.picker.bounds_in_model(object));
        let side = bounds.map_or(DVec3::Y, |[low, high]| high - low);
        match side.max_position() {
            0 => DVec3::X.to_array(),
            1 => DVec3::Y.to_array(),
            _ => DVec3::Z.to_array(),
        }
    }
}

/// The angle, radians, that turns a direction as this view shows it into the same direction as the reference view of
/// the region shows it. It is the rotation in the polar decomposition of A = (J_ref B)(J B)⁻¹, where B spans the
/// tangent plane and the J are the views' Jacobians. `None` if either view sees the surface edge-on, or if they see
/// opposite sides of it.
pub(super) fn to_reference_rad(hit: &Hit, region: Option<usize>, around: &Surroundings) -> Option<f64> {
    let (camera, pose) = around.reference(hit.object, region);
    let reference = crate::picking::View { camera, size_px: around.view.size_px };
    let (right, up) = hit.normal_in_model.any_orthonormal_pair();
    let shown = |view: &crate::picking::View, pose, frame: f64| {
        let [jx, jy] = match around.painted.carried(hit, frame) {
            Some(carried) => carried.pulled_back(view.map(pose).jacobian(carried.position)),
            None => view.map(pose).jacobian(hit.position_in_model),
        };
        DMat2::from_cols(DVec2::new(jx.dot(right), jy.dot(right)), DVec2::new(jx.dot(up), jy.dot(up)))
    };
    let now = shown(around.view, around.pose(hit.object), around.frame);
    let then = shown(&reference, pose, around.reference_frame(region));
    let area = now.determinant() * then.determinant();
    if area.is_nan() || area <= 0.0 {
        return None;
    }
    let map = then * now.inverse();
    Some((map.x_axis.y - map.y_axis.x).atan2(map.x_axis.x + map.y_axis.y))
}

fn waiting(at_px: DVec2, around: &Surroundings) -> ToolOutput {
    let hit = around.hit(at_px);
    match around.paintable(hit.as_ref()) {
        Ok(on) => {
            let angle = around.options.fill_angle_deg.to_radians();
            let turned = hit.and_then(|hit| to_reference_rad(&hit, on.region, around));
            let constant = around.options.fill == FillKind::Angle;
            let needle = turned.filter(|_| constant).map(|turned| Needle {
                at_px,
                along: DVec2::from_angle(angle - turned) * DVec2::new(1.0, -1.0),
                headed: false,
            });
            ToolOutput { needle, ..ToolOutput::saying(waiting_words(Tool::Fill, around.options, &on.name)) }
        }
        Err(refusal) if hit.is_some() => ToolOutput { refusal: None, ..ToolOutput::refusing(refusal) },
        Err(_) => ToolOutput::saying(waiting_words(Tool::Fill, around.options, "a region")),
    }
}
