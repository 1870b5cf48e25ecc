//! The source paper's own solve, in full: every neighbour is projected through the 4×4 matrix, in this frame and in the
//! reference (source paper, eq. 1–2). The solver `HornExact` and the `paper` preset use it, and tests judge the lifts
//! by it, so it shares no function with `screen_map`, `lift` or `solve`.

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
    /// Where a point shows, in pixels from the picture's centre, Y up. Points behind the eye come out mirrored, as they
    /// do in the paper.
    pub fn pixel(&self, position_in_model: DVec3) -> DVec2 {
        let clip = self.clip_from_model * position_in_model.extend(1.0);
        DVec2::new(clip.x / clip.w, clip.y / clip.w) * 0.5 * self.size_px
    }
}

/// The angle by which a stroke turns from the reference to this frame, radians: `arg Σ p̄ c` over its neighbours. As
/// complex numbers, p and c are a neighbour's offset from the stroke in the reference picture and in this frame. Each
/// point is given as a pair: where it is in the reference, and where it is now, model space. 0 when there are no
/// neighbours or the sum is not a number.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Parallel rays on a picture of 400 by 200 pixels, which is two units high.
    const VIEW: ClipView = ClipView {
        clip_from_model: DMat4::from_cols_array_2d(&[
            [0.5, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, -0.1, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ]),
        size_px: DVec2::new(400.0, 200.0),
    };

    #[test]
    fn neighbours_that_turn_by_an_angle_give_this_angle() {
        assert_eq!(VIEW.pixel(DVec3::new(0.5, -0.25, 3.0)), DVec2::new(50.0, -25.0));
        let (then, now) = (DVec3::new(0.2, 0.1, 0.0), DVec3::new(-0.3, 0.4, 1.0));
        let steps = [[0.3, 0.1], [-0.1, 0.25], [0.05, -0.2], [-0.4, -0.3]].map(DVec2::from_array);
        for angle in [-3.0, -1.2, 0.0, 0.7, 2.5_f64] {
            let neighbours = steps.iter().map(|&step| {
                let turned = DVec2::from_angle(angle).rotate(step) * 1.7;
                [then + step.extend(0.5), now + turned.extend(-0.5)]
            });
            let found = turn_rad([then, now], neighbours, &VIEW, &VIEW);
            assert!((found - angle).abs() < 1e-12, "{found} for {angle}");
        }
        assert_eq!(turn_rad([then, now], std::iter::empty(), &VIEW, &VIEW), 0.0);
    }

    /// One neighbour goes from the right to above, and a nearer one stays: the longer offsets count more, as the square
    /// of their length.
    #[test]
    fn neighbours_count_by_their_offsets() {
        let neighbours = [[DVec3::X, DVec3::Y], [DVec3::X * 0.5, DVec3::X * 0.5]];
        let found = turn_rad([DVec3::ZERO; 2], neighbours.into_iter(), &VIEW, &VIEW);
        assert!((found - 1.0_f64.atan2(0.25)).abs() < 1e-12, "{found}");
    }
}
