//! The cofactors of a matrix: where the matrix transforms a surface, its cofactors transform the normals.

use glam::{DMat3, Mat3};

/// The inverse transpose times the determinant; defined for mirrored and flat matrices too. Takes the unit normal of a
/// surface to a normal whose length is the factor by which `matrix` enlarges the surface's area.
#[inline(always)]
pub fn cofactors(matrix: DMat3) -> DMat3 {
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = matrix;
    DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y))
}

/// [`cofactors`] in single precision.
#[inline(always)]
pub fn cofactors_f32(matrix: Mat3) -> Mat3 {
    let Mat3 { x_axis: x, y_axis: y, z_axis: z } = matrix;
    Mat3::from_cols(y.cross(z), z.cross(x), x.cross(y))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn they_are_the_inverse_transpose_times_the_determinant() {
        let matrix = DMat3::from_cols_array(&[2.0, 0.5, -1.0, 0.25, -3.0, 0.75, 1.5, 1.0, 0.5]);
        let expected = matrix.inverse().transpose() * matrix.determinant();
        assert!(cofactors(matrix).abs_diff_eq(expected, 1e-12));
        assert!(cofactors_f32(matrix.as_mat3()).abs_diff_eq(expected.as_mat3(), 1e-6));
        // The cofactors of a matrix that flattens space onto a plane still give the normal of that plane.
        let flat = DMat3::from_cols(matrix.x_axis, matrix.y_axis, DVec3::ZERO);
        assert_eq!(cofactors(flat) * DVec3::Z, matrix.x_axis.cross(matrix.y_axis));
    }
}
