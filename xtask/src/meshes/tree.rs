//! Trees of the landscape: a spreading oak, a poplar and a bush, each of lumpy leaf clumps round its wood.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::curve::{bump, hash, noise, smoothstep};
use super::poly_mesh::{Look, Pigment, PolyMesh};

/// Leaves from the lit crown to the shade under it, then bark.
const PALETTE: [Pigment; 7] = [
    ("sunlit", "#b9b04c"),
    ("light", "#93a03f"),
    ("middle", "#637f38"),
    ("dark", "#4a6c42"),
    ("deep", "#3c5a4c"),
    ("bark", "#8f7058"),
    ("bark_dark", "#6a5448"),
];

/// A limb: its axis is the quadratic curve through the first and the last point, pulled towards the middle one.
struct Limb {
    path: [[f64; 3]; 3],
    /// At the foot and at the tip.
    radius: [f64; 2],
    /// How much wider the foot flares, as a share of its radius.
    flare: f64,
}

/// A clump of leaves: a lumpy ellipsoid.
struct Clump {
    centre: DVec3,
    half: DVec3,
    rows: usize,
    segments: usize,
    seed: u32,
    /// Moves the greens: positive is lighter, one unit is the clump's height.
    light: f64,
}

/// A spreading tree about 4 units high, its crown fuller towards +X.
pub fn tree() -> PolyMesh {
    let mut mesh = PolyMesh::new("tree", "A spreading tree about 4 units high.", &PALETTE);
    let limbs = [
        ([[0.0, -0.15, 0.0], [-0.14, 0.8, 0.02], [0.06, 1.75, 0.0]], [0.17, 0.10], 0.8),
        ([[0.0, 1.15, 0.0], [0.10, 1.65, 0.08], [0.85, 2.05, 0.25]], [0.105, 0.045], 0.3),
        ([[-0.04, 1.0, 0.0], [-0.25, 1.5, 0.1], [-0.95, 1.95, 0.05]], [0.10, 0.04], 0.3),
        ([[0.05, 1.6, 0.0], [0.05, 2.2, -0.05], [-0.15, 3.0, -0.1]], [0.115, 0.03], 0.1),
        ([[0.04, 1.5, 0.0], [0.2, 2.0, 0.1], [0.45, 2.75, 0.3]], [0.09, 0.03], 0.1),
    ];
    for (path, radius, flare) in limbs {
        add_limb(&mut mesh, &Limb { path, radius, flare });
    }
    // Centre, half size, how light.
    let clumps = [
        ([-0.12, 3.52, -0.05], [0.56, 0.42, 0.54], 0.16),
        ([0.42, 3.24, 0.10], [0.54, 0.42, 0.52], 0.08),
        ([-0.62, 3.16, 0.12], [0.52, 0.42, 0.50], 0.12),
        ([-0.05, 3.02, 0.46], [0.54, 0.42, 0.46], 0.06),
        ([0.02, 3.00, -0.52], [0.62, 0.46, 0.50], -0.02),
        ([0.88, 2.86, 0.22], [0.54, 0.38, 0.50], 0.0),
        ([-1.06, 2.72, 0.02], [0.52, 0.38, 0.50], 0.08),
        ([0.42, 2.66, 0.58], [0.50, 0.36, 0.42], -0.04),
        ([-0.52, 2.62, 0.56], [0.50, 0.36, 0.42], 0.04),
        ([1.26, 2.42, 0.12], [0.48, 0.32, 0.46], -0.06),
        ([-1.36, 2.26, 0.10], [0.44, 0.30, 0.42], 0.02),
        ([0.74, 2.34, -0.42], [0.62, 0.38, 0.46], -0.12),
        ([-0.70, 2.36, -0.44], [0.62, 0.38, 0.46], -0.10),
        ([0.86, 2.14, 0.50], [0.44, 0.28, 0.40], -0.10),
        ([-0.82, 2.06, 0.42], [0.44, 0.28, 0.38], -0.06),
        ([0.02, 2.26, 0.20], [0.56, 0.30, 0.50], -0.20),
    ];
    for (index, (centre, half, light)) in clumps.into_iter().enumerate() {
        let (centre, half) = (DVec3::from_array(centre), DVec3::from_array(half));
        let clump = Clump { centre, half, rows: 16, segments: 22, seed: index as u32 * 7 + 1, light };
        add_clump(&mut mesh, &clump);
        add_tufts(&mut mesh, &clump, 5);
    }
    mesh
}

/// Small clumps on a clump, which break its outline.
fn add_tufts(mesh: &mut PolyMesh, clump: &Clump, count: u32) {
    for tuft in 0..count {
        let chance = |number: u32| hash([clump.seed, tuft, number]);
        let angle =
            TAU * (f64::from(tuft) + 0.4 * chance(1)) / f64::from(count) + 0.37 * f64::from(clump.seed);
        let lift = 0.15 + 0.60 * chance(2);
        let round = (1.0 - lift * lift).max(0.0).sqrt();
        let out = DVec3::new(round * angle.cos(), lift, round * angle.sin());
        let size = 0.40 + 0.10 * chance(3);
        let small = Clump {
            centre: clump.centre + clump.half * out * 0.84,
            half: clump.half * size,
            rows: 8,
            segments: 11,
            seed: clump.seed * 31 + tuft,
            light: clump.light + 0.14 * lift,
        };
        add_clump(mesh, &small);
    }
}

/// A poplar about 4 units high and 0.8 wide.
pub fn poplar() -> PolyMesh {
    let mut mesh = PolyMesh::new("poplar", "A slender poplar about 4 units high.", &PALETTE);
    let trunk = [[0.0, -0.15, 0.0], [0.03, 0.9, 0.0], [0.02, 2.4, 0.0]];
    add_limb(&mut mesh, &Limb { path: trunk, radius: [0.10, 0.03], flare: 0.5 });
    let core = Clump {
        centre: DVec3::new(0.0, 2.28, 0.0),
        half: DVec3::new(0.34, 1.66, 0.34),
        rows: 34,
        segments: 22,
        seed: 200,
        light: 0.06,
    };
    add_clump(&mut mesh, &core);
    // Upright tufts up the core, in a spiral.
    const TUFTS: u32 = 34;
    for tuft in 0..TUFTS {
        let up = (f64::from(tuft) + 0.5) / f64::from(TUFTS);
        let height = 0.80 + 2.90 * up;
        let off = (height - core.centre.y) / core.half.y;
        let round = core.half.x * (1.0 - off * off).max(0.0).sqrt() * 0.86;
        let angle = 2.4 * f64::from(tuft);
        let size = 1.0 - 0.45 * up + 0.15 * hash([tuft, 5, 5]);
        let clump = Clump {
            centre: DVec3::new(round * angle.cos(), height, round * angle.sin()),
            half: DVec3::new(0.17, 0.34, 0.17) * size,
            rows: 10,
            segments: 11,
            seed: 210 + tuft,
            light: 0.10 + 0.25 * (up - 0.4),
        };
        add_clump(&mut mesh, &clump);
    }
    mesh
}

/// A bush of five clumps, about 1 unit high and 1.8 wide.
pub fn bush() -> PolyMesh {
    let mut mesh = PolyMesh::new("bush", "A bush about 1 unit high.", &PALETTE);
    let clumps = [
        ([0.0, 0.52, 0.0], [0.55, 0.50, 0.48]),
        ([0.50, 0.36, 0.08], [0.42, 0.38, 0.40]),
        ([-0.48, 0.40, -0.05], [0.44, 0.42, 0.40]),
        ([-0.18, 0.28, 0.34], [0.40, 0.32, 0.32]),
        ([0.24, 0.66, -0.22], [0.36, 0.34, 0.34]),
    ];
    for (index, (centre, half)) in clumps.into_iter().enumerate() {
        let clump = Clump {
            centre: DVec3::from_array(centre),
            half: DVec3::from_array(half),
            rows: 16,
            segments: 22,
            seed: 300 + index as u32,
            light: 0.05 * (2.0 - index as f64),
        };
        add_clump(&mut mesh, &clump);
        add_tufts(&mut mesh, &clump, 5);
    }
    mesh
}

fn add_limb(mesh: &mut PolyMesh, limb: &Limb) {
    const ROWS: usize = 16;
    const SIDES: usize = 12;
    let [foot, pull, tip] = limb.path.map(DVec3::from_array);
    let centre = |t: f64| foot.lerp(pull, t).lerp(pull.lerp(tip, t), t);
    mesh.lathe(
        [ROWS, SIDES],
        |row, side| {
            // From the tip down; the first and the last band close the ends.
            let t = 1.0 - row.saturating_sub(1).min(ROWS - 2) as f64 / (ROWS - 2) as f64;
            if row == 0 || row == ROWS {
                return centre(t);
            }
            let along = (centre(t + 0.01) - centre(t - 0.01)).normalize();
            let forward = along.cross(DVec3::X).normalize();
            let round = side as f64 / SIDES as f64;
            let angle = TAU * round;
            let [wide, thin] = limb.radius;
            let taper = wide + (thin - wide) * t.powf(0.8);
            let roots = limb.flare * bump(0.0, 0.3, t) * (0.8 + 0.35 * (3.0 * angle + 0.7).cos());
            let radius = taper * (1.0 + roots + 0.10 * noise(round, 5.0 * t, 4, 41));
            centre(t) + radius * (forward.cross(along) * angle.cos() + forward * angle.sin())
        },
        |_, side| {
            let shade = (SIDES / 2..SIDES - 1).contains(&((side + 5) % SIDES));
            Look { group: "wood", material: if shade { "bark_dark" } else { "bark" } }
        },
    );
}

fn add_clump(mesh: &mut PolyMesh, clump: &Clump) {
    let (rows, segments, seed) = (clump.rows, clump.segments, clump.seed);
    mesh.lathe(
        [rows, segments],
        |row, segment| {
            let round = (segment % segments) as f64 / segments as f64;
            let down = row as f64 / rows as f64;
            let inside = (PI * down).sin();
            // The rows sway, so that the borders of the greens, which follow them, are scalloped.
            let sway = (0.10 * noise(round, 0.0, 5, seed) + 0.05 * noise(round, 3.0, 9, seed + 1)) * inside;
            let (slope, angle) = (PI * (down + sway).clamp(0.0, 1.0), TAU * round);
            let lumps =
                0.20 * noise(round, 3.2 * down, 6, seed + 2) + 0.13 * noise(round, 6.0 * down, 11, seed + 3);
            let swell = 1.0 + lumps * smoothstep(0.0, 0.4, inside);
            let unit = DVec3::new(slope.sin() * angle.cos(), slope.cos(), -slope.sin() * angle.sin());
            clump.centre + clump.half * unit * swell
        },
        |row, _| {
            let down = (row as f64 + 0.5) / rows as f64 - clump.light;
            let material = match down {
                down if down < 0.13 => "sunlit",
                down if down < 0.32 => "light",
                down if down < 0.54 => "middle",
                down if down < 0.76 => "dark",
                _ => "deep",
            };
            Look { group: "leaves", material }
        },
    );
}
