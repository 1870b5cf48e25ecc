//! A puppet in two shapes with the same faces, so that one can be morphed into the other: round like a gourd, and long
//! and bent like a pear.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::curve::{Profile, noise, smoothstep};
use super::poly_mesh::{Look, Pigment, PolyMesh};

const ROWS: usize = 32;
const SEGMENTS: usize = 48;

const PALETTE: &[Pigment] = &[
    ("skin_1", "#2f6b66"),
    ("skin_2", "#3a7a72"),
    ("skin_3", "#478a7d"),
    ("skin_4", "#559a88"),
    ("skin_5", "#67a992"),
    ("belly_1", "#dcb877"),
    ("belly_2", "#e9cf97"),
    ("ear", "#d98a6a"),
    ("cheek", "#d27f62"),
    ("eye", "#1d2426"),
    ("nose", "#6d2f2f"),
];

/// What differs between the two shapes.
struct Shape {
    /// Half of the body from the crown down: distance from the axis, height.
    outline: &'static [[f64; 2]],
    /// How far the axis turns towards +X on its way up, radians.
    bend_rad: f64,
    /// The length of the ears, and how far they point outwards and upwards.
    ear: [f64; 3],
}

/// The round shape, 0.93 units high with its ears, looking to +Z.
pub fn puppet_round() -> PolyMesh {
    let outline = &[
        [0.0, 0.900],
        [0.110, 0.885],
        [0.235, 0.825],
        [0.330, 0.715],
        [0.380, 0.590],
        [0.425, 0.450],
        [0.445, 0.300],
        [0.400, 0.130],
        [0.280, 0.025],
        [0.120, 0.0],
        [0.0, 0.0],
    ];
    weave(
        "puppet_round",
        "A round puppet; its faces are those of puppet_long.obj.",
        &Shape { outline, bend_rad: 0.0, ear: [0.150, 0.75, 0.75] },
    )
}

/// The long shape, bent towards +X, looking to +Z.
pub fn puppet_long() -> PolyMesh {
    let outline = &[
        [0.0, 1.560],
        [0.070, 1.545],
        [0.140, 1.490],
        [0.182, 1.390],
        [0.195, 1.250],
        [0.190, 1.080],
        [0.205, 0.880],
        [0.255, 0.640],
        [0.310, 0.400],
        [0.315, 0.210],
        [0.240, 0.050],
        [0.110, 0.0],
        [0.0, 0.0],
    ];
    weave(
        "puppet_long",
        "A long, bent puppet; its faces are those of puppet_round.obj.",
        &Shape { outline, bend_rad: 0.62, ear: [0.200, 0.35, 1.0] },
    )
}

fn weave(name: &'static str, about: &'static str, shape: &Shape) -> PolyMesh {
    let mut mesh = PolyMesh::new(name, about, PALETTE);
    mesh.polish(&["eye", "nose"], 0.9, 300.0);
    let outline = Profile::through(shape.outline).spread(ROWS, 0.35);
    let skin = |row: f64, segment: f64| {
        let angle = TAU * segment / SEGMENTS as f64;
        let ring = (row as usize).min(ROWS - 1);
        let around = outline[ring].lerp(outline[ring + 1], row - ring as f64);
        let mut point = DVec3::new(around.x * angle.cos(), around.y, -around.x * angle.sin());
        let [length, out, rise] = shape.ear;
        for side in [1.0, -1.0] {
            let tip = DVec3::new(side * out, rise, 0.0).normalize();
            point += length * ear_weight(direction(row, segment), side) * tip;
        }
        bent(point, shape.bend_rad, shape.outline[0][1])
    };
    mesh.lathe([ROWS, SEGMENTS], |row, segment| skin(row as f64, segment as f64), look);
    for (name, down_deg, aside_deg) in [("eye", 58.0, 27.0), ("eye", 58.0, -27.0), ("nose", 73.0, 0.0)] {
        let centre = skin(ROWS as f64 * down_deg / 180.0, SEGMENTS as f64 * (0.75 + aside_deg / 360.0));
        let size =
            if name == "eye" { DVec3::new(0.055, 0.070, 0.032) } else { DVec3::new(0.054, 0.038, 0.042) };
        ball(&mut mesh, centre, size, Look { group: "face", material: name });
    }
    let sides = mesh
        .positions
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], point| [low.min(point.x), high.max(point.x)]);
    for point in &mut mesh.positions {
        point.x -= 0.5 * (sides[0] + sides[1]);
    }
    mesh.rest_on_ground();
    mesh.round_to(1e4);
    mesh.has_normals = true;
    mesh
}

/// A small rounded body of half-sizes `half`.
fn ball(mesh: &mut PolyMesh, centre: DVec3, half: DVec3, look: Look) {
    const ROWS: usize = 8;
    const SEGMENTS: usize = 12;
    mesh.lathe(
        [ROWS, SEGMENTS],
        |row, segment| {
            let (polar, angle) = (PI * row as f64 / ROWS as f64, TAU * segment as f64 / SEGMENTS as f64);
            let out = polar.sin();
            centre + half * DVec3::new(out * angle.cos(), polar.cos(), -out * angle.sin())
        },
        |_, _| look,
    );
}

/// The outward direction that a place of the grid would have if the puppet were a ball. Such directions say where its
/// features are.
fn direction(row: f64, segment: f64) -> DVec3 {
    let (polar, angle) = (PI * row / ROWS as f64, TAU * segment / SEGMENTS as f64);
    DVec3::new(polar.sin() * angle.cos(), polar.cos(), -polar.sin() * angle.sin())
}

/// The direction `down_deg` degrees below the crown and `aside_deg` degrees from the front towards +X.
fn seen(down_deg: f64, aside_deg: f64) -> DVec3 {
    let (down, aside) = (down_deg.to_radians(), aside_deg.to_radians());
    DVec3::new(down.sin() * aside.sin(), down.cos(), down.sin() * aside.cos())
}

/// How much of an ear's length a place of the grid gets, 0 to 1.
fn ear_weight(direction: DVec3, side: f64) -> f64 {
    let away = direction.angle_between(seen(38.0, 84.0 * side));
    smoothstep(0.46, 0.06, away)
}

/// Bends the axis into an arc towards +X.
fn bent(point: DVec3, bend_rad: f64, height: f64) -> DVec3 {
    if bend_rad == 0.0 {
        return point;
    }
    let arc_radius = height / bend_rad;
    let (sine, cosine) = (point.y / arc_radius).sin_cos();
    let reach = arc_radius - point.x;
    DVec3::new(arc_radius - reach * cosine, reach * sine, point.z)
}

/// The look of the face between a row and the next. It depends on the grid alone, so both shapes get the same looks.
fn look(row: usize, segment: usize) -> Look {
    let at = direction(row as f64 + 0.5, segment as f64 + 0.5);
    let away = |down_deg: f64, aside_deg: f64| {
        let mirrored = DVec3::new(at.x.abs(), at.y, at.z);
        mirrored.angle_between(seen(down_deg, aside_deg))
    };
    if away(76.0, 44.0) < 0.16 {
        return Look { group: "face", material: "cheek" };
    }
    let ear = ear_weight(at, 1.0).max(ear_weight(at, -1.0));
    if ear > 0.30 && at.z > 0.02 {
        return Look { group: "ears", material: "ear" };
    }
    let belly = away(122.0, 0.0);
    if belly < 0.62 {
        return Look { group: "belly", material: if belly < 0.42 { "belly_2" } else { "belly_1" } };
    }
    let mottle = noise((segment as f64 + 0.5) / SEGMENTS as f64, 0.45 * row as f64, 14, 51);
    let tone = 2.4 + 1.6 * at.y + 1.1 * mottle;
    let material = PALETTE[(4.0 - tone.clamp(0.0, 4.0)).round() as usize].0;
    Look { group: if ear > 0.30 { "ears" } else { "body" }, material }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_shapes_have_the_same_faces() {
        let faces = |mesh: PolyMesh| -> Vec<String> {
            mesh.to_obj()
                .unwrap()
                .lines()
                .filter(|line| !line.starts_with(['#', 'm', 'v']))
                .map(str::to_owned)
                .collect()
        };
        let (round, long) = (puppet_round(), puppet_long());
        assert_eq!(round.positions.len(), long.positions.len());
        assert_eq!(faces(round), faces(long));
    }
}
