//! The fish: the source paper's second model, 8,618 polygons.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::curve::{Profile, bump, smoothstep};
use super::poly_mesh::{Look, PolyMesh};

/// Height of the back over the middle line, by place along the body (0 the snout, 1 the tail's root).
const BACK: [[f64; 2]; 8] = [
    [0.0, 0.012],
    [0.06, 0.070],
    [0.18, 0.150],
    [0.36, 0.205],
    [0.55, 0.180],
    [0.76, 0.100],
    [0.90, 0.052],
    [1.0, 0.050],
];
/// Depth of the belly under the middle line.
const BELLY: [[f64; 2]; 8] = [
    [0.0, 0.016],
    [0.06, 0.062],
    [0.18, 0.130],
    [0.36, 0.180],
    [0.55, 0.165],
    [0.76, 0.090],
    [0.90, 0.050],
    [1.0, 0.048],
];
/// Half of the width.
const WIDTH: [[f64; 2]; 8] = [
    [0.0, 0.018],
    [0.06, 0.052],
    [0.18, 0.094],
    [0.36, 0.112],
    [0.55, 0.090],
    [0.76, 0.045],
    [0.90, 0.018],
    [1.0, 0.010],
];
/// Length of the body without the tail fin.
const LENGTH: f64 = 1.0;

/// A fish that swims towards −X: body (96 × 72 faces), seven fins, two eyes.
pub fn fish() -> PolyMesh {
    let mut mesh = PolyMesh::new(
        "fish",
        "A fish swimming towards -X: 8618 polygons.",
        &[
            ("back", "#35606a"),
            ("flank", "#7f9a8c"),
            ("belly", "#d8cfae"),
            ("mouth", "#7a3b38"),
            ("gill", "#a8553f"),
            ("fin", "#b5583a"),
            ("iris", "#d9a83c"),
            ("pupil", "#15171a"),
        ],
    );
    let shape = Shape {
        back: Profile::through(&BACK),
        belly: Profile::through(&BELLY),
        width: Profile::through(&WIDTH),
    };
    body(&mut mesh, &shape);
    middle_fins(&mut mesh, &shape);
    for side in [1.0, -1.0] {
        paired_fins(&mut mesh, &shape, side);
        eye(&mut mesh, &shape, side);
    }
    mesh.rest_on_ground();
    mesh
}

struct Shape {
    back: Profile,
    belly: Profile,
    width: Profile,
}

impl Shape {
    /// The skin at `along` (0 the snout, 1 the tail's root), `angle` counter-clockwise seen from the snout, 0 on top.
    fn skin(&self, along: f64, angle: f64) -> DVec3 {
        let (up, side) = (angle.cos(), angle.sin());
        let height = if up > 0.0 { self.back.height_at(along) } else { self.belly.height_at(along) };
        // The edge of the gill cover stands out a little.
        let cover = 0.22 + 0.035 * up;
        let gill =
            0.07 * smoothstep(cover - 0.07, cover, along) * (1.0 - smoothstep(cover, cover + 0.025, along));
        let swell = 1.0 + gill * side.abs();
        DVec3::new(along * LENGTH, height * up, -self.width.height_at(along) * side * swell)
    }
}

fn body(mesh: &mut PolyMesh, shape: &Shape) {
    const ROWS: usize = 96;
    const SEGMENTS: usize = 72;
    // The first rows line the mouth, from the throat out to the lips; the last one closes the tail's root.
    const MOUTH: usize = 8;
    let along = |row: usize| {
        let t = (row - MOUTH) as f64 / (ROWS - 1 - MOUTH) as f64;
        0.62 * t + 0.38 * t * t
    };
    mesh.lathe(
        [ROWS, SEGMENTS],
        |row, segment| {
            let angle = TAU * segment as f64 / SEGMENTS as f64;
            if row == ROWS {
                return DVec3::new(LENGTH, 0.0, 0.0);
            }
            if row >= MOUTH {
                let lips = bump(0.022, 0.024, along(row));
                let mut point = shape.skin(along(row), angle);
                point *= DVec3::new(1.0, 1.0 + 0.16 * lips, 1.0 + 0.16 * lips);
                return point;
            }
            // From the throat (row 0) the lining widens towards the lips and rolls over them.
            let t = row as f64 / MOUTH as f64;
            let lip = shape.skin(0.0, angle);
            let wide = (0.9 * t.sqrt()) + 0.1 * t;
            DVec3::new(0.075 * (1.0 - t) - 0.010 * bump(0.8, 0.4, t), lip.y * wide, lip.z * wide)
        },
        |row, segment| {
            let up = (TAU * (segment as f64 + 0.5) / SEGMENTS as f64).cos();
            let material = if row < MOUTH {
                "mouth"
            } else {
                let place = along(row.min(ROWS - 1));
                let wave = 0.10 * (place * 9.0).sin();
                let gill = (place - 0.22 - 0.035 * up).abs() < 0.012 && up.abs() < 0.75;
                match up {
                    _ if gill => "gill",
                    up if up > 0.42 + wave => "back",
                    up if up < -0.50 - wave => "belly",
                    _ => "flank",
                }
            };
            Look { group: "body", material }
        },
    );
}

const FIN: Look = Look { group: "fins", material: "fin" };

/// The fins that stand in the plane z = 0: the tail, the long fin on the back, and the anal fin below.
fn middle_fins(mesh: &mut PolyMesh, shape: &Shape) {
    const TAIL: [usize; 2] = [20, 12];
    mesh.blade(
        TAIL,
        |column, row| {
            let (t, s) = (column as f64 / TAIL[0] as f64, row as f64 / TAIL[1] as f64 * 2.0 - 1.0);
            // The tail has two lobes with a notch between them.
            let reach = 0.17 + 0.15 * s.abs().powf(1.4);
            let spread = 0.042 + 0.20 * t.powf(0.9) * (1.0 + 0.10 * s.max(0.0));
            let curl = 0.018 * (PI * t).sin() * (2.0 * s).sin();
            flat_fin([LENGTH - 0.045 + t * reach, s * spread, curl], [t, s.abs(), 18.0 * s], 0.009)
        },
        |_, _| FIN,
    );
    const DORSAL: [usize; 2] = [23, 11];
    mesh.blade(
        DORSAL,
        |column, row| {
            let (t, up) = (column as f64 / DORSAL[0] as f64, row as f64 / DORSAL[1] as f64);
            let along = 0.30 + 0.44 * t;
            let height = 0.125 * (PI * (0.06 + 0.90 * t)).sin().powf(0.7) * (1.0 - 0.45 * t) + 0.01;
            let foot = shape.back.height_at(along) - 0.012;
            let y = foot + up * (height + 0.004 * (26.0 * t).sin());
            flat_fin(
                [along * LENGTH + 0.075 * up, y, 0.008 * up * (5.0 * t).sin()],
                [up, (2.0 * t - 1.0).abs(), 22.0 * t],
                0.007,
            )
        },
        |_, _| FIN,
    );
    const ANAL: [usize; 2] = [12, 6];
    mesh.blade(
        ANAL,
        |column, row| {
            let (t, up) = (column as f64 / ANAL[0] as f64, row as f64 / ANAL[1] as f64);
            let along = 0.64 + 0.18 * t;
            let height = 0.10 * (PI * (0.15 + 0.75 * t)).sin() * (1.0 - 0.4 * t);
            let foot = -shape.belly.height_at(along) + 0.012;
            // Rows go upwards, and this fin hangs down: its first row is the free edge, its last one is at the body.
            let down = 1.0 - up;
            flat_fin(
                [along * LENGTH + 0.06 * down, foot - down * height, 0.0],
                [down, (2.0 * t - 1.0).abs(), 16.0 * t],
                0.006,
            )
        },
        |_, _| FIN,
    );
}

/// The two surface points of a fin, on its +Z and on its −Z side, round a point `middle` of the plane between them. The
/// fin gets thinner towards its edges and has shallow ridges, its rays. `out` runs from the root (0) to the free edge
/// (1), `aside` from the fin's centre line (0) to either edge (1). `rays` is the phase of the ridges, radians.
fn flat_fin(middle: [f64; 3], [out, aside, rays]: [f64; 3], thickness: f64) -> [DVec3; 2] {
    let thick = thickness * (1.0 - 0.7 * out) * (1.0 - 0.5 * aside) * (1.0 + 0.12 * rays.sin());
    let middle = DVec3::from_array(middle);
    [middle + DVec3::Z * thick, middle - DVec3::Z * thick]
}

/// The pectoral fin and the smaller pelvic fin of one side, pointing outwards and back. `side` is +1 for +Z, −1 for −Z.
fn paired_fins(mesh: &mut PolyMesh, shape: &Shape, side: f64) {
    let fins = [([8, 5], 0.27, -0.42, [0.20, 0.085]), ([6, 4], 0.45, -0.86, [0.12, 0.055])];
    for (cells, along, level, [length, width]) in fins {
        let angle = f64::acos(level);
        let mut root = shape.skin(along, angle);
        root.z = root.z.abs() * side * 0.94;
        let out = DVec3::new(0.80, -0.38, 0.46 * side).normalize();
        let across = DVec3::new(0.42, 0.90, 0.0).normalize();
        let across = (across - out * across.dot(out)).normalize();
        let face = out.cross(across).normalize();
        mesh.blade(
            cells,
            |column, row| {
                let t = column as f64 / cells[0] as f64;
                let s = row as f64 / cells[1] as f64 * 2.0 - 1.0;
                let half = width * (0.28 + 0.72 * (PI * 0.62 * t).sin());
                let reach = length * t * (1.0 - 0.16 * s * s);
                let middle = root + out * reach + across * (s * half) + face * (0.02 * t * t);
                let thick = 0.006 * (1.0 - 0.6 * t) * (1.0 - 0.4 * s * s);
                [middle + face * thick, middle - face * thick]
            },
            |_, _| FIN,
        );
    }
}

/// An eye: a flattened ball set into the head, with its pupil outwards.
fn eye(mesh: &mut PolyMesh, shape: &Shape, side: f64) {
    const ROWS: usize = 10;
    const SEGMENTS: usize = 16;
    let mut centre = shape.skin(0.115, 1.12);
    centre.z = (centre.z.abs() - 0.010) * side;
    let outward = DVec3::new(-0.22, 0.20, side).normalize();
    let right = DVec3::Y.cross(outward).normalize();
    let up = outward.cross(right);
    mesh.lathe(
        [ROWS, SEGMENTS],
        |row, segment| {
            let polar = PI * row as f64 / ROWS as f64;
            let angle = TAU * segment as f64 / SEGMENTS as f64;
            let radius = 0.034 * polar.sin();
            centre
                + outward * (0.023 * polar.cos())
                + right * (radius * angle.cos())
                + up * (radius * angle.sin())
        },
        |row, _| Look { group: "eyes", material: if row < 3 { "pupil" } else { "iris" } },
    );
}
