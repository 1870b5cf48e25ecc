//! Where the parade passes: paving, two house fronts, a low wall, a garland of pennants, the flag's mast.

use std::f64::consts::TAU;

use glam::DVec3;

use super::flag::MAST;
use crate::curve::hash;
use crate::poly_mesh::{Face, Look, PolyMesh};

/// Paving, its slabs of a few tones.
pub fn paving() -> PolyMesh {
    const SLABS: [usize; 2] = [24, 17];
    let mut mesh = PolyMesh::new(
        "paving",
        "The square's paving.",
        &[("paving", "#cdb896"), ("paving_light", "#d8c5a4"), ("paving_dark", "#bea783")],
    );
    let place =
        |column: usize, row: usize| DVec3::new(column as f64 * 0.8 - 9.6, 0.0, 7.0 - row as f64 * 0.8);
    mesh.sheet(SLABS, place, |column, row| {
        let tone = hash([column as u32, row as u32, 3]);
        let material = match tone {
            tone if tone > 0.35 => "paving_light",
            tone if tone < -0.35 => "paving_dark",
            _ => "paving",
        };
        Look { group: "paving", material }
    });
    mesh
}

/// A house front that faces +Z: its width and height, the lower left corners of its windows, the material of its wall.
struct Front {
    size: [f64; 2],
    windows: &'static [[f64; 2]],
    wall: &'static str,
}

/// Both house fronts. They stand on y = 0, and their walls meet the street at z = 0.
pub fn houses() -> [PolyMesh; 2] {
    let mut left = PolyMesh::new(
        "house_left",
        "A house front.",
        &[("wall_cream", "#efd8a4"), ("trim", "#fbf3df"), ("pane", "#51707f"), ("shutter", "#2f7d78")],
    );
    let rows: &[[f64; 2]] = &[[0.55, 0.85], [2.05, 0.85]];
    front(&mut left, &Front { size: [3.3, 2.15], windows: rows, wall: "wall_cream" });
    let mut right = PolyMesh::new(
        "house_right",
        "A house front.",
        &[
            ("wall_rose", "#ecb79a"),
            ("trim", "#fbf3df"),
            ("pane", "#4c6674"),
            ("shutter", "#3f6f9c"),
            ("door", "#2f5f52"),
        ],
    );
    let rows: &[[f64; 2]] =
        &[[0.5, 0.9], [3.6, 0.9], [5.15, 0.9], [0.5, 2.55], [2.05, 2.55], [3.6, 2.55], [5.15, 2.55]];
    front(&mut right, &Front { size: [6.7, 4.6], windows: rows, wall: "wall_rose" });
    block(&mut right, [DVec3::new(1.75, 0.0, 0.0), DVec3::new(2.75, 1.95, 0.06)], "trim");
    block(&mut right, [DVec3::new(1.87, 0.0, 0.0), DVec3::new(2.63, 1.83, 0.09)], "door");
    [left, right]
}

fn front(mesh: &mut PolyMesh, front: &Front) {
    let [wide, high] = front.size;
    let wall = Look { group: "wall", material: front.wall };
    block(mesh, [DVec3::new(0.0, 0.0, -1.2), DVec3::new(wide, high, 0.0)], wall.material);
    block(mesh, [DVec3::new(-0.08, high, -1.25), DVec3::new(wide + 0.08, high + 0.12, 0.14)], "trim");
    for &[left, low] in front.windows {
        let at = DVec3::new(left, low, 0.0);
        block(mesh, [at, at + DVec3::new(0.72, 1.02, 0.05)], "trim");
        block(mesh, [at + DVec3::new(0.07, 0.07, 0.0), at + DVec3::new(0.65, 0.95, 0.06)], "pane");
        block(mesh, [at + DVec3::new(-0.08, -0.07, 0.0), at + DVec3::new(0.80, 0.0, 0.11)], "trim");
        for shutter in [-0.36, 0.74] {
            let at = at + DVec3::X * shutter;
            block(mesh, [at, at + DVec3::new(0.34, 1.02, 0.05)], "shutter");
        }
    }
}

fn block(mesh: &mut PolyMesh, [low, high]: [DVec3; 2], material: &'static str) {
    let first = mesh.positions.len();
    let corner = |bits: usize| {
        let pick = |axis: usize| if bits >> axis & 1 == 0 { low[axis] } else { high[axis] };
        DVec3::new(pick(0), pick(1), pick(2))
    };
    mesh.positions.extend((0..8).map(corner));
    let sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    mesh.faces.extend(sides.map(|side| Face {
        corners: side.map(|corner| first + corner).to_vec(),
        look: Look { group: "house", material },
    }));
}

/// A low wall far behind, which shows in the gap between the houses.
pub fn far_wall() -> PolyMesh {
    let mut mesh = PolyMesh::new("far_wall", "A low wall.", &[("stone", "#b9a6a0"), ("coping", "#d9cbbf")]);
    block(&mut mesh, [DVec3::new(-9.0, 0.0, -6.5), DVec3::new(9.0, 0.95, -6.2)], "stone");
    block(&mut mesh, [DVec3::new(-9.0, 0.95, -6.55), DVec3::new(9.0, 1.05, -6.15)], "coping");
    mesh
}

/// A line with pennants from the mast to the right house, in the coordinates of the shot.
pub fn garland() -> PolyMesh {
    const PENNANTS: usize = 15;
    const ALONG: usize = 45;
    let mut mesh = PolyMesh::new(
        "garland",
        "A garland of pennants.",
        &[
            ("line", "#6a5a48"),
            ("red", "#cf4632"),
            ("blue", "#3777a0"),
            ("gold", "#efb931"),
            ("green", "#4f9155"),
        ],
    );
    let (from, to) = (DVec3::new(-3.16, 2.40, -2.26), DVec3::new(4.6, 3.65, -2.92));
    let hung = |share: f64| from.lerp(to, share) - DVec3::Y * (1.5 * share * (1.0 - share));
    line(&mut mesh, [ALONG, 6], hung);
    for pennant in 0..PENNANTS {
        let at = |shift: f64| hung((pennant as f64 + 0.5 + shift) / PENNANTS as f64);
        let first = mesh.positions.len();
        let swung = 0.05 * hash([pennant as u32, 5, 8]);
        mesh.positions.extend([at(-0.34), at(0.34), at(swung) + DVec3::new(0.0, -0.36, 0.05)]);
        let material = ["red", "gold", "blue", "green"][pennant % 4];
        let corners = vec![first, first + 2, first + 1];
        mesh.faces.push(Face { corners, look: Look { group: "pennants", material } });
    }
    mesh
}

/// A thin closed tube along a curve, `sides[0]` faces long and `sides[1]` faces round.
fn line(mesh: &mut PolyMesh, sides: [usize; 2], curve: impl Fn(f64) -> DVec3) {
    mesh.lathe(
        sides,
        |row, turn| {
            let middle = curve(row as f64 / sides[0] as f64);
            let round = TAU * turn as f64 / sides[1] as f64;
            let thick = if row == 0 || row == sides[0] { 0.0 } else { 0.012 };
            middle + DVec3::new(0.0, round.cos(), round.sin()) * thick
        },
        |_, _| Look { group: "line", material: "line" },
    );
}

/// The mast, with a ball on its top, in the coordinates of the shot.
pub fn mast() -> PolyMesh {
    const SEGMENTS: usize = 16;
    let [foot, top] = MAST;
    let height = top.y - foot.y;
    let outline = [
        [0.0, height + 0.07],
        [0.05, height + 0.05],
        [0.07, height],
        [0.05, height - 0.05],
        [0.034, height - 0.06],
        [0.038, 0.5 * height],
        [0.044, 0.12],
        [0.13, 0.10],
        [0.13, 0.0],
        [0.0, 0.0],
    ];
    let mut mesh = PolyMesh::new("mast", "The flag's mast.", &[("mast", "#7d5a3a"), ("ball", "#efb931")]);
    mesh.lathe(
        [outline.len() - 1, SEGMENTS],
        |row, segment| {
            let (round, [wide, high]) = (TAU * segment as f64 / SEGMENTS as f64, outline[row]);
            foot + DVec3::new(wide * round.cos(), high, -wide * round.sin())
        },
        |row, _| Look { group: "mast", material: if row < 4 { "ball" } else { "mast" } },
    );
    mesh
}
