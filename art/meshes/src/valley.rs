//! The landscape's ground: a meadow with a river bed and a path, and the river's water.

use glam::DVec3;

use super::curve::{Profile, bump, noise, smoothstep};
use super::poly_mesh::{Look, Pigment, PolyMesh};

/// The river's middle, from the viewer to the hills: −z, and the river's x there.
const RIVER: [[f64; 2]; 11] = [
    [-8.0, -2.6],
    [-6.0, -1.9],
    [-4.2, -1.2],
    [-2.4, -0.55],
    [-0.8, -0.15],
    [0.8, -0.45],
    [2.2, -1.45],
    [3.6, -2.3],
    [5.2, -1.6],
    [7.0, 0.2],
    [10.0, 2.2],
];

/// The path's middle, in the same form: −z, and the path's x there. The path ends at the cottage's door (`PATH_END`);
/// beyond it, the curve only guides the ground's columns.
const PATH: [[f64; 2]; 8] = [
    [-8.0, 0.9],
    [-6.0, 1.1],
    [-4.2, 1.65],
    [-2.4, 1.95],
    [-0.8, 1.75],
    [0.6, 1.75],
    [1.7, 2.3],
    [10.0, 5.5],
];

/// −z where the path ends.
const PATH_END: f64 = 1.55;

/// Z of the ground's edge at the viewer, and of its edge at the hills.
const NEAR: f64 = 7.8;
const FAR: f64 = -9.6;

const GROUND: [Pigment; 16] = [
    ("grass_near", "#5d7534"),
    ("grass_near_warm", "#73803a"),
    ("meadow_1", "#86994a"),
    ("meadow_2", "#9da651"),
    ("meadow_3", "#b5ac58"),
    ("meadow_4", "#7f9650"),
    ("meadow_5", "#a9b266"),
    ("field_1", "#c9b468"),
    ("field_2", "#a2ab62"),
    ("field_3", "#bfb673"),
    ("field_4", "#97a86c"),
    ("bank", "#8a6f48"),
    ("bank_grass", "#5f7a3b"),
    ("path", "#d8b888"),
    ("path_edge", "#b3925f"),
    ("bed", "#5a5340"),
];

/// The curves that the columns of the ground follow.
struct Plan {
    river: Profile,
    path: Profile,
}

impl Plan {
    fn new() -> Self {
        Self { river: Profile::through(&RIVER), path: Profile::through(&PATH) }
    }

    /// X of the left and the right shore at a z. The shores are farther apart where the river runs at a slant.
    fn shores(&self, z: f64) -> [f64; 2] {
        let slope = (self.river.height_at(-z + 0.1) - self.river.height_at(-z - 0.1)) / 0.2;
        let width = 0.36 + 0.030 * (z + 2.0).max(0.0) + 0.08 * (1.3 * z).sin();
        let half = width * (1.0 + slope * slope).sqrt().min(2.0);
        let middle = self.river.height_at(-z);
        [middle - half, middle + half]
    }

    /// X of the path's left and right edge at a z. At the door the path tapers to almost nothing.
    fn path_edges(&self, z: f64) -> [f64; 2] {
        let half =
            0.02 + (0.15 + 0.010 * (z + 2.0).max(0.0)) * smoothstep(PATH_END + 0.1, PATH_END - 0.3, -z);
        let middle = self.path.height_at(-z);
        [middle - half, middle + half]
    }

    /// Height of the ground; the water lies at 0.
    fn height(&self, x: f64, z: f64) -> f64 {
        let [left, right] = self.shores(z);
        let from_water = (left - x).max(x - right);
        let rolling = 0.07 * (0.9 * x + 0.5 * z).sin() + 0.05 * (1.7 * x - 0.8 * z + 1.0).sin();
        let sides = 0.75 * smoothstep(2.2, 8.5, x) + 0.55 * smoothstep(-2.0, -8.0, x);
        let knoll = 0.16 * bump(2.3, 2.2, x) * bump(-2.2, 3.0, z);
        let land = 0.20 + rolling + sides + knoll + 0.012 * noise(0.05 * x, 1.5 * z, 30, 61);
        let shore = smoothstep(-0.02, 0.75, from_water);
        let lip = 0.09 * smoothstep(-0.02, 0.10, from_water);
        (land * shore + lip * (1.0 - shore)) - 0.22 * smoothstep(0.0, -0.2, from_water)
    }
}

/// How many columns lie between one seam and the next. The spans between seams are: land, bank, bed, bank, land, edge
/// of the path, path, edge of the path, land.
const SPANS: [usize; 9] = [16, 2, 5, 2, 9, 1, 3, 1, 16];

/// The meadow, an open mesh. Banks, river bed and path follow its columns, so that their borders are smooth.
pub fn valley() -> PolyMesh {
    const ROWS: usize = 70;
    let mut mesh =
        PolyMesh::new("valley", "A meadow with a river bed and a path; open at its edges.", &GROUND);
    let plan = Plan::new();
    let columns = SPANS.iter().sum();
    mesh.sheet(
        [columns, ROWS],
        |column, row| {
            let (span, share) = span_at(column);
            let z = row_z(row, ROWS, column as f64 / columns as f64);
            let seams = seams(&plan, z);
            // In the two outer spans, columns grow wider outwards.
            let share = match span {
                0 => 1.0 - (1.0 - share).powf(1.5),
                8 => share.powf(1.5),
                _ => share,
            };
            let x = seams[span] + (seams[span + 1] - seams[span]) * share;
            DVec3::new(x, plan.height(x, z), z)
        },
        |column, row| {
            let (span, _) = span_at(column);
            let far = (row as f64 + 0.5) / ROWS as f64;
            ground_look(span, far, NEAR + (FAR - NEAR) * far.powf(0.85))
        },
    );
    mesh.round_to_thousandths();
    mesh
}

/// Z of a row where it is at `across`, 0..1, of the ground's width. Rows sway, so that the borders of colours, which
/// follow rows, are not straight.
fn row_z(row: usize, rows: usize, across: f64) -> f64 {
    let far = row as f64 / rows as f64;
    let sway = (0.55 * (9.0 * across + 5.0 * far).sin() + 0.3 * (23.0 * across + 2.0).sin())
        * (4.0 * far * (1.0 - far));
    NEAR + (FAR - NEAR) * far.powf(0.85) + sway
}

/// The span that a column is in, and how far across that span the column is, 0..1.
fn span_at(column: usize) -> (usize, f64) {
    let mut left = column;
    for (span, &count) in SPANS.iter().enumerate() {
        if left < count {
            return (span, left as f64 / count as f64);
        }
        left -= count;
    }
    (SPANS.len() - 1, 1.0)
}

/// X of the ten seams at a z.
fn seams(plan: &Plan, z: f64) -> [f64; 10] {
    let [left, right] = plan.shores(z);
    let [from, to] = plan.path_edges(z);
    let edge = 2.6 + 0.66 * (9.0 - z);
    let rim = 0.25 * (to - from);
    let bank = 0.20 + 0.08 * (2.1 * z).sin();
    // Where the river runs close to the path, its bank is squeezed.
    let right_bank = (right + bank).min(0.5 * (right + from));
    [-edge, left - bank, left, right, right_bank, from, from + rim, to - rim, to, edge.max(to + 1.0)]
}

fn ground_look(span: usize, far: f64, z: f64) -> Look {
    let side = match span {
        1 | 3 => return Look { group: "bank", material: if far < 0.3 { "bank" } else { "bank_grass" } },
        2 => return Look { group: "bank", material: "bed" },
        5 | 7 if -z < PATH_END => return Look { group: "path", material: "path_edge" },
        6 if -z < PATH_END => return Look { group: "path", material: "path" },
        0 => 0,
        4 => 1,
        _ => 2,
    };
    if far < 0.32 {
        let warm = (0.10..0.16).contains(&far) || far > 0.25;
        return Look { group: "grass", material: if warm { "grass_near_warm" } else { "grass_near" } };
    }
    const MEADOW: [&str; 5] = ["meadow_1", "meadow_2", "meadow_3", "meadow_4", "meadow_5"];
    const FIELD: [&str; 4] = ["field_1", "field_2", "field_3", "field_4"];
    let band = ((far - 0.32) * 20.0) as usize;
    if far < 0.72 {
        Look { group: "meadow", material: MEADOW[(band * 2 + side) % 5] }
    } else {
        Look { group: "fields", material: FIELD[(band + 2 * side) % 4] }
    }
}

const WATER: [Pigment; 5] = [
    ("water_light", "#e9dcc0"),
    ("water", "#bccbd2"),
    ("water_blue", "#93afc4"),
    ("water_green", "#6f8467"),
    ("water_dark", "#4d6450"),
];

/// The water at y = 0, in streaks along the river. They are dark under the left bank, where the trees stand, and light
/// at the right bank. The mesh is open, and to be shown unlit.
pub fn water() -> PolyMesh {
    const COLUMNS: usize = 14;
    const ROWS: usize = 90;
    let mut mesh = PolyMesh::new("water", "The river's water, in streaks along it; open.", &WATER);
    let plan = Plan::new();
    mesh.sheet(
        [COLUMNS, ROWS],
        |column, row| {
            let far = row as f64 / ROWS as f64;
            let z = NEAR + (FAR - NEAR) * far.powf(0.85);
            let [left, right] = plan.shores(z);
            let across = column as f64 / COLUMNS as f64;
            let inner = 4.0 * across * (1.0 - across);
            let sway = 0.16 * (1.9 * z).sin() + 0.08 * (5.3 * z + 9.0 * across).sin();
            let across = -0.1 + 1.2 * (across + 0.5 * sway * inner);
            DVec3::new(left + (right - left) * across, 0.0, z)
        },
        |column, _| {
            let material = match column {
                0..2 => "water_dark",
                2..4 => "water_green",
                4..6 => "water_blue",
                6..8 => "water",
                8..12 => "water_light",
                _ => "water",
            };
            Look { group: "water", material }
        },
    );
    mesh.round_to_thousandths();
    mesh
}
