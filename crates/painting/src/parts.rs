//! The parts of a body: the largest stroke that each can carry, and its automatic direction.

use glam::DVec3;
use impasto_core::parts::{Part, parts};
use impasto_core::{ScreenMap, TriangleMesh};
use impasto_scene::document::Direction;

use crate::references::BodyReference;

/// A stroke is at most `WIDTH_SHARE` of its part's second extent wide, and `LENGTH_SHARE` of its longest one long.
const WIDTH_SHARE: f64 = 0.42;
const LENGTH_SHARE: f64 = 0.6;

/// The least cap, pixels at the scene's size.
const LEAST_CAP_PX: f64 = 3.0;

/// Strokes stay at least this much longer than wide.
const LEAST_ASPECT: f32 = 1.2;

/// A part is long when its longest extent is more than this many times its second.
const LONG: f64 = 1.12;

/// A part is a backdrop when it fills this share of the picture, is at most this thick relative to its second extent,
/// and faces the eye with at least this cosine.
const BACKDROP_SHARE: f64 = 0.9;
const BACKDROP_THICKNESS: f64 = 0.2;
const BACKDROP_FACING: f64 = 0.6;

/// The angles of the two crossing families of strokes on a backdrop, degrees.
const BACKDROP_FAMILIES_DEG: (f64, f64) = (-58.0, 4.0);

/// The parts of a body.
#[derive(Debug)]
pub(crate) struct BodyParts {
    pub(crate) parts: Vec<Part>,
    pub(crate) of_triangle: Vec<u32>,
}

/// The largest strokes that a part carries, pixels at the scene's size. The reference pose decides: a stroke keeps its size
/// however far away it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cap {
    length_px: f32,
    width_px: f32,
}

impl BodyParts {
    pub(crate) fn of(mesh: &TriangleMesh) -> Self {
        let (parts, of_triangle) = parts(mesh);
        Self { parts, of_triangle }
    }

    /// The caps, from the reference view at the scene's own size.
    pub(crate) fn caps(&self, map: &ScreenMap) -> Vec<Cap> {
        let of_part = |part: &Part| {
            let scale = px_per_unit(map, part);
            let cap = |share: f64, extent: f64| (share * extent * scale).max(LEAST_CAP_PX) as f32;
            Cap { length_px: cap(LENGTH_SHARE, part.extents[0]), width_px: cap(WIDTH_SHARE, part.extents[1]) }
        };
        self.parts.iter().map(of_part).collect()
    }

    /// The automatic direction of each part.
    pub(crate) fn directions(&self, reference: &BodyReference) -> Vec<Direction> {
        self.parts.iter().map(|part| direction_of(part, reference)).collect()
    }
}

impl Cap {
    /// A stroke of this size, or as large as the part carries.
    pub(crate) fn apply(self, length_px: f32, width_px: f32) -> [f32; 2] {
        let width = width_px.min(self.width_px);
        // A stroke that is stated to be broader than long stays so.
        let aspect = LEAST_ASPECT.min(length_px / width_px.max(f32::MIN_POSITIVE));
        [length_px.min(self.length_px).max(width * aspect), width]
    }
}

/// Pixels per model unit at a part's middle, which counts as at least a quarter of the part's length away from the eye.
pub(crate) fn px_per_unit(map: &ScreenMap, part: &Part) -> f64 {
    let focal = (map.row_x.truncate().length() * map.row_y.truncate().length()).sqrt();
    let parallel = map.row_w.truncate() == DVec3::ZERO;
    let depth = if parallel { 1.0 } else { map.depth(part.center).max(0.25 * part.extents[0]) };
    let scale = focal / depth;
    if scale.is_finite() && scale > 0.0 { scale } else { 1.0 }
}

fn direction_of(part: &Part, reference: &BodyReference) -> Direction {
    let size_px = reference.size_px;
    let scale = px_per_unit(&reference.map, part);
    let gaze = reference.map.row_depth.truncate();
    let [longest, second, least] = part.extents;
    let fills = longest * scale >= BACKDROP_SHARE * f64::from(size_px[0].max(size_px[1]))
        && second * scale >= BACKDROP_SHARE * f64::from(size_px[0].min(size_px[1]));
    let faces = part.axes[2].dot(gaze.normalize_or_zero()).abs() > BACKDROP_FACING;
    if fills && faces && least < BACKDROP_THICKNESS * second {
        let (first, second) = BACKDROP_FAMILIES_DEG;
        return Direction::Crossing(first, second);
    }
    if longest > LONG * second { Direction::Along(part.axes[0].to_array()) } else { Direction::Up }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cap_keeps_strokes_longer_than_wide() {
        let cap = Cap { length_px: 30.0, width_px: 20.0 };
        assert_eq!(cap.apply(78.0, 25.0), [30.0, 20.0]);
        assert_eq!(cap.apply(10.0, 5.0), [10.0, 5.0]);
        let stubby = Cap { length_px: 12.0, width_px: 20.0 };
        assert_eq!(stubby.apply(78.0, 25.0), [24.0, 20.0]);
        assert_eq!(stubby.apply(10.0, 20.0), [10.0, 20.0]);
    }
}
