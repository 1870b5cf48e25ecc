//! Euler angles as a scene file writes them: degrees about X first, then Y, then Z.

use glam::{DMat3, DVec3};
use impasto_scene::motion;

/// The rotation of Euler angles in degrees.
pub(crate) fn matrix(rotation_deg: [f64; 3]) -> DMat3 {
    motion::rotation_from_euler_deg(DVec3::from(rotation_deg))
}

/// The Euler angles of a rotation in degrees. Many angles give the same rotation: these are the nearest to `near`
/// (except at ±90 degrees about Y, where X and Z are not unique).
pub(crate) fn degrees(rotation: DMat3, near: [f64; 3]) -> [f64; 3] {
    let first = motion::euler_deg_from_rotation(rotation);
    // Other angles that give the same rotation as `first`.
    let second = DVec3::new(first.x + 180.0, 180.0 - first.y, first.z + 180.0);
    let near = DVec3::from(near);
    let wound = |angles: DVec3| angles + ((near - angles) / 360.0).round() * 360.0;
    let [first, second] = [wound(first), wound(second)];
    let nearer = if first.distance_squared(near) <= second.distance_squared(near) { first } else { second };
    nearer.map(tidy).to_array()
}

/// Rounds away the last digits that come from arithmetic alone: 30.000000000000004 becomes 30.
pub(crate) fn tidy(value: f64) -> f64 {
    let rounded = (value * 1e9).round() / 1e9;
    if rounded == 0.0 { 0.0 } else { rounded }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_come_back_with_their_whole_turns() {
        for angles in [[7.0, 30.0, 137.0], [0.0, 0.0, -720.0], [400.0, -80.0, 12.0], [10.0, 100.0, 5.0]] {
            let back = degrees(matrix(angles), angles);
            assert!(back.iter().zip(angles).all(|(a, b)| (a - b).abs() < 1e-6), "{angles:?} {back:?}");
        }
    }

    #[test]
    fn x_turns_first_and_z_last() {
        let turned = matrix([90.0, 0.0, 90.0]) * DVec3::Y;
        assert!(turned.abs_diff_eq(DVec3::Z, 1e-12), "{turned}");
    }
}
