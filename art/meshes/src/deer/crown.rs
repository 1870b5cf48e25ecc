//! What the deer carries on its head: ears, antlers, eyes.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use crate::curve::smoothstep;
use crate::poly_mesh::{Look, PolyMesh};

use super::form::Form;

/// The right antler's beam and tines, each a chain of `[x, y, z, radius]`.
const ANTLER: [&[[f64; 4]]; 5] = [
    &[
        [0.680, 1.405, 0.038, 0.026],
        [0.662, 1.460, 0.052, 0.024],
        [0.615, 1.545, 0.098, 0.021],
        [0.575, 1.640, 0.155, 0.019],
        [0.580, 1.740, 0.200, 0.016],
        [0.630, 1.825, 0.215, 0.012],
        [0.700, 1.880, 0.200, 0.005],
    ],
    &[
        [0.645, 1.480, 0.064, 0.017],
        [0.720, 1.505, 0.088, 0.015],
        [0.785, 1.560, 0.098, 0.011],
        [0.815, 1.630, 0.094, 0.005],
    ],
    &[
        [0.583, 1.620, 0.142, 0.015],
        [0.640, 1.655, 0.172, 0.013],
        [0.690, 1.715, 0.180, 0.010],
        [0.710, 1.775, 0.172, 0.004],
    ],
    &[
        [0.578, 1.720, 0.192, 0.014],
        [0.540, 1.785, 0.225, 0.012],
        [0.520, 1.850, 0.236, 0.009],
        [0.525, 1.905, 0.232, 0.004],
    ],
    &[[0.610, 1.800, 0.213, 0.012], [0.605, 1.855, 0.232, 0.010], [0.615, 1.915, 0.236, 0.004]],
];

/// Where the eyes lie, seen from the side.
pub const EYE: DVec3 = DVec3::new(0.752, 1.350, 0.0);

/// Both ears, both antlers and both eyes.
pub fn add_crown(mesh: &mut PolyMesh, form: &Form) {
    for side in [1.0, -1.0] {
        ear(mesh, side);
        eye(mesh, form, side);
        for branch in ANTLER {
            let branch: Vec<[f64; 4]> = branch.iter().map(|&[x, y, z, r]| [x, y, z * side, r]).collect();
            tine(mesh, &branch);
        }
    }
}

/// One ear: leaf-shaped, hollow, pale inside, held sideways.
fn ear(mesh: &mut PolyMesh, side: f64) {
    const CELLS: [usize; 2] = [8, 14];
    let root = DVec3::new(0.640, 1.385, 0.052 * side);
    let along = DVec3::new(-0.20, 0.50, 0.85 * side).normalize();
    // The hollow looks forwards and a little to the side and down.
    let hollow = DVec3::new(1.0, -0.12, 0.25 * side);
    let hollow = (hollow - along * hollow.dot(along)).normalize();
    let right = along.cross(hollow);
    let first = mesh.faces.len();
    mesh.blade(
        CELLS,
        |column, row| {
            let (s, t) = (column as f64 / CELLS[0] as f64 * 2.0 - 1.0, row as f64 / CELLS[1] as f64);
            // Half the ear's width: narrow at the stem, widest below the middle, pointed at the end.
            let half = 0.026 + 0.038 * smoothstep(0.0, 0.45, t);
            let half = half * (1.0 - smoothstep(0.45, 1.06, t)).powf(0.7);
            let bend = 0.030 * t * t;
            // The edges curl forwards; relative to the ear's width, they do so most at the root.
            let curl = half * (0.95 - 0.55 * t) * s * s;
            let middle = root + along * (0.235 * t) + right * (half * s) + hollow * (curl + bend - 0.01);
            let thick = 0.007 * (1.0 - s * s) * (1.0 - t) + 0.002;
            [middle + hollow * thick, middle - hollow * thick]
        },
        |_, row| Look { group: "ears", material: if row + 3 > CELLS[1] { "coat_02" } else { "ear_outside" } },
    );
    for (index, face) in mesh.faces[first..first + CELLS[0] * CELLS[1]].iter_mut().enumerate() {
        let (column, row) = (index % CELLS[0], index / CELLS[0]);
        let edge = column == 0 || column + 1 == CELLS[0] || row + 2 > CELLS[1];
        face.look.material = if edge { "ear_outside" } else { "ear_inside" };
    }
}

/// A dark eye in the side of the head.
fn eye(mesh: &mut PolyMesh, form: &Form, side: f64) {
    const ROWS: usize = 8;
    const SEGMENTS: usize = 12;
    // From the middle of the head out to its skin.
    let mut centre = EYE;
    while form.distance(DVec3::new(EYE.x, EYE.y, centre.z)) < 0.0 {
        centre.z += 0.002;
    }
    centre.z = (centre.z - 0.004) * side;
    let outward = DVec3::new(0.35, 0.15, side).normalize();
    let right = DVec3::Y.cross(outward).normalize();
    let up = outward.cross(right);
    mesh.lathe(
        [ROWS, SEGMENTS],
        |row, segment| {
            let (polar, angle) = (PI * row as f64 / ROWS as f64, TAU * segment as f64 / SEGMENTS as f64);
            let radius = 0.026 * polar.sin();
            centre
                + outward * (0.013 * polar.cos())
                + right * (1.15 * radius * angle.cos())
                + up * (radius * angle.sin())
        },
        |_, _| Look { group: "eyes", material: "eye" },
    );
}

/// A bent horn of round sections `[x, y, z, radius]`, pale at its end.
fn tine(mesh: &mut PolyMesh, sections: &[[f64; 4]]) {
    const SIDES: usize = 8;
    const STEPS: usize = 2;
    let last = sections.len() - 1;
    let at = |index: usize| DVec3::from_slice(&sections[index][..3]);
    let rings: Vec<(DVec3, f64)> = (0..=last * STEPS)
        .map(|step| {
            let (span, t) = ((step / STEPS).min(last - 1), step as f64 / STEPS as f64);
            let t = t - span as f64;
            let [b, e] = [span.saturating_sub(1), (span + 2).min(last)].map(at);
            let (s, n) = (at(span), at(span + 1));
            let bend = 2.0 * b - 5.0 * s + 4.0 * n - e + (3.0 * s - b - 3.0 * n + e) * t;
            let middle = s + 0.5 * t * (n - b + bend * t);
            (middle, sections[span][3] + (sections[span + 1][3] - sections[span][3]) * t)
        })
        .collect();
    let rows = rings.len() + 1;
    mesh.lathe(
        [rows, SIDES],
        |row, segment| {
            let ring = row.clamp(1, rings.len()) - 1;
            let (middle, radius) = rings[ring];
            let along =
                (rings[(ring + 1).min(rings.len() - 1)].0 - rings[ring.saturating_sub(1)].0).normalize();
            if row == 0 || row == rows {
                return middle + along * if row == 0 { -radius } else { radius };
            }
            let right = (DVec3::X + 0.3 * DVec3::Z).cross(along).normalize();
            let up = right.cross(along);
            let angle = TAU * segment as f64 / SIDES as f64;
            middle + radius * (right * angle.cos() + up * angle.sin())
        },
        |row, _| Look {
            group: "antlers",
            material: if row + 3 > rings.len() { "antler_tip" } else { "antler" },
        },
    );
}
