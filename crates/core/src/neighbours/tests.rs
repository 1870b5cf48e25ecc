//! Tests of neighbour lists against brute force, with the portable build of the search and with that for wide vectors.

use super::*;
use crate::hash;

/// Numbers in −1..1.
fn scatter(index: u32, axis: u32) -> f32 {
    hash::unit(hash::combine(index, axis)) * 2.0 - 1.0
}

fn scattered(count: u32, size: Vec3) -> (Vec<Vec3>, Vec<Vec3>) {
    let positions: Vec<Vec3> = (0..count)
        .map(|index| Vec3::new(scatter(index, 0), scatter(index, 1), scatter(index, 2)) * size)
        .collect();
    let normals = positions.iter().map(|p| Vec3::new(0.2, 0.1, p.z.signum()).normalize()).collect();
    (positions, normals)
}

/// The lists found by comparing every query with every point. With `own`, the point with the query's own index counts
/// too.
fn brute_force(
    queries: Points<'_>,
    points: Points<'_>,
    radius: f32,
    most: usize,
    own: bool,
) -> Vec<Vec<u32>> {
    let list = |query: usize| {
        let mut found: Vec<(f32, u32)> = Vec::new();
        for (index, position) in points.positions.iter().enumerate() {
            let distance_sq = queries.positions[query].distance_squared(*position);
            let same_side = queries.normals[query].dot(points.normals[index]) > 0.0;
            if distance_sq <= radius * radius && same_side && (own || index != query) {
                found.push((distance_sq, index as u32));
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        found.truncate(most);
        found.into_iter().map(|(_, index)| index).collect()
    };
    (0..queries.positions.len()).map(list).collect()
}

/// Compares every build of the search with brute force.
fn check(positions: &[Vec3], normals: &[Vec3], radius: f32) {
    let points = Points { positions, normals };
    let expected = brute_force(points, points, radius, MAX_NEIGHBOURS, false);
    for (build, run) in wide::builds() {
        let found = Neighbours::found_among_themselves(points, radius, run);
        assert_eq!(found.len(), positions.len());
        for (particle, expected) in expected.iter().enumerate() {
            assert_eq!(found.of(particle), expected, "{build}: particle {particle}, radius {radius}");
        }
    }
}

#[test]
fn lists_equal_brute_force() {
    let (positions, normals) = scattered(1500, Vec3::new(1.0, 1.0, 0.1));
    for radius in [0.0, 1e-30, 0.02, 0.15, 0.7, 9.0, f32::INFINITY, f32::NAN] {
        check(&positions, &normals, radius);
    }
    let found = Neighbours::find(&positions, &normals, -1.0);
    assert!((0..positions.len()).all(|particle| found.of(particle).is_empty()));
}

#[test]
fn lists_of_others_equal_brute_force() {
    let (positions, normals) = scattered(700, Vec3::new(1.0, 1.0, 0.1));
    // Some queries are far from all points.
    let (around, around_normals) = scattered(900, Vec3::new(3.0, 1.5, 0.2));
    let points = Points { positions: &positions, normals: &normals };
    let queries = Points { positions: &around, normals: &around_normals };
    let index = PointIndex::new(points, 0.3);
    for most in [0, 1, 12] {
        let expected = brute_force(queries, points, 0.3, most, true);
        let found = index.nearest(queries, most);
        assert_eq!(found.len(), 900);
        for (query, expected) in expected.iter().enumerate() {
            assert_eq!(found.of(query), expected, "query {query}");
        }
    }
    let nothing = Points { positions: &[], normals: &[] };
    assert!(index.nearest(nothing, 12).is_empty());
    assert!(PointIndex::new(nothing, 1.0).nearest(queries, 12).of(3).is_empty());
}

#[test]
fn degenerate_bodies_equal_brute_force() {
    let count = 700;
    let up = vec![Vec3::Y; count];
    let body = |position: &dyn Fn(f32) -> Vec3| -> Vec<Vec3> {
        (0..count).map(|index| position(index as f32)).collect()
    };
    check(&body(&|_| Vec3::splat(0.3)), &up, 0.1);
    check(&body(&|index| Vec3::X * index), &up, 40.5);
    check(&body(&|index| Vec3::splat(1e-3 * (index % 7.0))), &up, 0.002);
    // Two clouds so far apart that no memory could hold all cells between them.
    let (cloud, normals) = scattered(count as u32, Vec3::splat(1e-4));
    let apart: Vec<Vec3> = cloud
        .iter()
        .enumerate()
        .map(|(index, p)| *p + Vec3::splat(if index % 2 == 0 { 1e6 } else { 0.0 }))
        .collect();
    check(&apart, &normals, 1e-6);
    check(&apart, &normals, 3e-5);
    check(&body(&|index| Vec3::splat(f32::MAX * (index / 350.0 - 1.0))), &up, 1.0);
}

#[test]
fn points_at_nan_or_infinity_have_no_neighbours() {
    let (mut positions, normals) = scattered(600, Vec3::ONE);
    for (index, position) in positions.iter_mut().enumerate() {
        position.x = match index % 5 {
            0 => f32::NAN,
            1 => f32::INFINITY,
            2 => f32::NEG_INFINITY,
            _ => position.x,
        };
    }
    check(&positions, &normals, 0.4);
    check(&[Vec3::NAN; 20], &[Vec3::Y; 20], 0.4);
    check(&positions, &vec![Vec3::NAN; 600], 0.4);
}

#[test]
fn threads_do_not_change_the_lists() {
    let (positions, normals) = scattered(20_000, Vec3::new(1.0, 1.0, 0.01));
    let on_threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| Neighbours::find(&positions, &normals, 0.05))
    };
    assert_eq!(on_threads(1), on_threads(3));
}

#[test]
fn a_list_is_full_at_its_radius() {
    let (side, spacing) = (100, 0.3);
    let radius = full_list_radius((f64::from(side) * spacing).powi(2), (side * side) as usize);
    let near = (-20..=20).flat_map(|y| (-20..=20).map(move |x| f64::from(x * x + y * y).sqrt() * spacing));
    let found = near.filter(|&away| away <= radius).count() as f64;
    assert!((found / MAX_NEIGHBOURS as f64 - 1.0).abs() < 0.1, "{found}");
    assert!(full_list_radius(1.0, 0).is_finite());
}

#[test]
fn arrays_that_no_lists_have_are_refused() {
    let (positions, normals) = scattered(40, Vec3::ONE);
    let found = Neighbours::find(&positions, &normals, 0.4);
    let arrays = found.arrays();
    let whole = (arrays.slots.to_vec(), arrays.lengths.to_vec(), arrays.indices.to_vec(), arrays.most);
    type Arrays = (Vec<u32>, Vec<u8>, Vec<u32>, usize);
    let read =
        |(slots, lengths, indices, most): Arrays| Neighbours::from_arrays(slots, lengths, indices, most);
    let again = read(whole.clone()).unwrap();
    assert!((0..40).all(|particle| again.of(particle) == found.of(particle)));
    let faults: [fn(&mut Arrays); 6] = [
        |arrays| arrays.1.truncate(39),
        |arrays| arrays.2.truncate(39),
        |arrays| arrays.0[3] = 40,
        |arrays| arrays.2[3] = 40,
        |arrays| arrays.1[3] = 51,
        // The number of indices matches `most`, but `most` is itself above `MAX_NEIGHBOURS`.
        |arrays| (arrays.3, arrays.2) = (MAX_NEIGHBOURS + 1, vec![0; 40 * (MAX_NEIGHBOURS + 1)]),
    ];
    for (number, fault) in faults.iter().enumerate() {
        let mut arrays = whole.clone();
        fault(&mut arrays);
        assert!(read(arrays).is_none(), "fault {number} is taken");
    }
}
