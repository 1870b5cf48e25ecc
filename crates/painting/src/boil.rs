//! Boil: strokes are laid anew every few frames, each a little elsewhere, since a painted film is never quite still.
//!
//! No strokes appear or vanish. Only their place, length, width, direction and colour change, by a limited amount. The
//! same frame always has the same strokes.

use impasto_core::hash;

/// Standard deviation of the shift at full strength: along the stroke, in stroke lengths, and across it, in stroke
/// widths.
const PLACE: [f32; 2] = [0.10, 0.22];
/// Standard deviations of the logarithms of length and width at full strength.
const SIZE: [f32; 2] = [0.16, 0.12];
/// Standard deviation of the direction at full strength, radians.
const ANGLE_RAD: f32 = 0.14;
/// Standard deviation of what is added to the slow noise of colour at full strength, in standard deviations of that
/// noise.
const DRIFT: f32 = 1.6;

/// How strokes are laid in one drawing. A drawing shows for a few frames, then strokes are laid anew.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Boil {
    amount: f32,
    /// Random bits of the drawing.
    drawing_bits: u32,
}

/// How a stroke differs from the one that the scene states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Boiled {
    /// Shift of the centre: along the stroke, in stroke lengths, and across it, in stroke widths.
    pub(crate) shift: [f32; 2],
    /// Factors on length and width.
    pub(crate) size: [f32; 2],
    /// Added to the angle.
    pub(crate) turn_rad: f32,
    /// Added to the slow noise of its colour.
    pub(crate) drift: f32,
}

impl Boil {
    /// The drawing that shows at a frame if each drawing holds for `on` frames.
    pub(crate) fn at(frame: f64, amount: f32, on: f32) -> Self {
        let drawing = (frame / f64::from(on.round().max(1.0))).floor() as i64;
        Self { amount, drawing_bits: hash::scramble(drawing as u32) }
    }

    /// How the stroke of the particle with these random bits differs in this drawing.
    pub(crate) fn of(self, bits: u32) -> Boiled {
        let bits = hash::combine(bits, self.drawing_bits);
        let normal =
            |which: u32, deviation: f32| self.amount * deviation * hash::normal(hash::combine(bits, which));
        Boiled {
            shift: [normal(0, PLACE[0]), normal(1, PLACE[1])],
            size: [normal(2, SIZE[0]).exp(), normal(3, SIZE[1]).exp()],
            turn_rad: normal(4, ANGLE_RAD),
            drift: normal(5, DRIFT),
        }
    }
}

/// The most that length and width grow where strokes boil by this amount, as factors.
pub(crate) fn most_size(amount: f32) -> [f32; 2] {
    SIZE.map(|deviation| (amount * deviation * hash::MOST_NORMAL).exp())
}

/// The most that a centre is shifted where strokes boil by this amount, along and across, in lengths and widths.
pub(crate) fn most_shift(amount: f32) -> [f32; 2] {
    PLACE.map(|deviation| amount * deviation * hash::MOST_NORMAL)
}

impl Boiled {
    /// The shift of the centre of a stroke with this angle and this size.
    pub(crate) fn shift_px(&self, angle_rad: f32, size_px: [f32; 2]) -> [f32; 2] {
        let (sin, cos) = angle_rad.sin_cos();
        let [along, across] = [0, 1].map(|axis| self.shift[axis] * size_px[axis]);
        [cos * along - sin * across, sin * along + cos * across]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drawings_hold_and_are_laid_anew_within_limits() {
        let at = |frame: f64, on: f32| Boil::at(frame, 0.5, on).of(7);
        assert_eq!(at(4.0, 2.0), at(5.9, 2.0));
        assert_ne!(at(5.0, 2.0), at(6.0, 2.0));
        assert_eq!(at(-3.0, 3.0), at(-1.0, 3.0));
        assert_ne!(at(-1.0, 3.0), at(0.0, 3.0));
        let most =
            (0..10_000u32).map(|bits| Boil::at(3.0, 0.5, 2.0).of(bits)).fold([0.0f32; 3], |most, boiled| {
                let along = boiled.shift[0].abs();
                [
                    most[0].max(along),
                    most[1].max(boiled.size[0].max(1.0 / boiled.size[0])),
                    most[2].max(boiled.turn_rad.abs()),
                ]
            });
        // The strength is a half, and no normal number lies farther out than about 3.5 standard deviations.
        assert!(most[0] > 0.1 && most[0] <= 0.175, "{most:?}");
        assert!(most[1] > 1.2 && most[1] <= 1.33, "{most:?}");
        assert!(most[2] > 0.15 && most[2] <= 0.246, "{most:?}");
        assert_eq!(Boil::at(3.0, 0.0, 2.0).of(7).shift, [0.0; 2]);
    }
}
