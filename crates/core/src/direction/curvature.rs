//! How a surface bends at a point, from the normals of the points round it.

use glam::{DMat2, DVec2, DVec3};

use super::tangent_axes;

/// The principal curvatures of a point and their directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curvature {
    /// The one of greater magnitude first; 1 / model units, positive where the surface is convex, seen from the
    /// side of its normal (as on a ball with its normals outward).
    pub curvatures: [f64; 2],
    /// For each curvature, the unit tangent along which the surface has it, model space.
    pub directions: [DVec3; 2],
}

/// Fits the shape operator S (symmetric, `n' ≈ n + S d`) to the neighbours of a point. `normal` is n; `near` gives the
/// offset d and the unit normal n' of each neighbour. `None` without neighbours, or where all of them lie nearly on one
/// line through the point.
pub fn principal(normal: DVec3, near: impl Iterator<Item = (DVec3, DVec3)>) -> Option<Curvature> {
    let [right, above] = tangent_axes(normal);
    let flat = |v: DVec3| DVec2::new(v.dot(right), v.dot(above));
    // Least squares for the entries (p, q, r) of S = [p q; q r]: `a` and `y` are both sides of its normal equations.
    let (mut a, mut y) = ([[0.0; 3]; 3], [0.0; 3]);
    for (offset, normal_there) in near {
        let (d, change) = (flat(offset), flat(normal_there - normal));
        for (row, value) in [([d.x, d.y, 0.0], change.x), ([0.0, d.x, d.y], change.y)] {
            for i in 0..3 {
                y[i] += row[i] * value;
                for j in 0..3 {
                    a[i][j] += row[i] * row[j];
                }
            }
        }
    }
    let matrix = glam::DMat3::from_cols(a[0].into(), a[1].into(), a[2].into());
    let size = matrix.x_axis.x + matrix.z_axis.z;
    if size <= 0.0 || matrix.determinant() <= 1e-9 * size.powi(3) {
        return None;
    }
    let entries = matrix.inverse() * DVec3::from(y);
    let shape = DMat2::from_cols(DVec2::new(entries.x, entries.y), DVec2::new(entries.y, entries.z));
    let (mean, half) = ((entries.x + entries.z) / 2.0, (entries.x - entries.z) / 2.0);
    let radius = half.hypot(entries.y);
    let values = if (mean + radius).abs() >= (mean - radius).abs() {
        [mean + radius, mean - radius]
    } else {
        [mean - radius, mean + radius]
    };
    // Both columns of S − (second eigenvalue)·1 are eigenvectors of the first eigenvalue; the longer is more exact.
    let others = shape - DMat2::from_diagonal(DVec2::splat(values[1]));
    let column = if others.x_axis.length_squared() > others.y_axis.length_squared() {
        others.x_axis
    } else {
        others.y_axis
    };
    let first = column.try_normalize().unwrap_or(DVec2::X);
    let in_space = |v: DVec2| right * v.x + above * v.y;
    Some(Curvature { curvatures: values, directions: [in_space(first), in_space(first.perp())] })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cylinder_bends_round_its_axis() {
        let radius = 2.0;
        let at = |angle: f64, along: f64| {
            let normal = DVec3::new(angle.sin(), 0.0, angle.cos());
            (normal * radius + DVec3::Y * along, normal)
        };
        let (position, normal) = at(0.3, 0.0);
        let near = (0..24).map(|index| {
            let (there, normal_there) =
                at(0.3 + 0.1 * f64::from(index % 5 - 2), 0.15 * f64::from(index / 5 - 2));
            (there - position, normal_there)
        });
        let found = principal(normal, near).unwrap();
        assert!((found.curvatures[0] - 0.5).abs() < 0.01, "{:?}", found.curvatures);
        assert!(found.curvatures[1].abs() < 0.01);
        assert!(found.directions[1].dot(DVec3::Y).abs() > 0.999);
        assert!(principal(normal, std::iter::empty()).is_none());
        let line = [-1.0, 1.0].map(|x| (DVec3::X * x, DVec3::Z));
        assert!(principal(DVec3::Z, line.into_iter()).is_none());
    }
}
