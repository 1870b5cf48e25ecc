//! The skin of the giant's face, and the moods that it turns into.

use glam::{DVec2, DVec3};

use crate::curve::smoothstep;

/// Names of the shapes that the face can turn into.
pub const MOODS: [&str; 3] = ["smile", "blink", "brows"];

/// How far the face is turned into each of its shapes, 0..=1.
#[derive(Clone, Copy, Debug, Default)]
pub struct Mood {
    pub smile: f64,
    pub blink: f64,
    pub brows: f64,
}

/// The middle of the skull, and half its size.
pub const MIDDLE: DVec3 = DVec3::new(0.0, 0.265, 0.045);
pub const HALF: DVec3 = DVec3::new(0.268, 0.335, 0.268);

/// Where an eye sits: its angles to the side and up.
pub const EYE: DVec2 = DVec2::new(0.40, 0.155);

/// How much a hill of this middle and this size (both in angles to the side and up) rises at a place.
pub fn hill(at: DVec2, middle: [f64; 2], size: [f64; 2]) -> f64 {
    (-((at - DVec2::from_array(middle)) / DVec2::from_array(size)).length_squared()).exp()
}

/// The unit vector at an angle to the side (0 in front) and an angle up.
pub fn outwards(at: DVec2) -> DVec3 {
    let (side, up) = (at.x, at.y);
    DVec3::new(side.sin() * up.cos(), up.sin(), side.cos() * up.cos())
}

/// The skin at an angle to the side (0 in front) and an angle up, lifted by `lift`.
pub fn skin(at: DVec2, lift: f64, mood: Mood) -> DVec3 {
    let way = outwards(at);
    let seen = DVec2::new(at.x.abs(), at.y);
    let jowl = 1.0 + 0.10 * hill(seen, [0.9, -0.45], [0.8, 0.50]) - 0.08 * smoothstep(0.3, 1.3, at.y);
    // The nose is round in front and steep at its sides.
    let bulb = (-(seen / DVec2::new(0.185, 0.150) + DVec2::new(0.0, 0.53)).length().powi(3)).exp();
    let nose = 0.108 * bulb
        + 0.040 * hill(seen, [0.0, 0.14], [0.10, 0.15])
        + 0.034 * hill(seen, [0.24, -0.11], [0.085, 0.080]);
    let cheek = 0.040 * hill(seen, [0.60, -0.20], [0.24, 0.20])
        + mood.smile * 0.030 * hill(seen, [0.58, -0.10], [0.20, 0.16]);
    let chin = 0.052 * hill(seen, [0.0, -0.88], [0.46, 0.19]);
    let brow = 0.016 * hill(seen, [EYE.x, 0.43], [0.26, 0.10]) + 0.010 * hill(seen, [0.0, 0.70], [0.5, 0.2]);
    let socket = -0.034 * hill(seen, [EYE.x, EYE.y], [0.19, 0.17]);
    let mouth = 0.016 * hill(seen, [0.0, -0.44], [0.36, 0.15])
        - 0.012 * hill(seen, [0.0, -0.65], [0.26, 0.06])
        - mood.smile * 0.012 * hill(seen, [0.60, -0.42], [0.10, 0.14]);
    let base = way * HALF * DVec3::new(jowl, 1.0, 1.0);
    let out = (way / HALF).normalize();
    let height = nose + cheek + chin + brow + socket + mouth + lift;
    let drop = -0.022 * bulb + mood.smile * (0.008 * bulb - 0.014 * hill(seen, [0.0, -0.95], [0.5, 0.25]));
    MIDDLE + base + out * height + DVec3::Y * drop
}
