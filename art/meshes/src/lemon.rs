//! The lemon and the pear: outlines turned round an axis, then made less regular.

use std::f64::consts::TAU;

use glam::DVec3;

use super::curve::{Profile, bump, noise, smoothstep};
use super::poly_mesh::{Look, PolyMesh};

/// The outline of half a lemon, from the nipple at the blossom end to the stalk. Each point is its distance from the
/// axis and its place along the axis.
const LEMON: [[f64; 2]; 13] = [
    [0.0, 0.500],
    [0.034, 0.492],
    [0.062, 0.462],
    [0.092, 0.425],
    [0.160, 0.372],
    [0.250, 0.270],
    [0.312, 0.110],
    [0.3185, -0.050],
    [0.275, -0.220],
    [0.185, -0.350],
    [0.095, -0.420],
    [0.050, -0.452],
    [0.0, -0.455],
];

/// A lemon lying on its side, its nipple towards +X, about one unit long.
pub fn lemon() -> PolyMesh {
    const ROWS: usize = 36;
    const SEGMENTS: usize = 36;
    let mut mesh = PolyMesh::new(
        "lemon",
        "A lemon lying along X, its nipple towards +X.",
        &[("lemon", "#e3b62c"), ("ripe", "#e4ae2a"), ("green", "#a9a53a"), ("stalk", "#6d6a35")],
    );
    mesh.polish(&["lemon", "ripe", "green"], 0.25, 40.0);
    let outline = Profile::through(&LEMON).spread(ROWS, 0.5);
    mesh.lathe(
        [ROWS, SEGMENTS],
        |row, segment| {
            let (radius, along) = (outline[row].x, outline[row].y);
            let round = segment as f64 / SEGMENTS as f64;
            let angle = TAU * round;
            // Shallow dents, a slightly oval section, and wrinkles on the neck of the nipple.
            let dents = 0.022 * noise(round, along * 5.0 + 7.0, 6, 11) + 0.020 * (2.0 * angle + 0.8).cos();
            let wrinkles = 0.035 * (6.0 * angle + 3.0 * along).cos() * bump(0.42, 0.10, along);
            let radius = radius * (1.0 + (dents + wrinkles) * smoothstep(0.0, 0.05, radius));
            let bow = -0.035 * (1.0 - 4.0 * along * along) + 0.05 * smoothstep(0.35, 0.5, along);
            DVec3::new(along, radius * angle.cos() + bow, radius * angle.sin())
        },
        |row, segment| {
            let along = outline[row].y;
            let patch = noise(segment as f64 / SEGMENTS as f64, along * 4.0 + 2.0, 5, 23);
            let material = match along {
                along if along < -0.435 => "stalk",
                along if !(-0.40..=0.44).contains(&along) => "green",
                _ if patch > 0.35 => "ripe",
                _ => "lemon",
            };
            Look { group: "skin", material }
        },
    );
    mesh.rest_on_ground();
    mesh
}

/// The outline of half a pear, from the stem to the blossom end. Each point is its distance from the axis and its
/// height.
const PEAR: [[f64; 2]; 16] = [
    [0.0, 0.900],
    [0.030, 0.905],
    [0.070, 0.915],
    [0.118, 0.890],
    [0.158, 0.820],
    [0.182, 0.720],
    [0.222, 0.610],
    [0.290, 0.490],
    [0.345, 0.350],
    [0.350, 0.220],
    [0.300, 0.095],
    [0.205, 0.020],
    [0.125, 0.002],
    [0.070, 0.022],
    [0.032, 0.040],
    [0.0, 0.042],
];

/// A pear that leans a little, with a bent stem.
pub fn pear() -> PolyMesh {
    const ROWS: usize = 40;
    const SEGMENTS: usize = 40;
    let mut mesh = PolyMesh::new(
        "pear",
        "A pear, slightly bent, with its stem.",
        &[("pear", "#b9a13a"), ("blush", "#b88334"), ("green", "#9c993c"), ("stem", "#50381f")],
    );
    let outline = Profile::through(&PEAR).spread(ROWS, 0.4);
    mesh.lathe(
        [ROWS, SEGMENTS],
        |row, segment| {
            let (radius, height) = (outline[row].x, outline[row].y);
            let angle = TAU * segment as f64 / SEGMENTS as f64;
            let uneven = 1.0 + 0.025 * (angle + 1.0).cos() + 0.018 * (3.0 * angle + 4.0 * height).cos();
            let bend = pear_bend(height);
            DVec3::new(
                radius * uneven * angle.cos() + bend,
                height,
                -radius * uneven * angle.sin() + 0.3 * bend,
            )
        },
        |row, segment| {
            let round = segment as f64 / SEGMENTS as f64;
            let height = outline[row].y;
            let patch = 0.5 * noise(round, height * 6.0, 12, 31);
            let cheek = (TAU * (round - 0.62)).cos() + patch;
            let material = if cheek > 0.55 && height > 0.08 && height < 0.75 {
                "blush"
            } else if cheek < -0.6 || height > 0.80 + 0.1 * patch {
                "green"
            } else {
                "pear"
            };
            Look { group: "skin", material }
        },
    );
    pear_stem(&mut mesh);
    mesh.rest_on_ground();
    mesh
}

/// How far the pear's axis leaves the vertical at a height.
fn pear_bend(height: f64) -> f64 {
    0.085 * smoothstep(0.3, 1.0, height) - 0.02 * height
}

fn pear_stem(mesh: &mut PolyMesh) {
    const SIDES: usize = 8;
    const ALONG: [f64; 11] = [0.0, 0.0, 0.05, 0.15, 0.3, 0.45, 0.6, 0.75, 0.9, 1.0, 1.0];
    let centre = |t: f64| {
        let up = 1.0 - t;
        DVec3::new(
            pear_bend(0.9) + 0.02 + 0.11 * up * up,
            0.875 + 0.19 * up,
            0.3 * pear_bend(0.9) - 0.03 * up,
        )
    };
    mesh.lathe(
        [ALONG.len() - 1, SIDES],
        |row, side| {
            let t = ALONG[row];
            if row == 0 || row == ALONG.len() - 1 {
                return centre(t);
            }
            let radius = 0.016 + 0.012 * bump(0.0, 0.35, t) + 0.018 * bump(1.0, 0.45, t);
            let along = (centre(t - 0.01) - centre(t + 0.01)).normalize();
            let forward = along.cross(DVec3::X).normalize();
            let angle = TAU * side as f64 / SIDES as f64;
            centre(t) + radius * (forward.cross(along) * angle.cos() + forward * angle.sin())
        },
        |_, _| Look { group: "stem", material: "stem" },
    );
}
