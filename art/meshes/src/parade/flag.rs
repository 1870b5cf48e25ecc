//! The parade's flag: striped cloth at its mast, and how the wind moves it.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::FRAMES;
use crate::curve::smoothstep;
use crate::poly_mesh::{Look, PolyMesh};

/// Faces from the mast to the free edge, and from the hem up.
const SIDES: [usize; 2] = [30, 20];
/// How long and how high the cloth is.
const SIZE: DVec2 = DVec2::new(1.75, 1.05);
/// Its lower corner at the mast.
const CORNER: DVec3 = DVec3::new(-3.12, 2.46, -2.30);
/// Foot and top of the mast, which stands just beside the cloth's edge.
pub const MAST: [DVec3; 2] =
    [DVec3::new(CORNER.x - 0.045, 0.0, CORNER.z), DVec3::new(CORNER.x - 0.045, 3.72, CORNER.z)];

/// The flag spread out almost flat, so that strokes can be laid on it well.
pub fn flag() -> PolyMesh {
    let mut mesh = PolyMesh::new(
        "flag",
        "A striped flag beside the parade's mast, spread out; open at its rim.",
        &[("red", "#c9402e"), ("cream", "#f3e6c6"), ("blue", "#2f6d94")],
    );
    let points = points(0.0, 0.12);
    let across = SIDES[0] + 1;
    mesh.sheet(
        SIDES,
        |column, row| points[row * across + column],
        |_, row| Look { group: "flag", material: ["red", "cream", "blue", "cream", "red"][row / 4] },
    );
    let share = |point: usize| {
        DVec2::new((point % across) as f64 / SIDES[0] as f64, (point / across) as f64 / SIDES[1] as f64)
    };
    mesh.uvs =
        mesh.faces.iter().map(|face| face.corners.iter().map(|&corner| share(corner)).collect()).collect();
    mesh
}

/// The bytes of `flag.pc2`, the flag's point cache: where its points are in the wind, frame by frame.
pub fn cache() -> Vec<u8> {
    let count = (SIDES[0] + 1) * (SIDES[1] + 1);
    let mut bytes = b"POINTCACHE2\0".to_vec();
    bytes.extend(1i32.to_le_bytes());
    bytes.extend((count as i32).to_le_bytes());
    // The frame of the first sample, and the frames from one sample to the next.
    bytes.extend(0f32.to_le_bytes());
    bytes.extend(1f32.to_le_bytes());
    bytes.extend((FRAMES as i32).to_le_bytes());
    for frame in 0..FRAMES {
        for point in points(frame as f64 / FRAMES as f64, 1.0) {
            bytes.extend(point.as_vec3().to_array().iter().flat_map(|number| number.to_le_bytes()));
        }
    }
    bytes
}

/// The points of the cloth, row by row from the hem up. `time` is a share of the shot, `wind` a strength, at most 1. A
/// row keeps its length, because only its direction waves.
fn points(time: f64, wind: f64) -> Vec<DVec3> {
    /// Integration steps along a row, for each face.
    const FINE: usize = 4;
    let mut points = Vec::new();
    for row in 0..=SIDES[1] {
        let high = row as f64 / SIDES[1] as f64;
        let mut at = CORNER + DVec3::Y * (high * SIZE.y);
        let step = SIZE.x / (SIDES[0] * FINE) as f64;
        for fine in 0..=SIDES[0] * FINE {
            if fine % FINE == 0 {
                points.push(at);
            }
            let along = (fine as f64 + 0.5) / (SIDES[0] * FINE) as f64;
            let grown = smoothstep(-0.05, 0.75, along);
            let wave = |crests: f64, times: f64, lean: f64| {
                (TAU * (crests * along - times * time + lean * high)).sin()
            };
            let turn =
                wind * grown * (0.86 * wave(1.15, 2.0, 0.10) + 0.26 * wave(2.1, 3.0, -0.12)) + 0.10 * wind;
            // It sags, most at its lower free corner, and now and then the wind lifts it.
            let sag = 0.06 + 0.30 * along * along * (1.0 - 0.35 * high) * (1.0 + 0.25 * wave(0.5, 1.0, 0.0));
            let sag = sag * (0.25 + 0.75 * wind);
            at += DVec3::new(turn.cos() * sag.cos(), -sag.sin(), turn.sin() * sag.cos()) * step;
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No edge of the cloth is stretched or pressed by more than a tenth, in any frame.
    #[test]
    fn the_cloth_keeps_its_size() {
        let across = SIDES[0] + 1;
        let [wide, high] = [SIZE.x / SIDES[0] as f64, SIZE.y / SIDES[1] as f64];
        for frame in 0..FRAMES {
            let points = points(frame as f64 / FRAMES as f64, 1.0);
            for (index, point) in points.iter().enumerate() {
                if (index + 1) % across != 0 {
                    let length = point.distance(points[index + 1]) / wide;
                    assert!((0.96..1.001).contains(&length), "along: {length}");
                }
                if let Some(above) = points.get(index + across) {
                    let length = point.distance(*above) / high;
                    assert!((0.9..1.1).contains(&length), "up: {length}");
                }
            }
        }
    }
}
