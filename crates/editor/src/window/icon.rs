//! The program's icon, drawn in code.

use winit::window::Icon;

const SIDE: u32 = 64;
const HALF_WIDTH: f32 = 0.1;
/// The two ends of each stroke, as shares of the side, and its colour.
const STROKES: [([[f32; 2]; 2], [u8; 3]); 3] = [
    ([[0.22, 0.34], [0.74, 0.24]], [240, 180, 65]),
    ([[0.24, 0.56], [0.80, 0.46]], [255, 131, 112]),
    ([[0.22, 0.78], [0.70, 0.70]], [143, 180, 255]),
];
const BACKGROUND: [u8; 3] = [34, 34, 37];

/// The program's icon: three strokes on a dark background.
pub(super) fn icon() -> Option<Icon> {
    let rgba = (0..SIDE * SIDE).flat_map(|index| pixel(index % SIDE, index / SIDE)).collect();
    Icon::from_rgba(rgba, SIDE, SIDE).ok()
}

fn pixel(x: u32, y: u32) -> [u8; 4] {
    let at = [(x as f32 + 0.5) / SIDE as f32, (y as f32 + 0.5) / SIDE as f32];
    let mut colour = BACKGROUND;
    for ([from, to], paint) in STROKES {
        let covered = coverage(distance(at, from, to) - HALF_WIDTH);
        colour = std::array::from_fn(|i| mix(colour[i], paint[i], covered));
    }
    let corner = [(at[0] - 0.5).abs().max(0.3) - 0.3, (at[1] - 0.5).abs().max(0.3) - 0.3];
    let alpha = mix(0, 255, coverage(corner[0].hypot(corner[1]) - 0.2));
    [colour[0], colour[1], colour[2], alpha]
}

fn coverage(outside: f32) -> f32 {
    (0.5 - outside * SIDE as f32).clamp(0.0, 1.0)
}

fn mix(from: u8, to: u8, part: f32) -> u8 {
    (f32::from(from) + (f32::from(to) - f32::from(from)) * part).round() as u8
}

fn distance(at: [f32; 2], from: [f32; 2], to: [f32; 2]) -> f32 {
    let along = [to[0] - from[0], to[1] - from[1]];
    let offset = [at[0] - from[0], at[1] - from[1]];
    let part = (offset[0] * along[0] + offset[1] * along[1]) / (along[0] * along[0] + along[1] * along[1]);
    let part = part.clamp(0.0, 1.0);
    (offset[0] - part * along[0]).hypot(offset[1] - part * along[1])
}
