//! A carp seen from above, in a bend: body, fins, barbels, eyes.

use std::f64::consts::TAU;

use glam::DVec3;

use super::blade::{Blade, blade, place};
use super::curve::Profile;
use super::poly_mesh::{Look, PolyMesh};

/// Half of the width seen from above, by place along the body: 0 the snout, 1 the tail's root.
const WIDTH: [[f64; 2]; 8] = [
    [0.0, 0.030],
    [0.05, 0.052],
    [0.15, 0.094],
    [0.30, 0.132],
    [0.48, 0.118],
    [0.70, 0.070],
    [0.88, 0.034],
    [1.0, 0.022],
];

/// The middle line from the snout to the tail's root. It is bent, because the carp turns as it swims.
const SPINE: [DVec3; 5] = [
    DVec3::new(-0.52, 0.0, 0.10),
    DVec3::new(-0.26, 0.0, -0.05),
    DVec3::new(0.05, 0.0, -0.10),
    DVec3::new(0.34, 0.0, 0.04),
    DVec3::new(0.50, 0.0, 0.26),
];

const ROWS: usize = 72;
const SEGMENTS: usize = 40;

/// A carp that swims towards −X with its back to +Y.
pub fn carp() -> PolyMesh {
    let mut mesh = PolyMesh::new(
        "carp",
        "A carp in a bend, its back up.",
        &[
            ("back", "#26282b"),
            ("flank", "#c9c9c2"),
            ("head", "#4c4d51"),
            ("fin", "#47494b"),
            ("barbel", "#222325"),
            ("eye", "#101113"),
        ],
    );
    let width = Profile::through(&WIDTH);
    let skin = |along: f64, angle: f64| {
        let (at, forward) = place(&SPINE, along);
        let side = DVec3::Y.cross(forward).normalize();
        let half = width.height_at(along);
        let closing = (1.0 - (1.0 - along / 0.03).max(0.0).powi(2)).max(0.0).sqrt();
        at + (side * (half * angle.cos()) + DVec3::Y * (1.15 * half * angle.sin())) * closing
    };
    let point = |row: usize, segment: usize| {
        let along = (row as f64 / ROWS as f64).powf(1.15);
        if row == 0 || row == ROWS {
            return place(&SPINE, along).0;
        }
        skin(along, -TAU * segment as f64 / SEGMENTS as f64)
    };
    mesh.lathe([ROWS, SEGMENTS], point, |row, segment| {
        let up = (-TAU * (segment as f64 + 0.5) / SEGMENTS as f64).sin();
        match row {
            0..12 => Look { group: "body", material: "head" },
            _ if up > 0.72 => Look { group: "body", material: "back" },
            _ => Look { group: "body", material: "flank" },
        }
    });
    fins(&mut mesh, &skin);
    mesh
}

fn fins(mesh: &mut PolyMesh, skin: &impl Fn(f64, f64) -> DVec3) {
    const FIN: Look = Look { group: "fins", material: "fin" };
    let fin = |mesh: &mut PolyMesh, path: &[DVec3], half_width: f64, widest: f64| {
        let shape = Blade { path, faces: DVec3::Y, half_width, half_thickness: 0.006, widest, fullness: 1.3 };
        blade(mesh, [20, 10], &shape, FIN);
    };
    for side in [0.0, std::f64::consts::PI] {
        // The front and the hind pair of fins, swept back. A path is root, bend, tip.
        for (along, reach, back, half_width) in [(0.24, 0.19, 0.16, 0.052), (0.58, 0.10, 0.12, 0.032)] {
            let root = skin(along, side) - DVec3::Y * 0.02;
            let (middle, forward) = place(&SPINE, along);
            let out = (root - middle).normalize();
            let path = [
                root - out * 0.02,
                root + out * (0.6 * reach) + forward * (0.35 * back),
                root + out * reach + forward * back,
            ];
            fin(mesh, &path, half_width, 0.62);
        }
        // Barbels.
        let root = skin(0.035, side);
        let (middle, forward) = place(&SPINE, 0.035);
        let out = (root - middle).normalize();
        let path = [root, root + out * 0.05 - forward * 0.02, root + out * 0.09 + forward * 0.03];
        let shape = Blade {
            path: &path,
            faces: DVec3::Y,
            half_width: 0.005,
            half_thickness: 0.005,
            widest: 0.2,
            fullness: 2.0,
        };
        blade(mesh, [10, 6], &shape, Look { group: "barbels", material: "barbel" });
        let eye = skin(0.085, side + if side == 0.0 { 0.8 } else { -0.8 });
        let point = |row: usize, segment: usize| {
            let polar = std::f64::consts::PI * row as f64 / 8.0;
            let around = TAU * segment as f64 / 12.0;
            eye + 0.026 * DVec3::new(polar.sin() * around.sin(), polar.cos(), polar.sin() * around.cos())
        };
        mesh.lathe([8, 12], point, |_, _| Look { group: "eyes", material: "eye" });
    }
    // The tail: two lobes that part.
    let (root, forward) = place(&SPINE, 0.985);
    let side = DVec3::Y.cross(forward).normalize();
    for lobe in [-1.0, 1.0] {
        let path = [
            root - forward * 0.02,
            root + forward * 0.14 + side * (0.055 * lobe),
            root + forward * 0.30 + side * (0.15 * lobe) + DVec3::Y * 0.01,
        ];
        fin(mesh, &path, 0.055, 0.5);
    }
    // The back fin, a low ridge.
    let ridge: Vec<DVec3> = [0.30, 0.42, 0.56, 0.68]
        .into_iter()
        .map(|along| skin(along, std::f64::consts::FRAC_PI_2) + DVec3::Y * 0.012)
        .collect();
    let shape = Blade {
        path: &ridge,
        faces: DVec3::Y,
        half_width: 0.020,
        half_thickness: 0.03,
        widest: 0.4,
        fullness: 1.2,
    };
    blade(mesh, [24, 8], &shape, Look { group: "fins", material: "barbel" });
}
