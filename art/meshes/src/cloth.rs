//! Makes the mesh of the still life's cloth: linen that lies on a table and hangs over its front edge in round folds.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec2, DVec3};

use super::curve::{Profile, bump, noise, smoothstep};
use super::poly_mesh::{Look, PolyMesh};

const COLUMNS: usize = 160;
const ROWS: usize = 80;
/// How many of the rows hang; the others lie on the table.
const HANGING: usize = 38;
/// Where the cloth has no folds: how far it lies above the table, and hangs in front of the table's edge.
const CLEARANCE: f64 = 0.008;
/// The radius of the cloth's bend round the table's edge.
const BEND: f64 = 0.03;
/// The radius of the bend where one corner is folded over.
const TURN: f64 = 0.016;

/// A fold: round where the cloth hangs, and a ridge on the table that gets lower towards the back.
struct Fold {
    /// Where its crest is, as a share of the cloth's width: at the hem, at the table's edge, and where the fold ends on
    /// the table.
    crest: [f64; 3],
    /// Half its width at the table's edge, as a share of the cloth's width.
    width: f64,
    /// About how far it stands out at the hem.
    height: f64,
    /// How far it runs back onto the table.
    reach: f64,
    /// How far it leans over: to the right, or to the left if negative.
    lean: f64,
}

const fn fold(crest: [f64; 3], [width, height]: [f64; 2], reach: f64, lean: f64) -> Fold {
    Fold { crest, width, height, reach, lean }
}

/// The folds, from the cloth's left edge to its right one. They begin under the fruit and spread towards the hem.
const FOLDS: [Fold; 7] = [
    fold([0.010, 0.030, 0.07], [0.052, 0.026], 0.12, -0.4),
    fold([0.105, 0.130, 0.19], [0.070, 0.074], 0.26, 0.7),
    fold([0.325, 0.350, 0.44], [0.084, 0.112], 0.42, 0.9),
    fold([0.490, 0.485, 0.48], [0.056, 0.020], 0.10, 0.4),
    fold([0.690, 0.660, 0.60], [0.076, 0.084], 0.43, 0.6),
    fold([0.865, 0.830, 0.70], [0.066, 0.112], 0.45, 0.8),
    fold([0.975, 0.955, 0.90], [0.044, 0.034], 0.16, 0.4),
];

/// A linen cloth (160 × 80 faces). Its origin is the middle of the table's edge: the table's
/// top is y = 0 for z < 0, and its front is z = 0.
pub fn cloth() -> PolyMesh {
    let mut mesh = PolyMesh::new(
        "cloth",
        "A cloth on a table's top (y = 0, z < 0) that hangs over its front edge (z = 0); open at its rim.",
        &[("linen", "#cfc6b3"), ("worn", "#c9bfaa"), ("hem", "#d6cebd")],
    );
    let back = Profile::through(&[[0.0, 0.50], [0.25, 0.60], [0.55, 0.74], [0.80, 0.76], [1.0, 0.70]]);
    mesh.sheet(
        [COLUMNS, ROWS],
        |column, row| {
            let across = column as f64 / COLUMNS as f64;
            draped(DVec2::new(across, along(row, across, back.height_at(across))))
        },
        |column, row| {
            let patch = noise(column as f64 / COLUMNS as f64 * 0.5, row as f64 * 0.07, 9, 41);
            let material = match row {
                0..=1 => "hem",
                _ if patch > 0.3 => "worn",
                _ => "linen",
            };
            // The last two hanging rows, at the table's edge, count as lying on the table.
            Look { group: if row + 2 < HANGING { "fall" } else { "top" }, material }
        },
    );
    mesh
}

/// How far behind the table's edge, along the cloth, a row lies; negative where it hangs.
fn along(row: usize, across: f64, back: f64) -> f64 {
    if row < HANGING {
        let drop = 0.222 - 0.024 * across;
        -drop * (1.0 - row as f64 / HANGING as f64)
    } else {
        let share = (row - HANGING) as f64 / (ROWS - HANGING) as f64;
        // The cloth's back edge is slightly wavy.
        let wave = 0.004 * noise(across * 0.5, 0.0, 6, 9);
        share * (back + wave)
    }
}

/// Where a point of the flat cloth comes to lie: `flat.x` is its share of the width, `flat.y` how far it
/// lies behind the table's edge.
fn draped(flat: DVec2) -> DVec3 {
    let (place, lift) = turned(flat);
    let (height, sideways) = folded(place);
    // Towards the back the cloth is gathered, and it lies a little askew.
    let lying = place.y.max(0.0);
    let hanging = (-place.y).max(0.0);
    let width = 1.16 - 0.16 * smoothstep(0.0, 0.75, lying) + 0.10 * hanging;
    let uneven_edge = 0.005 * (6.0 * place.y + 4.0 * place.x).sin() * bump(0.5, 0.5, (place.x - 0.5).abs());
    let x = (place.x - 0.5 + sideways) * width + 0.14 * lying + uneven_edge;
    let (over, normal) = over_edge(place.y);
    let point = DVec3::new(x, over.y, over.x);
    point + DVec3::new(0.0, normal.y, normal.x) * (height + lift)
}

/// The place at `along` on the path over the table's edge, and the cloth's outward direction there. Both are (z, y).
fn over_edge(along: f64) -> (DVec2, DVec2) {
    let centre = DVec2::new(CLEARANCE - BEND, CLEARANCE - BEND);
    if along >= 0.0 {
        return (centre + DVec2::new(-along, BEND), DVec2::Y);
    }
    let angle = (-along / BEND).min(FRAC_PI_2);
    let out = DVec2::new(angle.sin(), angle.cos());
    let below = (-along - FRAC_PI_2 * BEND).max(0.0);
    (centre + out * BEND - DVec2::Y * below, out)
}

/// Folds the back left corner over onto the cloth. Returns where the point then lies on the flat cloth, and how far
/// above it.
fn turned(flat: DVec2) -> (DVec2, f64) {
    // In units of length, from the left edge.
    let point = DVec2::new(flat.x * 0.9, flat.y);
    let (from, to) = (DVec2::new(0.0, 0.20), DVec2::new(0.25, 0.56));
    let line = (to - from).normalize();
    let beyond_line = DVec2::new(-line.y, line.x);
    let past = (point - from).dot(beyond_line);
    if past <= 0.0 {
        return (flat, 0.0);
    }
    let (step, lift) = if past < PI * TURN {
        let angle = past / TURN;
        (TURN * angle.sin(), TURN * (1.0 - angle.cos()))
    } else {
        let lying = past - PI * TURN;
        // The flap springs open a little towards its tip.
        (-lying, 2.0 * TURN + 0.6 * lying * lying - 0.006 * smoothstep(0.0, 0.05, lying))
    };
    let place = point + beyond_line * (step - past);
    (DVec2::new(place.x / 0.9, place.y), lift)
}

/// How far the cloth stands out in its folds, and how far it is pushed sideways, as a share of the width.
fn folded(place: DVec2) -> (f64, f64) {
    let hanging = smoothstep(-0.01, -0.24, place.y);
    // The folds wander a little on their way.
    let wander = 0.008 * (13.0 * place.y + 5.0 * place.x).sin();
    let mut height = 0.0;
    let mut sideways = 0.0;
    for fold in &FOLDS {
        let lying = (place.y / fold.reach).clamp(0.0, 1.0);
        let [hem, edge, end] = fold.crest;
        let crest = edge + (hem - edge) * hanging + (end - edge) * lying + wander;
        let width = fold.width * (1.0 + 0.25 * hanging - 0.45 * lying);
        // The side that the fold leans to is the steeper one.
        let off = (place.x - crest) / width;
        let off = off
            * if off * fold.lean > 0.0 { 1.0 + 0.22 * fold.lean.abs() } else { 1.0 - 0.25 * fold.lean.abs() };
        let profile = bump(0.0, 1.0, off);
        let stands =
            fold.height * (0.62 + 0.50 * hanging) * (1.0 - lying * lying * (3.0 - 2.0 * lying)) * profile;
        height += stands;
        sideways += 0.22 * fold.lean * stands * profile;
    }
    // Between the folds the cloth is never quite flat, except under the fruit.
    let slack =
        0.007 * (0.5 + 0.5 * noise(place.x * 0.5, place.y * 6.0, 14, 3)) * smoothstep(0.27, 0.12, place.y);
    (height + slack, sideways)
}
