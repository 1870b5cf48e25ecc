//! Makes the mesh `apple`, of 550 polygons like the first model of the source paper.

use std::f64::consts::TAU;

use glam::DVec3;

use super::curve::{Profile, bump, noise, smoothstep};
use super::poly_mesh::{Look, PolyMesh};

/// The outline of half an apple, from the stem cavity to the calyx. Each point is its distance from the axis and its
/// height.
const OUTLINE: [[f64; 2]; 17] = [
    [0.0, 0.640],
    [0.045, 0.655],
    [0.105, 0.735],
    [0.180, 0.815],
    [0.275, 0.852],
    [0.375, 0.828],
    [0.455, 0.745],
    [0.498, 0.625],
    [0.500, 0.490],
    [0.462, 0.335],
    [0.392, 0.190],
    [0.310, 0.075],
    [0.225, 0.012],
    [0.160, 0.008],
    [0.105, 0.045],
    [0.050, 0.090],
    [0.0, 0.100],
];

/// An apple with its skin (20 × 20 faces), a curved stem (9 × 6) and one leaf (2 × 6 × 8).
pub fn apple() -> PolyMesh {
    let mut mesh = PolyMesh::new(
        "apple",
        "An apple with stem and leaf: 550 polygons.",
        &[
            ("red", "#b4262b"),
            ("crimson", "#9c1c2a"),
            ("orange", "#c4472b"),
            ("yellow", "#cf8f3a"),
            ("stem", "#5b3d22"),
            ("leaf", "#4f7a2a"),
        ],
    );
    skin(&mut mesh);
    stem(&mut mesh);
    leaf(&mut mesh);
    mesh.rest_on_ground();
    mesh
}

fn skin(mesh: &mut PolyMesh) {
    const SEGMENTS: usize = 20;
    const ROWS: usize = 20;
    let outline = Profile::through(&OUTLINE).spread(ROWS, 0.45);
    mesh.lathe(
        [ROWS, SEGMENTS],
        |row, segment| skin_point(outline[row].x, outline[row].y, TAU * segment as f64 / SEGMENTS as f64),
        |row, segment| Look { group: "skin", material: blush(row, segment, ROWS, SEGMENTS) },
    );
}

/// Turns a point of the outline round the axis, and makes it a little less regular than a lathe would.
fn skin_point(radius: f64, height: f64, angle: f64) -> DVec3 {
    // Five bumps round the calyx, fading out towards the belly.
    let five = (5.0 * angle + 0.4).cos();
    let low = (1.0 - smoothstep(0.02, 0.42, height)) * smoothstep(0.04, 0.16, radius);
    let lobes = 1.0 + 0.045 * five * low;
    let foot = -0.014 * five * bump(0.20, 0.17, radius) * (1.0 - smoothstep(0.1, 0.3, height));
    // One shoulder is higher than the other, and one cheek is fuller.
    let cheek = 1.0 + 0.022 * (angle - 0.7).cos() + 0.020 * (2.0 * angle + 1.1).cos();
    let shoulder = 0.030 * radius * 2.0 * (angle + 2.2).cos() * smoothstep(0.35, 0.85, height);
    let spread = radius * lobes * cheek;
    let lean = 0.05 * (height - 0.4);
    DVec3::new(spread * angle.cos() + lean, height + foot + shoulder, -spread * angle.sin() - 0.4 * lean)
}

/// The material of a face of the skin, streaked from the stem to the calyx: yellow in the cavity, orange on one cheek,
/// crimson on the other.
fn blush(row: usize, segment: usize, rows: usize, segments: usize) -> &'static str {
    let down = row as f64 / rows as f64;
    let round = segment as f64 / segments as f64;
    let streak = noise(round, down * 1.5, 20, 3);
    if down < 0.14 + 0.07 * streak {
        return "yellow";
    }
    let cheek = (TAU * (round - 0.62)).cos() + 0.9 * streak;
    if cheek > 0.75 {
        "orange"
    } else if cheek < -0.85 {
        "crimson"
    } else {
        "red"
    }
}

/// A tilted stem that leans over and thickens towards both ends.
fn stem(mesh: &mut PolyMesh) {
    const SIDES: usize = 6;
    // Along the stem from its cut top to its buried foot; the first and the last step are the end faces.
    const ALONG: [f64; 10] = [0.0, 0.0, 0.04, 0.16, 0.34, 0.54, 0.74, 0.92, 1.0, 1.0];
    mesh.lathe(
        [ALONG.len() - 1, SIDES],
        |row, side| {
            let t = ALONG[row];
            let end = row == 0 || row == ALONG.len() - 1;
            let radius =
                if end { 0.0 } else { 0.019 + 0.017 * bump(0.0, 0.3, t) + 0.008 * bump(1.0, 0.3, t) };
            let (centre, right, forward) = stem_frame(t, 0.40, 0.02);
            let angle = TAU * side as f64 / SIDES as f64;
            centre + radius * (right * angle.cos() + forward * angle.sin())
        },
        |_, _| Look { group: "stem", material: "stem" },
    );
}

/// The centre of a stem at `t` (0 is its cut top, 1 its foot), and two directions across it. The foot is `off_axis`
/// away from the apple's axis, along X and Z.
pub(super) fn stem_frame(t: f64, height: f64, off_axis: f64) -> (DVec3, DVec3, DVec3) {
    let centre = |t: f64| {
        let up = 1.0 - t;
        let lean = 0.115 * up * up;
        DVec3::new(off_axis + lean, 0.625 + height * up - 0.02 * up * up, off_axis - 0.035 * up)
    };
    let along = (centre(t - 0.01) - centre(t + 0.01)).normalize();
    let forward = along.cross(DVec3::X).normalize();
    (centre(t), forward.cross(along), forward)
}

/// A leaf, folded along its midrib, its tip hanging.
fn leaf(mesh: &mut PolyMesh) {
    const ACROSS: usize = 6;
    const ALONG: usize = 8;
    // The blade starts on the stem and runs out to the right and a little towards the viewer.
    let root = DVec3::new(0.075, 0.855, 0.005);
    let out = DVec3::new(0.93, 0.0, 0.36).normalize();
    let side = out.cross(DVec3::Y);
    mesh.blade(
        [ACROSS, ALONG],
        |column, row| {
            let t = row as f64 / ALONG as f64;
            let s = column as f64 / ACROSS as f64 * 2.0 - 1.0;
            let half_width =
                0.012 + 0.105 * (std::f64::consts::PI * t.powf(0.82)).sin().max(0.0) * (1.0 - 0.18 * t);
            let half_width = if row == ALONG { 0.006 } else { half_width };
            // The leaf rises and bends over. Its halves fold up from the midrib, and their rims wave.
            let reach = 0.46 * (t - 0.10 * t * t);
            let rise = 0.26 * t - 0.30 * t * t;
            let fold = 0.34 * half_width * s.abs().powf(1.3) + 0.010 * (9.0 * t + 2.0 * s).sin() * s.abs();
            let middle = root + out * reach + DVec3::Y * (rise + fold) + side * (half_width * s);
            let thick = 0.006 * (1.0 - s * s) + 0.004 * bump(0.0, 0.4, s);
            [middle + DVec3::Y * thick, middle - DVec3::Y * thick]
        },
        |_, _| Look { group: "leaf", material: "leaf" },
    );
}
