//! Makes the meshes of the cube, of the source paper's third model (boxes, cones and balls), and of the log.

use std::f64::consts::{PI, TAU};

use glam::{DMat3, DVec2, DVec3};

use super::curve::{Profile, noise, smoothstep};
use super::poly_mesh::{Face, Look, PolyMesh};

/// A box with slightly rounded edges.
pub struct Block {
    /// Half its size, before it is turned.
    pub half: DVec3,
    /// Faces along each axis, at least 3: the outermost are the rounding.
    pub cells: [usize; 3],
    /// Radius of the edges.
    pub rounding: f64,
    /// Turns the block's axes into the mesh's.
    pub turn: DMat3,
    /// Its middle.
    pub centre: DVec3,
    /// Group and material.
    pub look: Look,
}

/// Adds a block.
pub fn add_block(mesh: &mut PolyMesh, block: &Block) {
    let mut index = std::collections::HashMap::new();
    let mut vertex = |mesh: &mut PolyMesh, cell: [usize; 3]| {
        *index.entry(cell).or_insert_with(|| {
            let point = DVec3::from_array(std::array::from_fn(|axis| {
                grid_line(cell[axis], block.cells[axis], block.half[axis], block.rounding)
            }));
            let inner = block.half - block.rounding;
            let core = point.clamp(-inner, inner);
            let rounded = core + (point - core).normalize() * block.rounding;
            mesh.positions.push(block.centre + block.turn * rounded);
            mesh.positions.len() - 1
        })
    };
    for axis in 0..3 {
        let (right, up) = ((axis + 1) % 3, (axis + 2) % 3);
        for far in [true, false] {
            for row in 0..block.cells[up] {
                for column in 0..block.cells[right] {
                    let mut corners = [[0, 0], [1, 0], [1, 1], [0, 1]]
                        .map(|[dx, dy]| {
                            let mut cell = [0; 3];
                            cell[axis] = if far { block.cells[axis] } else { 0 };
                            cell[right] = column + dx;
                            cell[up] = row + dy;
                            vertex(mesh, cell)
                        })
                        .to_vec();
                    if !far {
                        corners.reverse();
                    }
                    mesh.faces.push(Face { corners, look: block.look });
                }
            }
        }
    }
}

/// Where the grid lines of a block lie: the outermost cells are as wide as the rounding.
fn grid_line(line: usize, cells: usize, half: f64, rounding: f64) -> f64 {
    match line {
        0 => -half,
        line if line == cells => half,
        line => (half - rounding) * ((line - 1) as f64 / (cells - 2) as f64 * 2.0 - 1.0),
    }
}

/// A cube of one unit that stands on y = 0, its edges slightly rounded.
pub fn cube() -> PolyMesh {
    let mut mesh = PolyMesh::new(
        "cube",
        "A cube of one unit with slightly rounded edges, standing on y = 0.",
        &[("cube", "#b08a55")],
    );
    add_block(
        &mut mesh,
        &Block {
            half: DVec3::splat(0.5),
            cells: [10; 3],
            rounding: 0.03,
            turn: DMat3::IDENTITY,
            centre: DVec3::Y * 0.5,
            look: Look { group: "cube", material: "cube" },
        },
    );
    mesh
}

/// Four boxes, three cones and three balls, built up like a plaster group in a drawing class: 3,978 polygons.
pub fn simple_objects() -> PolyMesh {
    let mut mesh = PolyMesh::new(
        "simple_objects",
        "Four boxes, three cones and three balls: 3978 polygons.",
        &[
            ("ochre", "#b98a4a"),
            ("brick", "#a2503a"),
            ("slate", "#5c6f7c"),
            ("cream", "#d8cba8"),
            ("moss", "#74803f"),
            ("plum", "#74475a"),
        ],
    );
    let boxes = [
        // half size, cells, turn about Y in degrees, centre of its foot
        ("box_1", "ochre", [0.46, 0.24, 0.30], [8, 6, 8], 12.0, [-0.12, 0.0, -0.22]),
        ("box_2", "slate", [0.20, 0.36, 0.20], [6, 8, 7], -24.0, [0.62, 0.0, -0.26]),
        ("box_3", "cream", [0.22, 0.13, 0.17], [6, 4, 5], 38.0, [0.40, 0.0, 0.42]),
        ("box_4", "brick", [0.16, 0.10, 0.16], [5, 5, 5], -14.0, [-0.30, 0.48, -0.22]),
    ];
    for (group, material, half, cells, turn_deg, foot) in boxes {
        let half = DVec3::from_array(half);
        add_block(
            &mut mesh,
            &Block {
                half,
                cells,
                rounding: 0.018,
                turn: DMat3::from_rotation_y(f64::to_radians(turn_deg)),
                centre: DVec3::from_array(foot) + DVec3::Y * half.y,
                look: Look { group, material },
            },
        );
    }
    cone(
        &mut mesh,
        ([15, 36], [0.25, 0.62]),
        [0.16, 0.48, -0.22],
        Look { group: "cone_1", material: "moss" },
    );
    cone(&mut mesh, ([16, 32], [0.22, 0.50]), [-0.74, 0.0, 0.16], Look { group: "cone_2", material: "plum" });
    cone(
        &mut mesh,
        ([13, 24], [0.13, 0.34]),
        [0.62, 0.72, -0.26],
        Look { group: "cone_3", material: "cream" },
    );
    ball(&mut mesh, ([20, 40], 0.19), [-0.24, 0.19, 0.40], Look { group: "ball_1", material: "brick" });
    ball(&mut mesh, ([16, 32], 0.13), [-0.30, 0.81, -0.22], Look { group: "ball_2", material: "ochre" });
    ball(&mut mesh, ([14, 28], 0.12), [0.02, 0.12, 0.62], Look { group: "ball_3", material: "slate" });
    mesh
}

/// A cone that stands on `foot`; the last four of its rows are the base.
fn cone(
    mesh: &mut PolyMesh,
    ([rows, segments], [radius, height]): ([usize; 2], [f64; 2]),
    foot: [f64; 3],
    look: Look,
) {
    const BASE: usize = 4;
    let side = rows - BASE;
    mesh.lathe(
        [rows, segments],
        |row, segment| {
            let angle = TAU * segment as f64 / segments as f64;
            let (out, up) = if row <= side {
                let t = row as f64 / side as f64;
                (t, 1.0 - t)
            } else {
                (1.0 - (row - side) as f64 / BASE as f64, 0.0)
            };
            DVec3::from_array(foot)
                + DVec3::new(radius * out * angle.cos(), height * up, -radius * out * angle.sin())
        },
        |_, _| look,
    );
}

fn ball(mesh: &mut PolyMesh, ([rows, segments], radius): ([usize; 2], f64), centre: [f64; 3], look: Look) {
    mesh.lathe(
        [rows, segments],
        |row, segment| {
            let (polar, angle) = (PI * row as f64 / rows as f64, TAU * segment as f64 / segments as f64);
            let out = polar.sin();
            DVec3::from_array(centre)
                + radius * DVec3::new(out * angle.cos(), polar.cos(), -out * angle.sin())
        },
        |_, _| look,
    );
}

/// A log that stands on a cut end: ridged bark along Y, growth rings on both ends.
pub fn log() -> PolyMesh {
    const SEGMENTS: usize = 48;
    const RINGS: usize = 8;
    const BARK: usize = 36;
    const ROWS: usize = BARK + 2 * RINGS;
    const HEIGHT: f64 = 1.6;
    let mut mesh = PolyMesh::new(
        "log",
        "A log standing on its cut end: bark with its grain along Y, rings on both ends.",
        &[
            ("bark", "#5d4632"),
            ("bark_dark", "#463424"),
            ("bark_pale", "#77604a"),
            ("ring_pale", "#cfa974"),
            ("ring_dark", "#b08550"),
        ],
    );
    let girth = Profile::through(&[[0.0, 0.225], [0.25, 0.195], [0.7, 0.183], [1.2, 0.178], [1.6, 0.172]]);
    let ridge = |round: f64, height: f64| {
        noise(round + 0.012 * height, height * 1.1, 16, 41) + 0.45 * noise(round, height * 2.3 + 9.0, 24, 43)
    };
    mesh.lathe(
        [ROWS, SEGMENTS],
        |row, segment| {
            let round = segment as f64 / SEGMENTS as f64;
            let (share, height) = log_section(row, [RINGS, BARK], HEIGHT);
            let root = 1.0 + 0.06 * (1.0 - smoothstep(0.0, 0.35, height)) * (TAU * 5.0 * round).cos();
            let radius = girth.height_at(height) * root * (1.0 + 0.035 * ridge(round, height)) * share;
            let at = DVec2::from_angle(TAU * round) * radius;
            let lean = 0.02 * (height * 2.0).sin();
            DVec3::new(at.x + lean, height, -at.y)
        },
        |row, segment| {
            let at_end = !(RINGS..RINGS + BARK).contains(&row);
            if at_end {
                let ring = if row < RINGS { row } else { ROWS - 1 - row };
                let material = match ring {
                    7 => "bark_dark",
                    ring if ring % 2 == 0 => "ring_dark",
                    _ => "ring_pale",
                };
                return Look { group: "ends", material };
            }
            let height = log_section(row, [RINGS, BARK], HEIGHT).1;
            let tone = ridge((segment as f64 + 0.5) / SEGMENTS as f64, height);
            let material = match tone {
                tone if tone < -0.35 => "bark_dark",
                tone if tone > 0.45 => "bark_pale",
                _ => "bark",
            };
            Look { group: "bark", material }
        },
    );
    mesh
}

/// How far out (0 the middle, 1 the bark) and how high a row of the log lies. Rows go from the middle of the upper end
/// over the bark to the middle of the lower end.
fn log_section(row: usize, [rings, bark]: [usize; 2], height: f64) -> (f64, f64) {
    if row <= rings {
        (row as f64 / rings as f64, height)
    } else if row <= rings + bark {
        (1.0, height * (1.0 - (row - rings) as f64 / bark as f64))
    } else {
        (1.0 - (row - rings - bark) as f64 / rings as f64, 0.0)
    }
}
