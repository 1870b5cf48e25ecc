//! M7, shower door: does the brushwork stand still on the picture while the painted surface moves under it?

use crate::correlation;
use crate::plane::{Plane, Taps};
use crate::turns::Turn;

/// How the brushwork of two pictures correlates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ShowerDoor {
    /// Correlation at the pixels that show the same body in both: 1 for a shower door, 0 where nothing stays on the
    /// picture.
    pub same_pixels: f64,
    /// Correlation at the same surface points: 1 where the brushwork moves wholly with the surface.
    pub same_points: f64,
    /// How many pixels `same_pixels` is taken over.
    pub pixels: usize,
}

/// Two pictures with their bodies and the motion between them.
#[derive(Clone, Copy, Debug)]
pub struct Pair<'a> {
    /// The pictures.
    pub pictures: [&'a Plane; 2],
    /// Body ids per pixel; 0 where no body is.
    pub body_ids: [&'a [u32]; 2],
    /// Where each surface point of the first is in the second ([`crate::warp::correspondences`]).
    pub correspondences: &'a [Option<[f64; 2]>],
    /// The median length of strokes, pixels.
    pub stroke_px: f64,
}

/// Shower door over the pixels whose surface point shows in both pictures and has moved by more than half a stroke.
/// Brushwork is the picture minus its blur, H = I − G_{ℓ/2} * I, within each body's own pixels; ℓ is `stroke_px`.
pub fn shower_door(pair: &Pair<'_>) -> ShowerDoor {
    let brushwork = [0, 1].map(|side| fine(pair.pictures[side], pair.body_ids[side], 0.5 * pair.stroke_px));
    let size_px = brushwork[0].size_px;
    let moved: Vec<(usize, [f64; 2])> = pair
        .correspondences
        .iter()
        .enumerate()
        .filter_map(|(index, place)| place.map(|place| (index, place)))
        .filter(|&(index, [x, y])| {
            let (column, row) = ((index % size_px[0]) as f64, (index / size_px[0]) as f64);
            (x - column).hypot(y - row) > 0.5 * pair.stroke_px
        })
        .collect();
    let stays = moved.iter().filter(|(index, _)| pair.body_ids[0][*index] == pair.body_ids[1][*index]);
    let (same_pixels, pixels) = correlation::normalized(
        stays.map(|&(index, _)| (brushwork[0].values[index], brushwork[1].values[index])),
    );
    let goes = moved.iter().filter_map(|&(index, [x, y])| {
        let taps = Taps::new(size_px, x, y)?;
        Some((brushwork[0].values[index], taps.mix(|tap| brushwork[1].values[tap])))
    });
    let (same_points, _) = correlation::normalized(goes);
    ShowerDoor { same_pixels, same_points, pixels }
}

/// How far the turns of strokes lag behind the analytic turns: L = mean e^{2i(θ − θ₀ − φ)}. A stroke's angle goes from
/// θ₀ to θ where the analytic turn is φ.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lag {
    /// |arg L|, degrees.
    pub arg_deg: f64,
    /// |L|: 1 where all strokes agree.
    pub length: f64,
    /// How many strokes L is taken over.
    pub strokes: usize,
}

/// The lag over these turns.
pub fn lag<'a>(turns: impl Iterator<Item = &'a Turn>) -> Lag {
    let (mut sum, mut strokes) = (glam::DVec2::ZERO, 0);
    for turn in turns {
        sum += glam::DVec2::from_angle(2.0 * (turn.angle_rad - turn.expected_rad()));
        strokes += 1;
    }
    Lag { arg_deg: sum.to_angle().abs().to_degrees(), length: sum.length() / strokes.max(1) as f64, strokes }
}

/// The detail finer than strokes, body by body, so that silhouettes do not count as brushwork.
fn fine(picture: &Plane, body_ids: &[u32], sigma_px: f64) -> Plane {
    let mut bodies: Vec<u32> = body_ids.iter().copied().filter(|&id| id > 0).collect();
    bodies.sort_unstable();
    bodies.dedup();
    let mut sum = Plane::filled(picture.size_px, 0.0);
    for body in bodies {
        let mask: Vec<bool> = body_ids.iter().map(|&id| id == body).collect();
        let of_body = picture.high_pass_in(&mask, sigma_px);
        for (total, value) in sum.values.iter_mut().zip(&of_body.values) {
            *total += value;
        }
    }
    sum
}

/// Of the pixels of the bodies that `is_counted` picks: the share whose surface point has moved by more than `by_px`.
pub fn share_moved(
    motion: &impasto_gl_render::MotionPixels,
    is_counted: impl Fn(u32) -> bool,
    by_px: f64,
) -> f64 {
    let (mut counted, mut moved) = (0usize, 0usize);
    for (&id, [dx, dy]) in motion.body_id.iter().zip(&motion.offset_px) {
        if id > 0 && is_counted(id) {
            counted += 1;
            moved += usize::from(f64::from(dx.hypot(*dy)) > by_px);
        }
    }
    moved as f64 / counted.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(x: i64, y: i64) -> f32 {
        (impasto_core::hash::combine(x as u32, y as u32) % 256) as f32
    }

    #[test]
    fn a_pattern_that_stays_correlates_at_pixels_and_one_that_moves_at_points() {
        let size = [96, 96];
        let ids = vec![1; 96 * 96];
        let correspondences: Vec<Option<[f64; 2]>> = (0..96 * 96)
            .map(|index| {
                let x = (index % 96) as f64 + 7.0;
                (x <= 95.0).then_some([x, (index / 96) as f64])
            })
            .collect();
        let now = Plane::of(size, |x, y| noise(x as i64, y as i64)).blurred(1.0);
        let goes = Plane::of(size, |x, y| noise(x as i64 - 7, y as i64)).blurred(1.0);
        let of = |then: &Plane| {
            let pair = Pair {
                pictures: [&now, then],
                body_ids: [&ids, &ids],
                correspondences: &correspondences,
                stroke_px: 8.0,
            };
            shower_door(&pair)
        };
        let carried = of(&goes);
        assert!(carried.same_points > 0.95 && carried.same_pixels.abs() < 0.1, "{carried:?}");
        let stuck = of(&now);
        assert!(stuck.same_pixels > 0.99 && stuck.same_points.abs() < 0.1, "{stuck:?}");
        assert!(stuck.pixels > 8000);
    }
}
