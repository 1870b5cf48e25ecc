//! Turns pictures: by quarter turns exactly, by other angles with bilinear sampling.

use crate::plane::Plane;

/// Where a pixel of a square picture was before the picture was turned counter-clockwise by this many quarters. `last`
/// is the index of the last column and row.
fn before_quarters(quarters: i32, [x, y]: [usize; 2], last: usize) -> [usize; 2] {
    match quarters.rem_euclid(4) {
        0 => [x, y],
        // The top row was the right column.
        1 => [last - y, x],
        2 => [last - x, last - y],
        _ => [y, last - x],
    }
}

/// The bytes of a square picture, turned counter-clockwise by quarter turns; nothing is interpolated.
pub fn quarters_of_bytes(rgba8: &[u8], side_px: usize, quarters: i32) -> Vec<u8> {
    let pixel = |index: usize| {
        let [x, y] = before_quarters(quarters, [index % side_px, index / side_px], side_px - 1);
        let at = (y * side_px + x) * 4;
        &rgba8[at..at + 4]
    };
    (0..side_px * side_px).flat_map(|index| pixel(index).iter().copied()).collect()
}

/// Where a pixel was before the picture was turned counter-clockwise about its middle. 0, 0 is the centre of the first
/// pixel, y down.
pub fn place_before(size_px: [usize; 2], angle_rad: f64, [x, y]: [usize; 2]) -> [f64; 2] {
    let middle = size_px.map(|side| (side as f64 - 1.0) * 0.5);
    let (dx, dy) = (x as f64 - middle[0], middle[1] - y as f64);
    let (sin, cos) = angle_rad.sin_cos();
    [middle[0] + dx * cos + dy * sin, middle[1] - (dy * cos - dx * sin)]
}

/// A picture turned counter-clockwise about its middle; 0 where the turned picture does not reach.
pub fn turned(plane: &Plane, angle_rad: f64) -> Plane {
    Plane::of(plane.size_px, |x, y| {
        let [from_x, from_y] = place_before(plane.size_px, angle_rad, [x, y]);
        plane.sample(from_x, from_y).unwrap_or(0.0)
    })
}

/// A mask of the disk in the middle of a picture, its radius this share of the largest possible.
pub fn disk(size_px: [usize; 2], share: f64) -> Vec<bool> {
    let middle = size_px.map(|side| (side as f64 - 1.0) * 0.5);
    let radius = 0.5 * size_px[0].min(size_px[1]) as f64 * share;
    (0..size_px[0] * size_px[1])
        .map(|index| {
            let (x, y) = ((index % size_px[0]) as f64, (index / size_px[0]) as f64);
            (x - middle[0]).hypot(y - middle[1]) <= radius
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarters_agree_with_sampling() {
        let side = 8;
        let plane = Plane::of([side, side], |x, y| (x * 31 + y * 17) as f32 % 200.0);
        let bytes: Vec<u8> = plane.values.iter().flat_map(|&value| [value as u8; 4]).collect();
        for quarters in 0..4 {
            let exact = quarters_of_bytes(&bytes, side, quarters);
            let sampled = turned(&plane, f64::from(quarters) * std::f64::consts::FRAC_PI_2);
            for (index, value) in sampled.values.iter().enumerate() {
                assert!((f32::from(exact[index * 4]) - value).abs() < 1e-2, "{quarters} quarters at {index}");
            }
        }
    }

    #[test]
    fn a_quarter_turns_the_right_side_to_the_top() {
        let mut bytes = vec![0u8; 3 * 3 * 4];
        bytes[(3 + 2) * 4] = 9; // middle of the right side
        let turned = quarters_of_bytes(&bytes, 3, 1);
        assert_eq!(turned[4], 9, "middle of the top");
    }
}
