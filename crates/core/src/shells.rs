//! Shells, the connected pieces of a mesh, and which side of each can be seen: only the outside of a closed shell, both
//! sides of an open sheet.

use std::collections::HashMap;

use glam::Vec3;

use crate::{TriangleMesh, hash};

/// From where the triangles of a shell can be seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// A closed shell that winds outwards, as it should.
    Front,
    /// A closed shell that is inside out: its back is the outside.
    Back,
    /// A sheet with a border, a shell whose triangles do not all wind alike, or a closed one without volume.
    Both,
}

/// For each triangle, the side that can be seen.
///
/// Triangles that share an edge belong to one shell (edges are compared by position, so split normals and texture seams
/// do not open a shell). A shell is closed when its triangles run along every edge as often forwards as backwards; it
/// is inside out when its signed volume is negative.
pub fn sides(mesh: &TriangleMesh) -> Vec<Side> {
    let (mut shells, open) = find(mesh);
    let mut volume = vec![0.0f64; mesh.triangles.len()];
    for triangle in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(triangle).map(Vec3::as_dvec3);
        volume[shells.root(triangle)] += a.dot(b.cross(c));
    }
    (0..mesh.triangles.len())
        .map(|triangle| match shells.root(triangle) {
            root if open[root] || volume[root] == 0.0 => Side::Both,
            root if volume[root] < 0.0 => Side::Back,
            _ => Side::Front,
        })
        .collect()
}

/// For each triangle the number of its shell. Shells are counted from 0 in the order of their first triangles.
pub fn numbers(mesh: &TriangleMesh) -> Vec<u32> {
    let (mut shells, _) = find(mesh);
    let mut number_of_root: HashMap<usize, u32> = HashMap::new();
    (0..mesh.triangles.len())
        .map(|triangle| {
            let next = number_of_root.len() as u32;
            *number_of_root.entry(shells.root(triangle)).or_insert(next)
        })
        .collect()
}

/// The shells, and for each triangle that is the root of its shell, whether the shell is open (not closed).
fn find(mesh: &TriangleMesh) -> (Shells, Vec<bool>) {
    let point_of_vertex = weld(&mesh.positions);
    let mut shells = Shells::new(mesh.triangles.len());
    // For each edge: a triangle on it, and how many triangles run along it from the lower to the higher point number,
    // less how many run the other way.
    let mut edges: HashMap<(u32, u32), (u32, i32)> = HashMap::with_capacity(mesh.triangles.len() * 2);
    for (triangle, vertices) in mesh.triangles.iter().enumerate() {
        let points = vertices.map(|vertex| point_of_vertex[vertex as usize]);
        for corner in 0..3 {
            let (from, to) = (points[corner], points[(corner + 1) % 3]);
            if from == to {
                continue;
            }
            let (key, step) = if from < to { ((from, to), 1) } else { ((to, from), -1) };
            let entry = edges.entry(key).or_insert((triangle as u32, 0));
            shells.join(entry.0 as usize, triangle);
            entry.1 += step;
        }
    }
    let mut open = vec![false; mesh.triangles.len()];
    for &(triangle, balance) in edges.values() {
        if balance != 0 {
            open[shells.root(triangle as usize)] = true;
        }
    }
    (shells, open)
}

/// Gives vertices at the same position the same number, counted from 0 in the order in which positions first occur.
pub(crate) fn weld(positions: &[Vec3]) -> Vec<u32> {
    // A hash table of the first vertex at each position, at most half full, with linear probing.
    const FREE: u32 = u32::MAX;
    let mask = (2 * positions.len()).next_power_of_two() - 1;
    let mut first_at = vec![FREE; mask + 1];
    let mut numbers: Vec<u32> = Vec::with_capacity(positions.len());
    let mut count = 0;
    // Adding zero turns −0 into +0.
    let key = |vertex: usize| positions[vertex].to_array().map(|value| (value + 0.0).to_bits());
    for vertex in 0..positions.len() {
        let own = key(vertex);
        let mut slot = hash::combine(hash::combine(own[0], own[1]), own[2]) as usize & mask;
        while first_at[slot] != FREE && key(first_at[slot] as usize) != own {
            slot = (slot + 1) & mask;
        }
        if first_at[slot] == FREE {
            first_at[slot] = vertex as u32;
            numbers.push(count);
            count += 1;
        } else {
            numbers.push(numbers[first_at[slot] as usize]);
        }
    }
    numbers
}

/// Disjoint sets of triangles.
struct Shells {
    parent: Vec<u32>,
}

impl Shells {
    fn new(count: usize) -> Self {
        Self { parent: (0..count as u32).collect() }
    }

    fn root(&mut self, mut triangle: usize) -> usize {
        while self.parent[triangle] as usize != triangle {
            let grandparent = self.parent[self.parent[triangle] as usize];
            self.parent[triangle] = grandparent;
            triangle = grandparent as usize;
        }
        triangle
    }

    fn join(&mut self, first: usize, second: usize) {
        let (first, second) = (self.root(first), self.root(second));
        self.parent[first.max(second)] = first.min(second) as u32;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron() -> TriangleMesh {
        TriangleMesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z],
            triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
            ..Default::default()
        }
    }

    #[test]
    fn a_closed_shell_is_seen_from_outside() {
        let mut mesh = tetrahedron();
        assert_eq!(sides(&mesh), [Side::Front; 4]);
        for triangle in &mut mesh.triangles {
            triangle.swap(0, 1);
        }
        assert_eq!(sides(&mesh), [Side::Back; 4]);
    }

    #[test]
    fn a_sheet_beside_a_shell_is_seen_from_both_sides() {
        let mut mesh = tetrahedron();
        mesh.positions.extend([5.0, 6.0, 7.0].map(|x| Vec3::new(x, x * x, 0.0)));
        mesh.triangles.push([4, 5, 6]);
        assert_eq!(sides(&mesh), [Side::Front, Side::Front, Side::Front, Side::Front, Side::Both]);
    }

    #[test]
    fn split_vertices_do_not_open_a_shell() {
        let mut mesh = tetrahedron();
        mesh.positions.push(Vec3::new(-0.0, 0.0, 0.0));
        mesh.triangles[2][0] = 4;
        assert_eq!(sides(&mesh), [Side::Front; 4]);
    }
}
