//! Finds the point of a triangle that is nearest to another point.

use glam::DVec3;

/// The point of a triangle that is nearest to `at` (Ericson, Real-Time Collision Detection, 5.1.5). A triangle without
/// area is treated as its edges.
pub fn nearest_point(at: DVec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac);
    let on_plane = at - normal * ((at - a).dot(normal) / normal.length_squared());
    let inside = |from: DVec3, to: DVec3| (to - from).cross(on_plane - from).dot(normal) >= 0.0;
    if normal.length_squared() > 0.0 && inside(a, b) && inside(b, c) && inside(c, a) {
        return on_plane;
    }
    let on_edge = |from: DVec3, to: DVec3| {
        let edge = to - from;
        let t = (at - from).dot(edge) / edge.length_squared();
        if t.is_finite() { from + edge * t.clamp(0.0, 1.0) } else { from }
    };
    let candidates = [on_edge(a, b), on_edge(b, c), on_edge(c, a)];
    candidates
        .into_iter()
        .min_by(|p, q| (at - *p).length_squared().total_cmp(&(at - *q).length_squared()))
        .unwrap_or(a)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_points_of_a_triangle() {
        let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let near = |at: [f64; 3]| nearest_point(DVec3::from(at), triangle);
        assert_eq!(near([0.2, 0.2, 5.0]), DVec3::new(0.2, 0.2, 0.0));
        assert_eq!(near([-1.0, -1.0, 1.0]), DVec3::ZERO);
        assert!((near([1.0, 1.0, 0.0]) - DVec3::new(0.5, 0.5, 0.0)).length() < 1e-12);
        let needle = [DVec3::ZERO, DVec3::X, DVec3::X * 0.5];
        assert_eq!(nearest_point(DVec3::new(0.7, 3.0, 0.0), needle), DVec3::new(0.7, 0.0, 0.0));
    }
}
