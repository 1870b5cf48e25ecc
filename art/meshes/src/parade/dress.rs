//! What the giant wears about its head: hair, a paper crown, a ruff.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::skin::{MIDDLE, Mood, skin};
use crate::curve::smoothstep;
use crate::poly_mesh::{Look, PolyMesh};

/// Curly hair from temple to temple round the back; its origin is that of the face.
pub fn hair() -> PolyMesh {
    const COLUMNS: usize = 44;
    const ROWS: usize = 16;
    let mut mesh = PolyMesh::new("hair", "The giant's hair.", &[("hair", "#6b3a1f")]);
    mesh.sheet(
        [COLUMNS, ROWS],
        |column, row| {
            let (u, v) = (column as f64 / COLUMNS as f64, row as f64 / ROWS as f64);
            // Low on the head the hair begins behind the cheeks, higher up farther to the front.
            let front = 1.22 - 0.62 * smoothstep(0.50, 0.80, v);
            let side = front + (TAU - 2.0 * front) * u;
            let up = -0.62 + 2.0 * v;
            let curl = (10.0 * side).sin() * (8.0 * up + 1.5 * (5.0 * side).sin()).cos();
            let at = DVec2::new(if side > PI { side - TAU } else { side }, up);
            // Its rim sinks into the skin.
            let inside = smoothstep(0.0, 0.05, u.min(1.0 - u)) * smoothstep(0.0, 0.09, v.min(1.0 - v));
            skin(at, -0.008 + inside * (0.050 + 0.022 * curl), Mood::default())
        },
        |_, _| Look { group: "hair", material: "hair" },
    );
    mesh
}

/// A paper crown with a red band; its origin is that of the face.
pub fn crown() -> PolyMesh {
    const POINTS: usize = 9;
    const COLUMNS: usize = 6 * POINTS;
    const ROWS: usize = 4;
    let mut mesh =
        PolyMesh::new("crown", "The giant's crown.", &[("crown", "#f0c02f"), ("crown_band", "#c8402f")]);
    let point = |column: usize, row: usize| {
        let round = PI + TAU * (column % COLUMNS) as f64 / COLUMNS as f64;
        // Rows 0 and 1 bound the band; the others rise to the crown's points.
        let cut = (column * POINTS) as f64 / COLUMNS as f64;
        let zigzag = 1.0 - 2.0 * (cut - cut.round()).abs();
        let high = match row {
            0..2 => 0.050 * row as f64,
            row => 0.050 + (0.055 + 0.105 * zigzag) * (row - 1) as f64 / (ROWS - 1) as f64,
        };
        let wide = 0.247 + 0.34 * high;
        let tipped = 0.022 * round.cos();
        let at =
            MIDDLE + DVec3::new(wide * round.sin(), 0.212 + high + tipped, wide * 1.02 * round.cos() - 0.012);
        let out = DVec3::new(round.sin(), -0.2, round.cos()) * 0.006;
        [at + out, at - out]
    };
    mesh.blade([COLUMNS, ROWS], point, |_, row| Look {
        group: "crown",
        material: if row == 0 { "crown_band" } else { "crown" },
    });
    mesh
}

/// A pleated ruff; its origin is the joint of the neck.
pub fn ruff() -> PolyMesh {
    const PLEATS: f64 = 13.0;
    const COLUMNS: usize = 91;
    const ROWS: usize = 3;
    let mut mesh = PolyMesh::new("ruff", "The giant's ruff.", &[("ruff", "#f6f0e0")]);
    let point = |column: usize, row: usize| {
        let round = TAU * (column % COLUMNS) as f64 / COLUMNS as f64;
        let out = 1.0 - row as f64 / ROWS as f64;
        let wide = 0.075 + 0.165 * out;
        let high = 0.004 - 0.036 * out + 0.026 * (PLEATS * round).sin() * smoothstep(0.0, 0.6, out);
        let at = DVec3::new(wide * round.sin(), high, wide * 0.92 * round.cos() + 0.012);
        [at + DVec3::Y * 0.010, at - DVec3::Y * 0.010]
    };
    mesh.blade([COLUMNS, ROWS], point, |_, _| Look { group: "ruff", material: "ruff" });
    mesh
}
