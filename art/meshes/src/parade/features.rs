//! Makes the features of the giant's face: lips, mouth and teeth, lids and brows, which move with its skin; its ears;
//! and its eyes, which are meshes of their own.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::skin::{EYE, MIDDLE, Mood, skin};
use crate::curve::smoothstep;
use crate::poly_mesh::{Look, PolyMesh};

const fn look(group: &'static str, material: &'static str) -> Look {
    Look { group, material }
}

/// The mouth in a mood: lines from corner to corner, in angles to the side and up.
struct Mouth {
    mood: Mood,
}

impl Mouth {
    /// A point of the line where the lips part, at the edge of the upper lip or of the lower one. `u` runs from corner
    /// to corner of the mouth, −1..=1.
    fn parting(&self, u: f64, upper: bool) -> DVec2 {
        let smile = self.mood.smile;
        let wide = 0.35 + 0.15 * smile;
        let lift = (0.030 + 0.135 * smile) * u * u - 0.010 * (1.0 - u * u) * (1.0 - smile);
        let round = (1.0 - u * u).max(0.0);
        let gap = if upper { 0.006 + 0.028 * smile } else { -0.010 - 0.125 * smile };
        DVec2::new(wide * u, -0.450 - 0.010 * smile + lift + gap * round.powf(0.8))
    }

    /// How high a lip is.
    fn height(&self, u: f64, upper: bool) -> f64 {
        let full = (1.0 - u * u).max(0.0).powf(0.6);
        // The upper lip has a dip in its middle.
        let bow = if upper { 1.0 - 0.22 * (-(u / 0.16).powi(2)).exp() } else { 1.0 };
        (0.016 + full * bow * if upper { 0.066 } else { 0.080 }) * (1.0 - 0.18 * self.mood.smile)
    }
}

/// Lips, teeth, and the dark between them.
pub fn mouth(mesh: &mut PolyMesh, mood: Mood) {
    const COLUMNS: usize = 24;
    let mouth = Mouth { mood };
    let along = |column: usize| column as f64 / COLUMNS as f64 * 2.0 - 1.0;
    for upper in [true, false] {
        const ROWS: usize = 5;
        mesh.blade(
            [COLUMNS, ROWS],
            |column, row| {
                let u = along(column);
                // Rows run up: the upper lip starts at the parting, the lower one ends there.
                let v = row as f64 / ROWS as f64;
                let up = if upper { v } else { v - 1.0 };
                let at = mouth.parting(u, upper) + DVec2::Y * (up * mouth.height(u, upper));
                let full = (1.0 - u * u).max(0.0).powf(0.5);
                let dome = (PI * (0.12 + 0.80 * up.abs())).sin();
                [skin(at, 0.010 + 0.026 * dome * (0.35 + 0.65 * full), mood), skin(at, -0.002, mood)]
            },
            |_, _| look("lips", "lips"),
        );
    }
    // The dark reaches a little under both lips. The teeth hang from under the upper one.
    let sheet = |u: f64, v: f64, teeth: bool| {
        let (high, low) = (mouth.parting(u, true), mouth.parting(u, false));
        let round = (1.0 - u * u).max(0.0).powf(0.6);
        let top = high + DVec2::Y * (0.030 * round);
        let foot = if teeth { high.lerp(low, 0.50 * mood.smile) + DVec2::Y * 0.010 * round } else { low };
        let foot = if teeth { foot } else { foot - DVec2::Y * (0.025 * round) };
        foot.lerp(top, v) * DVec2::new(if teeth { 0.93 } else { 0.98 }, 1.0)
    };
    for (group, teeth, lift) in [("mouth", false, 0.004), ("teeth", true, 0.009)] {
        mesh.sheet(
            [COLUMNS, 2],
            |column, row| skin(sheet(along(column), row as f64 / 2.0, teeth), lift, mood),
            |_, _| look(group, "teeth"),
        );
    }
}

/// Both brows: bushy, arched sheets on the brow ridge.
pub fn brows(mesh: &mut PolyMesh, mood: Mood) {
    const COLUMNS: usize = 14;
    const ROWS: usize = 4;
    for side in [1.0, -1.0] {
        mesh.sheet(
            [COLUMNS, ROWS],
            |column, row| {
                let along = column as f64 / COLUMNS as f64;
                let along = if side > 0.0 { along } else { 1.0 - along };
                let across = row as f64 / ROWS as f64 * 2.0 - 1.0;
                let wide =
                    0.052 * (0.35 + 0.65 * smoothstep(0.0, 0.25, along)) * (1.0 - 0.75 * along * along);
                let middle = 0.450 + 0.050 * (PI * (0.10 + 0.80 * along)).sin() - 0.048 * along
                    + 0.110 * mood.brows * (1.0 - 0.35 * along)
                    + 0.020 * mood.smile
                    - 0.015 * mood.blink;
                let at = DVec2::new(side * (0.13 + 0.54 * along), middle + wide * across);
                skin(at, -0.004 + 0.036 * (1.0 - across * across).sqrt() * (1.0 - 0.5 * along), mood)
            },
            |_, _| look("brows", "brows"),
        );
    }
}

/// Both ears: flat round bodies.
pub fn ears(mesh: &mut PolyMesh) {
    const ROWS: usize = 9;
    const SEGMENTS: usize = 12;
    for side in [1.0, -1.0] {
        let middle = MIDDLE + DVec3::new(side * 0.305, -0.03, 0.005);
        mesh.lathe(
            [ROWS, SEGMENTS],
            |row, segment| {
                let (down, round) = (PI * row as f64 / ROWS as f64, TAU * segment as f64 / SEGMENTS as f64);
                let ball = DVec3::new(down.sin() * round.cos(), down.cos(), -down.sin() * round.sin());
                let turn = glam::DQuat::from_rotation_y(side * 0.45);
                middle + turn * (ball * DVec3::new(0.055, 0.090, 0.028))
            },
            |_, _| look("ears", "skin"),
        );
    }
}

/// Where an eye's middle is, and its axes: to its left, up, and ahead.
pub fn eye_frame(side: f64) -> (DVec3, [DVec3; 3]) {
    let ahead = DVec3::new(0.16 * side, -0.02, 1.0).normalize();
    let left = DVec3::Y.cross(ahead).normalize();
    let middle = skin(DVec2::new(side * EYE.x, EYE.y), 0.0, Mood::default()) - ahead * 0.012;
    (middle, [left, ahead.cross(left), ahead])
}

/// Half the size of an eye along its axes.
const BALL: DVec3 = DVec3::new(0.069, 0.075, 0.044);

/// A point of a shell that lies `out` outside the eyeball, by its angles to the left and up.
fn round_eye(side: f64, at: DVec2, out: f64) -> DVec3 {
    let (middle, axes) = eye_frame(side);
    let way = DVec3::new(at.x.sin() * at.y.cos(), at.y.sin(), at.x.cos() * at.y.cos());
    let on = way * (BALL + out);
    middle + axes[0] * on.x + axes[1] * on.y + axes[2] * on.z
}

/// An eye: a flat ball with a painted iris and a speck of light.
pub fn eye(side: f64) -> PolyMesh {
    const SEGMENTS: usize = 20;
    /// How far from the pole each ring lies.
    const RINGS: [f64; 10] = [0.0, 0.14, 0.28, 0.44, 0.58, 0.95, 1.25, 1.6, 2.2, PI];
    let mut mesh = PolyMesh::new(
        if side > 0.0 { "eye_left" } else { "eye_right" },
        "An eye of the giant.",
        &[("eye_white", "#f8f4ea"), ("iris", "#3f6b8c"), ("pupil", "#17130f")],
    );
    let (middle, axes) = eye_frame(side);
    mesh.lathe(
        [RINGS.len() - 1, SEGMENTS],
        |row, segment| {
            let round = TAU * segment as f64 / SEGMENTS as f64;
            let way =
                DVec3::new(RINGS[row].sin() * round.cos(), RINGS[row].sin() * round.sin(), RINGS[row].cos());
            let on = way * BALL;
            middle + axes[0] * on.x + axes[1] * on.y + axes[2] * on.z
        },
        |row, segment| {
            // The speck: above, and on the side of the sun.
            let speck = (2..4).contains(&row) && (6..9).contains(&segment);
            let material = match row {
                _ if speck => "eye_white",
                0..3 => "pupil",
                3..5 => "iris",
                _ => "eye_white",
            };
            look("eye", material)
        },
    );
    mesh
}

/// The lids of both eyes: shells over the balls.
pub fn lids(mesh: &mut PolyMesh, mood: Mood) {
    for side in [1.0, -1.0] {
        // Elevations of the free edges in the middle of the eye. In the socket the lids end at ±1.45.
        let shut = -0.50;
        let upper = 0.86 - 0.12 * mood.smile + 0.10 * mood.brows;
        let lower = -0.90 + 0.24 * mood.smile;
        lid(mesh, side, [upper + (shut - upper) * mood.blink, 1.45]);
        lid(mesh, side, [lower + (shut + 0.06 - lower) * mood.blink, -1.45]);
    }
}

fn lid(mesh: &mut PolyMesh, side: f64, [from, to]: [f64; 2]) {
    const COLUMNS: usize = 14;
    const ROWS: usize = 5;
    let upper = to > 0.0;
    mesh.blade(
        [COLUMNS, ROWS],
        |column, row| {
            let u = column as f64 / COLUMNS as f64 * 2.0 - 1.0;
            // Rows counted from the free edge; on the upper lid, the first band of faces is the lash.
            let row = if upper { row } else { ROWS - row };
            let v = [0.0, 0.08, 0.12, 0.40, 0.70, 1.0][row];
            let corner = -0.08;
            let edge = corner + (from - corner) * (1.0 - u * u).max(0.0).powf(0.6);
            let at = DVec2::new(1.45 * u, edge + (to - edge) * v);
            let thick = match row {
                1 if upper => 0.023,
                _ if upper => 0.015,
                _ => 0.012,
            };
            [round_eye(side, at, thick), round_eye(side, at, 0.002)]
        },
        |_, row| look("lids", if upper && row == 0 { "brows" } else { "skin" }),
    );
}
