//! A plain ball.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::poly_mesh::{Look, PolyMesh};

/// A ball of radius 0.5 that lies on y = 0: 32 rows of 64 faces.
pub fn globe() -> PolyMesh {
    const ROWS: usize = 32;
    const SEGMENTS: usize = 64;
    const RADIUS: f64 = 0.5;
    let mut mesh = PolyMesh::new(
        "globe",
        "A smooth ball of radius 0.5 about (0, 0.5, 0), in one colour.",
        &[("ochre", "#c38a3f")],
    );
    mesh.lathe(
        [ROWS, SEGMENTS],
        |row, segment| {
            let (polar, angle) = (PI * row as f64 / ROWS as f64, TAU * segment as f64 / SEGMENTS as f64);
            let out = polar.sin();
            RADIUS * DVec3::new(out * angle.cos(), 1.0 + polar.cos(), -out * angle.sin())
        },
        |_, _| Look { group: "globe", material: "ochre" },
    );
    mesh.round_to(1e4);
    mesh
}
