//! The overlays: what the editor draws over the picture, such as guides and outlines. Each has a file of its own, with
//! plain data and a function that draws it. All lengths are in points.

use egui::{Painter, Pos2, Rect};
use glam::{DVec2, DVec3};
use impasto_editor_model::picking::View;

mod amount_tint;
mod comb_preview;
mod direction_lines;
mod floor_grid;
mod gizmo;
mod guide_curve;
mod ink;
mod missing_mesh;
mod motion_path;
mod needle;
mod outline;
mod region_tint;
mod ring;
mod shot_border;
mod sight;
mod singular_points;
mod stand_ins;

pub use amount_tint::{AmountTint, amount_tint};
pub use comb_preview::{Comb, CombPreviewStroke, comb_preview};
pub use direction_lines::{DirectionInk, DirectionMark, direction_lines, trust_legend};
pub use floor_grid::floor_grid;
pub use gizmo::gizmo;
pub use guide_curve::{CurvePart, GuideCurve, guide_curve};
pub use missing_mesh::{MissingMesh, missing_mesh};
pub use motion_path::{MotionPath, motion_path};
pub use needle::{needle, needle_tag};
pub use outline::{Outline, outline};
pub use region_tint::{RegionTint, region_tints};
pub use ring::ring;
pub use shot_border::shot_border;
pub use sight::Sight;
pub use singular_points::{SingularPoint, singular_points};
pub use stand_ins::{StandIn, stand_ins};

/// Where overlays are drawn: a picture's rectangle in the window, and its view.
#[derive(Clone, Copy)]
pub struct Sheet<'a> {
    /// The painter, clipped to the rectangle.
    pub painter: &'a Painter,
    /// The picture's place in the window.
    pub rect: Rect,
    /// The picture's camera, and its size in points.
    pub view: &'a View,
}

impl Sheet<'_> {
    /// Converts a place in the picture (from its upper left corner, Y down) to the window.
    pub fn at(&self, at_px: DVec2) -> Pos2 {
        self.rect.min + egui::vec2(at_px.x as f32, at_px.y as f32)
    }

    /// Where a point of the world shows in the window; `None` if it is behind the camera or too far outside the
    /// picture.
    pub fn project(&self, position_in_world: DVec3) -> Option<Pos2> {
        let at_px = self.view.project(position_in_world)?;
        // Tessellation loses precision far outside the picture.
        (at_px.is_finite() && at_px.abs().max_element() < 1e5).then(|| self.at(at_px))
    }
}

#[cfg(test)]
mod tests;
