//! The landscape's sky: a hollow sheet in bands from cream to blue, and before it a few cumulus clouds.

use glam::DVec3;

use super::curve::{hash, noise, smoothstep};
use super::poly_mesh::{Look, Pigment, PolyMesh};

const PALETTE: [Pigment; 21] = [
    ("sky_01", "#f6dfb4"),
    ("sky_02", "#f5e0b9"),
    ("sky_03", "#f2e1c0"),
    ("sky_04", "#ece0c6"),
    ("sky_05", "#e4decb"),
    ("sky_06", "#dadbcf"),
    ("sky_07", "#ced6d2"),
    ("sky_08", "#c1d0d4"),
    ("sky_09", "#b4c9d5"),
    ("sky_10", "#a7c1d5"),
    ("sky_11", "#9ab8d3"),
    ("sky_12", "#8dafd0"),
    ("sky_13", "#82a6cc"),
    ("sky_14", "#789dc7"),
    ("sky_15", "#6f95c1"),
    ("sky_16", "#668dbb"),
    ("crest", "#fff4dc"),
    ("cream", "#fbe8cb"),
    ("flank", "#ecd7c4"),
    ("shade", "#cfc3c6"),
    ("belly", "#b3b2c3"),
];

const BANDS: usize = 16;

/// How far back the sheet stands in its middle.
const DEPTH: f64 = 15.5;

/// A cloud: a flat sheet with a level foot and a billowing top.
struct Cloud {
    /// Middle of its foot: across, height.
    foot: [f64; 2],
    /// Half its width, and its greatest height.
    size: [f64; 2],
    /// How far it stands before the sky.
    before: f64,
    billows: u32,
    seed: u32,
}

/// A sky 34 wide, from y = 1.8 to 11.4, hollow towards +Z, with eight clouds; open, to be shown unlit.
pub fn sky() -> PolyMesh {
    let mut mesh =
        PolyMesh::new("sky", "A sky in bands, with clouds before it; open, shown unlit.", &PALETTE);
    sheet(&mut mesh);
    let clouds = [
        ([2.3, 4.1], [3.6, 2.3], 0.20, 9),
        ([4.9, 3.75], [2.6, 1.1], 0.45, 7),
        ([-0.6, 3.9], [1.7, 0.75], 0.40, 6),
        ([-7.6, 4.3], [3.0, 1.6], 0.20, 8),
        ([9.6, 4.6], [2.4, 1.5], 0.20, 7),
        ([-3.6, 6.4], [1.9, 0.55], 0.20, 7),
        ([7.0, 7.3], [2.6, 0.60], 0.20, 8),
        ([-9.5, 3.4], [2.2, 0.60], 0.45, 6),
    ];
    for (index, (foot, size, before, billows)) in clouds.into_iter().enumerate() {
        cloud(&mut mesh, &Cloud { foot, size, before, billows, seed: 500 + 3 * index as u32 });
    }
    mesh
}

/// A point of the hollow, `before` it by so much.
fn hollow(x: f64, y: f64, before: f64) -> DVec3 {
    DVec3::new(x, y, before - DEPTH + 0.006 * x * x)
}

fn sheet(mesh: &mut PolyMesh) {
    const COLUMNS: usize = 48;
    const ROWS: usize = 2 * BANDS;
    mesh.sheet(
        [COLUMNS, ROWS],
        |column, row| {
            let across = column as f64 / COLUMNS as f64 * 2.0 - 1.0;
            let up = row as f64 / ROWS as f64;
            let inner = (4.0 * up * (1.0 - up)).min(1.0);
            // Bands bow over the light on the left, and sway.
            let bow = 0.9 * (1.0 - (across + 0.45) * (across + 0.45)) - 0.4;
            let sway = 0.35 * noise(0.5 * across + 0.5, 2.2 * up, 9, 71);
            hollow(17.0 * across, 1.8 + 9.6 * up.powf(1.1) + (bow + sway) * inner, 0.0)
        },
        |_, row| Look { group: "sky", material: PALETTE[row / 2].0 },
    );
}

fn cloud(mesh: &mut PolyMesh, cloud: &Cloud) {
    const COLUMNS: usize = 72;
    const ROWS: usize = 12;
    let ([foot_x, foot_y], [half, height]) = (cloud.foot, cloud.size);
    let span = |column: usize| column as f64 / COLUMNS as f64 * 2.0 - 1.0;
    mesh.sheet(
        [COLUMNS, ROWS],
        |column, row| {
            let across = span(column);
            let up = row as f64 / ROWS as f64;
            let rim = (1.0 - across * across).max(0.0).sqrt();
            let under =
                0.05 * height * noise(0.5 * across + 0.5, 0.0, 7, cloud.seed + 1) - 0.10 * height * rim;
            let top = (height * billow(across, cloud)).max(under + 0.012);
            // Inner rows bulge and sag: borders between lights are billows too, smaller ones.
            let roll = 0.40 * noise(0.5 * across + 0.5, 2.0 * up, 13, cloud.seed + 2) * up * (1.0 - up);
            let share = (up + roll).clamp(0.0, 1.0);
            hollow(foot_x + half * across, foot_y + under + (top - under) * share, cloud.before)
        },
        |_, row| {
            let material = match row {
                0..2 => "belly",
                2..4 => "shade",
                4..6 => "flank",
                6..9 => "cream",
                _ => "crest",
            };
            Look { group: "clouds", material }
        },
    );
}

/// The upper outline of a cloud at `across` (−1..=1), as a share of its height: the hull of overlapping rounds.
fn billow(across: f64, cloud: &Cloud) -> f64 {
    let rounds = (0..cloud.billows).map(|index| {
        let chance = |number: u32| hash([cloud.seed, index, number]);
        let middle = (f64::from(index) + 0.5 + 0.3 * chance(1)) / f64::from(cloud.billows) * 2.0 - 1.0;
        // Highest a little left of the middle, low at the ends.
        let crown = 1.0 - ((middle + 0.15) / 1.15).powi(2);
        let radius = (1.55 + 0.35 * chance(2)) / f64::from(cloud.billows);
        let lift = (0.86 * crown + 0.14 * chance(3)).max(0.0);
        let off = (across - middle) / radius;
        let dome = (1.0 - off * off).max(0.0).sqrt();
        (lift - 0.22) * smoothstep(0.0, 0.30, dome) + 0.24 * dome
    });
    // Both ends run out to nothing.
    rounds.fold(0.0, f64::max) * smoothstep(1.0, 0.86, across.abs()).sqrt()
}
