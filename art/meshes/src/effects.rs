//! Simple bodies with texture coordinates, made to be displaced by noise: a ball, a floor and a mushroom cloud.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::curve::Profile;
use super::poly_mesh::{Look, PolyMesh};

/// A ball of radius 0.5 about the origin.
pub fn ball() -> PolyMesh {
    const ROWS: usize = 40;
    const SEGMENTS: usize = 80;
    let about = "A smooth ball of radius 0.5 about the origin, with texture coordinates once round it.";
    let mut mesh = PolyMesh::new("ball", about, &[("clay", "#b9aa93")]);
    let point = |row: usize, segment: usize| {
        let (polar, angle) = (PI * row as f64 / ROWS as f64, TAU * segment as f64 / SEGMENTS as f64);
        0.5 * DVec3::new(polar.sin() * angle.cos(), polar.cos(), -polar.sin() * angle.sin())
    };
    let look = |_, _| Look { group: "ball", material: "clay" };
    mesh.lathe([ROWS, SEGMENTS], point, look);
    wrap(&mut mesh, [ROWS, SEGMENTS]);
    finished(mesh)
}

/// A square floor of side 4 on y = 0.
pub fn floor() -> PolyMesh {
    const CELLS: usize = 64;
    let about = "A square floor of side 4 on y = 0, with texture coordinates once over it.";
    let mut mesh = PolyMesh::new("floor", about, &[("stone", "#8f8678")]);
    let share = |at: usize| at as f64 / CELLS as f64;
    mesh.sheet(
        [CELLS, CELLS],
        |column, row| DVec3::new(share(column) - 0.5, 0.0, 0.5 - share(row)) * 4.0,
        |_, _| Look { group: "floor", material: "stone" },
    );
    for row in 0..CELLS {
        for column in 0..CELLS {
            let at = |right: usize, up: usize| DVec2::new(share(column + right), share(row + up));
            mesh.uvs.push(vec![at(0, 0), at(1, 0), at(1, 1), at(0, 1)]);
        }
    }
    finished(mesh)
}

/// A mushroom cloud that stands on y = 0, 1.6 high: a skirt, a stem and a cap that rolls under.
pub fn mushroom_cloud() -> PolyMesh {
    const SEGMENTS: usize = 72;
    let about = "A mushroom cloud on y = 0, 1.6 high, with texture coordinates once round it.";
    let mut mesh = PolyMesh::new("mushroom_cloud", about, &[("smoke", "#a89a8c")]);
    let outline = [
        [0.0, 1.60],
        [0.28, 1.56],
        [0.50, 1.44],
        [0.62, 1.24],
        [0.58, 1.06],
        [0.44, 0.98],
        [0.32, 1.02],
        [0.22, 0.98],
        [0.17, 0.80],
        [0.16, 0.50],
        [0.20, 0.28],
        [0.34, 0.16],
        [0.52, 0.10],
        [0.50, 0.02],
        [0.30, 0.0],
        [0.0, 0.0],
    ];
    let rows = Profile::through(&outline).spread(64, 0.35);
    let last = rows.len() - 1;
    let point = |row: usize, segment: usize| {
        let angle = TAU * segment as f64 / SEGMENTS as f64;
        DVec3::new(rows[row].x * angle.cos(), rows[row].y, -rows[row].x * angle.sin())
    };
    mesh.lathe([last, SEGMENTS], point, |_, _| Look { group: "cloud", material: "smoke" });
    wrap(&mut mesh, [last, SEGMENTS]);
    finished(mesh)
}

/// Texture coordinates of a lathe's faces: U once round, V up from one pole to the other.
fn wrap(mesh: &mut PolyMesh, [rows, segments]: [usize; 2]) {
    for row in 0..rows {
        for segment in 0..segments {
            let at = |right: usize, down: usize| {
                let down = row + down;
                // At a pole, U is that of the middle of the face.
                let pole = down == 0 || down == rows;
                let right = if pole { 0.5 } else { right as f64 };
                DVec2::new((segment as f64 + right) / segments as f64, 1.0 - down as f64 / rows as f64)
            };
            let mut corners = vec![at(0, 0), at(0, 1)];
            if row + 1 < rows {
                corners.push(at(1, 1));
            }
            if row > 0 {
                corners.push(at(1, 0));
            }
            mesh.uvs.push(corners);
        }
    }
}

fn finished(mut mesh: PolyMesh) -> PolyMesh {
    mesh.round_to(1e4);
    mesh.has_normals = true;
    mesh
}
