//! Makes the giant's papier-mache face in each of its moods: it smiles, blinks and lifts its brows. Its origin is the
//! joint of the head; it looks to +Z, and its left is +X.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::features;
use super::skin::{EYE, HALF, MIDDLE, Mood, hill, skin};
use crate::glb::linear;
use crate::poly_mesh::{Look, PolyMesh};

/// The face in a mood. Every mood has the same points in the same order.
pub fn face(mood: Mood) -> PolyMesh {
    let mut mesh = PolyMesh::new(
        "face",
        "The giant's face.",
        &[("skin", "#ffffff"), ("lips", "#ffffff"), ("teeth", "#ffffff"), ("brows", "#ffffff")],
    );
    head(&mut mesh, mood);
    features::ears(&mut mesh);
    features::mouth(&mut mesh, mood);
    features::lids(&mut mesh, mood);
    features::brows(&mut mesh, mood);
    mesh
}

fn head(mesh: &mut PolyMesh, mood: Mood) {
    /// Faces of a ring on each side.
    const SIDE: usize = 26;
    // Faces are narrow on the nose and grow towards the ears.
    let angle = |segment: usize| {
        let (step, side) = if segment <= SIDE { (segment, 1.0) } else { (2 * SIDE - segment, -1.0) };
        let t = step as f64 / SIDE as f64;
        side * PI * t * (0.40 + 0.60 * t)
    };
    let rings = rings();
    mesh.lathe(
        [rings.len() - 1, 2 * SIDE],
        |row, segment| skin(DVec2::new(angle(segment), rings[row]), 0.0, mood),
        |_, _| Look { group: "face", material: "skin" },
    );
}

/// The elevations of the skin's rings, radians, from the crown down: close together from the brows to the chin.
fn rings() -> Vec<f64> {
    let mut rings = vec![0.5 * PI];
    for (to, count) in [(0.62, 7), (0.36, 6), (-0.30, 15), (-1.10, 14), (-0.5 * PI, 4)] {
        let from = rings[rings.len() - 1];
        rings.extend((1..=count).map(|step| from + (to - from) * step as f64 / count as f64));
    }
    rings
}

/// The paint at each point of the face: rosy cheeks and nose, red lips, dark brows.
///
/// # Errors
/// A colour cannot be read.
pub fn paint(mesh: &PolyMesh) -> anyhow::Result<Vec<DVec3>> {
    let paint = |hex: &str| linear(hex).map(DVec3::from);
    let (flesh, rose, light) = (paint("#eeb68c")?, paint("#dd6a52")?, paint("#f6cfa8")?);
    let shade = paint("#c88a66")?;
    let [lips, teeth, brows] = [paint("#b5302c")?, paint("#f6efe0")?, paint("#5a3320")?];
    let mut colors: Vec<DVec3> = mesh
        .positions
        .iter()
        .map(|point| {
            let way = (*point - MIDDLE) / HALF;
            let seen = DVec2::new(way.x.atan2(way.z).abs(), way.y.atan2(way.x.hypot(way.z)));
            let rosy =
                hill(seen, [0.62, -0.22], [0.24, 0.20]) + 0.85 * hill(seen, [0.0, -0.10], [0.20, 0.14]);
            let rosy = rosy
                + 0.35 * hill(seen, [0.0, -0.95], [0.3, 0.12])
                + 0.6 * hill(seen, [1.6, 0.0], [0.2, 0.3]);
            let lit = 0.8 * hill(seen, [0.0, 0.62], [0.45, 0.22]);
            let deep = 0.55 * hill(seen, [EYE.x, EYE.y], [0.22, 0.19]);
            flesh.lerp(light, lit.min(1.0)).lerp(shade, deep).lerp(rose, (1.05 * rosy).min(1.0))
        })
        .collect();
    for face in &mesh.faces {
        let color = match face.look.material {
            "lips" => lips,
            "teeth" if face.look.group == "mouth" => paint("#5a1a1e")?,
            "teeth" => teeth,
            "brows" => brows,
            _ => continue,
        };
        for &corner in &face.corners {
            colors[corner] = color;
        }
    }
    Ok(colors)
}
