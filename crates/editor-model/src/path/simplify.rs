//! Removes points from a path, so that its guide has few points. The path stays within a given distance of what it
//! was (Ramer 1972; Douglas and Peucker 1973).

use glam::DVec3;
use impasto_scene::document::GuidePoint;

use super::PathPoint;

/// A path of more than four times this many steps keeps the point this many steps from each end, so that it begins and
/// ends in the same direction as before.
const END_STEPS: usize = 3;

/// The points that keep a path within `tolerance` (model units) of what it was; both ends stay.
pub(crate) fn within(path: &[PathPoint], tolerance: f64) -> Vec<PathPoint> {
    let Some(last) = path.len().checked_sub(1) else { return Vec::new() };
    let ends = if last > 4 * END_STEPS { vec![0, END_STEPS, last - END_STEPS, last] } else { vec![0, last] };
    let places: Vec<DVec3> = path.iter().map(|point| point.position).collect();
    let keep = needed(&places, &ends, tolerance);
    path.iter().zip(keep).filter_map(|(point, keep)| keep.then_some(*point)).collect()
}

/// The points that keep a guide within `tolerance` (model units) of what it was; both ends stay.
pub(crate) fn guide_within(points: &[GuidePoint], tolerance: f64) -> Vec<GuidePoint> {
    let Some(last) = points.len().checked_sub(1) else { return Vec::new() };
    let places: Vec<DVec3> = points.iter().map(|point| DVec3::from(point.at)).collect();
    let keep = needed(&places, &[0, last], tolerance);
    points.iter().zip(keep).filter(|(_, keep)| *keep).map(|(point, _)| point.clone()).collect()
}

/// For each point, whether it stays. The points at the indices `ends` stay, and between them as many as keep the line
/// within `tolerance` of all points.
fn needed(places: &[DVec3], ends: &[usize], tolerance: f64) -> Vec<bool> {
    let mut keep = vec![false; places.len()];
    for &end in ends {
        keep[end] = true;
    }
    let mut spans: Vec<(usize, usize)> = ends.windows(2).map(|pair| (pair[0], pair[1])).collect();
    while let Some((from, to)) = spans.pop() {
        let farthest = (from + 1..to)
            .map(|index| (off(places[index], places[from], places[to]), index))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((distance, index)) = farthest
            && distance > tolerance
        {
            keep[index] = true;
            spans.extend([(from, index), (index, to)]);
        }
    }
    keep
}

/// Distance from a point to a line segment.
fn off(point: DVec3, from: DVec3, to: DVec3) -> f64 {
    let piece = to - from;
    let t = ((point - from).dot(piece) / piece.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (from + piece * t).distance(point)
}
