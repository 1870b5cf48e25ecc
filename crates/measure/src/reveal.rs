//! M6, reveal coherence: do strokes that the reference view did not see have the directions of their neighbours?

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use impasto_core::angle::wrap_half_pi;
use impasto_core::bending::Vertices;
use impasto_core::direction::singularities::Singularity;
use impasto_painting::Painting;
use impasto_painting::frame::LayerKind;
use impasto_scene::motion;

use crate::strokes::{StrokesByKey, of_layer};
use crate::truth::{BodyView, SurfacePoint, TrueView};

/// A stroke counts as visible if the cosine between its surface's normal and the direction to the eye is larger than
/// `FACED`, and the alpha that it was drawn with is larger than `DRAWN`.
const FACED: f64 = 0.2;
const DRAWN: f64 = 0.1;

/// Strokes are neighbours only if the cosine between their normals is larger than this (37 degrees). Strokes across a
/// crease, round a limb or on the other side of a sheet do not count as neighbours.
const SAME_SIDE: f64 = 0.8;

/// How many neighbours a stroke is compared with, at most.
pub const NEIGHBOURS: usize = 10;

/// Neighbours lie within this many stroke lengths on the picture: strokes farther apart do not touch.
const TOUCHING: f64 = 1.5;

/// A stroke is near a singular point if its distance to the point is less than this many times its distance to the
/// farthest of the neighbours that it is compared with.
const ROUND_A_POINT: f64 = 1.5;

/// The difference between the angles of a stroke and a neighbour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// The angle between the two as undirected lines, degrees in 0..=90.
    pub apart_deg: f64,
    /// Index of the object plus 1.
    pub body_id: u32,
    /// Whether the stroke is near a singular point of the directions.
    pub near_pole: bool,
}

/// For each visible stroke of the body layer whose surface the reference view saw from behind: its differences to its
/// nearest visible neighbours of the same region that face the same way.
pub fn revealed(painting: &Painting, strokes: &StrokesByKey, size_px: [u32; 2]) -> Vec<Difference> {
    let (camera, frame) = motion::referred_to(painting.scene(), &painting.scene().reference);
    let reference = TrueView::new(&camera, size_px);
    let poses = motion::poses_at(painting.scene(), frame);
    let bent = painting.bent_at(frame);
    let poles: Vec<Vec<bool>> = (0..poses.len()).map(|object| painting.poles(object)).collect();
    let mut groups: BTreeMap<(u32, u32), Vec<Visible>> = BTreeMap::new();
    for (key, stroke) in of_layer(strokes, LayerKind::Body) {
        let object = key.body_id as usize - 1;
        let particle = painting.particles(object).get(key.particle as usize);
        let Some(particle) = particle.filter(|_| stroke.facing > FACED && stroke.alpha > DRAWN) else {
            continue;
        };
        let particle = match &bent[object] {
            Some(bent) => {
                let Vertices { positions, normals } = &bent.vertices;
                particle.on(&painting.surface(object).mesh, positions, normals)
            }
            None => particle,
        };
        let point =
            SurfacePoint { position: particle.position.as_dvec3(), normal: particle.normal.as_dvec3() };
        let body = BodyView { view: &reference, world_from_model: poses[object] };
        let visible = Visible {
            position: point.position,
            normal: point.normal,
            angle_rad: stroke.angle_rad,
            at_px: DVec2::from(stroke.particle_px),
            length_px: stroke.length_px,
            near_pole: poles[object][key.particle as usize],
            was_unseen: body.facing(point) <= 0.0,
        };
        groups.entry((key.body_id, stroke.region)).or_default().push(visible);
    }
    groups
        .iter()
        .flat_map(|((body_id, _), group)| {
            differences(*body_id, group, painting.singularities(*body_id as usize - 1))
        })
        .collect()
}

struct Visible {
    position: DVec3,
    normal: DVec3,
    angle_rad: f64,
    at_px: DVec2,
    length_px: f64,
    near_pole: bool,
    was_unseen: bool,
}

/// The differences between each stroke that the reference view did not see and its nearest neighbours on the surface.
fn differences(body_id: u32, group: &[Visible], singular: &[Singularity]) -> Vec<Difference> {
    let mut found = Vec::new();
    for (index, stroke) in group.iter().enumerate().filter(|(_, stroke)| stroke.was_unseen) {
        let mut others: Vec<(f64, f64)> = group
            .iter()
            .enumerate()
            .filter(|(other, near)| *other != index && near.normal.dot(stroke.normal) > SAME_SIDE)
            .filter(|(_, near)| near.at_px.distance(stroke.at_px) < TOUCHING * stroke.length_px)
            .map(|(_, other)| {
                let apart = wrap_half_pi(stroke.angle_rad - other.angle_rad);
                (stroke.position.distance_squared(other.position), apart.abs().to_degrees())
            })
            .collect();
        others.sort_by(|a, b| a.0.total_cmp(&b.0));
        others.truncate(NEIGHBOURS);
        let farthest = others.last().map_or(0.0, |(distance_sq, _)| distance_sq.sqrt());
        let close = |point: &Singularity| point.position.distance(stroke.position) < ROUND_A_POINT * farthest;
        let near_pole = stroke.near_pole || singular.iter().any(close);
        found.extend(others.iter().map(|&(_, apart_deg)| Difference { apart_deg, body_id, near_pole }));
    }
    found
}
