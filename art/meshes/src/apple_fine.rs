//! A finer apple than the source paper's: streaked skin, a stem, and one large leaf.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::apple::stem_frame;
use super::curve::{Profile, bump, hash, noise, smoothstep};
use super::poly_mesh::{Look, PolyMesh};

/// The outline of half an apple, from the stem cavity to the calyx. Each point is its distance from the axis and its
/// height.
const OUTLINE: [[f64; 2]; 17] = [
    [0.0, 0.640],
    [0.045, 0.660],
    [0.105, 0.735],
    [0.180, 0.810],
    [0.275, 0.845],
    [0.375, 0.820],
    [0.455, 0.740],
    [0.498, 0.625],
    [0.500, 0.490],
    [0.466, 0.340],
    [0.430, 0.195],
    [0.362, 0.086],
    [0.262, 0.018],
    [0.170, 0.010],
    [0.105, 0.045],
    [0.050, 0.090],
    [0.0, 0.100],
];

/// The skin's materials, from yellow to crimson. Neighbours differ so little that no border shows between them.
const SKIN: [&str; 28] = [
    "skin_01", "skin_02", "skin_03", "skin_04", "skin_05", "skin_06", "skin_07", "skin_08", "skin_09",
    "skin_10", "skin_11", "skin_12", "skin_13", "skin_14", "skin_15", "skin_16", "skin_17", "skin_18",
    "skin_19", "skin_20", "skin_21", "skin_22", "skin_23", "skin_24", "skin_25", "skin_26", "skin_27",
    "skin_28",
];

/// Height of the apple's middle above its foot.
pub const MIDDLE: f64 = 0.44;

/// An apple with its skin (52 × 144 faces), a curved stem (16 × 12) and one leaf (2 × 12 × 22) towards −X. The origin
/// is its middle, so that an animation can roll it.
pub fn apple_fine() -> PolyMesh {
    let mut mesh = PolyMesh::new(
        "apple_fine",
        "An apple with stem and leaf; the origin is its middle, its foot is at y = -0.44.",
        &[
            ("skin_01", "#d8a743"),
            ("skin_02", "#d7a141"),
            ("skin_03", "#d79b40"),
            ("skin_04", "#d6953e"),
            ("skin_05", "#d58f3d"),
            ("skin_06", "#d3883b"),
            ("skin_07", "#d2823a"),
            ("skin_08", "#d07b38"),
            ("skin_09", "#ce7437"),
            ("skin_10", "#cc6d35"),
            ("skin_11", "#ca6734"),
            ("skin_12", "#c86032"),
            ("skin_13", "#c65a31"),
            ("skin_14", "#c45430"),
            ("skin_15", "#c14d2e"),
            ("skin_16", "#bf472d"),
            ("skin_17", "#bc412c"),
            ("skin_18", "#b83b2c"),
            ("skin_19", "#b5352b"),
            ("skin_20", "#b1312b"),
            ("skin_21", "#ae2c2a"),
            ("skin_22", "#aa282a"),
            ("skin_23", "#a5252a"),
            ("skin_24", "#a02329"),
            ("skin_25", "#9b2029"),
            ("skin_26", "#951e28"),
            ("skin_27", "#8e1c28"),
            ("skin_28", "#881a27"),
            ("stem", "#6a4526"),
            ("leaf", "#557f2c"),
            ("leaf_shade", "#47702a"),
            ("rib", "#7d9a45"),
        ],
    );
    mesh.polish(&SKIN, 0.5, 120.0);
    mesh.polish(&["leaf", "leaf_shade", "rib"], 0.2, 40.0);
    skin(&mut mesh);
    stem(&mut mesh);
    leaf(&mut mesh);
    mesh.rest_on_ground();
    for point in &mut mesh.positions {
        point.y -= MIDDLE;
    }
    mesh
}

fn skin(mesh: &mut PolyMesh) {
    const SEGMENTS: usize = 144;
    const ROWS: usize = 52;
    let outline = Profile::through(&OUTLINE).spread(ROWS, 0.4);
    mesh.lathe(
        [ROWS, SEGMENTS],
        |row, segment| skin_point(outline[row].x, outline[row].y, TAU * segment as f64 / SEGMENTS as f64),
        |row, segment| {
            let round = (segment as f64 + 0.5) / SEGMENTS as f64;
            Look { group: "skin", material: blush(round, (row as f64 + 0.5) / ROWS as f64) }
        },
    );
}

/// Turns a point of the outline round the axis, and makes it a little less regular than a lathe would.
fn skin_point(radius: f64, height: f64, angle: f64) -> DVec3 {
    // Five bumps round the calyx, fading out towards the belly.
    let five = (5.0 * angle + 0.4).cos();
    let low = (1.0 - smoothstep(0.02, 0.45, height)) * smoothstep(0.04, 0.16, radius);
    let lobes = 1.0 + 0.012 * five * low;
    let foot = -0.009 * five * bump(0.20, 0.17, radius) * (1.0 - smoothstep(0.1, 0.3, height));
    // One shoulder higher than the other, one cheek fuller.
    let cheek = 1.0 + 0.018 * (angle - 0.7).cos() + 0.020 * (2.0 * angle + 1.1).cos();
    let shoulder = 0.044 * radius * (angle + 2.2).cos() * smoothstep(0.35, 0.85, height)
        + 0.012 * (3.0 * angle + 0.5).cos() * bump(0.28, 0.2, radius) * smoothstep(0.6, 0.8, height);
    let spread = radius * lobes * cheek;
    let lean = 0.04 * (height - 0.4);
    DVec3::new(spread * angle.cos() + lean, height + foot + shoulder, -spread * angle.sin() - 0.4 * lean)
}

/// The skin's material at a place: yellow in the cavity and about the calyx, orange on one cheek, crimson on the other,
/// with streaks. `round` is a share of a turn, `down` a share of the way from the stem to the calyx.
fn blush(round: f64, down: f64) -> &'static str {
    let broad = noise(round + 0.010 * (5.0 * down).sin(), 0.7 * down, 11, 3);
    let cheek = -(TAU * (round - 0.58)).cos();
    let cavity = 13.0 * smoothstep(0.26 + 0.05 * broad, 0.05, down);
    let calyx = 7.5 * smoothstep(0.72 + 0.05 * broad, 1.0, down);
    let redness = 17.5 + 8.0 * cheek + 3.6 * broad + streaks(round, down) - cavity - calyx;
    SKIN[redness.round().clamp(0.0, (SKIN.len() - 1) as f64) as usize]
}

/// What the streaks add to the redness. They are long threads, some redder than the skin under them, some yellower.
/// Each is a few faces broad in its middle, and tapers to both ends.
fn streaks(round: f64, down: f64) -> f64 {
    const COUNT: u32 = 46;
    (0..COUNT)
        .map(|index| {
            let random = |number: u32| hash([index, number, 61]);
            let middle = 0.46 + 0.20 * random(1);
            let reach = 0.30 + 0.12 * random(2);
            let along = (down - middle) / reach;
            let taper = (1.0 - along * along).max(0.0);
            let place = (f64::from(index) + 0.7 * random(3)) / f64::from(COUNT)
                + 0.006 * (4.0 * down + random(4)).sin();
            // Measured the shorter way round.
            let off = (round - place + 0.5).rem_euclid(1.0) - 0.5;
            let half_width = (0.017 + 0.006 * random(5)) * taper.sqrt() + 1e-4;
            let strength = 4.2 * random(6) + 0.8;
            strength * taper.sqrt() * (1.0 - (off / half_width).abs()).max(0.0)
        })
        .sum()
}

/// A tilted stem that leans over and thickens towards both ends.
fn stem(mesh: &mut PolyMesh) {
    const SIDES: usize = 12;
    const ALONG: usize = 16;
    mesh.lathe(
        [ALONG, SIDES],
        |row, side| {
            // The first and the last band are the end faces.
            let t = row.saturating_sub(1).min(ALONG - 2) as f64 / (ALONG - 2) as f64;
            let end = row == 0 || row == ALONG;
            let radius =
                if end { 0.0 } else { 0.019 + 0.016 * bump(0.0, 0.3, t) + 0.010 * bump(1.0, 0.3, t) };
            let (centre, right, forward) = stem_frame(t, 0.41, 0.01);
            let angle = TAU * side as f64 / SIDES as f64;
            centre + radius * (right * angle.cos() + forward * angle.sin())
        },
        |_, _| Look { group: "stem", material: "stem" },
    );
}

/// A large leaf on a short stalk, folded along its midrib, bent over, its tip hanging.
fn leaf(mesh: &mut PolyMesh) {
    const ACROSS: usize = 12;
    const ALONG: usize = 22;
    // It springs from the stem and runs out to the left and a little towards the viewer.
    let root = DVec3::new(0.045, 0.850, 0.0);
    let out = DVec3::new(-0.94, 0.0, 0.34).normalize();
    let side = out.cross(DVec3::Y);
    mesh.blade(
        [ACROSS, ALONG],
        |column, row| {
            let t = row as f64 / ALONG as f64;
            let even = column as f64 / ACROSS as f64 * 2.0 - 1.0;
            // The columns are closer together at the midrib, which is narrow.
            let s = even * (0.5 + 0.5 * even * even);
            // A stalk, then the blade, widest before its middle, drawn out to a tip.
            let blade = ((t - 0.12) / 0.88).max(0.0);
            let half_width =
                0.010 + 0.150 * (PI * blade.powf(0.78)).sin().max(0.0).powf(0.9) * (1.0 - 0.25 * blade);
            let half_width = if row == ALONG { 0.004 } else { half_width };
            let reach = 0.72 * t - 0.07 * t * t;
            let rise = 0.50 * t - 0.52 * t * t;
            // The halves rise from the midrib; their rim waves.
            let fold = half_width * (0.55 * s.abs() - 0.18 * s * s)
                + 0.012 * (11.0 * t + 1.5 * s).sin() * s * s * bump(0.5, 0.5, blade);
            let twist = 0.35 * half_width * s * (0.4 + t);
            let middle =
                root + out * reach + DVec3::Y * (rise + fold + twist) + side * (half_width * s * 0.95);
            let thick = 0.005 * (1.0 - s * s) + 0.006 * bump(0.0, 0.25, s) * (1.0 - 0.7 * t);
            [middle + DVec3::Y * thick, middle - DVec3::Y * thick]
        },
        |column, _| {
            let material = match column {
                5 | 6 => "rib",
                0..=5 => "leaf_shade",
                _ => "leaf",
            };
            Look { group: "leaf", material }
        },
    );
}
