//! The shape of the deer's body as a distance field, from which its mesh is made. The unit of length is its height at
//! the withers. X points forwards, Z to its right.

use glam::DVec3;

use crate::curve::smoothstep;
use crate::limb::{Limb, blend};

/// Cross-sections of the torso from the buttocks to the breast: x, y, z, half the size in the plane of X and Y, half
/// the size along Z. The tables below have the same columns.
const TORSO: [[f64; 5]; 9] = [
    [-0.575, 0.800, 0.0, 0.070, 0.050],
    [-0.535, 0.812, 0.0, 0.125, 0.096],
    [-0.440, 0.820, 0.0, 0.165, 0.140],
    [-0.290, 0.812, 0.0, 0.158, 0.138],
    [-0.090, 0.766, 0.0, 0.182, 0.157],
    [0.090, 0.750, 0.0, 0.203, 0.166],
    [0.250, 0.772, 0.0, 0.228, 0.146],
    [0.380, 0.776, 0.0, 0.196, 0.118],
    [0.475, 0.768, 0.0, 0.120, 0.080],
];

/// The neck, from between the shoulders up to the poll.
const NECK: [[f64; 5]; 6] = [
    [0.320, 0.840, 0.0, 0.195, 0.105],
    [0.430, 0.960, 0.0, 0.160, 0.090],
    [0.520, 1.090, 0.0, 0.122, 0.074],
    [0.580, 1.210, 0.0, 0.102, 0.064],
    [0.618, 1.300, 0.0, 0.092, 0.060],
    [0.645, 1.350, 0.0, 0.070, 0.055],
];

/// The head, from the back of the skull to the nose.
const HEAD: [[f64; 5]; 7] = [
    [0.628, 1.375, 0.0, 0.055, 0.055],
    [0.690, 1.357, 0.0, 0.088, 0.078],
    [0.760, 1.318, 0.0, 0.084, 0.072],
    [0.830, 1.280, 0.0, 0.066, 0.053],
    [0.910, 1.237, 0.0, 0.048, 0.040],
    [0.965, 1.208, 0.0, 0.045, 0.040],
    [0.995, 1.193, 0.0, 0.036, 0.032],
];

/// Cheek and lower jaw.
const JAW: [[f64; 5]; 3] =
    [[0.690, 1.290, 0.0, 0.055, 0.052], [0.800, 1.235, 0.0, 0.038, 0.036], [0.945, 1.180, 0.0, 0.024, 0.026]];

/// The right brow.
const BROW: [[f64; 5]; 2] = [[0.700, 1.395, 0.052, 0.030, 0.026], [0.760, 1.362, 0.055, 0.024, 0.020]];

/// The tail, from its root to its tip.
const TAIL: [[f64; 5]; 4] = [
    [-0.575, 0.895, 0.0, 0.034, 0.040],
    [-0.640, 0.835, 0.0, 0.032, 0.044],
    [-0.665, 0.750, 0.0, 0.030, 0.042],
    [-0.662, 0.680, 0.0, 0.016, 0.022],
];

/// The right fore leg from the shoulder blade to the pastern.
const FORE_LEG: [[f64; 5]; 10] = [
    [0.350, 0.850, 0.090, 0.120, 0.050],
    [0.385, 0.710, 0.108, 0.112, 0.056],
    [0.350, 0.580, 0.098, 0.076, 0.048],
    [0.348, 0.460, 0.092, 0.052, 0.039],
    [0.355, 0.360, 0.086, 0.039, 0.033],
    [0.362, 0.312, 0.084, 0.039, 0.035],
    [0.358, 0.262, 0.082, 0.029, 0.028],
    [0.352, 0.180, 0.080, 0.024, 0.023],
    [0.352, 0.112, 0.080, 0.031, 0.028],
    [0.374, 0.062, 0.080, 0.027, 0.027],
];

/// The right hind leg from the hip to the pastern.
const HIND_LEG: [[f64; 5]; 10] = [
    [-0.420, 0.850, 0.072, 0.150, 0.066],
    [-0.412, 0.735, 0.098, 0.168, 0.066],
    [-0.375, 0.615, 0.104, 0.124, 0.056],
    [-0.430, 0.495, 0.096, 0.074, 0.044],
    [-0.515, 0.395, 0.090, 0.048, 0.035],
    [-0.545, 0.340, 0.088, 0.046, 0.034],
    [-0.537, 0.280, 0.086, 0.035, 0.029],
    [-0.524, 0.190, 0.085, 0.028, 0.026],
    [-0.518, 0.115, 0.085, 0.034, 0.029],
    [-0.494, 0.062, 0.085, 0.028, 0.027],
];

/// The point of the hock, where the tendon of the heel ends.
const HEEL: [[f64; 5]; 3] = [
    [-0.500, 0.480, 0.094, 0.020, 0.018],
    [-0.568, 0.402, 0.090, 0.026, 0.022],
    [-0.560, 0.330, 0.088, 0.026, 0.024],
];

/// How far each hoof stands in front of (+) or behind its place in `FORE_LEG` or `HIND_LEG`: right fore, left fore,
/// right hind, left hind.
const STANCE: [f64; 4] = [0.060, -0.070, -0.055, 0.090];

/// The whole animal but for ears, antlers and eyes.
pub struct Form {
    torso: Limb,
    neck: Limb,
    head: Vec<Limb>,
    tail: Limb,
    legs: Vec<Vec<Limb>>,
}

impl Form {
    pub fn new() -> Self {
        let brow = Limb::through(&BROW);
        let legs = STANCE
            .iter()
            .enumerate()
            .map(|(index, &shift)| {
                let (leg, heel): (&[[f64; 5]], &[[f64; 5]]) =
                    if index < 2 { (&FORE_LEG, &[]) } else { (&HIND_LEG, &HEEL) };
                let pastern = leg[leg.len() - 1];
                let hoof = hoof([pastern[0], pastern[2]]);
                let mut limbs =
                    vec![Limb::through(&stepped(leg, shift)), Limb::through(&stepped(&hoof, shift))];
                if !heel.is_empty() {
                    limbs.push(Limb::through(&stepped(heel, shift)));
                }
                if index % 2 == 1 { limbs.iter().map(Limb::mirrored).collect() } else { limbs }
            })
            .collect();
        Self {
            torso: Limb::through(&TORSO),
            neck: Limb::through(&NECK),
            head: vec![Limb::through(&HEAD), Limb::through(&JAW), brow.mirrored(), brow],
            tail: Limb::through(&TAIL),
            legs,
        }
    }

    /// The same animal with legs, head and tail thicker by `by`, so that a skin woven round it has enough faces there.
    pub fn swollen(&self, by: f64) -> Self {
        let swell = |limbs: &Vec<Limb>| limbs.iter().map(|limb| limb.swollen(by)).collect();
        Self {
            torso: self.torso.swollen(0.0),
            neck: self.neck.swollen(0.0),
            head: swell(&self.head),
            tail: self.tail.swollen(by),
            legs: self.legs.iter().map(swell).collect(),
        }
    }

    /// About how far a point lies from the skin, negative inside.
    pub fn distance(&self, point: DVec3) -> f64 {
        let head = self
            .head
            .iter()
            .map(|limb| limb.distance(point))
            .reduce(|whole, limb| blend(whole, limb, 0.05))
            .unwrap_or(f64::INFINITY);
        let legs = self
            .legs
            .iter()
            .map(|leg| leg.iter().map(|limb| limb.distance(point)).reduce(|a, b| blend(a, b, 0.03)))
            .fold(f64::INFINITY, |nearest, leg| nearest.min(leg.unwrap_or(f64::INFINITY)));
        let trunk = blend(self.torso.distance(point), self.neck.distance(point), 0.14);
        let trunk = blend(trunk, head, 0.06);
        let body = blend(blend(trunk, legs, 0.07), self.tail.distance(point), 0.03);
        // The soles are flat on the ground.
        body.max(-point.y)
    }
}

/// A hoof under a pastern at `[x, z]`, a little in front of it.
fn hoof([x, z]: [f64; 2]) -> [[f64; 5]; 3] {
    [
        [x + 0.002, 0.062, z, 0.029, 0.028],
        [x + 0.016, 0.030, z, 0.037, 0.033],
        [x + 0.026, -0.020, z, 0.050, 0.038],
    ]
}

/// A leg swung from its shoulder or hip so that its hoof stands `shift` farther forwards.
fn stepped(sections: &[[f64; 5]], shift: f64) -> Vec<[f64; 5]> {
    sections
        .iter()
        .map(|&[x, y, z, depth, width]| [x + shift * smoothstep(0.85, -0.15, y), y, z, depth, width])
        .collect()
}
