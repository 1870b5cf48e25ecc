//! Flat boards: a wooden plank, and a thin plate whose two sides differ.

use glam::{DMat3, DVec3};

use super::blocks::{Block, add_block};
use super::curve::noise;
use super::poly_mesh::{Look, PolyMesh};

/// A plank of 1.6 x 0.1 x 0.34 that lies on y = 0, its grain along X.
pub fn plank() -> PolyMesh {
    let mut mesh = PolyMesh::new(
        "plank",
        "A wooden plank with rounded edges, lying on y = 0, its grain along X.",
        &[
            ("wood_dark", "#8d6138"),
            ("wood_brown", "#a17344"),
            ("wood", "#b48552"),
            ("wood_pale", "#c69a66"),
            ("wood_light", "#d3ad7b"),
            ("end_dark", "#946a41"),
            ("end_pale", "#c79f6e"),
        ],
    );
    board(&mut mesh, DVec3::new(0.8, 0.05, 0.17), [26, 5, 8], 0.012);
    for point in &mut mesh.positions {
        point.y += 0.05;
    }
    set_looks(&mut mesh, |at, outward| {
        if outward.x.abs() > 0.8 {
            // Growth rings of a log whose heart lies under the plank.
            let ring = ((at.y + 0.12).hypot(0.8 * at.z) * 32.0).sin();
            return Look { group: "ends", material: if ring > 0.0 { "end_pale" } else { "end_dark" } };
        }
        // Sawn edges are darker than the planed faces, so that broad strokes do not hide the plank's edges.
        let (group, shade) = if outward.y.abs() > 0.6 { ("face", -0.15) } else { ("edges", 0.55) };
        // Long streaks; the line of a streak wanders a little on its way.
        let across = at.z + 1.7 * at.y + 0.03 * (2.4 * at.x).sin();
        let streak = noise(0.5 + 0.04 * at.x, 26.0 * across, 24, 7)
            + 0.5 * noise(0.5 + 0.12 * at.x, 55.0 * across, 24, 8);
        let material = match streak - shade {
            streak if streak < -0.55 => "wood_dark",
            streak if streak < -0.20 => "wood_brown",
            streak if streak < 0.25 => "wood",
            streak if streak < 0.60 => "wood_pale",
            _ => "wood_light",
        };
        Look { group, material }
    });
    mesh.round_to(1e4);
    mesh
}

/// A plate of 1 x 1 x 0.012 about the origin, its front to +Z.
pub fn plate() -> PolyMesh {
    let mut mesh = PolyMesh::new(
        "plate",
        "A thin square plate about the origin: front to +Z, back to -Z, and the rim between.",
        &[("blue", "#2f6f94"), ("vermilion", "#cc5a36"), ("cream", "#eadfc4")],
    );
    board(&mut mesh, DVec3::new(0.5, 0.5, 0.006), [20, 20, 3], 0.003);
    set_looks(&mut mesh, |_, outward| match outward.z {
        z if z > 0.8 => Look { group: "front", material: "blue" },
        z if z < -0.8 => Look { group: "back", material: "vermilion" },
        _ => Look { group: "rim", material: "cream" },
    });
    mesh.round_to(1e4);
    mesh
}

/// A rounded block about the origin, all of one material.
fn board(mesh: &mut PolyMesh, half: DVec3, cells: [usize; 3], rounding: f64) {
    let look = Look { group: "board", material: mesh.palette[0].0 };
    add_block(mesh, &Block { half, cells, rounding, turn: DMat3::IDENTITY, centre: DVec3::ZERO, look });
}

/// Gives every face a look by its middle and its outward direction.
fn set_looks(mesh: &mut PolyMesh, look: impl Fn(DVec3, DVec3) -> Look) {
    for face in &mut mesh.faces {
        let at = |corner: usize| mesh.positions[face.corners[corner]];
        let outward = (at(2) - at(0)).cross(at(3) - at(1)).normalize();
        face.look = look((at(0) + at(1) + at(2) + at(3)) / 4.0, outward);
    }
}
