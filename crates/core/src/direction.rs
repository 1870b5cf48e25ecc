//! Base directions on a surface, as tangents in model space.

use glam::DVec3;

/// The direction round an axis, along the surface; unit, or zero where it is undefined.
///
/// `axis × n` follows bent and off-centre parts. Where the surface faces along the axis (the cap of a log) that
/// vanishes, and the circle round the axis through `center` stands in.
pub fn around(axis: DVec3, normal: DVec3, from_center: DVec3, size: f64) -> DVec3 {
    let axis = axis.normalize_or_zero();
    let round_part = axis.cross(normal);
    let round_center = axis.cross(from_center) / size.max(f64::MIN_POSITIVE);
    let direction = round_part + round_center * (1.0 - round_part.length()).max(0.0).powi(2) * 0.5;
    along_surface(direction, normal)
}

/// The direction towards `up`, along the surface; unit, or zero where the surface faces straight up or down.
pub fn towards(up: DVec3, normal: DVec3) -> DVec3 {
    along_surface(up, normal)
}

fn along_surface(direction: DVec3, normal: DVec3) -> DVec3 {
    (direction - normal * normal.dot(direction)).normalize_or_zero()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn around_goes_round_a_cylinder_and_its_cap() {
        let side = around(DVec3::Y, DVec3::X, DVec3::new(1.0, 0.3, 0.0), 2.0);
        assert!((side - DVec3::NEG_Z).length() < 1e-12);
        let cap = around(DVec3::Y, DVec3::Y, DVec3::new(0.5, 1.0, 0.0), 2.0);
        assert!((cap - DVec3::NEG_Z).length() < 1e-12);
        // A handle beside the axis: the direction goes round the handle's own bend, not round the jug.
        let handle = around(DVec3::Y, DVec3::Z, DVec3::new(0.8, 0.5, 0.05), 2.0);
        assert!((handle - DVec3::X).length() < 1e-2, "{handle}");
    }

    #[test]
    fn up_is_tangent() {
        let normal = DVec3::new(0.6, 0.0, 0.8);
        assert!((towards(DVec3::Y, normal) - DVec3::Y).length() < 1e-12);
        assert_eq!(towards(DVec3::Y, DVec3::Y), DVec3::ZERO);
    }
}
