//! The camera of a frame as shaders read it: the uniforms of `shared/lens.glsl`.

use glam::{Mat4, UVec2, Vec2};
use impasto_painting::frame::FrameView;

use crate::gl::Bound;

/// The uniforms of `shared/lens.glsl`.
pub(crate) const LENS_UNIFORMS: [&str; 5] =
    ["world_from_view", "size_px", "gaze_px", "px_per_unit_at_1", "orthographic"];

/// The uniforms of a shader that only computes the rays of pixels.
pub(crate) const RAY_UNIFORMS: [&str; 4] = ["world_from_view", "gaze_px", "px_per_unit_at_1", "orthographic"];

/// The uniforms of a shader that works in view space.
pub(crate) const VIEW_LENS_UNIFORMS: [&str; 4] = ["size_px", "gaze_px", "px_per_unit_at_1", "orthographic"];

/// The values of these uniforms in one frame.
#[derive(Clone, Copy)]
pub(crate) struct LensSetup {
    world_from_view: Mat4,
    size_px: Vec2,
    /// Where the gaze meets the picture, in pixels from the lower left corner: the picture's middle, unless the lens is
    /// shifted.
    gaze_px: Vec2,
    /// Pixels per world unit at a depth of 1; at any depth if rays are parallel.
    pub(crate) px_per_unit_at_1: f32,
    orthographic: f32,
}

impl LensSetup {
    pub(crate) fn new(view: &FrameView, size_px: [u32; 2]) -> Self {
        // The lens shift in NDC. In perspective, w is −z, so the shift is minus the z column. Orthographically, w is 1,
        // so the shift is the last column.
        let shift = if view.orthographic { view.clip_from_view.w_axis } else { -view.clip_from_view.z_axis };
        let size = UVec2::from(size_px).as_vec2();
        Self {
            gaze_px: 0.5 * size + 0.5 * size * Vec2::new(shift.x, shift.y),
            world_from_view: view.view_from_world.inverse(),
            size_px: size,
            px_per_unit_at_1: view.clip_from_view.y_axis.y * 0.5 * size_px[1] as f32,
            orthographic: f32::from(view.orthographic),
        }
    }

    /// Sets the uniforms of these names.
    pub(crate) fn set<'a>(&self, mut bound: Bound<'a>, names: &[&str]) -> Bound<'a> {
        for &name in names {
            bound = match name {
                "world_from_view" => bound.set(name, self.world_from_view),
                "size_px" => bound.set(name, self.size_px),
                "gaze_px" => bound.set(name, self.gaze_px),
                "px_per_unit_at_1" => bound.set(name, self.px_per_unit_at_1),
                _ => bound.set(name, self.orthographic),
            };
        }
        bound
    }
}
