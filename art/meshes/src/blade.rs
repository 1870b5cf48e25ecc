//! Builds blades: flat, pointed, bent bodies, such as leaves and fins.

use std::f64::consts::TAU;

use glam::DVec3;

use super::poly_mesh::{Look, PolyMesh};

/// A blade's middle line, and how wide and thick it is.
pub struct Blade<'a> {
    /// Points of the middle line, at least two; a Catmull-Rom curve goes through them.
    pub path: &'a [DVec3],
    /// The direction that its flat side faces, roughly.
    pub faces: DVec3,
    /// Half its greatest width.
    pub half_width: f64,
    /// Half its greatest thickness.
    pub half_thickness: f64,
    /// The place along its length where it is widest, 0..1.
    pub widest: f64,
    /// How full its outline is: 1 gives the outline of a lens, smaller numbers that of a spindle.
    pub fullness: f64,
}

/// Adds a blade with this many rows and segments.
pub fn blade(mesh: &mut PolyMesh, [rows, segments]: [usize; 2], blade: &Blade<'_>, look: Look) {
    let point = |row: usize, segment: usize| {
        let along = row as f64 / rows as f64;
        let (at, forward) = place(blade.path, along);
        let side = forward.cross(blade.faces).normalize();
        let up = side.cross(forward).normalize();
        // Its width grows up to its widest place, and shrinks towards the tip.
        let share =
            if along < blade.widest { along / blade.widest } else { (1.0 - along) / (1.0 - blade.widest) };
        let size = (share.clamp(0.0, 1.0) * std::f64::consts::FRAC_PI_2).sin().powf(1.0 / blade.fullness);
        let angle = TAU * segment as f64 / segments as f64;
        at + size * (side * (blade.half_width * angle.cos()) + up * (blade.half_thickness * angle.sin()))
    };
    mesh.lathe([rows, segments], point, |_, _| look);
}

/// The place at `along`, 0..1, on the curve through the points of `path`, and the direction of the curve there.
pub fn place(path: &[DVec3], along: f64) -> (DVec3, DVec3) {
    let last = path.len() - 1;
    let at = along.clamp(0.0, 1.0) * last as f64;
    let span = (at.floor() as usize).min(last - 1);
    let t = at - span as f64;
    let knot = |index: isize| path[(span as isize + index).clamp(0, last as isize) as usize];
    let (b, s, e, a) = (knot(-1), knot(0), knot(1), knot(2));
    let (linear, square, cubic) = (e - b, 2.0 * b - 5.0 * s + 4.0 * e - a, 3.0 * s - b - 3.0 * e + a);
    let position = s + 0.5 * t * (linear + t * (square + t * cubic));
    let forward = linear + t * (2.0 * square + t * 3.0 * cubic);
    (position, forward.normalize())
}
