//! Frames per second as a fraction, as files state it.

/// The denominator of television rates: 23.976 stands for 24000/1001.
const OF_TELEVISION: u32 = 1001;

/// A rate that differs from a television rate by less than this share (0.01 %) counts as that television rate.
const NEAR: f64 = 1e-4;

/// A rate as a fraction: a whole number, a television rate over 1001, or any other rate rounded to 1/1000 and reduced
/// to lowest terms. Both numbers are at least 1, and below 2^16 for rates up to 65 frames a second.
pub(crate) fn fraction(fps: f64) -> [u32; 2] {
    let fps = fps.clamp(0.001, 2e6);
    let nearest = |under: u32| {
        let over = (fps * f64::from(under)).round();
        let off = (over / f64::from(under) - fps).abs();
        (over as u32, off)
    };
    if let (over, off) = nearest(1)
        && off < 1e-9
    {
        return [over, 1];
    }
    // 29.97 becomes 30000/1001, not 29970/1000.
    let whole = (fps * f64::from(OF_TELEVISION) / 1000.0).round();
    if (whole * 1000.0 / f64::from(OF_TELEVISION) - fps).abs() < NEAR * fps {
        return [whole as u32 * 1000, OF_TELEVISION];
    }
    let (over, _) = nearest(1000);
    let shared = common(over, 1000);
    [(over / shared).max(1), 1000 / shared]
}

/// The largest number that divides both.
fn common(left: u32, right: u32) -> u32 {
    if right == 0 { left } else { common(right, left % right) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_of_film_and_television_are_fractions() {
        for (fps, wanted) in [
            (24.0, [24, 1]),
            (23.976, [24000, 1001]),
            (29.97, [30000, 1001]),
            (59.94, [60000, 1001]),
            (12.5, [25, 2]),
            (1.0, [1, 1]),
            (0.25, [1, 4]),
            (7.3, [73, 10]),
        ] {
            assert_eq!(fraction(fps), wanted, "{fps}");
        }
    }
}
