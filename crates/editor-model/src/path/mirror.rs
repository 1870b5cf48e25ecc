//! Mirrors gestures in the planes of an object's own axes, so that one gesture combs both sides of the object.

use glam::DVec3;
use impasto_scene::document::{Guide, GuidePoint};

use super::ObjectView;
use crate::picking::SurfacePoint;

/// The axes of an object that a gesture is mirrored in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MirrorAxes {
    /// Whether it is mirrored in the plane x = 0.
    pub x: bool,
    /// Whether it is mirrored in the plane y = 0.
    pub y: bool,
    /// Whether it is mirrored in the plane z = 0.
    pub z: bool,
}

impl MirrorAxes {
    /// For each mirror image, the factors that positions are multiplied by. One axis gives one image, two give three,
    /// and three give seven.
    pub fn flips(self) -> Vec<DVec3> {
        let on = [self.x, self.y, self.z];
        (1..8usize)
            .filter(|image| (0..3).all(|axis| image >> axis & 1 == 0 || on[axis]))
            .map(|image| {
                DVec3::from_array([0, 1, 2].map(|axis| if image >> axis & 1 == 1 { -1.0 } else { 1.0 }))
            })
            .collect()
    }
}

/// A guide's mirror image, laid onto the surface. It is broken into pieces where no surface lies within half the
/// guide's radius. `nearest` finds the surface: its arguments are a point, the direction that the surface faces, and
/// the greatest distance. `seen` and `reference` are as in [`super::SurfacePath::guides`].
pub fn mirrored(
    guide: &Guide,
    flip: DVec3,
    seen: &ObjectView,
    reference: &ObjectView,
    nearest: &mut dyn FnMut(DVec3, DVec3, f64) -> Option<SurfacePoint>,
) -> Vec<Guide> {
    // Each mirroring changes the sign of a turn.
    let handedness = flip.x * flip.y * flip.z;
    let mut pieces: Vec<Vec<GuidePoint>> = vec![Vec::new()];
    for point in &guide.points {
        let [at, normal] = [point.at, point.normal].map(|v| DVec3::from(v) * flip);
        match nearest(at, normal, guide.radius * 0.5) {
            Some(found) => {
                let point = GuidePoint {
                    at: found.position.to_array(),
                    normal: found.normal.to_array(),
                    turn_deg: point.turn_deg * handedness,
                };
                if let Some(piece) = pieces.last_mut() {
                    piece.push(point);
                }
            }
            None => pieces.push(Vec::new()),
        }
    }
    let seen = seen.mirrored(flip);
    pieces
        .into_iter()
        .filter(|points| points.len() >= 2)
        .map(|points| {
            let view = seen.guide_view(reference, DVec3::from(points[points.len() / 2].at));
            Guide { points, view, ..guide.clone() }
        })
        .collect()
}
