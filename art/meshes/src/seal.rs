//! Makes the mesh of a seal, the red print of a carved stone: a sheet with holes where the stone is carved.

use glam::DVec3;

use super::curve::hash;
use super::poly_mesh::{Face, Look, PolyMesh};

/// The print from the top row down; `#` is red. It shows a brush in an eye, in a frame.
const CARVING: [&str; 16] = [
    "################",
    "################",
    "##............##",
    "##.##########.##",
    "##.#...##...#.##",
    "##.#.######.#.##",
    "##.###.##.###.##",
    "##.....##.....##",
    "##.##..##..##.##",
    "##.#########..##",
    "##....#..#....##",
    "##.####..####.##",
    "##.##......##.##",
    "##............##",
    "################",
    "################",
];

/// A square of side 1 in the plane Z = 0, facing +Z.
pub fn seal() -> PolyMesh {
    let mut mesh = PolyMesh::new("seal", "The print of a seal.", &[("cinnabar", "#b2281e")]);
    let look = Look { group: "print", material: "cinnabar" };
    let side = CARVING.len();
    for row in 0..=side {
        for column in 0..=side {
            // The stone is worn, so corners lie a little off the grid.
            let worn = |which: u32| 0.012 * hash([row as u32, column as u32, which]);
            let [x, y] =
                [(column, 1), (side - row, 2)].map(|(at, which)| at as f64 / side as f64 + worn(which));
            mesh.positions.push(DVec3::new(x - 0.5, y - 0.5, 0.0));
        }
    }
    let at = |row: usize, column: usize| row * (side + 1) + column;
    for (row, line) in CARVING.iter().enumerate() {
        for (column, _) in line.chars().enumerate().filter(|(_, mark)| *mark == '#') {
            let corners =
                vec![at(row + 1, column), at(row + 1, column + 1), at(row, column + 1), at(row, column)];
            mesh.faces.push(Face { corners, look });
        }
    }
    mesh
}
