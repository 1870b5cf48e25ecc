//! Makes the mesh of the bamboo: two stalks of sections, thin twigs, and leaves that hang in threes to fives.

use std::f64::consts::TAU;

use glam::DVec3;

use super::blade::{Blade, blade, place};
use super::curve::hash;
use super::poly_mesh::{Look, PolyMesh};

const NEAR: Look = Look { group: "near", material: "stalk" };
const FAR: Look = Look { group: "far", material: "pale stalk" };
const KNOTS: Look = Look { group: "knots", material: "knot" };
const TWIGS: Look = Look { group: "twigs", material: "twig" };
const LEAVES: Look = Look { group: "leaves", material: "leaf" };
const PALE_LEAVES: Look = Look { group: "pale leaves", material: "pale leaf" };

/// A twig: whether it is on the paler stalk, how far along the stalk it begins (0..1), how far it reaches from there in
/// X and Y, and the angles at which its leaves hang, radians.
struct Twig {
    is_pale: bool,
    along: f64,
    by: [f64; 2],
    angles: &'static [f64],
}

const TWIGS_OF: [Twig; 6] = [
    Twig { is_pale: false, along: 0.72, by: [-0.46, 0.24], angles: &[-2.55, -2.15, -1.8, -1.35, -3.0] },
    Twig { is_pale: false, along: 0.60, by: [0.46, 0.26], angles: &[-0.35, -0.85, -1.25, -1.7] },
    Twig { is_pale: false, along: 0.47, by: [-0.36, 0.28], angles: &[-2.8, -2.3, -1.85] },
    Twig { is_pale: false, along: 0.86, by: [0.40, 0.16], angles: &[-0.2, -0.7, -1.2, -1.65, 0.3] },
    Twig { is_pale: true, along: 0.50, by: [0.28, 0.26], angles: &[-0.6, -1.1, -1.6] },
    Twig { is_pale: true, along: 0.80, by: [-0.30, 0.22], angles: &[-2.6, -2.0, -1.5] },
];

/// Bamboo from y = −0.35 to 3.4: one stalk near z = 0, a paler one behind it.
pub fn bamboo() -> PolyMesh {
    let mut mesh = PolyMesh::new(
        "bamboo",
        "Two stalks of bamboo with their leaves.",
        &[
            ("stalk", "#8d8f86"),
            ("pale stalk", "#cfd0c8"),
            ("knot", "#2c2e2b"),
            ("twig", "#4a4c48"),
            ("leaf", "#26282a"),
            ("pale leaf", "#a2a49f"),
        ],
    );
    let far = stalk(&mut mesh, [[0.52, -0.35, -0.35], [0.44, 1.2, -0.35], [0.52, 3.4, -0.35]], 0.052, FAR);
    let near = stalk(&mut mesh, [[-0.02, -0.35, 0.0], [0.12, 1.3, 0.0], [0.02, 3.4, 0.0]], 0.085, NEAR);
    for (number, twig) in TWIGS_OF.into_iter().enumerate() {
        let Twig { is_pale, along, by: [x, y], angles } = twig;
        let stem = if is_pale { &far } else { &near };
        let (from, _) = place(stem, along);
        let to = from + DVec3::new(x, y, 0.12);
        let between = from.lerp(to, 0.5) + DVec3::new(0.0, 0.07, 0.03);
        let path = [from, between, to];
        let look = if is_pale { Look { group: "twigs", material: "pale leaf" } } else { TWIGS };
        let twig = Blade {
            path: &path,
            faces: DVec3::Z,
            half_width: 0.011,
            half_thickness: 0.011,
            widest: 0.3,
            fullness: 3.0,
        };
        blade(&mut mesh, [14, 6], &twig, look);
        for (index, &angle) in angles.iter().enumerate() {
            leaf(&mut mesh, to, (angle, [number, index]), is_pale);
        }
    }
    mesh
}

/// A stalk of sections that swell a little at their ends; returns the points that its middle line goes through.
fn stalk(mesh: &mut PolyMesh, through: [[f64; 3]; 3], radius: f64, look: Look) -> [DVec3; 3] {
    const SECTIONS: usize = 6;
    let path = through.map(DVec3::from);
    for section in 0..SECTIONS {
        let [from, to] = [section as f64 + 0.012, section as f64 + 0.988].map(|end| end / SECTIONS as f64);
        let point = |row: usize, segment: usize| {
            let t = row as f64 / 18.0;
            let (at, forward) = place(&path, from + (to - from) * t);
            let side = forward.cross(DVec3::Z).normalize();
            let front = side.cross(forward);
            let end = (2.0 * t - 1.0).abs();
            let swell = 1.0 + 0.22 * end.powi(8) - 0.05 * (1.0 - end);
            let closing = (1.0 - end.powi(40)).max(0.0).sqrt();
            let angle = TAU * segment as f64 / 20.0;
            at + (side * angle.cos() + front * angle.sin()) * (radius * swell * closing)
        };
        mesh.lathe([18, 20], point, |_, _| look);
        if section > 0 {
            let (at, forward) = place(&path, section as f64 / SECTIONS as f64);
            let side = forward.cross(DVec3::Z).normalize() * (1.12 * radius);
            let ring = [at - side, at - 0.3 * side + forward * 0.012, at + side];
            let knot = Blade {
                path: &ring,
                faces: DVec3::Z,
                half_width: 0.016,
                half_thickness: 1.2 * radius,
                widest: 0.5,
                fullness: 2.0,
            };
            blade(
                mesh,
                [10, 8],
                &knot,
                Look { material: if radius > 0.06 { "knot" } else { "pale leaf" }, ..KNOTS },
            );
        }
    }
    path
}

/// A leaf that hangs from its twig's end at an angle in the plane of X and Y. `which`, the numbers of the twig and of
/// the leaf, makes each leaf a little different.
fn leaf(mesh: &mut PolyMesh, from: DVec3, (angle, which): (f64, [usize; 2]), is_pale: bool) {
    let random = |number: u32| hash([which[0] as u32, which[1] as u32, number]);
    let length = 0.50 * (1.0 + 0.30 * random(1));
    let along = DVec3::new(angle.cos(), angle.sin(), 0.25 * random(2)).normalize();
    let droop = DVec3::new(0.0, -0.16 * length, 0.03);
    let middle = from + along * (0.45 * length) - droop * 0.3;
    let path = [from, middle, from + along * length + droop];
    let shape = Blade {
        path: &path,
        faces: DVec3::new(0.25 * random(3), 0.35 + 0.2 * random(4), 1.0).normalize(),
        half_width: 0.047 * (1.0 + 0.3 * random(5)),
        half_thickness: 0.010,
        widest: 0.36,
        fullness: 1.0,
    };
    blade(mesh, [22, 10], &shape, if is_pale { PALE_LEAVES } else { LEAVES });
}
