//! M6: do strokes that the reference view did not see lie as their neighbours do?

use std::collections::BTreeMap;

use glam::DVec3;
use impasto_core::angle::wrap_half_pi;
use impasto_painting::Painting;
use impasto_painting::frame::LayerKind;
use impasto_scene::{document, motion};

use crate::strokes::{SeenStroke, SeenStrokes, of_layer};
use crate::truth::{BodyView, SurfacePoint, TrueView};

/// A stroke is seen when its surface faces the eye by this cosine, and this much of it was drawn.
const FACED: f64 = 0.2;
const DRAWN: f64 = 0.1;

/// Neighbours face the same way by this cosine: those across a crease or on the other side of a sheet are none.
const SAME_SIDE: f64 = 0.5;

/// How many neighbours a stroke is compared with.
pub const NEIGHBOURS: usize = 10;

/// For each stroke that is seen now and that the reference view saw from behind, how far its neighbours' angles are from
/// its own, degrees.
pub fn revealed(painting: &Painting, strokes: &SeenStrokes, size_px: [u32; 2]) -> Vec<f64> {
    let document::Reference::Frame(frame) = painting.scene().reference;
    let reference = TrueView::new(&motion::camera_at(painting.scene(), frame as f64), size_px);
    let poses = motion::poses_at(painting.scene(), frame as f64);
    let mut groups: BTreeMap<(u32, u32), Vec<Visible>> = BTreeMap::new();
    for (key, stroke) in of_layer(strokes, LayerKind::Body) {
        let object = key.body_id as usize - 1;
        let particle = painting.particles(object).get(key.particle as usize);
        let Some(particle) = particle.filter(|_| stroke.facing > FACED && stroke.alpha > DRAWN) else {
            continue;
        };
        let point =
            SurfacePoint { position: particle.position.as_dvec3(), normal: particle.normal.as_dvec3() };
        let body = BodyView { view: &reference, world_from_model: poses[object] };
        let visible = Visible {
            position: point.position,
            normal: point.normal,
            stroke: *stroke,
            was_unseen: body.facing(point) <= 0.0,
        };
        groups.entry((key.body_id, stroke.region)).or_default().push(visible);
    }
    groups.values().flat_map(|group| neighbour_differences_deg(group)).collect()
}

/// A stroke that is seen.
struct Visible {
    position: DVec3,
    normal: DVec3,
    stroke: SeenStroke,
    was_unseen: bool,
}

/// |wrap_π(θᵢ − θⱼ)| over the nearest neighbours on the surface of each stroke that was unseen, degrees.
fn neighbour_differences_deg(group: &[Visible]) -> Vec<f64> {
    let mut differences = Vec::new();
    for (index, stroke) in group.iter().enumerate().filter(|(_, stroke)| stroke.was_unseen) {
        let mut others: Vec<(f64, f64)> = group
            .iter()
            .enumerate()
            .filter(|(other, near)| *other != index && near.normal.dot(stroke.normal) > SAME_SIDE)
            .map(|(_, other)| {
                let apart = wrap_half_pi(stroke.stroke.angle_rad - other.stroke.angle_rad);
                (stroke.position.distance_squared(other.position), apart.abs().to_degrees())
            })
            .collect();
        others.sort_by(|a, b| a.0.total_cmp(&b.0));
        differences.extend(others.iter().take(NEIGHBOURS).map(|(_, apart)| apart));
    }
    differences
}
