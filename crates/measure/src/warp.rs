//! M5, warp error: which surface points show in two pictures, and how alike they look.

use impasto_gl_render::{MotionPixels, ReferencePixels};

use crate::plane::{Plane, Taps};

/// Two depths agree if they differ by at most this share of the depth.
const DEPTH_SHARE: f32 = 0.01;

/// For each pixel of the first picture, where its surface point shows in the second, in columns and rows. `None` where
/// no body is, or where the point is off the second picture or hidden in it. A point is visible in the second picture
/// if the four pixels round it show its body, and their mean depth agrees with the point's.
pub fn correspondences(motion: &MotionPixels, then: &ReferencePixels) -> Vec<Option<[f64; 2]>> {
    let size_px = motion.size_px.map(|side| side as usize);
    let place = |index: usize| {
        let id = motion.body_id[index];
        let [dx, dy] = motion.offset_px[index].map(f64::from);
        let (x, y) = ((index % size_px[0]) as f64 + dx, (index / size_px[0]) as f64 + dy);
        let taps = Taps::new(size_px, x, y).filter(|_| id > 0 && motion.depth_then[index] > 0.0)?;
        if !taps.all(|tap| then.body_id[tap] == id) {
            return None;
        }
        let depth = taps.mix(|tap| then.depth[tap]);
        let agree = (depth - motion.depth_then[index]).abs() <= DEPTH_SHARE * motion.depth_then[index];
        agree.then_some([x, y])
    };
    (0..motion.body_id.len()).map(place).collect()
}

/// How much a picture differs from another one that is carried along with the motion between them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Warp {
    /// Mean squared difference at the same surface points; a difference of 255 is that of black and white.
    pub error: f64,
    /// How many pixels the mean is taken over.
    pub pixels: usize,
}

/// Warp error: W = Σ M ‖I_then(x + v) − I_now(x)‖² / Σ M. x + v is the place in `then` of the surface point at pixel x;
/// M is 1 where that point is visible in both pictures, and 0 elsewhere.
pub fn warp_error(now: &Plane, then: &Plane, correspondences: &[Option<[f64; 2]>]) -> Warp {
    let (mut sum, mut pixels) = (0.0, 0);
    for (value, place) in now.values.iter().zip(correspondences) {
        let Some([x, y]) = place else { continue };
        if let Some(there) = then.sample(*x, *y) {
            sum += f64::from(there - value).powi(2);
            pixels += 1;
        }
    }
    Warp { error: sum / pixels.max(1) as f64, pixels }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One body that fills the picture, moved by whole pixels.
    fn moved(size: u32, by: [f32; 2]) -> (MotionPixels, ReferencePixels) {
        let pixels = (size * size) as usize;
        let motion = MotionPixels {
            size_px: [size, size],
            offset_px: vec![by; pixels],
            depth_then: vec![2.0; pixels],
            body_id: vec![1; pixels],
        };
        (motion, ReferencePixels { depth: vec![2.0; pixels], body_id: vec![1; pixels] })
    }

    #[test]
    fn a_picture_that_moves_with_its_surface_has_no_error() {
        let texture = |x: i64, y: i64| ((x * 37 + y * 91) % 251) as f32;
        let now = Plane::of([32, 32], |x, y| texture(x as i64, y as i64));
        let carried = Plane::of([32, 32], |x, y| texture(x as i64 - 3, y as i64 + 2));
        let (motion, then) = moved(32, [3.0, -2.0]);
        let correspondences = correspondences(&motion, &then);
        let warp = warp_error(&now, &carried, &correspondences);
        assert_eq!((warp.error, warp.pixels), (0.0, 29 * 30));
        let left_behind = warp_error(&now, &now, &correspondences);
        assert!(left_behind.error > 100.0, "{left_behind:?}");
    }

    #[test]
    fn points_hidden_in_the_second_picture_do_not_count() {
        let (motion, mut then) = moved(8, [0.0, 0.0]);
        then.body_id[9] = 2;
        then.depth[18] = 1.0;
        let correspondences = correspondences(&motion, &then);
        assert_eq!(correspondences.iter().filter(|place| place.is_none()).count(), 2);
        assert!(correspondences[9].is_none() && correspondences[18].is_none());
    }
}
