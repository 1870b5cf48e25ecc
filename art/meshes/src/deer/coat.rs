//! Decides which colour of the deer's coat lies where. Lengths are in units of the deer's height at the withers.

use glam::DVec3;

use crate::curve::{bump, noise, smoothstep};
use crate::poly_mesh::Look;

/// The materials of the coat, from the dark line along the back to the white of the rump. Neighbours differ so little
/// that no border shows between them.
pub const COAT: [&str; 20] = [
    "coat_01", "coat_02", "coat_03", "coat_04", "coat_05", "coat_06", "coat_07", "coat_08", "coat_09",
    "coat_10", "coat_11", "coat_12", "coat_13", "coat_14", "coat_15", "coat_16", "coat_17", "coat_18",
    "coat_19", "coat_20",
];

/// Group and material at a point of the skin, whose normal there is `outward`.
pub fn look(point: DVec3, outward: DVec3) -> Look {
    let group = group(point);
    let material = match group {
        "hooves" => "hoof",
        "nose" => "nose",
        _ => {
            let light = lightness(point, outward).clamp(0.0, 0.999);
            COAT[(light * COAT.len() as f64) as usize]
        }
    };
    Look { group, material }
}

fn group(point: DVec3) -> &'static str {
    let DVec3 { x, y, .. } = point;
    if y < 0.062 {
        "hooves"
    } else if x > 0.972 - 0.25 * (y - 1.21) && y > 1.185 {
        "nose"
    } else if x < -0.612 - 0.18 * (0.87 - y).max(0.0) && y > 0.6 && point.z.abs() < 0.048 {
        "tail"
    } else if y < 0.56 {
        "legs"
    } else if x + 0.7 * y > 1.47 && y > 1.15 {
        "head"
    } else {
        "body"
    }
}

/// How light the coat is, about 0 to 1.
fn lightness(point: DVec3, outward: DVec3) -> f64 {
    let DVec3 { x, y, z } = point;
    let mottle = 0.035 * noise(0.5 + 0.31 * x + 0.3 * z, 14.0 * y + 9.0 * z, 60, 71);
    if group(point) == "tail" {
        return 0.26 + mottle + 0.7 * smoothstep(-0.2, 0.5, outward.x);
    }
    // Dark along the back and the nape, a middle tone on the flanks.
    let flank = 0.34 + 0.10 * smoothstep(0.9, 0.68, y) - 0.24 * smoothstep(0.55, 0.98, outward.y);
    // Pale below: belly, inside of the legs, throat.
    let under = smoothstep(0.15, -0.75, outward.y) * smoothstep(0.50, 0.62, y);
    let inside = smoothstep(-0.2, -0.8, outward.z * z.signum()) * smoothstep(0.20, 0.40, y);
    let throat =
        smoothstep(0.25, 0.95, outward.x - 0.6 * outward.y) * bump(1.14, 0.16, y) * smoothstep(0.45, 0.55, x);
    let rump = smoothstep(-0.10, -0.85, outward.x)
        * smoothstep(0.64, 0.74, y)
        * smoothstep(-0.50, -0.56, x)
        * smoothstep(0.97, 0.90, y);

    // Dark: the shins and the bridge of the nose. Pale: the muzzle, the chin and round the eyes.
    let shin = 0.14 * smoothstep(0.50, 0.20, y) * smoothstep(-0.3, 0.6, outward.x);
    let in_head = smoothstep(1.46, 1.50, x + 0.7 * y);
    let bridge = 0.16 * in_head * smoothstep(0.5, 0.9, outward.y) * smoothstep(0.70, 0.78, x);
    let eye = bump(0.0, 0.052, (point - DVec3::new(0.742, 1.350, 0.07 * z.signum())).length());
    let muzzle = 0.36 * smoothstep(0.90, 0.955, x) * in_head;
    let chin = in_head * smoothstep(-0.2, -0.7, outward.y);
    let pale = (0.50 * under).max(0.36 * inside).max(0.45 * throat).max(0.62 * rump).max(0.22 * eye);
    flank + mottle + pale.max(muzzle).max(0.45 * chin) - shin - bridge
}
