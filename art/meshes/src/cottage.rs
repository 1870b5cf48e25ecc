//! Makes the mesh of the landscape's cottage: limewashed walls under a sagging tiled roof, a lean-to, a chimney.

use glam::{DMat3, DVec3};

use super::blocks::{Block, add_block};
use super::curve::{hash, noise};
use super::poly_mesh::{Look, PolyMesh};

const LENGTH: f64 = 1.7;
const DEPTH: f64 = 1.0;
const EAVES: f64 = 0.82;
const RIDGE: f64 = 1.46;

/// A cottage of 1.7 by 1 without its lean-to, 1.86 high at the top of the chimney. Its door looks towards +Z, its ridge
/// runs along X.
pub fn cottage() -> PolyMesh {
    let mut mesh = PolyMesh::new(
        "cottage",
        "A cottage with a tiled roof, a lean-to at +X and a chimney; its door looks towards +Z.",
        &[
            ("wall", "#f3e3c3"),
            ("wall_warm", "#ead3a8"),
            ("plinth", "#b79c7c"),
            ("tile_1", "#bd5636"),
            ("tile_2", "#a84a30"),
            ("tile_3", "#cd6c42"),
            ("tile_4", "#98432f"),
            ("brick", "#a4583d"),
            ("brick_dark", "#74402f"),
            ("door", "#3f6a72"),
            ("shutter", "#5b8b92"),
            ("glass", "#3b3c48"),
            ("beam", "#7a5a42"),
        ],
    );
    walls(&mut mesh, [LENGTH, DEPTH, EAVES, RIDGE], 0.0);
    walls(&mut mesh, [0.7, 0.74, 0.50, 0.88], 1.12);
    for slope in [1.0, -1.0] {
        roof(&mut mesh, [LENGTH, DEPTH, EAVES, RIDGE], 0.0, slope);
        roof(&mut mesh, [0.7, 0.74, 0.50, 0.88], 1.12, slope);
    }
    fittings(&mut mesh);
    mesh
}

/// A house body, a prism with gables, with its middle at X = `middle`.
fn walls(mesh: &mut PolyMesh, [length, depth, eaves, ridge]: [f64; 4], middle: f64) {
    const COLUMNS: usize = 14;
    // The outline of a gable, counter-clockwise seen from +X (Z to the left): foot, eaves, ridge, with rows between.
    let mut outline = Vec::new();
    let half = depth / 2.0;
    let levels = [-0.3, 0.02, 0.16, 0.40, 0.66, 1.0];
    outline.extend(levels.iter().map(|level| [-half, level * eaves]));
    outline.push([-half * 0.5, 0.5 * (eaves + ridge)]);
    outline.push([0.0, ridge]);
    outline.push([half * 0.5, 0.5 * (eaves + ridge)]);
    outline.extend(levels.iter().rev().map(|level| [half, level * eaves]));
    let sides = outline.len();
    let material = |side: usize| match side {
        0..2 | 12..14 => "plinth",
        2 | 11 => "wall_warm",
        _ => "wall",
    };
    // The gables are closed by fans towards their middle.
    mesh.lathe(
        [COLUMNS + 2, sides],
        |row, side| {
            let step = row.saturating_sub(1).min(COLUMNS) as f64 / COLUMNS as f64;
            let x = middle + length / 2.0 - step * length;
            if row == 0 || row == COLUMNS + 2 {
                return DVec3::new(x, eaves * 0.6, 0.0);
            }
            let [z, y] = outline[side % sides];
            let uneven = 0.008 * noise(step, 2.0 * y, 7, 91) * f64::from(u8::from(y < eaves));
            DVec3::new(x, y, z + uneven)
        },
        |row, side| {
            let gable = row == 0 || row == COLUMNS + 1;
            Look { group: "walls", material: if gable { "wall" } else { material(side) } }
        },
    );
}

/// One slope of a roof: a slab that overhangs the walls and sags, tiled in courses.
fn roof(mesh: &mut PolyMesh, [length, depth, eaves, ridge]: [f64; 4], middle: f64, slope: f64) {
    const COLUMNS: usize = 18;
    const ROWS: usize = 10;
    const OVER: f64 = 0.10;
    let fall = (ridge - eaves) / (depth / 2.0);
    let seed = (middle * 10.0) as u32 + u32::from(slope > 0.0);
    mesh.blade(
        [COLUMNS, ROWS],
        |column, row| {
            let across = column as f64 / COLUMNS as f64 * 2.0 - 1.0;
            let up = row as f64 / ROWS as f64;
            let out = (depth / 2.0 + 0.13) * (1.0 - up) - 0.012;
            let sag = -0.040 * (1.0 - across * across) * (0.4 + 0.6 * up) - 0.02 * up * (1.0 - up) * 4.0;
            let uneven = 0.010 * noise(0.5 + 0.5 * across, 4.0 * up, 9, 95 + seed);
            let upturn = 0.05 * (1.0 - up).powi(4);
            let y = ridge + 0.05 - fall * out + sag + uneven + upturn;
            let x = middle + slope * across * (length / 2.0 + OVER);
            let point = DVec3::new(x, y, slope * out);
            let normal = DVec3::new(0.0, 1.0, slope * fall).normalize();
            [point + normal * 0.035, point - normal * 0.035]
        },
        |column, row| {
            // Patches of older and newer tiles, two courses high.
            let plot = (column + 2 * (row / 2)) / 3;
            let material = match hash([plot as u32, row as u32 / 2, 7 + seed]) {
                chance if chance < -0.5 => "tile_2",
                chance if chance < 0.3 => "tile_1",
                chance if chance < 0.75 => "tile_3",
                _ => "tile_4",
            };
            Look { group: "roof", material }
        },
    );
}

/// Door, windows, shutters, beams and chimney.
fn fittings(mesh: &mut PolyMesh) {
    let front = DEPTH / 2.0;
    let left = -LENGTH / 2.0;
    // Each block has a group, a material, a centre and half a size.
    let parts = [
        ("door", "door", [0.20, 0.28, front], [0.125, 0.28, 0.025]),
        ("door", "beam", [0.20, 0.58, front], [0.17, 0.03, 0.035]),
        ("door", "plinth", [0.20, 0.015, front + 0.08], [0.20, 0.03, 0.10]),
        ("window", "glass", [-0.42, 0.45, front], [0.095, 0.115, 0.018]),
        ("window", "shutter", [-0.575, 0.45, front], [0.055, 0.13, 0.028]),
        ("window", "shutter", [-0.265, 0.45, front], [0.055, 0.13, 0.028]),
        ("window", "beam", [-0.42, 0.315, front], [0.13, 0.020, 0.040]),
        ("window", "glass", [0.60, 0.47, front], [0.080, 0.090, 0.018]),
        ("window", "shutter", [0.725, 0.47, front], [0.042, 0.10, 0.028]),
        ("window", "shutter", [0.475, 0.47, front], [0.042, 0.10, 0.028]),
        ("window", "glass", [left, 0.45, 0.05], [0.018, 0.115, 0.095]),
        ("window", "glass", [left, 0.98, 0.0], [0.018, 0.080, 0.065]),
        ("window", "door", [1.16, 0.20, 0.37], [0.13, 0.22, 0.025]),
        ("chimney", "brick", [-0.52, 1.48, -0.06], [0.105, 0.26, 0.095]),
        ("chimney", "brick_dark", [-0.52, 1.735, -0.06], [0.130, 0.030, 0.120]),
        ("chimney", "brick", [-0.52, 1.80, -0.06], [0.055, 0.060, 0.055]),
    ];
    for (group, material, centre, half) in parts {
        let half = DVec3::from_array(half);
        add_block(
            mesh,
            &Block {
                half,
                cells: [4, 4, 3],
                rounding: 0.15 * half.min_element(),
                turn: DMat3::IDENTITY,
                centre: DVec3::from_array(centre),
                look: Look { group, material },
            },
        );
    }
}
