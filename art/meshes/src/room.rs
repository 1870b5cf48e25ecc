//! What still lifes stand on and in front of: a table, a floor that curves up into a wall, a panel.

use std::f64::consts::FRAC_PI_2;

use glam::{DVec2, DVec3};

use super::curve::{bump, hash, smoothstep};
use super::poly_mesh::{Look, PolyMesh};

const BOARD: [&str; 5] = ["board_1", "board_2", "board_3", "board_4", "board_5"];

/// A table top of five boards, 3.2 by 1.5, its upper face at y = 0 so that things rest on it.
pub fn table() -> PolyMesh {
    const COLUMNS: usize = 28;
    const CELLS_PER_BOARD: usize = 3;
    const LENGTH: f64 = 3.2;
    const DEPTH: f64 = 1.5;
    const THICKNESS: f64 = 0.09;
    let mut mesh = PolyMesh::new(
        "table",
        "A table top of five boards; its upper face lies at y = 0, the boards run along X.",
        &[
            ("board_1", "#7b4c2b"),
            ("board_2", "#8a5630"),
            ("board_3", "#764526"),
            ("board_4", "#855334"),
            ("board_5", "#6f4226"),
        ],
    );
    // Half the size of a board's cross-section. Its long edges are rounded, so that light catches them.
    let half = DVec2::new(DEPTH / BOARD.len() as f64 / 2.0, THICKNESS / 2.0);
    for (index, board) in BOARD.into_iter().enumerate() {
        let middle_z = DEPTH * ((index as f64 + 0.5) / BOARD.len() as f64 - 0.5);
        let overhang = 0.03 * hash([index as u32, 0, 77]);
        let tilt = 0.002 * hash([index as u32, 1, 77]);
        let section = rounded_section(half, 0.016, CELLS_PER_BOARD);
        // `lathe` takes segments that turn counter-clockwise as seen from the first pole. The section does so as seen
        // from +X, so the first pole is the end at +X.
        mesh.lathe(
            [COLUMNS + 2, section.len()],
            |row, side| {
                let step = row.saturating_sub(1).min(COLUMNS) as f64 / COLUMNS as f64;
                let x = LENGTH / 2.0 + overhang - step * LENGTH;
                let end = row == 0 || row == COLUMNS + 2;
                let point = if end { DVec2::ZERO } else { section[side % section.len()] };
                DVec3::new(x, point.y - half.y + tilt * point.x / half.x, middle_z - point.x)
            },
            |_, _| Look { group: "top", material: board },
        );
    }
    mesh
}

/// The outline of a rectangle with rounded corners, counter-clockwise, its long sides in `cells` steps.
fn rounded_section(half: DVec2, corner: f64, cells: usize) -> Vec<DVec2> {
    let mut points = Vec::new();
    for (side, sign) in [(1.0, -1.0), (-1.0, 1.0)] {
        let y = side * half.y;
        let long = half.x - corner;
        points.extend((0..=cells).map(|cell| {
            let t = cell as f64 / cells as f64 * 2.0 - 1.0;
            DVec2::new(sign * t * long, y)
        }));
        let inset = corner * (1.0 - std::f64::consts::FRAC_1_SQRT_2);
        let x = sign * half.x;
        points.push(DVec2::new(x - sign * inset, y - side * inset));
        points.push(DVec2::new(x, y - side * corner));
        points.push(DVec2::new(x, -y + side * corner));
        points.push(DVec2::new(x - sign * inset, -y + side * inset));
    }
    points
}

/// A backdrop: a floor at y = 0 that curves up into a wall, which is a little hollow towards the viewer. The wall
/// stands at z = −1 in the middle; the floor reaches to z = 5.
pub fn wall() -> PolyMesh {
    const COLUMNS: usize = 40;
    const ROWS: usize = 44;
    const BEND: f64 = 0.9;
    const FLOOR: f64 = 5.1;
    const HEIGHT: f64 = 5.0;
    let mut mesh = PolyMesh::new(
        "wall",
        "A floor at y = 0 that curves up into a wall; open at its edges.",
        &[("floor", "#6d6257"), ("wall", "#66604f")],
    );
    let lengths = [FLOOR, BEND * FRAC_PI_2, HEIGHT];
    let total: f64 = lengths.iter().sum();
    mesh.sheet(
        [COLUMNS, ROWS],
        |column, row| {
            let across = column as f64 / COLUMNS as f64 * 2.0 - 1.0;
            let along = row as f64 / ROWS as f64 * total;
            let past_floor = along - lengths[0];
            let (z, y) = if past_floor <= 0.0 {
                (-past_floor, 0.0)
            } else if past_floor < lengths[1] {
                let angle = past_floor / BEND;
                (-BEND * angle.sin(), BEND * (1.0 - angle.cos()))
            } else {
                (-BEND, BEND + past_floor - lengths[1])
            };
            let hollow = 0.6 * across * across * smoothstep(0.5, -0.9, z);
            let uneven = 0.012 * (3.0 * across + 1.7 * y).sin() * smoothstep(0.2, 0.8, y);
            DVec3::new(5.0 * across, y, z - 0.1 + hollow + uneven)
        },
        |_, row| {
            let floor = (row as f64 + 0.5) / ROWS as f64 * total < lengths[0];
            let name = if floor { "floor" } else { "wall" };
            Look { group: name, material: name }
        },
    );
    mesh
}

/// A thin panel one unit wide and one high, standing on its edge, facing +Z; its rim is a little thicker, like a
/// stretched canvas.
pub fn plane() -> PolyMesh {
    const CELLS: usize = 20;
    let mut mesh = PolyMesh::new(
        "plane",
        "A panel of 1 by 1, standing on y = 0, facing +Z.",
        &[("panel", "#9a8f7a"), ("rim", "#6a5a45")],
    );
    mesh.blade(
        [CELLS, CELLS],
        |column, row| {
            let across = column as f64 / CELLS as f64;
            let up = row as f64 / CELLS as f64;
            // The outermost cells are the rim: they are made narrower, 0.015 wide.
            let squeeze = |t: f64| if t > 0.0 && t < 1.0 { 0.015 + 0.97 * (t - 0.05) / 0.9 } else { t };
            let (across, up) = (squeeze(across), squeeze(up));
            let edge = bump(0.0, 0.1, across.min(1.0 - across).min(up).min(1.0 - up).max(0.0));
            let thick = 0.012 + 0.006 * edge;
            let middle = DVec3::new(across - 0.5, up, 0.0);
            [middle + DVec3::Z * thick, middle - DVec3::Z * thick]
        },
        |column, row| {
            let rim = column == 0 || row == 0 || column == CELLS - 1 || row == CELLS - 1;
            Look { group: "panel", material: if rim { "rim" } else { "panel" } }
        },
    );
    mesh
}
