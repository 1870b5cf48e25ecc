//! Splits a matrix into a turn and a stretch. A node's mesh gets the stretch, its object's pose the turn.

use glam::DMat3;

/// A stretch counts as an even scale if it differs from one by at most this share of that scale.
const EVEN: f64 = 1e-5;

/// The most steps of the iteration. The first ones only bring it near its end; each later one doubles the number of
/// correct digits.
const STEPS: usize = 60;

/// The symmetric stretch S of `matrix` = Q S with a turn Q (polar decomposition, Higham 1986). For a mirroring matrix
/// it is −S, so that Q stays a turn. The result is the identity for a matrix that only turns and scales evenly, since
/// the pose takes care of that. It is also the identity for a singular matrix, for which Q is not unique.
pub(crate) fn stretch_of(matrix: DMat3) -> DMat3 {
    let determinant = matrix.determinant();
    let size = matrix.to_cols_array().iter().fold(0.0f64, |most, value| most.max(value.abs()));
    if !(determinant.abs() > 1e-9 * size.powi(3) && determinant.is_finite()) {
        return DMat3::IDENTITY;
    }
    let mut turn = matrix * (1.0 / size);
    for _ in 0..STEPS {
        let next = (turn + turn.inverse().transpose()) * 0.5;
        let moved = next - turn;
        turn = next;
        if moved.to_cols_array().iter().all(|value| value.abs() < 1e-15) {
            break;
        }
    }
    // For a mirroring matrix, the iteration ends in a turn with a reflection.
    let turn = if determinant < 0.0 { -turn } else { turn };
    let stretch = turn.transpose() * matrix;
    let even = determinant.abs().cbrt();
    let is_even =
        determinant > 0.0 && stretch.abs_diff_eq(DMat3::from_diagonal(glam::DVec3::splat(even)), EVEN * even);
    if is_even { DMat3::IDENTITY } else { stretch }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DQuat, DVec3};

    #[test]
    fn turns_and_even_scales_have_no_stretch() {
        let turn =
            DMat3::from_quat(DQuat::from_rotation_y(0.7) * DQuat::from_rotation_x(137f64.to_radians()));
        assert_eq!(stretch_of(turn), DMat3::IDENTITY);
        assert_eq!(stretch_of(turn * 0.01), DMat3::IDENTITY);
        assert_eq!(stretch_of(DMat3::ZERO), DMat3::IDENTITY);
    }

    #[test]
    fn what_is_left_of_a_stretched_matrix_is_a_turn() {
        let turn = DMat3::from_quat(DQuat::from_axis_angle(DVec3::new(1.0, -2.0, 0.5).normalize(), 2.1));
        for scale in [DVec3::new(1.0, 2.0, 3.0), DVec3::new(1.0, -2.0, 3.0), DVec3::new(-1.0, -1.0, -1.0)] {
            let matrix = turn * DMat3::from_diagonal(scale);
            let stretch = stretch_of(matrix);
            let left = matrix * stretch.inverse();
            assert!((left.determinant() - 1.0).abs() < 1e-9, "{scale}");
            assert!((left * left.transpose()).abs_diff_eq(DMat3::IDENTITY, 1e-9));
        }
        // Shear: a parent's uneven scale over a child's turn.
        let sheared = DMat3::from_diagonal(DVec3::new(1.0, 3.0, 1.0)) * turn;
        let left = sheared * stretch_of(sheared).inverse();
        assert!((left * left.transpose()).abs_diff_eq(DMat3::IDENTITY, 1e-9));
    }
}
