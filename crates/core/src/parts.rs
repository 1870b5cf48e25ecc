//! The parts of a body: the principal axes of each, and its length along them.

use std::collections::HashMap;

use glam::{DMat3, DVec3, Vec3};

use crate::{TriangleMesh, shells};

/// A part of a mesh: one shell, or all the shells that are too small to count alone, taken together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// Centroid of its surface, model space.
    pub center: DVec3,
    /// Principal axes, as unit vectors; the one along which the part is longest comes first. Each points to the side on
    /// which its component of greatest magnitude is positive.
    pub axes: [DVec3; 3],
    /// Length from end to end along each axis, model units.
    pub extents: [f64; 3],
}

/// A shell of fewer triangles than this is too small to be a part of its own.
const LEAST_TRIANGLES: usize = 8;

/// In a mesh of more shells than this, a shell with less than `LEAST_SHARE` of the surface is too small as well.
const MANY_SHELLS: usize = 48;
const LEAST_SHARE: f64 = 0.02;

/// The parts of a mesh, and the part that each triangle belongs to. A part is a shell; shells that are too small, such
/// as the leaves of a tree or single triangles, make one part together.
pub fn parts(mesh: &TriangleMesh) -> (Vec<Part>, Vec<u32>) {
    let of_triangle = numbers(mesh);
    let count = of_triangle.iter().max().map_or(0, |&last| last as usize + 1);
    let mut moments = vec![Moments::default(); count];
    for (triangle, &part) in of_triangle.iter().enumerate() {
        moments[part as usize].add(mesh.corners(triangle).map(Vec3::as_dvec3));
    }
    let mut parts: Vec<Part> = moments.iter().map(Moments::part).collect();
    let mut reach = vec![[[f64::INFINITY, f64::NEG_INFINITY]; 3]; count];
    for (triangle, &part) in of_triangle.iter().enumerate() {
        let (part, reach) = (&parts[part as usize], &mut reach[part as usize]);
        for corner in mesh.corners(triangle) {
            for (axis, [low, high]) in part.axes.iter().zip(reach.iter_mut()) {
                let along = axis.dot(corner.as_dvec3());
                *low = low.min(along);
                *high = high.max(along);
            }
        }
    }
    for (part, reach) in parts.iter_mut().zip(reach) {
        let mut order = [0, 1, 2];
        let length = |axis: usize| reach[axis][1] - reach[axis][0];
        order.sort_by(|&a, &b| length(b).total_cmp(&length(a)));
        (part.axes, part.extents) = (order.map(|axis| part.axes[axis]), order.map(length));
    }
    (parts, of_triangle)
}

/// The number of the part of each triangle. Parts are counted from 0 in the order of their first triangles.
fn numbers(mesh: &TriangleMesh) -> Vec<u32> {
    let shells = shells::numbers(mesh);
    let count = shells.iter().max().map_or(0, |&last| last as usize + 1);
    let (mut triangles, mut areas) = (vec![0usize; count], vec![0.0f64; count]);
    for (triangle, &shell) in shells.iter().enumerate() {
        let [a, b, c] = mesh.corners(triangle).map(Vec3::as_dvec3);
        triangles[shell as usize] += 1;
        areas[shell as usize] += (b - a).cross(c - a).length();
    }
    let least_area = if count > MANY_SHELLS { LEAST_SHARE * areas.iter().sum::<f64>() } else { 0.0 };
    let stands_alone =
        |shell: &u32| triangles[*shell as usize] >= LEAST_TRIANGLES && areas[*shell as usize] >= least_area;
    let mut number: HashMap<Option<u32>, u32> = HashMap::new();
    shells
        .iter()
        .map(|&shell| {
            let next = number.len() as u32;
            *number.entry(Some(shell).filter(stands_alone)).or_insert(next)
        })
        .collect()
}

/// Area-weighted sums over triangles.
#[derive(Clone, Copy, Default)]
struct Moments {
    area: f64,
    first: DVec3,
    second: [[f64; 3]; 3],
}

impl Moments {
    fn add(&mut self, [a, b, c]: [DVec3; 3]) {
        let area = (b - a).cross(c - a).length() * 0.5;
        self.area += area;
        self.first += (a + b + c) / 3.0 * area;
        // The mean of a quadratic function over a triangle is exactly its mean over the midpoints of the three edges.
        for point in [(a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5] {
            let point = point.to_array();
            for (row, sums) in self.second.iter_mut().enumerate() {
                for (column, sum) in sums.iter_mut().enumerate() {
                    *sum += point[row] * point[column] * area / 3.0;
                }
            }
        }
    }

    fn part(&self) -> Part {
        let area = self.area.max(f64::MIN_POSITIVE);
        let center = self.first / area;
        let middle = center.to_array();
        let covariance: [[f64; 3]; 3] = std::array::from_fn(|row| {
            std::array::from_fn(|column| self.second[row][column] / area - middle[row] * middle[column])
        });
        Part { center, axes: principal_axes(covariance), extents: [0.0; 3] }
    }
}

/// Eigenvectors of a symmetric matrix by Jacobi's rotations, in no order.
fn principal_axes(mut matrix: [[f64; 3]; 3]) -> [DVec3; 3] {
    let mut axes = DMat3::IDENTITY;
    for _ in 0..24 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if matrix[p][q].abs() <= 1e-15 * (matrix[p][p].abs() + matrix[q][q].abs()) {
                continue;
            }
            let angle = 0.5 * (2.0 * matrix[p][q]).atan2(matrix[q][q] - matrix[p][p]);
            let (sin, cos) = angle.sin_cos();
            let rotate = |x: f64, y: f64| (cos * x - sin * y, sin * x + cos * y);
            for row in &mut matrix {
                (row[p], row[q]) = rotate(row[p], row[q]);
            }
            let (first, second) = (matrix[p], matrix[q]);
            for (column, (first, second)) in first.into_iter().zip(second).enumerate() {
                (matrix[p][column], matrix[q][column]) = rotate(first, second);
            }
            let (a, b) = (axes.col(p), axes.col(q));
            *axes.col_mut(p) = a * cos - b * sin;
            *axes.col_mut(q) = a * sin + b * cos;
        }
    }
    [0, 1, 2].map(|index| {
        let axis = axes.col(index).normalize_or(DVec3::Y);
        let largest = axis
            .to_array()
            .into_iter()
            .fold(0.0f64, |best, value| if value.abs() > best.abs() + 1e-9 { value } else { best });
        if largest < 0.0 { -axis } else { axis }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    fn brick(half: DVec3, turn: DQuat, at: DVec3) -> TriangleMesh {
        let corner = |index: usize| {
            let sign = |bit: usize| if index >> bit & 1 == 1 { 1.0 } else { -1.0 };
            (turn * (half * DVec3::new(sign(0), sign(1), sign(2))) + at).as_vec3()
        };
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        TriangleMesh {
            positions: (0..8).map(corner).collect(),
            triangles: quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
            ..Default::default()
        }
    }

    #[test]
    fn a_turned_brick_has_its_axes_and_lengths() {
        let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.3, -0.7, 1.1);
        let mut mesh = brick(DVec3::new(0.2, 1.0, 0.5), turn, DVec3::new(3.0, -2.0, 1.0));
        let second = brick(DVec3::splat(0.1), DQuat::IDENTITY, DVec3::ZERO);
        let first_count = mesh.positions.len() as u32;
        mesh.positions.extend(second.positions);
        mesh.triangles.extend(second.triangles.iter().map(|t| t.map(|vertex| vertex + first_count)));
        let (parts, of_triangle) = parts(&mesh);
        assert_eq!(parts.len(), 2);
        assert_eq!(of_triangle[0], 0);
        assert_eq!(of_triangle[12], 1);
        let part = parts[0];
        assert!((part.center - DVec3::new(3.0, -2.0, 1.0)).length() < 1e-6);
        for (axis, (expected, extent)) in part
            .axes
            .iter()
            .zip([(DVec3::Y, 2.0), (DVec3::Z, 1.0), (DVec3::X, 0.4)].iter().map(|(a, e)| (turn * *a, e)))
        {
            assert!(axis.dot(expected).abs() > 1.0 - 1e-9);
            let index = part.axes.iter().position(|other| other == axis).unwrap();
            assert!((part.extents[index] - extent).abs() < 1e-6);
        }
    }

    #[test]
    fn separate_triangles_are_one_part_together() {
        let mut mesh = brick(DVec3::new(0.2, 1.0, 0.5), DQuat::IDENTITY, DVec3::ZERO);
        let torn: Vec<Vec3> = (0..mesh.triangles.len())
            .flat_map(|triangle| {
                mesh.corners(triangle).map(|corner| corner + Vec3::X * triangle as f32 * 0.01)
            })
            .collect();
        mesh.triangles =
            (0..torn.len() as u32 / 3).map(|triangle| [0, 1, 2].map(|k| 3 * triangle + k)).collect();
        mesh.positions = torn;
        assert_eq!(parts(&mesh).0.len(), 1);
    }

    #[test]
    fn the_leaves_of_a_tree_are_one_part_and_its_trunk_another() {
        let mut mesh = brick(DVec3::new(0.5, 4.0, 0.5), DQuat::IDENTITY, DVec3::ZERO);
        for leaf in 0..60 {
            let at = DVec3::new(f64::from(leaf % 10), 5.0, f64::from(leaf / 10));
            let bit = brick(DVec3::splat(0.2), DQuat::IDENTITY, at);
            let first = mesh.positions.len() as u32;
            mesh.positions.extend(bit.positions);
            mesh.triangles.extend(bit.triangles.iter().map(|t| t.map(|vertex| vertex + first)));
        }
        let (parts, of_triangle) = parts(&mesh);
        assert_eq!(parts.len(), 2);
        assert_eq!((of_triangle[0], of_triangle[12], *of_triangle.last().unwrap()), (0, 1, 1));
        assert!(parts[1].extents[0] > 9.0);
    }

    #[test]
    fn a_flat_sheet_and_a_point_have_axes_too() {
        let sheet = TriangleMesh {
            positions: vec![Vec3::ZERO, Vec3::X * 4.0, Vec3::new(4.0, 1.0, 0.0), Vec3::Y],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Default::default()
        };
        let part = parts(&sheet).0[0];
        assert!(part.extents[2] < 1e-9 && part.axes[0].x.abs() > 0.9);
        let point =
            TriangleMesh { positions: vec![Vec3::ONE; 3], triangles: vec![[0, 1, 2]], ..Default::default() };
        let part = parts(&point).0[0];
        assert!(part.axes.iter().all(|axis| axis.is_finite()) && part.extents == [0.0; 3]);
    }
}
