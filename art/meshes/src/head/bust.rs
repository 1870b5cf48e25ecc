//! Makes the mesh of the bust under the portrait's head: a jacket with folds, and a linen collar round the neck.

use std::f64::consts::TAU;

use glam::DVec3;

use super::{PIVOT, turn};
use crate::curve::{bump, noise, smoothstep};
use crate::poly_mesh::{Look, PolyMesh};

/// The jacket's rings, from the neck's opening over the shoulders down. Each row gives three points of a ring: in front
/// (y, z), at the side (x, y, z), and at the back (y, z).
const JACKET: [[f64; 7]; 12] = [
    [-0.330, -0.100, 0.000, -0.330, -0.120, -0.330, -0.140],
    [-0.320, 0.060, 0.150, -0.280, -0.130, -0.240, -0.300],
    [-0.310, 0.120, 0.215, -0.245, -0.140, -0.210, -0.360],
    [-0.340, 0.160, 0.300, -0.255, -0.150, -0.220, -0.400],
    [-0.410, 0.205, 0.460, -0.295, -0.160, -0.270, -0.450],
    [-0.500, 0.250, 0.640, -0.350, -0.165, -0.340, -0.490],
    [-0.600, 0.290, 0.770, -0.440, -0.165, -0.440, -0.520],
    [-0.710, 0.330, 0.840, -0.580, -0.160, -0.570, -0.540],
    [-0.840, 0.370, 0.870, -0.750, -0.150, -0.730, -0.550],
    [-0.990, 0.390, 0.880, -0.930, -0.140, -0.910, -0.550],
    [-1.160, 0.380, 0.880, -1.160, -0.140, -1.160, -0.550],
    [-1.210, -0.100, 0.000, -1.210, -0.120, -1.210, -0.140],
];

/// How far the rows of `JACKET` are raised, so that the collar comes up to the middle of the neck.
const LIFT: f64 = 0.095;

/// Shoulders in a jacket with a linen collar. It has the origin of [`super::head`], so that the two fit together.
pub fn bust() -> PolyMesh {
    let mut mesh = PolyMesh::new(
        "bust",
        "Shoulders in a jacket with a linen collar; the head's mesh fits on it at the same place.",
        &[("wool", "#4b6069"), ("linen", "#e4dccb"), ("linen_shade", "#c4bdb0")],
    );
    jacket(&mut mesh);
    collar(&mut mesh);
    for point in &mut mesh.positions {
        *point -= PIVOT;
    }
    mesh
}

/// A point of the jacket without folds: `ring` counts rows of `JACKET` (fractions lie between two), `angle` is 0 in
/// front.
fn ring(ring: f64, angle: f64) -> DVec3 {
    let index = (ring.max(0.0) as usize).min(JACKET.len() - 2);
    let t = ring - index as f64;
    let knot = |step: usize| JACKET[(index + step).saturating_sub(1).min(JACKET.len() - 1)];
    let (before, start, end, after) = (knot(0), knot(1), knot(2), knot(3));
    let value = |v: usize| {
        let (b, s, e, a) = (before[v], start[v], end[v], after[v]);
        s + 0.5 * t * (e - b + t * (2.0 * b - 5.0 * s + 4.0 * e - a + t * (3.0 * s - b - 3.0 * e + a)))
    };
    let (sine, cosine) = angle.sin_cos();
    let (y, z) = if cosine > 0.0 { (value(0), value(1)) } else { (value(5), value(6)) };
    DVec3::new(
        value(2) * sine,
        y * cosine * cosine + value(3) * sine * sine + LIFT,
        value(4) + (z - value(4)) * cosine.abs(),
    )
}

/// How far the wool stands out at a place of the jacket, about −1..=1: it has narrow folds under the collar, which join
/// into wide ones farther down.
fn fold(down: f64, angle: f64) -> f64 {
    let round = angle / TAU;
    let wander = 0.9 * noise(round, down * 0.22, 7, 31) + 0.25 * noise(round, down * 0.5, 15, 12);
    let narrow = (20.0 * angle + 2.4 * wander).cos();
    let wide = (10.0 * angle + 3.2 * wander).cos();
    let fallen = smoothstep(4.0, 7.5, down);
    let full = 0.65 + 0.35 * noise(round, down * 0.2, 11, 5);
    full * (narrow * (1.0 - fallen) * 0.8 + wide * (0.25 + 0.75 * fallen))
}

fn jacket(mesh: &mut PolyMesh) {
    const ROWS: usize = 56;
    const SEGMENTS: usize = 120;
    let down = |row: usize| 11.0 * row as f64 / ROWS as f64;
    mesh.lathe(
        [ROWS, SEGMENTS],
        |row, segment| {
            let (down, angle) = (down(row), turn(segment, SEGMENTS));
            let point = ring(down, angle);
            let out = DVec3::new(point.x, 0.25, point.z + 0.15).normalize_or(DVec3::Y);
            let lies = smoothstep(4.2, 6.2, down) * (1.0 - smoothstep(10.0, 11.0, down));
            // The seam in front, where the sleeve is set in.
            let seam = bump(0.0, 0.14, angle.sin().abs() - 0.86 + 0.02 * (down - 7.0))
                * smoothstep(0.0, 0.3, angle.cos());
            let seam = 0.030 * seam * smoothstep(5.0, 8.0, down);
            point + out * ((0.056 * fold(down, angle) - seam) * lies)
        },
        |_, _| Look { group: "jacket", material: "wool" },
    );
}

/// A turned-down linen collar, open in front.
fn collar(mesh: &mut PolyMesh) {
    const ALONG: usize = 72;
    const ACROSS: usize = 16;
    mesh.blade(
        [ALONG, ACROSS],
        |column, row| {
            // Columns run to the right, seen from outside: from the front round the neck to the front again.
            let angle = 0.10 + (TAU - 0.20) * column as f64 / ALONG as f64;
            // Rows run up: from the lower edge on the jacket to the edge that stands at the neck.
            let up = row as f64 / ACROSS as f64;
            let front = smoothstep(0.2, 1.0, angle.cos());
            let reach = 4.6 + 0.7 * front + 0.05 * (angle * 9.0).sin();
            let down = reach + (1.55 - reach) * up;
            let ripple = 0.008 * (angle * 14.0 + 2.0 * up).sin() * (1.0 - up);
            let point = ring(down, angle);
            let out = DVec3::new(point.x * 0.6, 0.30, (point.z + 0.15) * 0.8).normalize_or(DVec3::Y);
            let stand = DVec3::Y * 0.055 * smoothstep(0.75, 1.0, up);
            let middle = point + out * (0.036 + ripple) + stand;
            [middle + out * 0.008, middle - out * 0.008]
        },
        |_, row| Look { group: "collar", material: if row == 0 { "linen_shade" } else { "linen" } },
    );
}
