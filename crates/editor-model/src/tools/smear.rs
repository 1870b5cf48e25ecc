//! Smearing: the brush takes up the direction under it and carries it along.

use glam::DVec2;

use crate::path::PathPoint;

/// How far, from 0 to 1, the brush's own direction turns to the direction under the brush at each stamp.
const TAKEN_UP: f64 = 0.1;

/// The direction that the brush carries at each stamp: the angle of a line on the screen, radians counter-clockwise.
/// `shown_rad` gives the direction under each stamp before the smear. Where it is `None`, the brush's direction stays.
pub(super) fn carried(shown_rad: impl Iterator<Item = Option<f64>>) -> Vec<Option<f64>> {
    // Directions are blended at twice the angle, so that the two directions of a line are the same.
    let mut brush: Option<DVec2> = None;
    shown_rad
        .map(|shown| {
            let under = shown.map(|angle| DVec2::from_angle(2.0 * angle));
            brush = match (brush, under) {
                (Some(brush), Some(under)) => brush.lerp(under, TAKEN_UP).try_normalize().or(Some(brush)),
                (brush, under) => brush.or(under),
            };
            brush.map(|carried| 0.5 * carried.to_angle())
        })
        .collect()
}

/// How far the carried direction is turned from the gesture's own line at a point, degrees in −90..=90.
pub(super) fn turn_deg(
    point: &PathPoint,
    line_rad: f64,
    stamps: &[PathPoint],
    carried_rad: &[Option<f64>],
) -> f64 {
    let nearest = stamps
        .iter()
        .zip(carried_rad)
        .min_by(|(a, _), (b, _)| a.at_px.distance(point.at_px).total_cmp(&b.at_px.distance(point.at_px)));
    let Some((_, &Some(carried))) = nearest else { return 0.0 };
    let off = (carried - line_rad).to_degrees();
    off - 180.0 * (off / 180.0).round()
}
