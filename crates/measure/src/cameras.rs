//! Camera motions that the protocols use: roll, orbit, zoom and sideways moves.

use glam::{DMat3, DVec3};
use impasto_scene::document::Lens;
use impasto_scene::motion::CameraPose;

/// The camera rolled about its gaze, counter-clockwise as seen from behind it.
pub fn rolled(camera: &CameraPose, roll_rad: f64) -> CameraPose {
    CameraPose { roll_rad: camera.roll_rad + roll_rad, ..camera.clone() }
}

/// The camera moved round its target, about the vertical. Whole turns give exactly the same camera.
pub fn orbited(camera: &CameraPose, angle_deg: f64) -> CameraPose {
    let turn = DMat3::from_rotation_y(angle_deg.rem_euclid(360.0).to_radians());
    let offset = camera.eye - camera.target;
    let eye = if angle_deg % 360.0 == 0.0 { camera.eye } else { camera.target + turn * offset };
    CameraPose { eye, ..camera.clone() }
}

/// The camera zoomed in by this factor through its lens. It stays where it is, so it cannot run into a wall.
pub fn zoomed(camera: &CameraPose, factor: f64) -> CameraPose {
    let lens = match camera.lens {
        Lens::Perspective { fov_y_deg, near, far } => {
            let half = (0.5 * fov_y_deg.to_radians()).tan() / factor;
            Lens::Perspective { fov_y_deg: 2.0 * half.atan().to_degrees(), near, far }
        }
        Lens::Orthographic { height, near, far } => Lens::Orthographic { height: height / factor, near, far },
    };
    CameraPose { lens, shift: camera.shift * factor, ..camera.clone() }
}

/// The camera with its eye and its target moved together. `right` and `up` are shares of the distance between the two.
pub fn moved_sideways(camera: &CameraPose, [right, up]: [f64; 2]) -> CameraPose {
    let offset = camera.target - camera.eye;
    let to_right = offset.cross(DVec3::Y).normalize_or(DVec3::X);
    let upwards = to_right.cross(offset).normalize_or(DVec3::Y);
    let shift = (to_right * right + upwards * up) * offset.length();
    CameraPose { eye: camera.eye + shift, target: camera.target + shift, ..camera.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> CameraPose {
        CameraPose {
            eye: DVec3::new(1.0, 2.0, 4.0),
            target: DVec3::new(0.0, 0.5, 0.0),
            roll_rad: 0.1,
            shift: glam::DVec2::ZERO,
            lens: Lens::Perspective { fov_y_deg: 35.0, near: 0.1, far: 50.0 },
        }
    }

    #[test]
    fn an_orbit_closes_and_keeps_height_and_distance() {
        assert_eq!(orbited(&camera(), 360.0), camera());
        let half = orbited(&camera(), 180.0);
        assert!((half.eye - DVec3::new(-1.0, 2.0, -4.0)).length() < 1e-12);
    }

    #[test]
    fn a_zoom_by_two_halves_the_field_of_view() {
        let Lens::Perspective { fov_y_deg, .. } = zoomed(&camera(), 2.0).lens else {
            panic!("a perspective lens")
        };
        let tangent = |degrees: f64| (0.5 * degrees.to_radians()).tan();
        assert!((tangent(fov_y_deg) * 2.0 - tangent(35.0)).abs() < 1e-12);
    }

    #[test]
    fn a_sideways_move_keeps_the_gaze() {
        let moved = moved_sideways(&camera(), [0.2, -0.1]);
        assert!(((moved.target - moved.eye) - (camera().target - camera().eye)).length() < 1e-12);
        assert!((moved.eye - camera().eye).dot(camera().target - camera().eye).abs() < 1e-12);
    }
}
