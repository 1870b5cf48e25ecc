//! Tests of inverse bilinear interpolation: our formula against that of the source (docs/techniques/inverse_bilinear.md
//! names it), and tapered and bent strokes as they are drawn.

use glam::{DMat3, DVec2};
use impasto_core::hash;
use impasto_core::inverse_bilinear::{FARTHEST, bilinear, inverse_bilinear};

mod strokes;

fn chance(index: u32, which: u32) -> f64 {
    f64::from(hash::unit(hash::combine(index, which)))
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    General,
    Trapezoid,
    Parallelogram,
    Rectangle,
}

const KINDS: [Kind; 4] = [Kind::General, Kind::Trapezoid, Kind::Parallelogram, Kind::Rectangle];

/// The `index`th of many convex quads; every second one is wound clockwise.
fn convex(index: u32, kind: Kind) -> [DVec2; 4] {
    let between = |which: u32, low: f64, high: f64| low + (high - low) * chance(index, which);
    let corner_deg = if kind == Kind::Rectangle { 90.0 } else { between(3, 10.0, 170.0) };
    let winding = if index.is_multiple_of(2) { 1.0 } else { -1.0 };
    let along = DVec2::from_angle(between(0, 0.0, std::f64::consts::TAU));
    let b1 = along * between(1, 1.0, 1000.0);
    let b2 = along.rotate(DVec2::from_angle(winding * corner_deg.to_radians())) * between(2, 1.0, 1000.0);
    // p₃ = p₀ + s b₁ + t b₂ lies beyond the line from p₁ to p₂ when s + t > 1; then the quad is convex.
    let (s, t) = match kind {
        Kind::General => {
            let s = between(4, 0.05, 3.0);
            (s, (1.02 - s).max(0.05) + between(5, 0.0, 2.0))
        }
        Kind::Trapezoid => (between(4, 0.02, 3.0), 1.0),
        Kind::Parallelogram | Kind::Rectangle => (1.0, 1.0),
    };
    let p0 = DVec2::new(between(6, -500.0, 500.0), between(7, -500.0, 500.0));
    [p0, p0 + b1, p0 + b2, p0 + b1 * s + b2 * t]
}

/// The source's own formula, with "+" before the root and u from one component.
fn as_the_source_has_it(point: DVec2, [p0, p1, p2, p3]: [DVec2; 4]) -> DVec2 {
    let wedge = |a: DVec2, b: DVec2| a.x * b.y - a.y * b.x;
    let (q, b1, b2, b3) = (point - p0, p1 - p0, p2 - p0, p0 - p1 - p2 + p3);
    let (a, b, c) = (wedge(b2, b3), wedge(b3, q) - wedge(b1, b2), wedge(b1, q));
    let v = (-b + (b * b - 4.0 * a * c).sqrt()) / (2.0 * a);
    let under = b1 + b3 * v;
    let over = q - b2 * v;
    let u = if under.x.abs() > under.y.abs() { over.x / under.x } else { over.y / under.y };
    DVec2::new(u, v)
}

fn is_near(found: DVec2, wanted: DVec2, most: f64) -> bool {
    (found - wanted).abs().max_element() <= most
}

#[test]
fn there_and_back_in_convex_quads_of_all_kinds() {
    for kind in KINDS {
        let mut worst = 0.0_f64;
        for index in 0..20_000 {
            let corners = convex(index, kind);
            let at = DVec2::new(chance(index, 8), chance(index, 9));
            let found = inverse_bilinear(bilinear(at, corners), corners);
            worst = worst.max((found - at).abs().max_element());
        }
        println!("{kind:?}: off by at most {worst:e}");
        assert!(worst <= 1e-9, "{kind:?}: {worst:e}");
    }
}

#[test]
fn the_sources_root_is_wrong_wherever_the_corner_turns_left() {
    let (mut right, mut wrong) = (0, 0);
    for index in 0..20_000 {
        let corners = convex(index, Kind::General);
        let at = DVec2::new(chance(index, 8), chance(index, 9)) * 0.98 + 0.01;
        let theirs = as_the_source_has_it(bilinear(at, corners), corners);
        let turns_left = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]) > 0.0;
        if turns_left {
            wrong += u32::from(!is_near(theirs, at, 1e-3));
        } else {
            right += u32::from(is_near(theirs, at, 1e-3));
        }
    }
    // On a quad that is nearly a parallelogram, the source's root loses precision.
    assert!(wrong == 10_000 && right > 9_900, "{wrong} wrong, {right} right");
}

#[test]
fn the_sources_root_has_no_value_on_parallelograms() {
    let square = [DVec2::ZERO, DVec2::Y, DVec2::X, DVec2::ONE];
    assert!(as_the_source_has_it(DVec2::new(0.25, 0.75), square).is_nan());
    assert_eq!(inverse_bilinear(DVec2::new(0.25, 0.75), square), DVec2::new(0.75, 0.25));
}

#[test]
fn corners_are_exact_in_both_windings() {
    let wanted = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE];
    let quad = [DVec2::new(3.0, 1.0), DVec2::new(11.0, 2.0), DVec2::new(2.0, 8.0), DVec2::new(9.0, 13.0)];
    // Wound the other way, p₁ and p₂ are swapped, and so are u and v.
    let clockwise = [quad[0], quad[2], quad[1], quad[3]];
    for index in 0..4 {
        assert!(is_near(inverse_bilinear(quad[index], quad), wanted[index], 1e-15), "corner {index}");
        let other = [0, 2, 1, 3][index];
        assert!(is_near(inverse_bilinear(quad[index], clockwise), wanted[other], 1e-15), "corner {index}");
    }
}

#[test]
fn a_triangle_is_a_quad_whichever_corner_it_has_twice() {
    let [a, b, c] = [DVec2::new(1.0, 2.0), DVec2::new(40.0, 7.0), DVec2::new(9.0, 33.0)];
    for corners in [[a, a, b, c], [a, b, a, c], [a, b, c, b], [a, b, c, c]] {
        for index in 0..1000 {
            // Not at the doubled corner itself: a whole side of the unit square maps to that point.
            let at = DVec2::new(chance(index, 0), chance(index, 1)) * 0.9 + 0.05;
            let found = inverse_bilinear(bilinear(at, corners), corners);
            assert!(is_near(found, at, 1e-9), "{corners:?}: {found} for {at}");
        }
    }
}

#[test]
fn inside_a_concave_quad_every_point_has_its_place() {
    for index in 0..20_000 {
        let [p0, p1, p2, _] = convex(index, Kind::General);
        let (s, t) = (0.05 + 0.4 * chance(index, 10), 0.05 + 0.4 * chance(index, 11));
        let corners = [p0, p1, p2, p0 + (p1 - p0) * s + (p2 - p0) * t];
        // A point of the triangle p₀ p₁ p₃, which lies inside the quad.
        let (x, y) = (chance(index, 8), chance(index, 9));
        let (x, y) = if x + y > 1.0 { (1.0 - x, 1.0 - y) } else { (x, y) };
        let point = p0 + (corners[1] - p0) * x + (corners[3] - p0) * y;
        let found = inverse_bilinear(point, corners);
        let size = (p1 - p0).length().max((p2 - p0).length());
        assert!(bilinear(found, corners).distance(point) <= 1e-7 * size, "{corners:?}: {found} for {point}");
        let inside = -1e-6..=1.0 + 1e-6;
        assert!(inside.contains(&found.x) && inside.contains(&found.y), "{corners:?}: {found} for {point}");
    }
}

#[test]
fn every_quad_and_point_gives_a_bounded_number() {
    let coordinates = [0.0, 1.0, -1.0, 1e-30, 5e8, -1e30];
    let pick = |index: u32, which: u32| coordinates[(chance(index, which) * 6.0) as usize];
    for index in 0..200_000 {
        let at = |corner: u32| DVec2::new(pick(index, 2 * corner), pick(index, 2 * corner + 1));
        let found = inverse_bilinear(at(4), [at(0), at(1), at(2), at(3)]);
        assert!(found.abs().max_element() <= FARTHEST, "{:?}: {found}", [at(0), at(1), at(2), at(3), at(4)]);
    }
}

/// (u, v) by two triangles that share the diagonal from p₁ to p₂: affine in each.
fn on_two_triangles(point: DVec2, [p0, p1, p2, p3]: [DVec2; 4]) -> DVec2 {
    let affine = |corner: DVec2, along: DVec2, across: DVec2| {
        let area = along.perp_dot(across);
        let off = point - corner;
        DVec2::new(off.perp_dot(across) / area, along.perp_dot(off) / area)
    };
    if (p2 - p1).perp_dot(point - p1) * (p2 - p1).perp_dot(p0 - p1) >= 0.0 {
        affine(p0, p1 - p0, p2 - p0)
    } else {
        1.0 - affine(p3, p2 - p3, p1 - p3)
    }
}

/// (u, v) by the projective map through the four corners.
fn projective(point: DVec2, [p0, p1, p2, p3]: [DVec2; 4]) -> DVec2 {
    // Heckbert's map from the unit square to the quad, inverted.
    let (sum, d1, d2) = (p0 - p1 + p3 - p2, p1 - p3, p2 - p3);
    let area = d1.perp_dot(d2);
    let (g, h) = (sum.perp_dot(d2) / area, d1.perp_dot(sum) / area);
    let forth = DMat3::from_cols((p1 - p0 + p1 * g).extend(g), (p2 - p0 + p2 * h).extend(h), p0.extend(1.0));
    let at = forth.inverse() * point.extend(1.0);
    at.truncate() / at.z
}

type Map = fn(DVec2, [DVec2; 4]) -> DVec2;

/// How much the derivative of (u, v) jumps across the diagonal from p₁ to p₂, times the length of that diagonal.
fn jump_over_the_diagonal(map: Map, corners: [DVec2; 4]) -> f64 {
    let place = corners[1].lerp(corners[2], 0.4);
    let side = (corners[2] - corners[1]).perp().normalize() * 1e-3;
    let change = |at: DVec2, step: DVec2| (map(at + step, corners) - map(at, corners)) / step.length();
    let size = corners[1].distance(corners[2]);
    (change(place, side) + change(place, -side)).length() * size
}

const SQUARE: [DVec2; 4] =
    [DVec2::new(0.0, 0.0), DVec2::new(100.0, 0.0), DVec2::new(0.0, 100.0), DVec2::new(100.0, 100.0)];
/// A parallelogram: scaled, turned and sheared.
const SHEARED: [DVec2; 4] =
    [DVec2::new(5.0, 9.0), DVec2::new(90.0, 50.0), DVec2::new(-30.0, 70.0), DVec2::new(55.0, 111.0)];
/// A square with one corner moved.
const MOVED: [DVec2; 4] =
    [DVec2::new(0.0, 0.0), DVec2::new(100.0, 0.0), DVec2::new(0.0, 100.0), DVec2::new(100.0, 40.0)];

#[test]
fn two_triangles_have_a_seam_where_sides_are_not_parallel_and_a_quad_has_none() {
    for corners in [SQUARE, SHEARED] {
        assert!(jump_over_the_diagonal(on_two_triangles, corners) < 1e-6);
        assert!(jump_over_the_diagonal(inverse_bilinear, corners) < 1e-6);
    }
    let theirs = jump_over_the_diagonal(on_two_triangles, MOVED);
    let ours = jump_over_the_diagonal(inverse_bilinear, MOVED);
    println!("moved corner: {theirs:.3} on two triangles, {ours:.6} on the quad");
    assert!(theirs > 0.5 && ours < 1e-3 * theirs, "{theirs} {ours}");
}

#[test]
fn the_projective_map_has_no_seam_either_but_spreads_its_edges_unevenly() {
    assert!(jump_over_the_diagonal(projective, MOVED) < 1e-3);
    // On the bottom edge, u must depend on the two ends of the edge alone. Otherwise a quad that shares only this edge
    // would have another u at the same place.
    let quarter = MOVED[0].lerp(MOVED[1], 0.25);
    assert!((projective(quarter, MOVED).x - 0.25).abs() > 0.05, "{}", projective(quarter, MOVED));
    assert!((inverse_bilinear(quarter, MOVED).x - 0.25).abs() < 1e-12);
}
