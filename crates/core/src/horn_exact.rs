//! The source paper's own solve, in full: every neighbour is projected through the 4×4 matrix, in this frame and in the
//! reference (source paper, eq. 1–2). The `paper` preset uses it, and tests judge the lifts by it, so it shares no
//! function with `screen_map`, `lift` or `solve`.

use glam::{DMat4, DVec2, DVec3};

/// A picture as OpenGL sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClipView {
    /// Model space to clip space.
    pub clip_from_model: DMat4,
    /// Width and height of the picture in pixels.
    pub size_px: DVec2,
}

impl ClipView {
    /// Where a point shows, in pixels, Y up. Points behind the eye come out mirrored, as they do in the paper.
    pub fn pixel(&self, position_in_model: DVec3) -> DVec2 {
        let clip = self.clip_from_model * position_in_model.extend(1.0);
        DVec2::new(clip.x / clip.w, clip.y / clip.w) * 0.5 * self.size_px
    }
}

/// The angle by which a stroke turns from the reference to this frame, radians: `arg Σ p̄ c` over its neighbours. As
/// complex numbers, p and c are a neighbour's offset from the stroke in the reference picture and in this frame. Each point is
/// given where it is in the reference and where it is now, model space. 0 when there are no neighbours or the sum is not finite.
pub fn turn_rad(
    center: [DVec3; 2],
    neighbours: impl Iterator<Item = [DVec3; 2]>,
    reference: &ClipView,
    now: &ClipView,
) -> f64 {
    let (center_then, center_now) = (reference.pixel(center[0]), now.pixel(center[1]));
    let (mut dot, mut cross) = (0.0, 0.0);
    for neighbour in neighbours {
        let p = reference.pixel(neighbour[0]) - center_then;
        let c = now.pixel(neighbour[1]) - center_now;
        dot += p.x * c.x + p.y * c.y;
        cross += p.x * c.y - p.y * c.x;
    }
    let angle = cross.atan2(dot);
    if angle.is_finite() { angle } else { 0.0 }
}
