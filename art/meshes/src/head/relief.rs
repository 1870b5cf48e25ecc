//! What the features add to the head's basic form: brow, sockets, nose, cheekbones, mouth, chin, neck muscles.

use glam::{DVec2, DVec3};

use crate::curve::{Profile, smoothstep};

/// How far the nose's ridge stands out over the face: pairs of the height on the face and the distance there.
const RIDGE: [[f64; 2]; 13] = [
    [0.270, 0.0],
    [0.286, 0.004],
    [0.296, 0.036],
    [0.308, 0.072],
    [0.322, 0.096],
    [0.338, 0.105],
    [0.356, 0.101],
    [0.388, 0.082],
    [0.430, 0.060],
    [0.475, 0.038],
    [0.520, 0.018],
    [0.565, 0.006],
    [0.620, 0.0],
];

/// Half the nose's width where it meets the face: pairs of the height on the face and the half width there.
const NOSE_WIDTH: [[f64; 2]; 7] = [
    [0.270, 0.052],
    [0.320, 0.060],
    [0.350, 0.058],
    [0.400, 0.056],
    [0.450, 0.056],
    [0.510, 0.052],
    [0.620, 0.070],
];

/// A soft hump of height 1 round a centre; `size` holds its half-widths.
fn hump(point: DVec2, centre: [f64; 2], size: [f64; 2]) -> f64 {
    let away = (point - DVec2::from_array(centre)) / DVec2::from_array(size);
    (-away.length_squared()).exp()
}

/// The features as distances from the basic form.
pub struct Relief {
    ridge: Profile,
    width: Profile,
}

impl Relief {
    pub fn new() -> Self {
        Self { ridge: Profile::through(&RIDGE), width: Profile::through(&NOSE_WIDTH) }
    }

    /// Moves a point of the basic form to where the features put it.
    pub fn raise(&self, point: DVec3) -> DVec3 {
        let in_front = smoothstep(0.02, 0.16, point.z);
        let seen = DVec2::new(point.x.abs(), point.y);
        let flank = DVec3::new(point.x.signum(), 0.0, 0.35).normalize();
        point
            + DVec3::Z * in_front * (planes(seen) + mouth(seen) + self.nose(seen))
            + flank * sides(seen, point.z)
            + neck(point)
    }

    /// Ridge, tip and wings of the nose.
    fn nose(&self, seen: DVec2) -> f64 {
        if seen.y < RIDGE[0][0] || seen.y > RIDGE[RIDGE.len() - 1][0] {
            return 0.0;
        }
        let stands = self.ridge.height_at(seen.y);
        let across = seen.x / self.width.height_at(seen.y);
        // A rounded ridge that runs out into the cheek.
        let ridge = stands * (1.0 - smoothstep(0.10, 1.15, across)).powf(0.9);
        let ball = 0.008 * hump(seen, [0.0, 0.334], [0.034, 0.026]);
        let wing = 0.044 * (hump(seen, [0.056, 0.314], [0.022, 0.022]).powf(0.8));
        let crease = 0.010 * hump(seen, [0.040, 0.338], [0.012, 0.016]);
        let nostril = 0.022 * hump(seen, [0.030, 0.297], [0.013, 0.007]);
        ridge + ball + wing - crease - nostril
    }
}

/// Forehead, brow, sockets and cheeks, for one half of the face.
fn planes(seen: DVec2) -> f64 {
    let brow = 0.012 * hump(seen, [0.105, 0.592], [0.075, 0.026]);
    let forehead = 0.006 * hump(seen, [0.0, 0.730], [0.14, 0.07]);
    let away = (seen - DVec2::new(0.128, 0.500)) / DVec2::new(0.082, 0.050);
    let socket = 0.050 * (-away.length_squared().powf(1.6)).exp();
    let inner = 0.016 * hump(seen, [0.060, 0.515], [0.024, 0.030]);
    let pouch = 0.004 * hump(seen, [0.130, 0.435], [0.06, 0.020]);
    let bone = 0.016 * hump(seen, [0.190, 0.410], [0.070, 0.055]);
    let apple = 0.010 * hump(seen, [0.130, 0.360], [0.060, 0.060]);
    let hollow = 0.006 * hump(seen, [0.190, 0.250], [0.070, 0.070]);
    brow + forehead - socket - inner + pouch + bone + apple - hollow
}

/// The mouth's surroundings and the chin; the lips themselves are bodies of their own.
fn mouth(seen: DVec2) -> f64 {
    let muzzle = 0.012 * hump(seen, [0.0, 0.215], [0.100, 0.060]);
    let philtrum = 0.006 * hump(seen, [0.0, 0.258], [0.012, 0.024]);
    let column = 0.003 * hump(seen, [0.022, 0.255], [0.010, 0.024]);
    let corner = 0.006 * hump(seen, [0.116, 0.212], [0.022, 0.020]);
    let fold = 0.014 * hump(seen, [0.0, 0.134], [0.070, 0.018]);
    let chin = 0.020 * hump(seen, [0.0, 0.072], [0.062, 0.040]);
    let laugh = (seen.x - 0.078 - 0.32 * (0.315 - seen.y)) / 0.014;
    let laugh = 0.004 * (-laugh * laugh).exp() * hump(seen, [0.095, 0.265], [0.05, 0.04]);
    muzzle - philtrum + column - corner - fold + chin - laugh
}

/// How far the face's sides are moved: cheekbones out, temples and hollows of the cheeks in.
fn sides(seen: DVec2, z: f64) -> f64 {
    let bone = 0.012 * hump(DVec2::new(z, seen.y), [0.14, 0.425], [0.10, 0.050]);
    let temple = 0.014 * hump(DVec2::new(z, seen.y), [0.17, 0.600], [0.09, 0.060]);
    let hollow = 0.003 * hump(DVec2::new(z, seen.y), [0.14, 0.270], [0.10, 0.070]);
    bone - temple - hollow
}

/// How far the muscles from behind the ears to the pit of the neck push the skin outwards.
fn neck(point: DVec3) -> DVec3 {
    let from = DVec3::new(0.150, 0.150, -0.170);
    let to = DVec3::new(0.028, -0.330, 0.060);
    let half = DVec3::new(point.x.abs(), point.y, point.z);
    let share = ((half - from).dot(to - from) / (to - from).length_squared()).clamp(0.0, 1.0);
    let away = half.distance(from.lerp(to, share)) / 0.040;
    let below_jaw = 1.0 - smoothstep(-0.14, 0.03, point.y);
    let outward = DVec3::new(point.x, 0.0, point.z + 0.11).normalize_or_zero();
    outward * (0.018 * (-away * away).exp() * below_jaw)
}
