//! The brush that paints amounts: the dabs that a drag leaves on a surface, and those that an eraser spares.

use impasto_scene::document::{Amount, AmountDab, PaintedAmount, Region};

use crate::path::PathPoint;
use crate::session::ToolOptions;

/// Dabs of a drag lie this share of the radius apart, which looks even.
pub(super) const DAB_SHARE: f64 = 0.5;

/// A dab has the falloff (1 − r²)², with r the distance from its middle in radii. In the middle of one dab of a long
/// drag, the falloffs of all its dabs, which lie [`DAB_SHARE`] apart, have this sum: `1 + 2 (1 − ¼)²`. A dab multiplies
/// by 1 + (factor − 1) · falloff, about factor^falloff, so a drag multiplies by about factor^`OVERLAP`.
const OVERLAP: f64 = 2.125;

/// The factor of one dab. Together, the dabs of a drag that raises give 1 + strength. Those of a drag that lowers give
/// the reciprocal, or 1 − strength for amounts that may be 0.
pub(super) fn factor(of: Amount, raises: bool, strength: f64) -> f64 {
    let strength = strength.clamp(0.0, 1.0);
    let drag = match (raises, *of.range().start() > 0.0) {
        (true, _) => 1.0 + strength,
        (false, true) => 1.0 / (1.0 + strength),
        (false, false) => 1.0 - strength,
    };
    let by = drag.powf(1.0 / OVERLAP);
    ((by * 1000.0).round() / 1000.0).clamp(*of.range().start(), *of.range().end())
}

/// The dabs of a drag that touched these points. `felt` gives two factors for a point: the first multiplies `radius`,
/// the second is what the dab paints.
pub(super) fn dabs(
    touched: &[PathPoint],
    radius: f64,
    felt: impl Fn(&PathPoint) -> (f64, f64),
) -> Vec<AmountDab> {
    let dab = |stamp: &PathPoint| {
        let (narrows, by) = felt(stamp);
        AmountDab {
            at: stamp.position.to_array().map(|value| short(value, radius)),
            normal: stamp.normal.to_array().map(|value| short(value, 1.0)),
            radius: short(radius * narrows, radius),
            by,
        }
    };
    touched.iter().map(dab).collect()
}

/// A value rounded to a thousandth of `length` or finer, so that a file of dabs stays readable.
pub(super) fn short(value: f64, length: f64) -> f64 {
    let digits = (3.0 - length.log10().floor()).clamp(0.0, 12.0) as i32;
    let scale = 10f64.powi(digits);
    let rounded = (value * scale).round() / scale;
    if rounded == 0.0 { 0.0 } else { rounded }
}

/// The amounts of a region that are left after an eraser of this radius touched these points. A dab of this amount on
/// this object is gone if the eraser went over its middle, on the same side of the surface.
pub(super) fn erased(
    region: &Region,
    (of, object): (Amount, &str),
    touched: &[PathPoint],
    radius: f64,
) -> Vec<PaintedAmount> {
    let is_touched = |dab: &AmountDab| {
        let [at, normal] = [dab.at, dab.normal].map(glam::DVec3::from);
        touched.iter().any(|stamp| stamp.position.distance(at) <= radius && stamp.normal.dot(normal) > 0.0)
    };
    let left = |amount: &PaintedAmount| {
        let mut left = amount.clone();
        if amount.of == of && amount.object.as_deref().or(region.on.object()) == Some(object) {
            left.dabs.retain(|dab| !is_touched(dab));
        }
        left
    };
    region.amounts.iter().map(left).filter(|amount| !amount.dabs.is_empty()).collect()
}

pub(super) fn waiting_words(options: &ToolOptions) -> String {
    let verbs = if options.lowers { ["lower", "raise"] } else { ["raise", "lower"] };
    let [drag, ctrl] = verbs;
    format!(
        "[Drag] {drag} the {}  [Ctrl] {ctrl}  [Shift] erase  [F] radius  [Middle] orbit",
        options.amount.word()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drag_comes_to_what_its_strength_says() {
        // The factors along the middle of a long drag, with the falloff of a dab.
        let along = |by: f64, at: f64| {
            let weight = |dab: i32| (1.0 - (at - f64::from(dab) * DAB_SHARE).powi(2)).max(0.0).powi(2);
            (-6..=6).map(|dab| 1.0 + (by - 1.0) * weight(dab)).product::<f64>()
        };
        for (of, raises, wanted) in [
            (Amount::Width, true, 2.0),
            (Amount::Length, false, 0.5),
            (Amount::Density, true, 2.0),
            (Amount::Density, false, 0.0),
            (Amount::Flatness, false, 0.0),
        ] {
            let by = factor(of, raises, 1.0);
            assert!(of.range().contains(&by));
            for step in 0..=10 {
                let found = along(by, f64::from(step) * 0.05);
                assert!((found - wanted).abs() < 0.07, "{of:?} {raises}: {found}, not {wanted}");
            }
        }
        assert_eq!(factor(Amount::Width, true, 0.0), 1.0);
    }

    #[test]
    fn numbers_have_no_more_digits_than_the_brush_needs() {
        assert_eq!(short(0.123456789, 0.05), 0.12346);
        assert_eq!(short(-12.3456789, 3.0), -12.346);
        assert_eq!(short(1234.56789, 2e4), 1235.0);
        assert_eq!(short(-1e-9, 0.1).to_bits(), 0);
        assert_eq!(short(1e-9, 1e-8), 1e-9);
    }
}
