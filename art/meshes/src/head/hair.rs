//! Models the hair of the head: parted in the middle, drawn back in waves over the ears to a knot.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::loft::form;
use crate::curve::{Profile, bump, smoothstep};
use crate::poly_mesh::{Look, PolyMesh};

/// Where the hair ends, as pairs of an angle from the front and the ring of the head that the hair reaches there.
const HAIRLINE: [[f64; 2]; 9] = [
    [0.0, 3.70],
    [0.30, 3.85],
    [0.60, 4.35],
    [0.90, 5.30],
    [1.20, 6.70],
    [1.45, 8.00],
    [1.75, 9.40],
    [2.30, 11.20],
    [3.15, 12.00],
];

/// How many locks lie between the crown and the hairline.
const LOCKS: f64 = 7.0;

/// Adds the cap of hair and the knot.
pub fn hair(mesh: &mut PolyMesh) {
    cap(mesh);
    knot(mesh);
}

fn cap(mesh: &mut PolyMesh) {
    const ROWS: usize = 56;
    const SEGMENTS: usize = 44;
    let hairline = Profile::through(&HAIRLINE);
    let angle_at = |segment: usize| TAU * segment as f64 / SEGMENTS as f64;
    mesh.lathe(
        [ROWS, SEGMENTS],
        |row, segment| cap_point(&hairline, row as f64 / ROWS as f64, angle_at(segment)),
        |row, _| Look { group: "hair", material: lock_tone(lock((row as f64 + 0.5) / ROWS as f64)) },
    );
}

/// Where a row lies across its lock: 0 in the furrow, 1 on the crest.
fn lock(down: f64) -> f64 {
    (down * LOCKS * PI).sin().abs()
}

fn lock_tone(high: f64) -> &'static str {
    if high > 0.80 {
        "hair_light"
    } else if high > 0.36 {
        "hair"
    } else {
        "hair_dark"
    }
}

/// A point of the cap: `row` is 0 at the crown and 1 at the hairline; rows follow the waves of the locks.
fn cap_point(hairline: &Profile, row: f64, angle: f64) -> DVec3 {
    let turned = if angle > PI { TAU - angle } else { angle };
    let wave = 0.040 * (5.0 * turned - 3.0 * row).sin() * smoothstep(0.1, 0.5, turned);
    let down = row + wave * 4.0 * row * (1.0 - row);
    let foot = form(hairline.height_at(turned) * down, angle);
    let out = DVec3::new(foot.x / 0.30, (foot.y - 0.62).max(-0.1) / 0.38, (foot.z + 0.06) / 0.42)
        .normalize_or(DVec3::Y);
    // Full over the ears, flatter on top; at the hairline it rolls under.
    let full = 0.040 + 0.030 * bump(1.55, 0.9, turned) * smoothstep(0.45, 0.9, down);
    let roll = smoothstep(0.78, 1.0, down);
    let roll = (1.0 - roll * roll).max(0.0).sqrt();
    let waves = 0.014 * (lock(row).powf(0.7) - 0.6) * smoothstep(0.08, 0.25, down);
    let parting =
        0.020 * (-(foot.x / 0.018).powi(2)).exp() * smoothstep(1.2, 0.8, turned) * smoothstep(0.0, 0.2, down);
    foot + out * ((full + waves - parting) * roll - 0.018 * (1.0 - roll))
}

/// A knot at the back of the head, wound like a shell.
fn knot(mesh: &mut PolyMesh) {
    const ROWS: usize = 24;
    const SEGMENTS: usize = 30;
    let centre = DVec3::new(0.0, 0.400, -0.510);
    let axis = DVec3::new(0.0, -0.12, -1.0).normalize();
    let up = (DVec3::Y - axis * axis.y).normalize();
    let right = up.cross(axis);
    let wound = |row: usize, segment: usize| {
        let (away, turn) = (row as f64 / ROWS as f64, segment as f64 / SEGMENTS as f64);
        ((away * 4.5 + turn) * PI).sin().abs()
    };
    mesh.lathe(
        [ROWS, SEGMENTS],
        |row, segment| {
            let away = PI * row as f64 / ROWS as f64;
            let angle = TAU * segment as f64 / SEGMENTS as f64;
            let radius = 0.155 + 0.016 * (wound(row, segment).powf(0.6) - 0.6) * away.sin();
            let across = right * angle.cos() * 1.05 + up * angle.sin();
            centre + radius * (0.80 * axis * away.cos() + across * away.sin())
        },
        |row, segment| Look { group: "knot", material: lock_tone(wound(row, segment)) },
    );
}
