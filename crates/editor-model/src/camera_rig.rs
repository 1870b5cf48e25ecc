//! The free camera: orbit, pan, zoom, frame. It starts with the shot camera's pose, roll included, so that leaving the
//! shot camera does not move the picture.

use glam::{DQuat, DVec2, DVec3};
use impasto_scene::document::Lens;
use impasto_scene::motion::CameraPose;

use crate::picking::View;

#[cfg(test)]
mod tests;

/// Orbit per pixel of drag, radians.
const ORBIT_RAD_PER_PX: f64 = 0.5 * std::f64::consts::PI / 300.0;
/// Factor on the distance per step of the wheel.
pub const ZOOM_PER_STEP: f64 = 0.85;
/// The gaze stays this far from straight up and down, where a look-at camera has no up direction.
const POLE_GAP_RAD: f64 = 0.0087;
/// Views from above and below are tilted off the axis by this angle, radians, so that the camera has an up direction.
const AXIS_GAP_RAD: f64 = 1e-3;
/// Framing leaves this share of the picture's width or height free, of whichever the box fills more.
const FRAME_MARGIN: f64 = 0.1;
/// Zooming and framing keep the distance to the target, or the height of an orthographic picture, within these limits,
/// world units.
const DISTANCES: std::ops::RangeInclusive<f64> = 1e-3..=1e6;

/// A camera that the user moves freely.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeView {
    pose: CameraPose,
    /// Vertical field of view that [`Self::toggle_orthographic`] goes back to, degrees.
    fov_y_deg: f64,
    /// Distances of the near and far planes that it began with, world units.
    depths: [f64; 2],
}

/// A view along an axis of the world, named after the side that the camera is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisView {
    /// From +X.
    Right,
    /// From −X.
    Left,
    /// From +Y, −Z up.
    Top,
    /// From −Y, +Z up.
    Bottom,
    /// From +Z.
    Front,
    /// From −Z.
    Back,
}

impl FreeView {
    /// A free camera with this pose.
    pub fn new(pose: CameraPose) -> Self {
        let fov_y_deg = match pose.lens {
            Lens::Perspective { fov_y_deg, .. } => fov_y_deg,
            Lens::Orthographic { .. } => 35.0,
        };
        let (Lens::Perspective { near, far, .. } | Lens::Orthographic { near, far, .. }) = pose.lens;
        Self { pose, fov_y_deg, depths: [near, far] }
    }

    /// Its pose.
    pub fn pose(&self) -> &CameraPose {
        &self.pose
    }

    /// Distance from the eye to the target, world units.
    pub fn distance(&self) -> f64 {
        self.pose.eye.distance(self.pose.target)
    }

    /// Turns round a point by a drag in pixels (Y down): a drag sideways turns about the world's Y, a drag up or down
    /// about the level axis to the right. The point keeps its place in the picture.
    pub fn orbit(&mut self, delta_px: DVec2, about: DVec3) {
        // The roll is taken out of the drag, so that a rolled view follows the pointer, too.
        let drag = DVec2::from_angle(self.pose.roll_rad).rotate(delta_px * DVec2::new(1.0, -1.0));
        let [right, gaze] = self.level_axes();
        let pitch = gaze.y.clamp(-1.0, 1.0).asin();
        // A camera that is already nearer to the pole may stay there, but gets no nearer.
        let limit = (std::f64::consts::FRAC_PI_2 - POLE_GAP_RAD).max(pitch.abs());
        let wanted = (pitch + drag.y * ORBIT_RAD_PER_PX).clamp(-limit, limit);
        let turn = DQuat::from_rotation_y(-drag.x * ORBIT_RAD_PER_PX)
            * DQuat::from_axis_angle(right, wanted - pitch);
        for point in [&mut self.pose.eye, &mut self.pose.target] {
            *point = about + turn * (*point - about);
        }
    }

    /// Moves parallel to the picture by a drag in pixels (Y down), so that a point at the depth of `held` follows the
    /// pointer.
    pub fn pan(&mut self, delta_px: DVec2, held: DVec3, size_px: DVec2) {
        let view = self.view(size_px);
        let [right, up, _] = view.axes();
        let step = (right * -delta_px.x + up * delta_px.y) / view.px_per_unit(held);
        self.move_by(step);
    }

    /// Moves nearer (positive steps) or farther; the point `toward` keeps its place in the picture. Without a surface
    /// under the cursor, pass the point at the target's depth ([`View::at_depth_of`]).
    pub fn zoom(&mut self, steps: f64, toward: DVec3) {
        let wanted = ZOOM_PER_STEP.powf(steps.clamp(-100.0, 100.0));
        match &mut self.pose.lens {
            Lens::Perspective { .. } => {
                let distance = self.distance();
                let scale = (distance * wanted).clamp(*DISTANCES.start(), *DISTANCES.end()) / distance;
                // Eye and target approach the point by the same factor, so the eye never passes it.
                for point in [&mut self.pose.eye, &mut self.pose.target] {
                    *point = toward + (*point - toward) * scale;
                }
                self.reach(distance * scale);
            }
            Lens::Orthographic { height, .. } => {
                let scale = (*height * wanted).clamp(*DISTANCES.start(), *DISTANCES.end()) / *height;
                *height *= scale;
                let gaze = (self.pose.target - self.pose.eye).normalize_or(DVec3::NEG_Z);
                let away = (self.pose.target - toward).reject_from_normalized(gaze);
                self.move_by(away * (scale - 1.0));
            }
        }
    }

    /// Moves the camera, without turning it, so that a box (least and greatest corner, world space) fills the picture.
    pub fn frame(&mut self, [low, high]: [DVec3; 2], size_px: DVec2) {
        if !low.is_finite() || !high.is_finite() {
            return;
        }
        let [right, up, gaze] = self.view(size_px).axes();
        let (centre, half) = ((low + high) * 0.5, (high - low) * 0.5);
        let aspect = size_px.x / size_px.y;
        let corners = (0..8).map(|corner| {
            let sign = |axis: u32| if corner >> axis & 1 == 0 { -1.0 } else { 1.0 };
            half * DVec3::new(sign(0), sign(1), sign(2))
        });
        let fill = 1.0 - FRAME_MARGIN;
        let tallest = |corner: DVec3| corner.dot(up).abs().max(corner.dot(right).abs() / aspect) / fill;
        let distance = match &mut self.pose.lens {
            Lens::Perspective { fov_y_deg, .. } => {
                let slope = (0.5 * fov_y_deg.to_radians()).tan();
                corners.map(|corner| tallest(corner) / slope - corner.dot(gaze)).fold(0.0, f64::max)
            }
            Lens::Orthographic { height, .. } => {
                let tallest = corners.map(tallest).fold(0.0, f64::max);
                *height = (2.0 * tallest).clamp(*DISTANCES.start(), *DISTANCES.end());
                half.length() * 2.0
            }
        };
        let distance = distance.clamp(*DISTANCES.start(), *DISTANCES.end());
        self.pose.target = centre;
        self.pose.eye = centre - gaze * distance;
        self.reach(distance + half.length() * 2.0);
    }

    /// Looks at its target along an axis, upright.
    pub fn look_along(&mut self, axis: AxisView) {
        let (sin, cos) = AXIS_GAP_RAD.sin_cos();
        let from_target = match axis {
            AxisView::Right => DVec3::X,
            AxisView::Left => DVec3::NEG_X,
            AxisView::Top => DVec3::new(0.0, cos, sin),
            AxisView::Bottom => DVec3::new(0.0, -cos, sin),
            AxisView::Front => DVec3::Z,
            AxisView::Back => DVec3::NEG_Z,
        };
        self.pose.eye = self.pose.target + from_target * self.distance();
        self.pose.roll_rad = 0.0;
    }

    /// Switches between perspective and parallel rays. What is at the target keeps its size.
    pub fn toggle_orthographic(&mut self) {
        let slope = |fov_y_deg: f64| (0.5 * fov_y_deg.to_radians()).tan();
        match self.pose.lens {
            Lens::Perspective { fov_y_deg, near, far } => {
                self.fov_y_deg = fov_y_deg;
                let height = 2.0 * self.distance() * slope(fov_y_deg);
                self.pose.lens = Lens::Orthographic { height, near, far };
            }
            Lens::Orthographic { height, near, far } => {
                let gaze = (self.pose.target - self.pose.eye).normalize_or(DVec3::NEG_Z);
                let distance = 0.5 * height / slope(self.fov_y_deg);
                self.pose.eye = self.pose.target - gaze * distance;
                self.pose.lens = Lens::Perspective { fov_y_deg: self.fov_y_deg, near, far };
            }
        }
    }

    /// This camera in a viewport.
    pub fn view(&self, size_px: DVec2) -> View {
        View { camera: self.pose.clone(), size_px }
    }

    fn move_by(&mut self, step: DVec3) {
        self.pose.eye += step;
        self.pose.target += step;
    }

    /// Puts the clip planes back where they began, or farther apart where points at this distance need it.
    fn reach(&mut self, distance: f64) {
        match &mut self.pose.lens {
            Lens::Perspective { near, far, .. } | Lens::Orthographic { near, far, .. } => {
                *far = self.depths[1].max(distance * 2.0);
                *near = self.depths[0].min(distance * 0.01);
            }
        }
    }

    /// Right and gaze of the camera without its roll, world space; right is level.
    fn level_axes(&self) -> [DVec3; 2] {
        let level = CameraPose { roll_rad: 0.0, ..self.pose.clone() };
        let view = level.view_from_world();
        [view.row(0).truncate(), -view.row(2).truncate()]
    }
}

/// What the viewport looks through.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Looking {
    /// The shot camera.
    #[default]
    Shot,
    /// A free camera.
    Free(FreeView),
}

impl Looking {
    /// The camera's pose, given that of the shot.
    pub fn pose<'a>(&'a self, shot: &'a CameraPose) -> &'a CameraPose {
        match self {
            Self::Shot => shot,
            Self::Free(free) => free.pose(),
        }
    }

    /// The free camera. While looking through the shot camera, this switches to a free one with the same pose.
    pub fn free(&mut self, shot: &CameraPose) -> &mut FreeView {
        if matches!(self, Self::Shot) {
            *self = Self::Free(FreeView::new(shot.clone()));
        }
        match self {
            Self::Free(free) => free,
            Self::Shot => unreachable!("it was made free above"),
        }
    }
}
