//! The parts of the portrait's head that are made apart from its skin: eyes with their lids, brows, lips, ears, pearls.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::loft::Skin;
use crate::curve::{bump, smoothstep};
use crate::poly_mesh::{Look, PolyMesh};

/// The centre of the eye at +X.
const EYE: DVec3 = DVec3::new(0.133, 0.498, 0.266);

const fn look(group: &'static str, material: &'static str) -> Look {
    Look { group, material }
}

/// Both eyes: a ball, an upper lid lowered over it, a lower lid.
pub fn eyes(mesh: &mut PolyMesh) {
    for side in [1.0, -1.0] {
        ball(mesh, side);
        // For each lid, the elevations of its free edge and of its end in the socket.
        lid(mesh, side, [-0.18, 1.05], 0.0655);
        lid(mesh, side, [-0.46, -1.15], 0.0635);
    }
}

fn eye_centre(side: f64) -> DVec3 {
    DVec3::new(side * EYE.x, EYE.y, EYE.z)
}

/// The eyeball. It looks down, and its pole is the pupil.
fn ball(mesh: &mut PolyMesh, side: f64) {
    const ROWS: usize = 12;
    let gaze = DVec3::new(0.0, -0.42, 1.0).normalize();
    let up = (DVec3::Y - gaze * gaze.y).normalize();
    let right = up.cross(gaze);
    mesh.lathe(
        [ROWS, 20],
        |row, segment| {
            let from_pole = PI * row as f64 / ROWS as f64;
            let angle = TAU * segment as f64 / 20.0;
            let across = right * angle.cos() + up * angle.sin();
            eye_centre(side) + 0.060 * (gaze * from_pole.cos() + across * from_pole.sin())
        },
        |row, _| {
            look(
                "eyes",
                if row < 1 {
                    "pupil"
                } else if row < 3 {
                    "iris"
                } else {
                    "white"
                },
            )
        },
    );
}

/// One lid: a shell over the eyeball between the corners of the eye. In the middle of the eye it reaches from the
/// elevation `from`, its free edge, to the elevation `to` in the socket.
fn lid(mesh: &mut PolyMesh, side: f64, [from, to]: [f64; 2], radius: f64) {
    const COLUMNS: usize = 18;
    const ROWS: usize = 7;
    let upper = to > from;
    mesh.blade(
        [COLUMNS, ROWS],
        |column, row| {
            let u = column as f64 / COLUMNS as f64 * 2.0 - 1.0;
            let outer = u * side;
            // Rows run up: the upper lid starts at its edge, the lower one ends there.
            let v = row as f64 / ROWS as f64;
            let v = if upper { v } else { 1.0 - v };
            let arch = (1.0 - u * u).max(0.0).powf(0.6);
            let corner = -0.20 + 0.10 * outer;
            let edge = corner + (from - corner) * arch;
            let elevation = edge + (to - edge) * v;
            let azimuth = 1.25 * u;
            let direction = DVec3::new(
                azimuth.sin() * elevation.cos() * 1.16,
                elevation.sin(),
                azimuth.cos() * elevation.cos(),
            );
            // The lid is thickest at its edge.
            let thick = 0.0022 + 0.0025 * (1.0 - smoothstep(0.0, 0.35, v));
            let centre = eye_centre(side);
            [centre + direction * (radius + thick), centre + direction * (radius - 0.004)]
        },
        |_, row| {
            let edge = if upper { row } else { ROWS - 1 - row };
            match (upper, edge) {
                (true, 0) => look("lids", "lash"),
                (false, 0) => look("lids", "rim"),
                (true, _) => look("lids", "lid"),
                (false, _) => look("lids", "skin_warm"),
            }
        },
    );
}

/// Both brows: thin tapering bodies on the brow ridge.
pub fn brows(mesh: &mut PolyMesh, skin: &Skin) {
    const COLUMNS: usize = 18;
    const ROWS: usize = 4;
    for side in [1.0, -1.0] {
        mesh.blade(
            [COLUMNS, ROWS],
            |column, row| {
                let along = column as f64 / COLUMNS as f64;
                let along = if side > 0.0 { along } else { 1.0 - along };
                let across = row as f64 / ROWS as f64 * 2.0 - 1.0;
                let x = 0.050 + 0.165 * along;
                let middle = 0.574 + 0.040 * (along * 2.1).sin() - 0.034 * along * along;
                let wide =
                    0.0125 * smoothstep(-0.25, 0.20, along) * (1.0 - 0.85 * smoothstep(0.3, 1.0, along));
                let foot = skin.face(side * x, middle + wide * across);
                let thick = 0.005 * (1.0 - across * across);
                [foot + DVec3::Z * (thick + 0.002), foot - DVec3::Z * 0.003]
            },
            |_, _| look("brows", "brow"),
        );
    }
}

/// Upper and lower lip: two bodies that meet in the parting line.
pub fn lips(mesh: &mut PolyMesh, skin: &Skin) {
    const COLUMNS: usize = 26;
    const ROWS: usize = 7;
    for upper in [true, false] {
        mesh.blade(
            [COLUMNS, ROWS],
            |column, row| {
                let u = column as f64 / COLUMNS as f64 * 2.0 - 1.0;
                let v = row as f64 / ROWS as f64;
                let v = if upper { v } else { 1.0 - v };
                lip_point(skin, upper, DVec2::new(u, v))
            },
            |_, row| match (upper, row) {
                (true, 0) => look("lips", "mouth"),
                (true, _) => look("lips", "lip_upper"),
                (false, _) => look("lips", "lip_lower"),
            },
        );
    }
}

/// The front and the back of a lip at a place: `at.x` runs from corner to corner of the mouth (−1..=1), `at.y` from the
/// parting line outwards (0..=1).
fn lip_point(skin: &Skin, upper: bool, at: DVec2) -> [DVec3; 2] {
    let (u, v) = (at.x, at.y);
    let wide = u.abs();
    let taper = (1.0 - wide.powf(2.2)).max(0.0);
    // The parting line: a small drop in the middle, corners turned up a little.
    let parting = 0.207 - 0.004 * bump(0.0, 0.35, u) + 0.003 * bump(0.45, 0.40, wide) + 0.010 * u * u;
    let (reach, full) = if upper {
        let bow = 0.025 * (1.0 - wide.powf(1.7)) + 0.003 * bump(0.26, 0.26, wide) - 0.004 * bump(0.0, 0.2, u);
        (bow.max(0.0), 0.007 + 0.002 * bump(0.0, 0.3, u))
    } else {
        (-0.033 * (1.0 - wide.powf(2.8)).max(0.0), 0.010 + 0.002 * bump(0.35, 0.4, wide))
    };
    let foot = skin.face(0.112 * u, parting + reach * v);
    let swell = if upper {
        (PI * (0.16 + 0.84 * v)).sin().powf(0.8)
    } else {
        (PI * (0.08 + 0.92 * v)).sin().powf(0.7)
    };
    let out = full * taper.powf(0.7) * swell.max(0.0) - 0.004 * (1.0 - taper);
    [foot + DVec3::Z * (out + 0.003), foot - DVec3::Z * 0.003]
}

/// Both ears: a rim, a hollow and a lobe, turned out from the head.
pub fn ears(mesh: &mut PolyMesh) {
    const ROWS: usize = 18;
    const SEGMENTS: usize = 24;
    for side in [1.0, -1.0] {
        // The ear's own plane: along its length, across it towards the back, and out of it.
        let length = DVec3::new(side * 0.10, 1.0, -0.22).normalize();
        let back = DVec3::new(side * 0.42, 0.0, -1.0);
        let back = (back - length * back.dot(length)).normalize();
        let out = length.cross(back) * -side;
        let centre = DVec3::new(side * 0.322, 0.415, -0.050);
        mesh.lathe(
            [ROWS, SEGMENTS],
            |row, segment| {
                // Seen from outside, segments turn counter-clockwise on both sides of the head.
                let angle = TAU * segment as f64 / SEGMENTS as f64 * side;
                let away = row as f64 / ROWS as f64 * 2.0;
                let (away, front) = if away <= 1.0 { (away, true) } else { (2.0 - away, false) };
                // The ear is narrow at the lobe, and full at the top and the back.
                let (sine, cosine) = angle.sin_cos();
                let rim = DVec2::new(0.058 + 0.016 * sine + 0.006 * cosine, 0.118);
                let (across, along) = (rim.x * away * cosine, rim.y * away * sine);
                let lobe = smoothstep(-0.4, -0.8, sine);
                let height =
                    if front { ear_relief(away, sine) * (1.0 - lobe) + 0.016 * lobe } else { -0.014 };
                let height = height * smoothstep(1.0, 0.92, away);
                centre
                    + length * along
                    + back * across
                    + out * (height + 0.03 * away * smoothstep(-0.5, 1.0, cosine))
            },
            |row, _| look("ears", if row < 6 { "ear_deep" } else { "skin_warm" }),
        );
    }
}

/// Height of the ear over its plane from the middle (0) to the rim (1): hollow, inner fold, groove, rim.
fn ear_relief(away: f64, sine: f64) -> f64 {
    let fold = 0.014 * bump(0.60, 0.18, away);
    let rim = 0.022 * bump(0.90, 0.16, away);
    -0.016 * bump(0.0, 0.5, away) + fold * smoothstep(-0.6, 0.2, sine) + rim
}

/// A pearl under each ear.
pub fn pearls(mesh: &mut PolyMesh) {
    const ROWS: usize = 11;
    const RADIUS: f64 = 0.030;
    for side in [1.0, -1.0] {
        let centre = DVec3::new(side * 0.314, 0.252, -0.052);
        mesh.lathe(
            [ROWS, 16],
            |row, segment| {
                let (down, angle) = (PI * row as f64 / ROWS as f64, TAU * segment as f64 / 16.0);
                let drop = 1.0 + 0.25 * smoothstep(0.5, 1.0, down.cos());
                let spread = RADIUS * down.sin();
                centre + DVec3::new(spread * angle.cos(), RADIUS * drop * down.cos(), -spread * angle.sin())
            },
            |_, _| look("pearls", "pearl"),
        );
    }
}
