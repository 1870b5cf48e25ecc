//! Makes the meshes of an explosion: billows of fire, billows of smoke round them, and splinters that fly off.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};

use super::curve::hash;
use super::poly_mesh::{Look, Pigment, PolyMesh};
use super::surface_net::{Grid, tighten, weave};

/// A ball; many of them, melted together, make a billow of fire or smoke.
#[derive(Clone, Copy)]
struct Lobe {
    middle: DVec3,
    radius: f64,
}

/// The middle of the blast.
const HEART: DVec3 = DVec3::new(0.0, 0.55, 0.0);

/// The fire.
pub fn blast_fire() -> PolyMesh {
    let mut lobes = vec![Lobe { middle: HEART, radius: 0.45 }];
    lobes.extend((0..34).map(|index| {
        let out = golden(index, 34) * DVec3::new(1.0, 0.95, 0.9);
        let radius = 0.13 + 0.10 * hash([index, 1, 5]).abs();
        Lobe { middle: HEART + out * (0.46 + 0.09 * hash([index, 2, 5])), radius }
    }));
    lobes.extend((0..9).map(|index| {
        let angle = TAU * (f64::from(index) + 0.3 * hash([index, 3, 5])) / 9.0;
        let middle = DVec3::new(0.5 * angle.cos(), 0.12, 0.4 * angle.sin());
        Lobe { middle, radius: 0.15 + 0.05 * hash([index, 4, 5]) }
    }));
    billow("blast_fire", "Billows of fire; the ground is at y = 0.", &[("fire", "#f0a03c")], &lobes)
}

/// The smoke: a crown that is open below, and open to the front, where the fire shows.
pub fn blast_smoke() -> PolyMesh {
    let mut lobes = Vec::new();
    for index in 0..64 {
        let way = golden(index, 64);
        let out = way * DVec3::new(0.92, 0.86, 0.6);
        let is_open = way.z > 0.25 && way.y < 0.72 || way.y < -0.25;
        if is_open {
            continue;
        }
        let radius = 0.17 + 0.15 * hash([index, 1, 9]).abs();
        let reach = 0.78 + 0.16 * hash([index, 2, 9]);
        lobes.push(Lobe { middle: HEART + DVec3::new(0.0, 0.22, -0.12) + out * reach, radius });
    }
    billow("blast_smoke", "Billows of smoke, open to +Z.", &[("smoke", "#4a4038")], &lobes)
}

/// Splinters that fly off, thin and long.
pub fn blast_sparks() -> PolyMesh {
    const SPARKS: u32 = 70;
    let about = "Splinters that fly off a blast; each is a thin body of its own.";
    let mut mesh = PolyMesh::new("blast_sparks", about, &[("ember", "#ffb54a")]);
    for index in 0..SPARKS {
        let way = golden(index, SPARKS);
        // None flies towards the viewer.
        if way.z > 0.45 {
            continue;
        }
        let way = DVec3::new(way.x, way.y.abs() * 1.1 + 0.05, way.z * 0.7).normalize();
        let reach = 1.02 + 0.5 * hash([index, 1, 3]).abs();
        let (long, wide) = (0.03 + 0.05 * hash([index, 2, 3]).abs(), 0.009 + 0.005 * hash([index, 3, 3]));
        let turn = DQuat::from_rotation_arc(DVec3::Y, way);
        mesh.lathe(
            [3, 5],
            |row, segment| {
                let angle = TAU * segment as f64 / 5.0;
                let out = if row == 0 || row == 3 { 0.0 } else { wide };
                let along = [1.0, 0.3, -0.5, -1.6][row] * long;
                HEART + way * reach + turn * DVec3::new(out * angle.cos(), along, -out * angle.sin())
            },
            |_, _| Look { group: "sparks", material: "ember" },
        );
    }
    mesh.round_to(1e4);
    mesh
}

/// The direction with this index, of `count` directions that are spread evenly over a ball.
fn golden(index: u32, count: u32) -> DVec3 {
    let y = 1.0 - 2.0 * (f64::from(index) + 0.5) / f64::from(count);
    let angle = f64::from(index) * 2.399_963_229_7;
    let out = (1.0 - y * y).sqrt();
    DVec3::new(out * angle.cos(), y, out * angle.sin())
}

/// A mesh of lobes that are melted together and cut off at the ground.
fn billow(name: &'static str, about: &'static str, palette: &'static [Pigment], lobes: &[Lobe]) -> PolyMesh {
    const MELT: f64 = 0.018;
    let mut mesh = PolyMesh::new(name, about, palette);
    let field = |point: DVec3| {
        // The smooth minimum of the distances to all lobes.
        let sum: f64 =
            lobes.iter().map(|lobe| (-((point - lobe.middle).length() - lobe.radius) / MELT).exp()).sum();
        let body = -MELT * sum.max(1e-300).ln();
        body.max(0.02 - point.y)
    };
    let grid = Grid {
        low: DVec3::new(-1.45, -0.06, -1.1),
        high: DVec3::new(1.45, 2.05, 1.1),
        cell: DVec3::splat(0.042),
    };
    let points = weave(&mut mesh, &grid, field, Look { group: palette[0].0, material: palette[0].0 });
    tighten(&mut mesh, points, field, 3);
    mesh.round_to(1e4);
    mesh.has_normals = true;
    mesh
}
