//! The basic form of head and neck: rings, each through a front, a side and a back point; and the skin over it.

use std::f64::consts::PI;

use glam::DVec3;

use super::relief::Relief;

/// The rings from the crown down to the pit of the neck. Each row states a front point (y, z), a side point (x, y, z),
/// a back point (y, z), and how square the ring is in front and behind: 2 is an ellipse, more is squarer, less is more
/// pointed. The chin is at y = 0, the crown of the skull at y = 1, the eyes half-way between; the face looks towards
/// +Z.
const RINGS: [[f64; 9]; 26] = [
    [1.000, -0.080, 0.000, 1.000, -0.080, 1.000, -0.080, 2.0, 2.0],
    [0.985, 0.095, 0.165, 0.972, -0.080, 0.970, -0.240, 2.0, 2.0],
    [0.940, 0.230, 0.262, 0.900, -0.080, 0.890, -0.360, 2.0, 2.0],
    [0.870, 0.319, 0.306, 0.810, -0.070, 0.790, -0.430, 2.1, 2.0],
    [0.790, 0.364, 0.323, 0.720, -0.060, 0.680, -0.455, 2.2, 2.0],
    [0.710, 0.386, 0.326, 0.640, -0.050, 0.570, -0.445, 2.3, 2.0],
    [0.630, 0.394, 0.321, 0.570, -0.030, 0.470, -0.410, 2.3, 2.0],
    [0.565, 0.389, 0.314, 0.510, -0.010, 0.400, -0.375, 2.3, 2.0],
    [0.500, 0.374, 0.309, 0.455, 0.000, 0.340, -0.340, 2.3, 1.9],
    [0.430, 0.374, 0.301, 0.395, 0.005, 0.280, -0.315, 2.2, 1.8],
    [0.360, 0.382, 0.287, 0.335, 0.005, 0.230, -0.300, 2.1, 1.7],
    [0.290, 0.388, 0.267, 0.278, 0.005, 0.190, -0.290, 2.0, 1.6],
    [0.240, 0.392, 0.252, 0.240, 0.005, 0.150, -0.285, 1.97, 1.5],
    [0.200, 0.390, 0.239, 0.210, 0.005, 0.120, -0.280, 1.94, 1.4],
    [0.160, 0.384, 0.225, 0.181, 0.000, 0.090, -0.275, 1.91, 1.4],
    [0.120, 0.376, 0.208, 0.152, -0.005, 0.060, -0.270, 1.90, 1.4],
    [0.070, 0.373, 0.190, 0.118, -0.012, 0.020, -0.265, 1.90, 1.5],
    [0.032, 0.352, 0.158, 0.080, -0.035, -0.020, -0.262, 1.92, 1.8],
    [0.014, 0.300, 0.136, 0.046, -0.060, -0.050, -0.260, 1.96, 2.0],
    [0.004, 0.215, 0.133, -0.005, -0.080, -0.090, -0.260, 2.0, 2.0],
    [-0.034, 0.120, 0.129, -0.055, -0.100, -0.130, -0.262, 2.0, 2.0],
    [-0.115, 0.066, 0.128, -0.125, -0.110, -0.190, -0.268, 2.0, 2.0],
    [-0.210, 0.044, 0.133, -0.210, -0.120, -0.250, -0.285, 2.0, 2.0],
    [-0.290, 0.046, 0.150, -0.280, -0.130, -0.300, -0.305, 2.0, 2.0],
    [-0.400, 0.060, 0.165, -0.390, -0.130, -0.390, -0.315, 2.0, 2.0],
    [-0.500, -0.100, 0.000, -0.500, -0.100, -0.500, -0.100, 2.0, 2.0],
];

/// Number of the last ring.
pub const LAST_RING: f64 = (RINGS.len() - 1) as f64;

/// A point of the basic form: `ring` counts rings (fractions lie between two), `angle` is 0 in front, a quarter turn
/// at the +X side.
pub fn form(ring: f64, angle: f64) -> DVec3 {
    let index = (ring.max(0.0) as usize).min(RINGS.len() - 2);
    let t = ring - index as f64;
    let knot = |step: usize| RINGS[(index + step).saturating_sub(1).min(RINGS.len() - 1)];
    let (before, start, end, after) = (knot(0), knot(1), knot(2), knot(3));
    let mut ring = [0.0; 9];
    for (value, place) in ring.iter_mut().enumerate() {
        let (b, s, e, a) = (before[value], start[value], end[value], after[value]);
        *place =
            s + 0.5 * t * (e - b + t * (2.0 * b - 5.0 * s + 4.0 * e - a + t * (3.0 * s - b - 3.0 * e + a)));
    }
    let [front_y, front_z, side_x, side_y, side_z, back_y, back_z, square_front, square_back] = ring;
    let (sine, cosine) = angle.sin_cos();
    let (end_y, end_z, square) =
        if cosine > 0.0 { (front_y, front_z, square_front) } else { (back_y, back_z, square_back) };
    let reach = (sine.abs().powf(square) + cosine.abs().powf(square)).powf(-1.0 / square);
    DVec3::new(
        side_x * sine * reach,
        end_y * cosine * cosine + side_y * sine * sine,
        side_z + (end_z - side_z) * cosine.abs() * reach,
    )
}

/// The head's skin: the basic form with its relief.
pub struct Skin {
    relief: Relief,
}

impl Skin {
    pub fn new() -> Self {
        Self { relief: Relief::new() }
    }

    /// The point of the skin at a ring and an angle.
    pub fn point(&self, ring: f64, angle: f64) -> DVec3 {
        self.relief.raise(form(ring, angle))
    }

    /// The point of the face that lies at `x`, `y` seen from the front.
    pub fn face(&self, x: f64, y: f64) -> DVec3 {
        const STEP: f64 = 1e-3;
        let mut angle = (x / 0.42).clamp(-1.0, 1.0).asin();
        let mut ring = (0..=60)
            .map(|step| 3.0 + f64::from(step) * 0.25)
            .min_by(|&a, &b| (form(a, angle).y - y).abs().total_cmp(&(form(b, angle).y - y).abs()))
            .unwrap_or(8.0);
        for _ in 0..12 {
            let here = self.point(ring, angle);
            let down = (self.point(ring + STEP, angle) - here) / STEP;
            let round = (self.point(ring, angle + STEP) - here) / STEP;
            let (off_x, off_y) = (x - here.x, y - here.y);
            let area = down.x * round.y - round.x * down.y;
            if area.abs() < 1e-9 {
                break;
            }
            ring += 0.8 * ((off_x * round.y - round.x * off_y) / area).clamp(-0.5, 0.5);
            angle += 0.8 * ((down.x * off_y - off_x * down.y) / area).clamp(-0.2, 0.2);
            angle = angle.clamp(-0.48 * PI, 0.48 * PI);
        }
        self.point(ring, angle)
    }
}
