//! The landscape's hills: four ranges behind each other, cooler and lighter with distance.

use glam::DVec3;

use super::curve::{Profile, noise, smoothstep};
use super::poly_mesh::{Look, Pigment, PolyMesh};

const PALETTE: [Pigment; 16] = [
    ("near_1", "#7f9150"),
    ("near_2", "#97a25a"),
    ("near_3", "#5f7a4a"),
    ("near_4", "#aea65f"),
    ("middle_1", "#7d9a86"),
    ("middle_2", "#93aa90"),
    ("middle_3", "#658a85"),
    ("middle_4", "#a6b094"),
    ("blue_1", "#7899b8"),
    ("blue_2", "#88a6bc"),
    ("blue_3", "#688ab0"),
    ("blue_4", "#8faabb"),
    ("far_1", "#86a6da"),
    ("far_2", "#8fadda"),
    ("far_3", "#7d9fd7"),
    ("far_4", "#97b3dd"),
];

/// A range of hills. Its foot stands at z = `foot`, its ridge at z = `foot` − `deep`.
struct Range {
    group: &'static str,
    /// Where its four colours begin in the palette.
    colors: usize,
    /// X and height of the ridge.
    ridge: &'static [[f64; 2]],
    foot: f64,
    deep: f64,
    roughness: f64,
    seed: u32,
}

const NEAR: [[f64; 2]; 9] = [
    [-13.0, 2.2],
    [-9.0, 1.9],
    [-6.0, 1.35],
    [-3.5, 0.75],
    [-0.5, 0.42],
    [2.0, 0.60],
    [5.0, 1.25],
    [8.5, 1.75],
    [13.0, 1.6],
];
const MIDDLE: [[f64; 2]; 9] = [
    [-14.0, 2.3],
    [-10.0, 2.7],
    [-6.5, 2.35],
    [-3.0, 1.55],
    [0.0, 1.15],
    [3.5, 1.70],
    [6.5, 2.45],
    [10.0, 2.3],
    [14.0, 2.6],
];
const BLUE: [[f64; 2]; 9] = [
    [-15.0, 3.3],
    [-11.0, 3.0],
    [-7.5, 3.25],
    [-4.5, 2.75],
    [-1.0, 2.0],
    [2.5, 2.15],
    [6.0, 2.75],
    [10.5, 3.1],
    [15.0, 2.7],
];
const FARTHEST: [[f64; 2]; 9] = [
    [-16.0, 3.2],
    [-11.0, 3.7],
    [-6.0, 3.3],
    [-2.5, 3.25],
    [0.5, 3.75],
    [3.0, 3.3],
    [7.0, 2.9],
    [11.5, 3.4],
    [16.0, 3.1],
];

/// Four ranges, groups `near`, `middle`, `blue` and `far`; open at their feet and behind.
pub fn hills() -> PolyMesh {
    let mut mesh = PolyMesh::new("hills", "Four ranges of hills behind each other; open behind.", &PALETTE);
    let ranges = [
        Range { group: "near", colors: 0, ridge: &NEAR, foot: -7.6, deep: 2.4, roughness: 0.10, seed: 81 },
        Range {
            group: "middle",
            colors: 4,
            ridge: &MIDDLE,
            foot: -9.0,
            deep: 2.4,
            roughness: 0.14,
            seed: 82,
        },
        Range { group: "blue", colors: 8, ridge: &BLUE, foot: -10.8, deep: 2.0, roughness: 0.16, seed: 83 },
        Range {
            group: "far",
            colors: 12,
            ridge: &FARTHEST,
            foot: -12.4,
            deep: 1.6,
            roughness: 0.20,
            seed: 84,
        },
    ];
    for range in &ranges {
        add_range(&mut mesh, range);
    }
    mesh.round_to_thousandths();
    mesh
}

fn add_range(mesh: &mut PolyMesh, range: &Range) {
    const COLUMNS: usize = 64;
    const ROWS: usize = 14;
    let ridge = Profile::through(range.ridge);
    let (first, last) = (range.ridge[0][0], range.ridge[range.ridge.len() - 1][0]);
    mesh.sheet(
        [COLUMNS, ROWS],
        |column, row| {
            let across = column as f64 / COLUMNS as f64;
            let up = row as f64 / ROWS as f64;
            let inner = 4.0 * up * (1.0 - up);
            // Rows and columns slant and sway, so that the borders of fields and woods, which follow them, are not
            // straight.
            let slant = 0.03 * inner * (9.0 * across + 3.0 * up + f64::from(range.seed)).sin();
            let sway = 0.055 * inner * noise(across, 2.0 * up, 9, range.seed + 9);
            let x = first + (last - first) * (across + slant).clamp(0.0, 1.0);
            let along = (up + sway).max(0.0);
            let top = ridge.height_at(x) + 0.5;
            let rise = smoothstep(-0.25, 1.0, along) - smoothstep(-0.25, 1.0, 0.0);
            let rise = rise / (1.0 - smoothstep(-0.25, 1.0, 0.0));
            let folds = range.roughness
                * (noise(0.5 * across, 1.5 * along, 30, range.seed)
                    + 0.6 * noise(across, 2.5 * along, 31, range.seed + 4));
            let spurs = range.roughness * 1.6 * ((1.1 * x + f64::from(range.seed)).sin() * inner);
            let y = -0.5 + top * rise * (1.0 + 0.3 * folds);
            DVec3::new(x, y, range.foot - range.deep * along + spurs)
        },
        |column, row| {
            // A patchwork of plots: each is some columns wide, and each row of plots is shifted against the next.
            let tier = row / 3;
            let plot = (column + 2 * tier + tier * tier % 5) / (5 + tier % 3);
            let chance = super::curve::hash([plot as u32, tier as u32, range.seed]);
            let pick = match chance {
                chance if chance < -0.45 => 2,
                chance if chance < 0.15 => 0,
                chance if chance < 0.65 => 1,
                _ => 3,
            };
            Look { group: range.group, material: PALETTE[range.colors + pick].0 }
        },
    );
}
