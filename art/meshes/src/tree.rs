//! Makes the meshes of the landscape's trees: a spreading oak, a poplar and a bush. Their leaves are small star-shaped
//! sprays.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::curve::{bump, hash, noise};
use super::poly_mesh::{Look, Pigment, PolyMesh};

/// The colours of leaves, from the lit crown to the shade under it, then those of bark.
const PALETTE: [Pigment; 7] = [
    ("sunlit", "#a9a94b"),
    ("light", "#8c9b43"),
    ("middle", "#72893f"),
    ("dark", "#5a7840"),
    ("deep", "#456544"),
    ("bark", "#8f7058"),
    ("bark_dark", "#6a5448"),
];

/// A limb of a tree. Its axis is a quadratic Bézier curve with the control points `path`.
struct Limb {
    path: [[f64; 3]; 3],
    /// Its radius at the foot and at the tip.
    radius: [f64; 2],
    /// How much wider the foot flares, as a share of its radius.
    flare: f64,
}

/// A clump of leaves: a shaded core that sprays of leaves stand out of.
#[derive(Clone, Copy)]
struct Clump {
    centre: DVec3,
    half: DVec3,
    /// How many sprays, before those inside other clumps are left out.
    sprays: u32,
    seed: u32,
    /// How much lighter than usual its greens are; 1 is the whole range from the darkest to the lightest.
    light: f64,
}

/// One spray: a small ragged star of leaves.
struct Spray {
    centre: DVec3,
    /// The direction in which its top faces.
    axis: DVec3,
    /// Half its size along the axis, and across.
    half: [f64; 2],
    seed: u32,
    light: f64,
}

/// A spreading tree about 4 units high.
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
    // Each clump has a centre, half a size, and a lightness.
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
    let clumps: Vec<Clump> = (0..)
        .zip(clumps)
        .map(|(index, (centre, half, light))| Clump {
            centre: DVec3::from_array(centre),
            half: DVec3::from_array(half),
            sprays: 62,
            seed: index * 7 + 1,
            light,
        })
        .collect();
    add_crown(&mut mesh, &clumps);
    mesh.round_to_thousandths();
    mesh
}

/// A poplar about 4 units high and 0.8 wide.
pub fn poplar() -> PolyMesh {
    let mut mesh = PolyMesh::new("poplar", "A slender poplar about 4 units high.", &PALETTE);
    let trunk = [[0.0, -0.15, 0.0], [0.03, 0.9, 0.0], [0.02, 2.4, 0.0]];
    add_limb(&mut mesh, &Limb { path: trunk, radius: [0.10, 0.03], flare: 0.5 });
    let core = Clump {
        centre: DVec3::new(0.0, 2.28, 0.0),
        half: DVec3::new(0.34, 1.66, 0.34),
        sprays: 0,
        seed: 200,
        light: 0.0,
    };
    add_core(&mut mesh, &core, [18, 11]);
    // Upright sprays up the core, in a spiral.
    const SPRAYS: u32 = 150;
    for spray in 0..SPRAYS {
        let up = (f64::from(spray) + 0.5) / f64::from(SPRAYS);
        let height = 0.76 + 3.18 * up;
        let off = (height - core.centre.y) / core.half.y;
        let round = core.half.x * (1.0 - off * off).max(0.0).sqrt() * (0.96 - 0.38 * up);
        let angle = 2.4 * f64::from(spray);
        let out = DVec3::new(angle.cos(), 0.0, angle.sin());
        let size = 1.08 - 0.50 * up + 0.22 * hash([spray, 5, 5]);
        let leaves = Spray {
            centre: out * round + DVec3::Y * height,
            axis: (out * 0.35 + DVec3::Y).normalize(),
            half: [0.26 * size, 0.125 * size],
            seed: 210 + spray,
            light: 0.45 + 0.20 * (up - 0.5) + 0.16 * hash([spray, 6, 6]),
        };
        add_spray(&mut mesh, &leaves);
    }
    mesh.round_to_thousandths();
    mesh
}

/// A bush of five clumps, about 1 unit high and 1.9 wide.
pub fn bush() -> PolyMesh {
    let mut mesh = PolyMesh::new("bush", "A bush about 1 unit high.", &PALETTE);
    let clumps = [
        ([0.0, 0.52, 0.0], [0.55, 0.50, 0.48]),
        ([0.50, 0.36, 0.08], [0.42, 0.38, 0.40]),
        ([-0.48, 0.40, -0.05], [0.44, 0.42, 0.40]),
        ([-0.18, 0.28, 0.34], [0.40, 0.32, 0.32]),
        ([0.24, 0.66, -0.22], [0.36, 0.34, 0.34]),
    ];
    let clumps: Vec<Clump> = (0..)
        .zip(clumps)
        .map(|(index, (centre, half))| Clump {
            centre: DVec3::from_array(centre),
            half: DVec3::from_array(half),
            sprays: 58,
            seed: 300 + index,
            light: 0.05 * (2.0 - f64::from(index)),
        })
        .collect();
    add_crown(&mut mesh, &clumps);
    mesh.round_to_thousandths();
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

/// Adds the clumps of a crown. Sprays that lie inside a clump would not show and are left out.
fn add_crown(mesh: &mut PolyMesh, clumps: &[Clump]) {
    for clump in clumps {
        add_core(mesh, clump, [8, 10]);
        for spray in sprays(clump) {
            let inside = |other: &Clump| ((spray.centre - other.centre) / other.half).length() < 0.74;
            if !clumps.iter().any(inside) {
                add_spray(mesh, &spray);
            }
        }
    }
}

/// The sprays of a clump: spread evenly over all but its underside, on a spiral from the top down.
fn sprays(clump: &Clump) -> impl Iterator<Item = Spray> {
    (0..clump.sprays).map(move |index| {
        let chance = |number: u32| hash([clump.seed, index, number]);
        let share = (f64::from(index) + 0.5 + 0.4 * chance(1)) / f64::from(clump.sprays);
        let lift = 1.0 - 1.62 * share;
        let round = (1.0 - lift * lift).max(0.0).sqrt();
        let angle = 2.4 * f64::from(index) + 0.5 * chance(2) + f64::from(clump.seed);
        let out = DVec3::new(round * angle.cos(), lift, round * angle.sin());
        let size = (0.30 + 0.12 * chance(3)) * clump.half.x.min(clump.half.z);
        Spray {
            centre: clump.centre + clump.half * out * (0.88 + 0.14 * chance(4)),
            axis: (out + DVec3::new(0.46 * chance(5), 0.22, 0.46 * chance(6))).normalize(),
            half: [0.34 * size, size],
            seed: clump.seed * 37 + index,
            light: 0.46 + 1.2 * clump.light + 0.24 * lift + 0.12 * chance(7),
        }
    })
}

/// The core of a clump: a lumpy ellipsoid in the darker greens.
fn add_core(mesh: &mut PolyMesh, clump: &Clump, [rows, segments]: [usize; 2]) {
    mesh.lathe(
        [rows, segments],
        |row, segment| {
            let round = (segment % segments) as f64 / segments as f64;
            let down = row as f64 / rows as f64;
            let (slope, angle) = (PI * down, TAU * round);
            let lumps = 0.12 * noise(round, 4.0 * down, 6, clump.seed + 2) * (PI * down).sin();
            let unit = DVec3::new(slope.sin() * angle.cos(), slope.cos(), -slope.sin() * angle.sin());
            clump.centre + clump.half * unit * (0.80 + lumps)
        },
        |row, segment| {
            let down = (row as f64 + 0.5) / rows as f64;
            let light = 0.52 + clump.light - 0.45 * down;
            Look {
                group: "leaves",
                material: green(light + 0.06 * hash([clump.seed, row as u32, segment as u32])),
            }
        },
    );
}

/// Adds a shallow star of leaves. Its lower side is of a middle green.
fn add_spray(mesh: &mut PolyMesh, spray: &Spray) {
    const SIDES: usize = 8;
    let aside = if spray.axis.y.abs() < 0.9 { DVec3::Y } else { DVec3::X };
    let right = aside.cross(spray.axis).normalize();
    let back = right.cross(spray.axis);
    let [along, across] = spray.half;
    mesh.lathe(
        [2, SIDES],
        |row, side| {
            let chance = |number: u32| hash([spray.seed, number, (side % SIDES) as u32]);
            let angle = TAU * (side as f64 + 0.5 * chance(1)) / SIDES as f64 + f64::from(spray.seed);
            let tip = if side % 2 == 0 { 1.0 + 0.20 * chance(2) } else { 0.74 + 0.12 * chance(2) };
            let (level, reach) = match row {
                0 => (1.0, 0.0),
                1 => (0.22 * chance(3) - 0.1 * tip, tip),
                _ => (-0.45, 0.0),
            };
            let flat = (right * angle.cos() - back * angle.sin()) * across * reach;
            spray.centre + spray.axis * along * level + flat
        },
        |row, side| {
            let sprinkle = 0.07 * hash([spray.seed, 4, side as u32 / 4]);
            Look { group: "leaves", material: green(if row == 0 { spray.light + sprinkle } else { 0.5 }) }
        },
    );
}

/// The green of a lightness, 0 to 1.
fn green(light: f64) -> &'static str {
    const GREENS: [&str; 5] = ["deep", "dark", "middle", "light", "sunlit"];
    GREENS[((light * 5.0).max(0.0) as usize).min(4)]
}
