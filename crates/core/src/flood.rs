//! Flood fill over a mesh: the faces that are reached from one face without crossing a sharp edge.

use std::collections::HashSet;

use glam::DVec3;

use crate::TriangleMesh;
use crate::nearest::nearest_point;
use crate::shells;

/// A face that faces opposite to the seed's normal counts as this many times farther away than it is.
const TURNED_AWAY: f64 = 4.0;

/// Where both ends of an edge have more triangles than this, the edge is handled only once. Otherwise n triangles round
/// such an edge would take n² steps.
const CROWDED: usize = 64;

/// For each triangle, whether it is reached from a seed over edges at which the two triangles' normals differ by less
/// than `sharp_rad`.
///
/// The seed is a point with a normal, in model space. The flood begins at the triangle nearest to it; among triangles
/// about equally near, at one that faces along the normal. Edges are compared by position, so split vertices do not
/// stop the flood. The triangles of one polygon count as one face, and a triangle without area takes the normal of the
/// face that it was reached from.
pub fn flooded(mesh: &TriangleMesh, at: DVec3, normal: DVec3, sharp_rad: f64) -> Vec<bool> {
    let mut is_reached = vec![false; mesh.triangles.len()];
    let Some(first) = nearest_triangle(mesh, at, normal.normalize_or_zero()) else { return is_reached };
    let points = Points::of(mesh);
    let least_cos = sharp_rad.cos();
    let mut crowded = HashSet::new();
    is_reached[first] = true;
    let mut open = vec![(first, face_normal(mesh, first))];
    while let Some((triangle, facing)) = open.pop() {
        let corners = points.of_triangle[triangle];
        for corner in 0..3 {
            let (from, to) = (corners[corner], corners[(corner + 1) % 3]);
            let near = points.triangles_at_fewer(from, to);
            let is_done = near.len() > CROWDED && !crowded.insert((from.min(to), from.max(to)));
            if from == to || is_done {
                continue;
            }
            for &other in near {
                let other = other as usize;
                let shared = points.of_triangle[other];
                if is_reached[other] || !shared.contains(&to) || !shared.contains(&from) {
                    continue;
                }
                let there = face_normal(mesh, other);
                let polygon = |triangle: usize| mesh.polygon_of_triangle.get(triangle);
                let one_face = polygon(triangle).is_some() && polygon(triangle) == polygon(other);
                let passes = one_face || there == DVec3::ZERO || there.dot(facing) > least_cos;
                if passes {
                    is_reached[other] = true;
                    open.push((other, if there == DVec3::ZERO { facing } else { there }));
                }
            }
        }
    }
    is_reached
}

/// The unit normal of a triangle; zero for one without area.
fn face_normal(mesh: &TriangleMesh, triangle: usize) -> DVec3 {
    let [a, b, c] = mesh.corners(triangle).map(|corner| corner.as_dvec3());
    (b - a).cross(c - a).normalize_or_zero()
}

fn nearest_triangle(mesh: &TriangleMesh, at: DVec3, normal: DVec3) -> Option<usize> {
    let mut best: Option<(f64, usize)> = None;
    let tie = mesh.bounds().map_or(0.0, |(low, high)| f64::from((high - low).length()) * 1e-6);
    for triangle in 0..mesh.triangles.len() {
        let corners = mesh.corners(triangle);
        // No triangle is nearer than the box round it.
        let (low, high) =
            (corners[0].min(corners[1]).min(corners[2]), corners[0].max(corners[1]).max(corners[2]));
        let least = (at - at.clamp(low.as_dvec3(), high.as_dvec3())).length();
        if best.is_some_and(|(cost, _)| least >= cost) {
            continue;
        }
        let corners = corners.map(|corner| corner.as_dvec3());
        let far = (at - nearest_point(at, corners)).length() + tie;
        let turned = (1.0 - face_normal(mesh, triangle).dot(normal)) * 0.5;
        let cost = far * (1.0 + (TURNED_AWAY - 1.0) * turned);
        if best.is_none_or(|(least, _)| cost < least) {
            best = Some((cost, triangle));
        }
    }
    best.map(|(_, triangle)| triangle)
}

/// The distinct positions of a mesh's vertices, with the triangles at each.
struct Points {
    of_triangle: Vec<[u32; 3]>,
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

impl Points {
    fn of(mesh: &TriangleMesh) -> Self {
        let of_vertex = shells::weld(&mesh.positions);
        let count = of_vertex.iter().max().map_or(0, |&last| last as usize + 1);
        let mut starts = vec![0u32; count + 1];
        let of_triangle: Vec<[u32; 3]> =
            mesh.triangles.iter().map(|corners| corners.map(|vertex| of_vertex[vertex as usize])).collect();
        for &point in of_triangle.iter().flatten() {
            starts[point as usize + 1] += 1;
        }
        for index in 0..count {
            starts[index + 1] += starts[index];
        }
        let mut next = starts.clone();
        let mut triangles = vec![0; mesh.triangles.len() * 3];
        for (triangle, corners) in of_triangle.iter().enumerate() {
            for &point in corners {
                let slot = &mut next[point as usize];
                triangles[*slot as usize] = triangle as u32;
                *slot += 1;
            }
        }
        Self { of_triangle, starts, triangles }
    }

    /// The triangles at one end of an edge: the end that has fewer.
    fn triangles_at_fewer(&self, from: u32, to: u32) -> &[u32] {
        let (from, to) = (self.triangles_at(from), self.triangles_at(to));
        if from.len() <= to.len() { from } else { to }
    }

    fn triangles_at(&self, point: u32) -> &[u32] {
        &self.triangles[self.starts[point as usize] as usize..self.starts[point as usize + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    /// A strip of quads bent along a curve of these angles (degrees), every quad with vertices of its own.
    fn strip(angles_deg: &[f64]) -> TriangleMesh {
        let mut mesh = TriangleMesh::default();
        let mut from = DVec3::ZERO;
        for (quad, angle_deg) in angles_deg.iter().enumerate() {
            let (sin, cos) = angle_deg.to_radians().sin_cos();
            let to = from + DVec3::new(cos, 0.0, -sin);
            let first = mesh.positions.len() as u32;
            let corners = [from, to, to + DVec3::Y, from + DVec3::Y];
            mesh.positions.extend(corners.map(|corner| corner.as_vec3()));
            mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
            mesh.polygon_of_triangle.extend([quad as u32; 2]);
            from = to;
        }
        mesh
    }

    fn quads(mesh: &TriangleMesh, at: DVec3, normal: DVec3, sharp_deg: f64) -> Vec<bool> {
        let found = flooded(mesh, at, normal, sharp_deg.to_radians());
        assert!(found.chunks(2).all(|quad| quad[0] == quad[1]));
        found.chunks(2).map(|quad| quad[0]).collect()
    }

    #[test]
    fn it_stops_at_sharp_edges_and_not_at_split_vertices() {
        let mesh = strip(&[0.0, 0.0, 20.0, 40.0, 100.0, 110.0]);
        let seed = (DVec3::new(0.5, 0.5, 0.1), DVec3::Z);
        assert_eq!(quads(&mesh, seed.0, seed.1, 10.0), [true, true, false, false, false, false]);
        assert_eq!(quads(&mesh, seed.0, seed.1, 30.0), [true, true, true, true, false, false]);
        assert_eq!(quads(&mesh, seed.0, seed.1, 61.0), [true; 6]);
        assert_eq!(quads(&mesh, seed.0, seed.1, 0.0), [true, false, false, false, false, false]);
    }

    #[test]
    fn the_normal_of_the_seed_picks_a_side_of_a_thin_plate() {
        let mut mesh = strip(&[0.0, 0.0]);
        let back: Vec<Vec3> = mesh.positions.iter().map(|at| *at - Vec3::Z * 1e-3).collect();
        mesh.positions.extend(back);
        mesh.triangles.extend(mesh.triangles.clone().iter().map(|[a, b, c]| [a + 8, c + 8, b + 8]));
        mesh.polygon_of_triangle.extend([2, 2, 3, 3]);
        let at = DVec3::new(0.5, 0.5, -5e-4);
        assert_eq!(quads(&mesh, at, DVec3::Z, 30.0), [true, true, false, false]);
        assert_eq!(quads(&mesh, at, DVec3::NEG_Z, 30.0), [false, false, true, true]);
        assert!(flooded(&TriangleMesh::default(), at, DVec3::Z, 1.0).is_empty());
    }
}
