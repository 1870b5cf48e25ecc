//! The jug of the still life: thrown clay, glazed from the rim to below the belly, with a lip and a handle.

use std::f64::consts::TAU;

use glam::DVec3;

use super::curve::{Profile, bump, noise, smoothstep};
use super::poly_mesh::{Look, PolyMesh};

/// The outline of half the jug, from the middle of the foot, up the outside, over the rim and down the inside. Each
/// point is its distance from the axis and its height.
const OUTLINE: [[f64; 2]; 26] = [
    [0.0, 0.010],
    [0.15, 0.010],
    [0.205, 0.0],
    [0.232, 0.010],
    [0.262, 0.055],
    [0.3185, 0.150],
    [0.362, 0.270],
    [0.372, 0.380],
    [0.345, 0.500],
    [0.286, 0.615],
    [0.222, 0.710],
    [0.186, 0.790],
    [0.182, 0.855],
    [0.202, 0.920],
    [0.236, 0.972],
    [0.248, 0.992],
    [0.238, 1.004],
    [0.220, 0.992],
    [0.182, 0.930],
    [0.150, 0.860],
    [0.152, 0.790],
    [0.188, 0.700],
    [0.312, 0.480],
    [0.320, 0.280],
    [0.200, 0.060],
    [0.0, 0.045],
];

/// A jug of about one unit: body (64 × 72 faces), spout towards −X, handle towards +X.
pub fn jug() -> PolyMesh {
    let mut mesh = PolyMesh::new(
        "jug",
        "A glazed clay jug, its lip towards -X, its handle towards +X.",
        &[("glaze", "#3f6673"), ("rim", "#5a8894"), ("clay", "#b08d6c"), ("inside", "#15232a")],
    );
    mesh.polish(&["glaze"], 0.9, 300.0);
    body(&mut mesh);
    handle(&mut mesh);
    mesh
}

fn body(mesh: &mut PolyMesh) {
    const ROWS: usize = 64;
    const SEGMENTS: usize = 72;
    const FINE: usize = 24;
    /// About the height at which the glaze ends.
    const GLAZE: f64 = 0.245;
    // Sampled more finely than the rows, so that rows can follow the wavy border of the glaze.
    let mut outline = Profile::through(&OUTLINE).spread(ROWS * FINE, 0.45);
    // The lathe runs from the upper pole to the lower one; here that is from the inside floor to the foot.
    outline.reverse();
    let rim = (0..=ROWS).max_by(|&a, &b| outline[a * FINE].y.total_cmp(&outline[b * FINE].y)).unwrap_or(0);
    let below = |height: f64| (rim..=ROWS).find(|&row| outline[row * FINE].y < height).unwrap_or(ROWS);
    let (border, lowest) = (below(GLAZE), ROWS - 4);
    let outline_at = |row: usize, segment: usize| {
        let angle = TAU * segment as f64 / SEGMENTS as f64;
        // The height at which the glaze ends at this angle. The rows near it are moved along the outline, so that one
        // lies there.
        let wanted = GLAZE + glaze_run(angle);
        let found = (rim * FINE..=ROWS * FINE).find(|&fine| outline[fine].y < wanted).unwrap_or(ROWS * FINE);
        let shift = found as f64 - (border * FINE) as f64;
        let share = if row <= border {
            smoothstep((border - 16) as f64, border as f64, row as f64)
        } else {
            smoothstep(lowest as f64, border as f64, row as f64)
        };
        let fine = ((row * FINE) as f64 + shift * share).round() as usize;
        (outline[fine.min(ROWS * FINE)], angle)
    };
    mesh.lathe(
        [ROWS, SEGMENTS],
        |row, segment| {
            let (point, angle) = outline_at(row, segment);
            body_point(point.x, point.y, angle)
        },
        |row, _| {
            let height = outline[row * FINE].y;
            let (group, material) = if row + 2 < rim && height < 0.975 {
                ("inside", "inside")
            } else if height > 0.962 {
                ("body", "rim")
            } else if row < border {
                ("body", "glaze")
            } else {
                ("body", "clay")
            };
            Look { group, material }
        },
    );
}

/// How much higher than usual the glaze ends: a wavy line with a few runs.
fn glaze_run(angle: f64) -> f64 {
    let round = angle / TAU;
    0.026 * (3.0 * angle + 0.6).sin() + 0.036 * noise(round, 0.0, 11, 5) + 0.012 * noise(round, 0.0, 23, 6)
}

/// A point of the outline turned round the axis, with the lip pulled out towards −X, and faint throwing rings.
fn body_point(radius: f64, height: f64, angle: f64) -> DVec3 {
    let towards_lip = -angle.cos();
    let high = smoothstep(0.80, 1.0, height);
    let pull = smoothstep(0.55, 1.0, towards_lip) * high;
    let pinch = bump(0.62, 0.32, towards_lip) * high;
    let rings = 1.0 + 0.004 * (height * 46.0).sin() * smoothstep(0.1, 0.2, height) * (1.0 - high);
    let spread = radius * rings * (1.0 + 0.48 * pull * pull - 0.07 * pinch);
    let lift = 0.050 * pull - 0.012 * pinch;
    DVec3::new(spread * angle.cos(), height + lift * radius / 0.24, -spread * angle.sin())
}

/// The handle: a flat oval that leaves the neck, bows out and ends on the belly.
fn handle(mesh: &mut PolyMesh) {
    const ALONG: usize = 34;
    const SIDES: usize = 16;
    let path = Profile::through(&[
        [0.180, 0.925],
        [0.275, 0.962],
        [0.405, 0.945],
        [0.492, 0.845],
        [0.508, 0.695],
        [0.450, 0.545],
        [0.345, 0.430],
    ])
    .spread(ALONG - 2, 0.4);
    let last = path.len() - 1;
    mesh.lathe(
        [ALONG, SIDES],
        |row, side| {
            // The first and the last band close the ends, which lie inside the wall.
            let index = row.saturating_sub(1).min(last);
            let tangent = (path[(index + 1).min(last)] - path[index.saturating_sub(1)]).normalize();
            let t = index as f64 / last as f64;
            let centre = DVec3::new(path[index].x, path[index].y, 0.0);
            let flat = DVec3::new(tangent.y, -tangent.x, 0.0);
            if row == 0 || row == ALONG {
                return centre;
            }
            let swell = 0.014 * bump(0.0, 0.16, t) + 0.020 * bump(1.0, 0.22, t);
            let (thick, wide) = (0.032 + swell * 0.7, 0.050 + swell);
            let angle = TAU * side as f64 / SIDES as f64;
            centre + flat * (thick * angle.cos()) + DVec3::Z * (wide * angle.sin())
        },
        |_, _| Look { group: "handle", material: "glaze" },
    );
}
