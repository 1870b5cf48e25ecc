//! The landscape's sky: a hollow sheet in bands from cream to blue, and in front of it some cumulus clouds.

use glam::DVec3;

use super::curve::{hash, noise, smoothstep};
use super::poly_mesh::{Look, Pigment, PolyMesh};

const PALETTE: [Pigment; 35] = [
    ("sky_01", "#f6dfb4"),
    ("sky_02", "#f5e0b7"),
    ("sky_03", "#f4e0ba"),
    ("sky_04", "#f3e1bf"),
    ("sky_05", "#f0e1c2"),
    ("sky_06", "#ece0c6"),
    ("sky_07", "#e7dfc9"),
    ("sky_08", "#e2ddcc"),
    ("sky_09", "#dcdcce"),
    ("sky_10", "#d5d9d0"),
    ("sky_11", "#ced6d2"),
    ("sky_12", "#c6d2d3"),
    ("sky_13", "#becfd4"),
    ("sky_14", "#b7cad5"),
    ("sky_15", "#afc6d5"),
    ("sky_16", "#a7c1d5"),
    ("sky_17", "#9fbcd4"),
    ("sky_18", "#97b6d2"),
    ("sky_19", "#90b1d1"),
    ("sky_20", "#89abce"),
    ("sky_21", "#82a6cc"),
    ("sky_22", "#7ca1c9"),
    ("sky_23", "#769bc6"),
    ("sky_24", "#7197c2"),
    ("sky_25", "#6b92bf"),
    ("sky_26", "#668dbb"),
    ("cloud_1", "#b6b5c5"),
    ("cloud_2", "#c2bdc8"),
    ("cloud_3", "#cec6cb"),
    ("cloud_4", "#dacfcd"),
    ("cloud_5", "#e5d8ce"),
    ("cloud_6", "#efe1d0"),
    ("cloud_7", "#f6e9d2"),
    ("cloud_8", "#fbefd6"),
    ("cloud_9", "#fff5de"),
];

const BANDS: usize = 26;

/// How many tones the clouds have, from the belly to the crest. In the palette they follow the sky's.
const TONES: usize = 9;

/// How far back the sheet stands in its middle.
const DEPTH: f64 = 15.5;

/// A cloud: a flat sheet with a level foot and a billowing top.
struct Cloud {
    /// Middle of its foot: across, height.
    foot: [f64; 2],
    /// Half its width, and its greatest height.
    size: [f64; 2],
    /// How far it stands in front of the sky.
    before: f64,
    /// How many billows its outline has.
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
    mesh.round_to_thousandths();
    mesh
}

/// A point `before` units in front of the hollow sheet.
fn hollow(x: f64, y: f64, before: f64) -> DVec3 {
    DVec3::new(x, y, before - DEPTH + 0.006 * x * x)
}

fn sheet(mesh: &mut PolyMesh) {
    const COLUMNS: usize = 34;
    mesh.sheet(
        [COLUMNS, BANDS],
        |column, row| {
            let across = column as f64 / COLUMNS as f64 * 2.0 - 1.0;
            let up = row as f64 / BANDS as f64;
            let inner = (4.0 * up * (1.0 - up)).min(1.0);
            // The bands are wavy arches, highest left of the middle.
            let bow = 0.9 * (1.0 - (across + 0.45) * (across + 0.45)) - 0.4;
            let sway = 0.35 * noise(0.5 * across + 0.5, 2.2 * up, 9, 71);
            hollow(17.0 * across, 1.8 + 9.6 * up.powf(1.1) + (bow + sway) * inner, 0.0)
        },
        |_, row| Look { group: "sky", material: PALETTE[row].0 },
    );
}

fn cloud(mesh: &mut PolyMesh, cloud: &Cloud) {
    let ([foot_x, foot_y], [half, height]) = (cloud.foot, cloud.size);
    let columns = 24 + (12.0 * half) as usize;
    // A second line of billows, in front of those of the outline.
    let front = Cloud { seed: cloud.seed + 1, billows: cloud.billows + 2, ..*cloud };
    mesh.sheet(
        [columns, TONES],
        |column, row| {
            let across = column as f64 / columns as f64 * 2.0 - 1.0;
            let up = row as f64 / TONES as f64;
            let rim = (1.0 - across * across).max(0.0).sqrt();
            let under =
                0.05 * height * noise(0.5 * across + 0.5, 0.0, 7, cloud.seed + 1) - 0.10 * height * rim;
            // Borders between tones billow too: farther down they follow the billows in front.
            let crest = billow(across, cloud);
            let inner = 0.25 * crest + 0.75 * crest.min(billow(across - 0.05, &front));
            let top = (height * (inner + (crest - inner) * up * up)).max(under + 0.012);
            let roll = 0.22 * noise(0.5 * across + 0.5, 2.5 * up, 17, cloud.seed + 2) * up * (1.0 - up);
            let share = (up + roll).clamp(0.0, 1.0);
            hollow(foot_x + half * across, foot_y + under + (top - under) * share, cloud.before)
        },
        |_, row| Look { group: "clouds", material: PALETTE[BANDS + row].0 },
    );
}

/// The upper outline of a cloud at `across` (−1..=1), as a share of its height: the highest of overlapping billows.
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
    // The height falls to 0 at both ends of the cloud.
    rounds.fold(0.0, f64::max) * smoothstep(1.0, 0.86, across.abs()).sqrt()
}
