//! Metric M14, density: are there as many strokes as wanted, evenly spread?

use impasto_core::sampling::hexagonal_spacing;

/// One stroke of a layer in a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedStroke {
    /// Its centre, pixels.
    pub center_px: [f64; 2],
    /// Its presence, 0..=1.
    pub alpha: f64,
    /// The area of the picture that one stroke should have to itself here, pixels.
    pub wanted_area_px: f64,
}

/// Σ `alpha` · `wanted_area_px`, divided by `pixels`. `pixels` is the area in which the strokes lie, painted or
/// not. The result is 1 where there are as many strokes as wanted.
pub fn shown_over_wanted(strokes: &[PlacedStroke], pixels: usize) -> f64 {
    strokes.iter().map(|stroke| stroke.alpha * stroke.wanted_area_px).sum::<f64>() / pixels.max(1) as f64
}

/// How evenly the strokes with an alpha above a half are spread: the mean distance to the nearest neighbour, divided
/// by that distance in a hexagonal lattice with as many points on as many pixels; 0 if there are fewer than two such
/// strokes. The second result is the number of strokes with an alpha above a half.
pub fn spacing_over_ideal(strokes: &[PlacedStroke], pixels: usize) -> (f64, usize) {
    let mut shown: Vec<[f64; 2]> =
        strokes.iter().filter(|stroke| stroke.alpha > 0.5).map(|stroke| stroke.center_px).collect();
    if shown.len() < 2 {
        return (0.0, shown.len());
    }
    shown.sort_by(|a, b| a[0].total_cmp(&b[0]));
    // Searches outwards to either side, until all further strokes are too far away in x alone.
    let nearest = |index: usize| {
        let [x, y] = shown[index];
        let mut least = f64::INFINITY;
        let mut compare = |[other_x, other_y]: [f64; 2]| {
            least = least.min((other_x - x).hypot(other_y - y));
            (other_x - x).abs() <= least
        };
        let _ = shown[..index].iter().rev().all(|&other| compare(other));
        let _ = shown[index + 1..].iter().all(|&other| compare(other));
        least
    };
    let mean = (0..shown.len()).map(nearest).sum::<f64>() / shown.len() as f64;
    (mean / hexagonal_spacing(pixels as f64, shown.len()), shown.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hexagonal_lattice_has_ideal_spacing_and_random_points_do_not() {
        let place = |x: f64, y: f64| PlacedStroke {
            center_px: [x, y],
            alpha: 1.0,
            wanted_area_px: 3f64.sqrt() * 50.0,
        };
        let lattice: Vec<PlacedStroke> = (0..40)
            .flat_map(|row| (0..40).map(move |column| (row, column)))
            .map(|(row, column)| {
                place(10.0 * f64::from(column) + 5.0 * f64::from(row % 2), f64::from(row) * 5.0 * 3f64.sqrt())
            })
            .collect();
        let pixels = (400.0 * 40.0 * 5.0 * 3f64.sqrt()) as usize;
        let (spacing, count) = spacing_over_ideal(&lattice, pixels);
        assert!((spacing - 1.0).abs() < 1e-3 && count == 1600, "{spacing}");
        assert!((shown_over_wanted(&lattice, pixels) - 1.0).abs() < 1e-3);
        let unit = |which: u32| f64::from(impasto_core::hash::unit(impasto_core::hash::scramble(which)));
        let random: Vec<PlacedStroke> =
            (0..1600).map(|i| place(unit(2 * i) * 400.0, unit(2 * i + 1) * 346.0)).collect();
        let (spacing, _) = spacing_over_ideal(&random, pixels);
        assert!(spacing < 0.55, "{spacing}");
    }
}
