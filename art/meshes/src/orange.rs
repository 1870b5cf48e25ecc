//! The mesh `orange`: nearly a ball, with a dimple and the scar of its stalk.

use std::f64::consts::TAU;

use glam::DVec3;

use super::curve::{Profile, bump, noise, smoothstep};
use super::poly_mesh::{Look, PolyMesh};

/// The outline of half an orange, from the stalk to the blossom end. Each point is its distance from the axis and its
/// height.
const OUTLINE: [[f64; 2]; 17] = [
    [0.0, 0.872],
    [0.022, 0.870],
    [0.034, 0.852],
    [0.044, 0.840],
    [0.070, 0.858],
    [0.125, 0.886],
    [0.215, 0.880],
    [0.330, 0.815],
    [0.430, 0.700],
    [0.488, 0.560],
    [0.498, 0.420],
    [0.452, 0.255],
    [0.360, 0.120],
    [0.240, 0.035],
    [0.120, 0.004],
    [0.040, 0.002],
    [0.0, 0.006],
];

/// The skin's colours, from the pale shoulder to the ripe foot. Each is so close to the next that no border shows.
const SKIN: [&str; 12] = [
    "skin_01", "skin_02", "skin_03", "skin_04", "skin_05", "skin_06", "skin_07", "skin_08", "skin_09",
    "skin_10", "skin_11", "skin_12",
];

/// An orange of one unit across, its stalk up (44 × 60 faces).
pub fn orange() -> PolyMesh {
    const ROWS: usize = 44;
    const SEGMENTS: usize = 60;
    let mut mesh = PolyMesh::new(
        "orange",
        "An orange, its stalk up.",
        &[
            ("skin_01", "#dd9435"),
            ("skin_02", "#dc9133"),
            ("skin_03", "#db8e31"),
            ("skin_04", "#da8b30"),
            ("skin_05", "#d9882e"),
            ("skin_06", "#d8852c"),
            ("skin_07", "#d6832b"),
            ("skin_08", "#d5812a"),
            ("skin_09", "#d47f29"),
            ("skin_10", "#d37c28"),
            ("skin_11", "#d17a28"),
            ("skin_12", "#d07827"),
            ("stalk", "#4a4a26"),
        ],
    );
    mesh.polish(&SKIN, 0.25, 40.0);
    let outline = Profile::through(&OUTLINE).spread(ROWS, 0.45);
    mesh.lathe(
        [ROWS, SEGMENTS],
        |row, segment| {
            let (radius, height) = (outline[row].x, outline[row].y);
            let round = segment as f64 / SEGMENTS as f64;
            let angle = TAU * round;
            // Creases run into the dimple; the whole is not quite round.
            let creases =
                0.035 * (7.0 * angle).cos() * bump(0.10, 0.10, radius) * smoothstep(0.7, 0.85, height);
            let uneven = 0.014 * (angle + 0.6).cos() + 0.012 * (2.0 * angle + 2.0).cos();
            let peel = 0.004 * noise(round, height * 24.0, 30, 19) * smoothstep(0.08, 0.3, radius);
            let spread = radius * (1.0 + uneven + peel + creases);
            let tip = 0.02 * (angle - 1.0).cos() * radius;
            DVec3::new(spread * angle.cos(), height + tip, -spread * angle.sin())
        },
        |row, segment| {
            let (radius, height) = (outline[row].x, outline[row].y);
            let round = segment as f64 / SEGMENTS as f64;
            // The skin is paler round the stalk, riper below, and clouded.
            let clouds = 1.6 * noise(round, height * 2.2, 5, 23) + 0.8 * noise(round, height * 5.0, 11, 29);
            let ripeness = 5.5 + 8.0 * (0.5 - height) + clouds;
            let stalk = height > 0.7 && radius < 0.043;
            let material = if stalk { "stalk" } else { SKIN[ripeness.round().clamp(0.0, 11.0) as usize] };
            Look { group: if stalk { "stalk" } else { "skin" }, material }
        },
    );
    mesh.rest_on_ground();
    mesh
}
