//! The landscape's figure: a woman walking home along the path, with a shawl, a straw hat and a basket.

use std::f64::consts::TAU;

use glam::DVec3;

use super::curve::{Profile, noise, smoothstep};
use super::poly_mesh::{Look, PolyMesh};

/// The outline of the body from the crown of the hat down. Each point: its distance from the axis, its height.
const OUTLINE: [[f64; 2]; 19] = [
    [0.0, 1.640],
    [0.060, 1.635],
    [0.092, 1.600],
    [0.100, 1.550],
    [0.175, 1.530],
    [0.180, 1.515],
    [0.095, 1.505],
    [0.092, 1.430],
    [0.060, 1.375],
    [0.062, 1.345],
    [0.150, 1.300],
    [0.205, 1.200],
    [0.190, 1.060],
    [0.135, 0.930],
    [0.205, 0.800],
    [0.265, 0.450],
    [0.315, 0.060],
    [0.290, 0.010],
    [0.0, 0.0],
];

/// A walking woman 1.64 units high, who looks towards −Z.
pub fn walker() -> PolyMesh {
    let mut mesh = PolyMesh::new(
        "walker",
        "A woman in a long skirt, with a shawl, a straw hat and a basket.",
        &[
            ("straw", "#e6c67c"),
            ("skin", "#c98f6c"),
            ("shawl", "#f1e6d2"),
            ("skirt", "#3f5f92"),
            ("skirt_dark", "#34507f"),
            ("apron", "#c9453a"),
            ("basket", "#9a6d3f"),
        ],
    );
    body(&mut mesh);
    arm(&mut mesh, -1.0);
    arm(&mut mesh, 1.0);
    basket(&mut mesh);
    mesh
}

fn body(mesh: &mut PolyMesh) {
    const ROWS: usize = 42;
    const SEGMENTS: usize = 24;
    let outline = Profile::through(&OUTLINE).spread(ROWS, 0.4);
    mesh.lathe(
        [ROWS, SEGMENTS],
        |row, segment| {
            let (radius, height) = (outline[row].x, outline[row].y);
            let round = segment as f64 / SEGMENTS as f64;
            let angle = TAU * round;
            // The skirt falls in folds and swings back; the upper body is wider than deep.
            let skirt = smoothstep(0.9, 0.2, height);
            let folds = 1.0 + 0.09 * skirt * ((7.0 * angle).sin() + noise(round, 2.0 * height, 7, 17));
            let flat = 1.0 - 0.28 * smoothstep(0.85, 1.0, height) * smoothstep(1.40, 1.32, height);
            let swing = 0.10 * skirt * skirt - 0.05 * smoothstep(1.0, 1.6, height);
            DVec3::new(radius * folds * angle.cos(), height, -radius * folds * flat * angle.sin() + swing)
        },
        |row, segment| {
            let height = 0.5 * (outline[row].y + outline[row + 1].y);
            let fold = segment % 4 == 0;
            let material = match height {
                height if height > 1.505 => "straw",
                height if height > 1.335 => "skin",
                height if height > 0.935 => "shawl",
                height if height > 0.895 => "apron",
                _ if fold => "skirt_dark",
                _ => "skirt",
            };
            Look { group: "figure", material }
        },
    );
}

/// One arm, from the shoulder to the hand; the right one (`side` 1) carries the basket.
fn arm(mesh: &mut PolyMesh, side: f64) {
    const ROWS: usize = 14;
    const SIDES: usize = 10;
    let forward = if side > 0.0 { 0.02 } else { -0.10 };
    let centre = move |t: f64| {
        let bow = t * (1.0 - t);
        DVec3::new(side * (0.16 + 0.10 * t + 0.12 * bow), 1.27 - 0.50 * t, forward * t - 0.02)
    };
    mesh.lathe(
        [ROWS, SIDES],
        |row, turn| {
            let t = row.saturating_sub(1).min(ROWS - 2) as f64 / (ROWS - 2) as f64;
            if row == 0 || row == ROWS {
                return centre(t);
            }
            let radius = 0.060 - 0.024 * t;
            let angle = TAU * turn as f64 / SIDES as f64;
            centre(t) + radius * DVec3::new(angle.cos(), 0.0, -angle.sin())
        },
        |row, _| Look { group: "figure", material: if row < ROWS - 4 { "shawl" } else { "skin" } },
    );
}

fn basket(mesh: &mut PolyMesh) {
    const ROWS: usize = 10;
    const SIDES: usize = 16;
    let outline = Profile::through(&[[0.0, 0.10], [0.11, 0.12], [0.13, 0.07], [0.10, -0.06], [0.0, -0.07]])
        .spread(ROWS, 0.4);
    mesh.lathe(
        [ROWS, SIDES],
        |row, side| {
            let angle = TAU * side as f64 / SIDES as f64;
            let radius = outline[row].x;
            DVec3::new(0.29 + 0.8 * radius * angle.cos(), 0.66 + outline[row].y, -1.2 * radius * angle.sin())
        },
        |_, _| Look { group: "figure", material: "basket" },
    );
}
