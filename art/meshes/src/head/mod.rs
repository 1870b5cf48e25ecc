//! The sitter of the portrait: a woman's head and neck, and the bust that they stand on.

mod bust;
mod features;
mod hair;
mod loft;
mod relief;

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::curve::smoothstep;
use super::poly_mesh::{Look, PolyMesh};

pub use bust::bust;

use loft::{LAST_RING, Skin};

/// The point that the head turns about, with the chin at y = 0 and the crown at y = 1. It becomes the mesh's origin.
const PIVOT: DVec3 = DVec3::new(0.0, -0.20, -0.12);

/// A head of one unit from chin to crown, facing +Z, with neck, hair, ears and pearls.
pub fn head() -> PolyMesh {
    let mut mesh = PolyMesh::new(
        "head",
        "A woman's head with lowered eyes, facing +Z; it turns about the origin, which lies in the neck.",
        &[
            ("skin", "#d9a583"),
            ("skin_light", "#dca987"),
            ("skin_warm", "#d89f81"),
            ("skin_blush", "#d6987d"),
            ("skin_rose", "#d49279"),
            ("skin_cool", "#cfa284"),
            ("skin_shade", "#7d4536"),
            ("lid", "#cf9880"),
            ("lash", "#3a2219"),
            ("rim", "#c0796b"),
            ("white", "#d8cfc2"),
            ("iris", "#4a4a3c"),
            ("pupil", "#1c1512"),
            ("brow", "#6b452c"),
            ("lip_upper", "#b0665a"),
            ("lip_lower", "#c07a6a"),
            ("mouth", "#6b2a28"),
            ("ear_deep", "#b5705c"),
            ("pearl", "#e6e2d8"),
            ("hair", "#5f3820"),
            ("hair_light", "#6e4325"),
            ("hair_dark", "#4a2c1a"),
        ],
    );
    let skin_tones = [
        "skin",
        "skin_light",
        "skin_warm",
        "skin_blush",
        "skin_rose",
        "skin_cool",
        "skin_shade",
        "lid",
        "rim",
        "ear_deep",
    ];
    mesh.polish(&skin_tones, 0.12, 30.0);
    mesh.polish(&["lip_upper", "lip_lower", "mouth"], 0.3, 60.0);
    mesh.polish(&["hair", "hair_light", "hair_dark"], 0.2, 30.0);
    mesh.polish(&["white", "iris", "pupil"], 0.8, 300.0);
    mesh.polish(&["pearl"], 0.9, 300.0);
    let form = Skin::new();
    skin(&mut mesh, &form);
    features::eyes(&mut mesh);
    features::brows(&mut mesh, &form);
    features::lips(&mut mesh, &form);
    features::ears(&mut mesh);
    features::pearls(&mut mesh);
    hair::hair(&mut mesh);
    for point in &mut mesh.positions {
        *point -= PIVOT;
    }
    mesh
}

fn skin(mesh: &mut PolyMesh, form: &Skin) {
    /// Faces of a ring on each side of the head.
    const HALF: usize = 34;
    /// How many of these faces lie between the front and the angle `TURN`.
    const FORWARDS: usize = 29;
    const TURN: f64 = 1.65;
    let rings = rings();
    // Faces are narrow on the nose and grow towards the ears.
    let angle = |segment: usize| {
        let (step, side) = if segment <= HALF { (segment, 1.0) } else { (2 * HALF - segment, -1.0) };
        if step <= FORWARDS {
            let t = step as f64 / FORWARDS as f64;
            side * TURN * (0.45 * t + 0.55 * t * t)
        } else {
            side * (TURN + (PI - TURN) * (step - FORWARDS) as f64 / (HALF - FORWARDS) as f64)
        }
    };
    let point = |row: usize, segment: usize| form.point(rings[row], angle(segment % (2 * HALF)));
    let last = rings.len() - 1;
    mesh.lathe([last, 2 * HALF], point, |row, segment| {
        let middle = (point(row, segment) + point(row + 1, segment + 1)) / 2.0;
        Look { group: "skin", material: tone(middle) }
    });
}

/// The rings at which the skin's rows lie: close together from the brow to the chin.
fn rings() -> Vec<f64> {
    let mut rings = vec![0.0];
    let mut add = |to: f64, count: usize| {
        let from = rings[rings.len() - 1];
        rings.extend((1..=count).map(|step| from + (to - from) * step as f64 / count as f64));
    };
    add(3.0, 3);
    add(6.0, 7);
    add(10.0, 19);
    add(11.6, 16);
    add(16.0, 18);
    add(20.0, 7);
    add(LAST_RING, 4);
    rings
}

/// The colour of the skin at a place: light on the forehead, rosy on cheeks, nose and chin, cool along the jaw.
fn tone(point: DVec3) -> &'static str {
    let seen = DVec2::new(point.x.abs(), point.y);
    let near = |centre: [f64; 2], size: [f64; 2]| {
        (-((seen - DVec2::from_array(centre)) / DVec2::from_array(size)).length_squared()).exp()
    };
    let in_front = smoothstep(0.0, 0.12, point.z);
    // The nostrils.
    if in_front > 0.5 && near([0.031, 0.296], [0.013, 0.006]) > 0.5 && point.z > 0.39 {
        return "skin_shade";
    }
    let rosy = near([0.190, 0.375], [0.090, 0.075])
        + near([0.0, 0.325], [0.075, 0.032])
        + 0.4 * near([0.0, 0.070], [0.06, 0.04]);
    let light = near([0.05, 0.740], [0.20, 0.11]) + near([0.0, 0.440], [0.03, 0.08]);
    let cool =
        smoothstep(0.21, 0.06, seen.y + 0.20 * (point.z - 0.2)) + near([0.128, 0.505], [0.07, 0.05]) * 0.3;
    let (rosy, light) = (rosy * in_front, light * in_front);
    if rosy > 0.72 {
        "skin_rose"
    } else if rosy > 0.46 {
        "skin_blush"
    } else if rosy > 0.24 {
        "skin_warm"
    } else if light > 0.50 {
        "skin_light"
    } else if cool > 0.50 {
        "skin_cool"
    } else {
        "skin"
    }
}

/// The angle of a step when `count` steps make a whole turn.
fn turn(step: usize, count: usize) -> f64 {
    TAU * step as f64 / count as f64
}
