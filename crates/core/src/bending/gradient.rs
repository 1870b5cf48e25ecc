//! The deformation gradient F at each vertex of a bent surface.

use std::cmp::Ordering;

use glam::{DMat2, DMat3, DVec2, DVec3, Mat3, Vec3};
use rayon::prelude::*;

use super::Bonds;
use crate::TriangleMesh;
use crate::cofactors::cofactors_f32;

/// How many places (see [`Gradients`]) one task handles.
const CHUNK: usize = 1024;

/// Weights that give the deformation gradient F at each vertex from where the vertices are.
///
/// Along the surface, F is a least-squares fit to the edges round the vertex. Each edge counts alike, whatever its
/// length. Across the surface, F takes the normal of the plane fitted at rest to the unit normal of the plane fitted
/// now. So F is exact for any rigid motion and, along the surface, for any affine map. It is continuous across the
/// edges of the mesh, except at creases.
///
/// A *place* is one vertex, or several with equal positions and normals that stay together, as along a seam of
/// texture coordinates.
#[derive(Debug)]
pub struct Gradients {
    place_of_vertex: Vec<u32>,
    places: Vec<Place>,
    /// The neighbours of all places, place by place.
    edges: Vec<Edge>,
}

#[derive(Debug)]
struct Place {
    /// One of its vertices.
    vertex: u32,
    /// Where its edges end in the list. They begin where the edges of the previous place end.
    end: u32,
    /// Rows of M⁻¹. The columns of M are the two fitted tangents and their unit normal, at rest.
    from_rest: [Vec3; 3],
}

/// An edge from a place to a neighbour, with its weights in the two fitted tangents.
#[derive(Clone, Copy, Debug)]
struct Edge {
    to: u32,
    weights: [f32; 2],
}

impl Gradients {
    /// The weights for a mesh at rest; `bonds` tells which vertices stay together.
    pub fn new(mesh: &TriangleMesh, bonds: Bonds<'_>) -> Self {
        let (place_of_vertex, vertex_of_place) = places(mesh, bonds);
        // Lists the corners at each place. A corner's number is three times its triangle's, plus 0, 1 or 2.
        let place_of = |corner: u32| {
            let vertex = mesh.triangles[corner as usize / 3][corner as usize % 3];
            place_of_vertex[vertex as usize] as usize
        };
        let corners = 0..mesh.triangles.len() as u32 * 3;
        let mut first = vec![0u32; vertex_of_place.len() + 2];
        corners.clone().for_each(|corner| first[place_of(corner) + 2] += 1);
        for place in 1..first.len() {
            first[place] += first[place - 1];
        }
        let mut list = vec![0; corners.len()];
        for corner in corners {
            let slot = &mut first[place_of(corner) + 1];
            list[*slot as usize] = corner;
            *slot += 1;
        }
        let (mut places, mut edges) = (Vec::with_capacity(vertex_of_place.len()), Vec::new());
        let mut own = Vec::new();
        for (place, &vertex) in vertex_of_place.iter().enumerate() {
            own.clear();
            own.extend(list[first[place] as usize..first[place + 1] as usize].iter().map(|&corner| {
                let [a, b, c] = mesh.triangles[corner as usize / 3];
                [[b, c], [c, a], [a, b]][corner as usize % 3]
            }));
            let from_rest = fit(&mesh.positions, vertex, &own, &mut edges);
            places.push(Place { vertex, end: edges.len() as u32, from_rest });
        }
        edges.shrink_to_fit();
        Self { place_of_vertex, places, edges }
    }

    /// F at each vertex when the vertices are at these positions; columns in model space. F takes a step on the surface
    /// at rest to the same step now, and the normal at rest to about the normal now.
    pub fn at(&self, positions: &[Vec3]) -> Vec<Mat3> {
        let mut of_place = vec![Mat3::IDENTITY; self.places.len()];
        of_place.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, gradients)| {
            for (offset, gradient) in gradients.iter_mut().enumerate() {
                *gradient = self.of_place(chunk * CHUNK + offset, positions);
            }
        });
        self.place_of_vertex.iter().map(|&place| of_place[place as usize]).collect()
    }

    fn of_place(&self, index: usize, positions: &[Vec3]) -> Mat3 {
        let Place { vertex, end, from_rest: [u, v, w] } = self.places[index];
        let first = index.checked_sub(1).map_or(0, |before| self.places[before].end);
        let center = positions[vertex as usize];
        let (mut along, mut across) = (Vec3::ZERO, Vec3::ZERO);
        for Edge { to, weights } in &self.edges[first as usize..end as usize] {
            let step = positions[*to as usize] - center;
            along += step * weights[0];
            across += step * weights[1];
        }
        let normal = along.cross(across).normalize_or_zero();
        let column = |axis: usize| along * u[axis] + across * v[axis] + normal * w[axis];
        Mat3::from_cols(column(0), column(1), column(2))
    }

    /// The normals of the bent mesh, from those at rest and F at each vertex: each turns as the surface round it does.
    pub fn normals(&self, rest: &[Vec3], gradients: &[Mat3]) -> Vec<Vec3> {
        let turned = |(normal, gradient): (&Vec3, &Mat3)| {
            (cofactors_f32(*gradient) * *normal).try_normalize().unwrap_or(*normal)
        };
        rest.par_iter().zip(gradients).with_min_len(CHUNK).map(turned).collect()
    }
}

/// The place of each vertex, and for each place its first vertex.
fn places(TriangleMesh { positions, normals, .. }: &TriangleMesh, bonds: Bonds<'_>) -> (Vec<u32>, Vec<u32>) {
    let bits = |v: Vec3| v.to_array().map(f32::to_bits);
    let key = |vertex: u32| (bits(positions[vertex as usize]), bits(normals[vertex as usize]));
    let compare = |a: u32, b: u32| key(a).cmp(&key(b)).then_with(|| bonds.compare(a, b));
    let mut sorted: Vec<u32> = (0..positions.len() as u32).collect();
    sorted.par_sort_unstable_by(|&a, &b| compare(a, b).then(a.cmp(&b)));
    let mut first_of_vertex = vec![0; positions.len()];
    for alike in sorted.chunk_by(|&a, &b| compare(a, b) == Ordering::Equal) {
        alike.iter().for_each(|&vertex| first_of_vertex[vertex as usize] = alike[0]);
    }
    let mut vertex_of_place = Vec::with_capacity(positions.len());
    let mut place_of_vertex = vec![0; positions.len()];
    for vertex in 0..positions.len() {
        let first = first_of_vertex[vertex] as usize;
        if first == vertex {
            place_of_vertex[vertex] = vertex_of_place.len() as u32;
            vertex_of_place.push(vertex as u32);
        } else {
            place_of_vertex[vertex] = place_of_vertex[first];
        }
    }
    (place_of_vertex, vertex_of_place)
}

/// Adds the edges of a place with their weights, and returns the rows of M⁻¹. `corners` holds the other two corners of
/// each of its triangles, in the order in which the triangle winds. Where all of these triangles are without area, no
/// edge is added, so F will be zero.
fn fit(positions: &[Vec3], vertex: u32, corners: &[[u32; 2]], edges: &mut Vec<Edge>) -> [Vec3; 3] {
    let rigid = DMat3::IDENTITY;
    let as_rows = |matrix: DMat3| [0, 1, 2].map(|row| matrix.row(row).as_vec3());
    let center = positions[vertex as usize].as_dvec3();
    let step = |to: u32| positions[to as usize].as_dvec3() - center;
    let faces = corners.iter().map(|&[b, c]| step(b).cross(step(c)));
    let largest = faces.clone().max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
    let Some(largest) = largest.and_then(DVec3::try_normalize) else { return as_rows(rigid) };
    // Where faces lie on each other, back to back, their normals cancel.
    let normal = faces.sum::<DVec3>().normalize_or_zero();
    let normal = if normal.dot(largest) > 0.1 { normal } else { largest };
    let (right, up) = normal.any_orthonormal_pair();
    let mut around: Vec<u32> = corners.iter().flatten().copied().collect();
    around.sort_unstable();
    around.dedup();
    let flat = |to: u32| DVec2::new(step(to).dot(right), step(to).dot(up));
    let weight = |to: u32| 1.0 / step(to).length_squared().max(f64::MIN_POSITIVE);
    let sum = around.iter().fold(DMat2::ZERO, |sum, &to| {
        let (e, w) = (flat(to), weight(to));
        sum + DMat2::from_cols(e * (e.x * w), e * (e.y * w))
    });
    let inverse = sum.inverse();
    if !inverse.is_finite() {
        return as_rows(rigid);
    }
    let before = edges.len();
    let (mut along, mut across) = (DVec3::ZERO, DVec3::ZERO);
    for &to in &around {
        let h = inverse * flat(to) * weight(to);
        along += step(to) * h.x;
        across += step(to) * h.y;
        edges.push(Edge { to, weights: h.as_vec2().to_array() });
    }
    let fitted = DMat3::from_cols(along, across, along.cross(across).normalize_or(normal));
    let from_rest = fitted.inverse();
    if !from_rest.is_finite() {
        edges.truncate(before);
        return as_rows(rigid);
    }
    as_rows(from_rest)
}
