//! Tests of sampling: the order never changes by a bit, and degenerate meshes do no harm.

use std::collections::HashSet;
use std::sync::Arc;

use glam::Vec3;

use super::candidates::Candidates;
use super::levels::spacing;
use super::{Cell, Cells, Needed, Particle, ProgressiveOrder, Surface, barycentric, progressive, scattered};
use crate::{TriangleMesh, hash};

/// Square grids of triangles; each patch maps a point of the square −1..1 to a position and a normal.
fn patches(cells: u32, patches: &[&dyn Fn(f32, f32) -> (Vec3, Vec3)]) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for patch in patches {
        let first = mesh.positions.len() as u32;
        for index in 0..(cells + 1) * (cells + 1) {
            let [x, y] =
                [index % (cells + 1), index / (cells + 1)].map(|i| (2 * i) as f32 / cells as f32 - 1.0);
            let (position, normal) = patch(x, y);
            mesh.positions.push(position);
            mesh.normals.push(normal);
        }
        for cell in 0..cells * cells {
            let a = first + cell / cells * (cells + 1) + cell % cells;
            let [b, c, d] = [a + 1, a + cells + 2, a + cells + 1];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}

/// A cube projected onto a ball: unlike sines, this gives the same bits on every machine.
fn ball() -> TriangleMesh {
    let on = |position: Vec3| (position.normalize(), position.normalize());
    patches(
        6,
        &[
            &|x, y| on(Vec3::new(x, y, 1.0)),
            &|x, y| on(Vec3::new(-x, y, -1.0)),
            &|x, y| on(Vec3::new(1.0, x, y)),
            &|x, y| on(Vec3::new(-1.0, -x, y)),
            &|x, y| on(Vec3::new(y, 1.0, x)),
            &|x, y| on(Vec3::new(y, -1.0, -x)),
        ],
    )
}

fn sheet() -> TriangleMesh {
    patches(3, &[&|x, y| (Vec3::new(x, y, 0.0), Vec3::Z)])
}

/// A sheet whose corner normals differ so much that the cones of its faces do not tell whether two particles are on the
/// same side: the normals at the particles must be compared.
fn creased_sheet() -> TriangleMesh {
    patches(5, &[&|x, y| (Vec3::new(x, y, 0.1 * x * y), Vec3::new(2.0 * x, 1.9 * y, 0.3).normalize())])
}

fn squares_on_each_other() -> TriangleMesh {
    let square = |x: f32, y: f32| (Vec3::new(x, y, 0.0), Vec3::Z);
    patches(1, &[&square, &square, &square, &square, &square, &square, &square, &square])
}

/// A speck beside a long rod, far from the origin.
fn rod_and_speck() -> TriangleMesh {
    let away = Vec3::new(300.0, -200.0, 50.0);
    patches(
        2,
        &[&|x, y| (away + Vec3::new(90.0 * x, 0.01 * y, 0.0), Vec3::Z), &|x, y| {
            (away + Vec3::new(0.02 * x, 5.0, 0.02 * y), Vec3::Y)
        }],
    )
}

fn bits(particles: &[Particle]) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325u64;
    let mut add = |value: u32| hash = (hash ^ u64::from(value)).wrapping_mul(0x0100_0000_01b3);
    for particle in particles {
        add(particle.triangle);
        add(u32::from(particle.flipped));
        let (position, normal) = (particle.position.to_array(), particle.normal.to_array());
        particle.barycentric.iter().chain(&position).chain(&normal).for_each(|value| add(value.to_bits()));
    }
    hash
}

/// Every painting depends on every bit of this order.
#[test]
fn the_order_has_never_changed() {
    let bodies: [(&str, TriangleMesh, [u64; 3]); 5] = [
        ("ball", ball(), [0x432a_690f_e0c2_740b, 0x6c42_4230_fca6_b876, 0x399d_1934_0bad_07b2]),
        ("sheet", sheet(), [0x3a43_312f_e2d0_accb, 0x0bf7_2464_904d_2c62, 0xf7c7_15c5_9268_da8c]),
        (
            "creased sheet",
            creased_sheet(),
            [0xc098_9a54_105a_ed8e, 0x5503_42e5_d9cd_db13, 0x4699_a815_e34a_572a],
        ),
        (
            "squares on each other",
            squares_on_each_other(),
            [0x518c_f667_54eb_7b9a, 0x11f2_1ebe_9697_13cf, 0xfcde_8c1f_ea2c_77df],
        ),
        (
            "rod and speck",
            rod_and_speck(),
            [0xd238_b786_0217_cfb3, 0x6ec8_4c03_b56f_ef22, 0x8c23_462a_65cd_6611],
        ),
    ];
    for (name, mesh, expected) in bodies {
        let surface = Surface::new(&mesh, |_| true);
        let found = [20, 1500, 60_000].map(|count| bits(&progressive(&surface, count, 3)));
        assert_eq!(found, expected, "{name}");
    }
}

/// Samples measure the surface: each of the squares has about as many as the others.
#[test]
fn samples_of_squares_on_each_other_are_even_by_area() {
    let mesh = squares_on_each_other();
    let surface = Surface::new(&mesh, |_| true);
    let of_samples = super::samples(&surface, 1500, 3);
    for square in 0..8 {
        let count = of_samples.iter().filter(|sample| sample.triangle / 2 == square).count();
        assert!((1500 / 8 - 45..1500 / 8 + 45).contains(&count), "{count} on square {square}");
    }
    assert_eq!(bits(&of_samples), 0xa7fe_060d_dd86_8cf8);
    assert_eq!(super::samples(&surface, 20_000, 3).len(), 8192);
}

/// Eight sheets lie so near to each other that the order seems crowded at first. At finer spacings they have room, and
/// get their share again.
#[test]
fn close_sheets_get_their_share_at_fine_spacings() {
    let sheet = |z: f32| move |x: f32, y: f32| (Vec3::new(x, y, z), Vec3::Z);
    let sheets: Vec<_> = (0..8).map(|number| sheet(0.03 * number as f32)).collect();
    let patch_of: Vec<&dyn Fn(f32, f32) -> (Vec3, Vec3)> = sheets.iter().map(|sheet| sheet as _).collect();
    let mesh = patches(3, &patch_of);
    let surface = Surface::new(&mesh, |_| true);
    let mut order = ProgressiveOrder::default();
    order.grow(&surface, 5, 200_000);
    assert!(order.state.is_crowded());
    let before = |ordinal: f32| order.ordinals.partition_point(|&of| of < ordinal) as f32;
    let share = (before(150_000.0) - before(60_000.0)) / 90_000.0;
    assert!((0.97..1.03).contains(&share), "{share}");
}

#[test]
fn growing_in_steps_gives_the_same_order() {
    for mesh in [ball(), creased_sheet(), squares_on_each_other()] {
        let surface = Surface::new(&mesh, |_| true);
        let mut order = ProgressiveOrder::default();
        for count in [1, 7, 400, 401, 9000, 20_000, 40_000] {
            order.grow(&surface, 5, count);
            let len = order.len_of(count).expect("so many");
            assert_eq!(order.particles[..len], progressive(&surface, count, 5));
        }
        let mut at_once = ProgressiveOrder::default();
        at_once.grow(&surface, 5, 40_000);
        assert_eq!((order.state, order.ordinals), (at_once.state, at_once.ordinals));
    }
}

/// As many particles come before an ordinal as it says, wherever in a level it lies. A rod that is thinner than the
/// spacing has up to 15 % more.
#[test]
fn an_ordinal_counts_the_particles_before_it() {
    for (name, mesh, off) in
        [("ball", ball(), 0.015), ("creased sheet", creased_sheet(), 0.015), ("rod", rod_and_speck(), 0.15)]
    {
        let surface = Surface::new(&mesh, |_| true);
        let mut order = ProgressiveOrder::default();
        order.grow(&surface, 5, 250_000);
        assert!(order.ordinals.is_sorted() && order.ordinals.len() == order.particles.len());
        for ordinal in [20_000.0, 20_500.0, 57_000.0, 81_234.0, 200_000.0] {
            let before = order.ordinals.partition_point(|&of| of < ordinal) as f32;
            assert!((before / ordinal - 1.0).abs() < off, "{name}: {before} before {ordinal}");
        }
    }
}

/// Fifty sheets on each other, and one apart. The mesh lists their small faces in turn, so each cell has faces of all
/// sheets, and few tries. The one apart gets about four fifths of its share.
#[test]
fn an_open_sheet_among_piled_ones_is_hardly_thinner() {
    let square = |x: f32, y: f32| (Vec3::new(x, y, 0.0), Vec3::Z);
    let apart = |x: f32, y: f32| (Vec3::new(x + 5.0, y, 0.0), Vec3::Z);
    let pile: [&dyn Fn(f32, f32) -> (Vec3, Vec3); 50] = [&square; 50];
    let mut mesh = patches(20, &[&pile[..], &[&apart]].concat());
    let of_patch = mesh.triangles.len() / 51;
    let (triangles, number) = (mesh.triangles.clone(), |index: usize| index % 51 * of_patch + index / 51);
    mesh.triangles = (0..triangles.len()).map(|index| triangles[number(index)]).collect();
    let surface = Surface::new(&mesh, |_| true);
    let of_cell = vec![400_000.0; Cells::new(&surface).all().len()];
    let first_part = Arc::new(vec![0; of_cell.len()]);
    let order =
        ProgressiveOrder::where_needed(&surface, 5, &Needed { of_cell, first_part, is_strict: false });
    assert!(order.state.is_crowded());
    let all = order.particles.iter().zip(&order.ordinals);
    let open = all.filter(|&(particle, &ordinal)| particle.position.x > 2.0 && ordinal > 50_000.0).count();
    let share = open as f64 / (350_000.0 / 51.0);
    assert!((0.75..1.1).contains(&share), "{share} of its share");
}

/// A pile of squares has little room. A sheet beside it still gets as many particles as it would have alone, whether it
/// is as large as one of the squares or has a hundredth of the pile's area.
#[test]
fn a_sheet_beside_a_pile_keeps_its_share() {
    let square = |x: f32, y: f32| (Vec3::new(x, y, 0.0), Vec3::Z);
    for side in [1.0f32, 0.28] {
        let beside = move |x: f32, y: f32| (Vec3::new(side * x + 5.0, side * y, 0.0), Vec3::Z);
        let of_area = side * side / (8.0 + side * side);
        let pile: [&dyn Fn(f32, f32) -> (Vec3, Vec3); 8] = [&square; 8];
        let order_of = |mesh: TriangleMesh, count: f32| {
            let surface = Surface::new(&mesh, |_| true);
            let of_cell = vec![count; Cells::new(&surface).all().len()];
            let first_part = Arc::new(vec![0; of_cell.len()]);
            ProgressiveOrder::where_needed(&surface, 5, &Needed { of_cell, first_part, is_strict: false })
        };
        let order = order_of(patches(1, &[&pile[..], &[&beside]].concat()), 200_000.0);
        let alone = order_of(patches(1, &[&beside]), 200_000.0 * of_area);
        assert!(order.state.is_crowded() && !alone.state.is_crowded());
        let on_sheet_before = |order: &ProgressiveOrder, most: f32| {
            let is_before = |index: usize| order.ordinals.get(index).copied().unwrap_or(index as f32) < most;
            let all = order.particles.iter().enumerate();
            all.filter(|&(index, particle)| is_before(index) && particle.position.x > 2.0).count() as f64
        };
        for ([from, to], [least, most]) in
            [([10_000.0f32, 30_000.0], [0.85, 1.1]), ([30_000.0, 150_000.0], [0.98, 1.02])]
        {
            let found = on_sheet_before(&order, to) - on_sheet_before(&order, from);
            let [to, from] = [to, from].map(|most| on_sheet_before(&alone, most * of_area));
            let share = found / (to - from);
            assert!(share > least && share < most, "{side}, {from} to {to}: {share} of its share");
        }
        // The pile has little more than one of its squares would have.
        let on_pile = order.particles.len() as f64 - on_sheet_before(&order, f32::INFINITY);
        let of_square = 200_000.0 / f64::from(8.0 + side * side);
        assert!((1.0..1.3).contains(&(on_pile / of_square)), "{on_pile} of {of_square}");
    }
}

#[test]
fn where_it_is_needed_the_order_is_that_of_the_whole() {
    let mesh = patches(2, &[&|x, y| (Vec3::new(x, y, 0.0), Vec3::Z)]);
    let surface = Surface::new(&mesh, |_| true);
    let cells = Cells::new(&surface);
    // Much in a disk on the front, less round it, nothing elsewhere.
    let needed = |at: Vec3, front: bool| match at.length() {
        near if front && near < 0.2 => 100_000.0,
        near if front && near < 0.4 => 30_000.0,
        _ => 0.0,
    };
    let of_cell = cells.all().iter().map(|cell| needed(cell.center.as_vec3(), cell.normal.z > 0.0));
    let mut needs: Vec<f32> = of_cell.collect();
    // The needs of one cell's parts are listed.
    let mut first_part = vec![0; needs.len()];
    first_part[0] = needs.len() as u32;
    needs.extend([needs[0]; 4]);
    first_part.resize(needs.len(), 0);
    let needed = Needed { of_cell: needs, first_part: Arc::new(first_part), is_strict: false };
    let sparse = ProgressiveOrder::where_needed(&surface, 5, &needed);
    let mut whole = ProgressiveOrder::default();
    whole.grow(&surface, 5, 100_000);
    assert!(sparse.particles.len() < whole.particles.len() / 3);
    let inside = |order: &ProgressiveOrder, least: f32, reach: f32| -> Vec<(Particle, f32)> {
        let all =
            order.particles.iter().zip(&order.ordinals).map(|(&particle, &ordinal)| (particle, ordinal));
        let within = |(particle, ordinal): &(Particle, f32)| {
            !particle.flipped && particle.position.length() < reach && *ordinal < least
        };
        all.filter(within).collect()
    };
    // Compares only what lies at least half a cell and a few spacings inside the border of what is needed.
    for (least, reach) in [(98_000.0, 0.15), (29_000.0, 0.33)] {
        let [of_sparse, of_whole] = [&sparse, &whole].map(|order| inside(order, least, reach));
        assert!(of_whole.len() > 500);
        let same = of_sparse.iter().filter(|one| of_whole.contains(one)).count();
        assert!(
            same + of_whole.len() / 100 >= of_whole.len().max(of_sparse.len()),
            "{same} of {} and {} are the same",
            of_sparse.len(),
            of_whole.len()
        );
    }
    // Beyond the particles that are always there, nothing lies where nothing is needed.
    let far = |(particle, ordinal): (&Particle, &f32)| {
        (particle.position.length() > 0.5 || particle.flipped) && *ordinal > 20_000.0
    };
    assert_eq!(sparse.particles.iter().zip(&sparse.ordinals).filter(|&one| far(one)).count(), 0);
}

/// A triangle 2³¹ units long, whose near end needs far more particles, as if an eye were there. Its distinct places lie
/// 128 units apart, so a finer order has nothing to add.
#[test]
fn an_order_ends_where_places_are_no_longer_told_apart() {
    let far = 2_147_483_648.0;
    let mesh = TriangleMesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Z * far],
        normals: vec![Vec3::Y; 3],
        triangles: vec![[0, 1, 2]],
        ..TriangleMesh::default()
    };
    let surface = Surface::new(&mesh, |_| true);
    let cells = Cells::new(&surface);
    let needs = |cell: &Cell| if cell.center.z - cell.radius < 0.0 { 1e7 } else { 10_000.0 };
    let of_cell: Vec<f32> = cells.all().iter().map(needs).collect();
    let first_part = Arc::new(vec![0; of_cell.len()]);
    let needed = Needed { of_cell, first_part, is_strict: false };
    let order = ProgressiveOrder::where_needed(&surface, 5, &needed);
    let finest = spacing(&surface, order.state.level_end);
    assert!((64.0..256.0).contains(&finest), "the last spacing is {finest}");
    assert!((8192..1_000_000).contains(&order.particles.len()), "{} particles", order.particles.len());
}

/// Large faces are cut, small ones are put together; all cells together are the surface.
#[test]
fn every_point_of_a_cell_lies_in_its_sphere_and_faces_within_its_spread() {
    for (name, mesh) in [("sheet", sheet()), ("creased", creased_sheet()), ("rod", rod_and_speck())]
        .into_iter()
        .chain([("fine", patches(120, &[&|x, y| (Vec3::new(x, y, 0.1 * x * y), Vec3::Z)]))])
    {
        let surface = Surface::new(&mesh, |_| true);
        let mut cells: Vec<Cell> = Cells::new(&surface).into_iter().collect();
        for _ in 0..3 {
            assert!((cells.iter().map(|cell| cell.share).sum::<f64>() - 1.0).abs() < 1e-9, "{name}");
            for (number, cell) in cells.iter().enumerate() {
                assert!(cell.share <= 1.0 / 4096.0 * 1.001, "{name}: {}", cell.share);
                for sample in 0..8 {
                    let random = |which: u32| hash::unit(hash::combine(number as u32 * 8 + sample, which));
                    let (face, weights) = cell.place(&surface, random(1), barycentric(random(2), random(3)));
                    let particle = surface.particle(face, weights);
                    let distance = particle.position.as_dvec3().distance(cell.center);
                    assert!(distance <= cell.radius * 1.001 + 1e-4, "{name}: cell {number}");
                    let off = particle.normal.as_dvec3().distance(cell.normal);
                    assert!(off <= cell.spread + 1e-5, "{name}: {off} of {}", cell.spread);
                    assert!(cell.triangles(&surface).any(|triangle| triangle == particle.triangle as usize));
                }
            }
            cells = cells.iter().flat_map(|cell| cell.split(&surface)).collect();
        }
        let bits: HashSet<u32> = cells.iter().map(|cell| cell.bits).collect();
        assert!(bits.len() + cells.len() / 1000 >= cells.len(), "{name}: cells with equal bits");
    }
}

#[test]
fn degenerate_bodies_get_all_their_particles() {
    let at =
        |scale: f32, offset: Vec3| patches(1, &[&|x, y| (Vec3::new(x, y, 0.0) * scale + offset, Vec3::Z)]);
    let mut bodies = vec![
        at(1e-18, Vec3::ZERO),
        at(1e15, Vec3::ZERO),
        at(1e-3, Vec3::splat(1e7)),
        at(1.0, Vec3::splat(f32::NAN)),
    ];
    let mut without_normals = ball();
    without_normals.normals.fill(Vec3::ZERO);
    bodies.push(without_normals);
    for mesh in bodies {
        let surface = Surface::new(&mesh, |_| true);
        let count = if surface.area() > 0.0 { 2000 } else { 0 };
        assert_eq!(progressive(&surface, 2000, 1).len(), count);
    }
}

#[test]
fn scattered_particles_fill_every_face_by_its_area() {
    let mesh = rod_and_speck();
    let surface = Surface::new(&mesh, |_| true);
    let count = 200_000;
    let particles = scattered(&surface, count, 9);
    for (triangle, flipped, area) in surface.faces() {
        let found =
            particles.iter().filter(|p| p.triangle == triangle && p.flipped == flipped).count() as f64;
        let expected = count as f64 * area / surface.area();
        // Five standard deviations.
        assert!((found - expected).abs() <= 5.0 * expected.sqrt(), "{triangle}: {found} of {expected}");
    }
    assert_eq!(scattered(&surface, 1000, 9), particles[..1000]);
    assert!(scattered(&Surface::new(&mesh, |_| false), 10, 9).is_empty());
}

#[test]
fn particles_computed_in_blocks_equal_those_computed_singly() {
    // Corner normals that cancel out leave no interpolated normal between them.
    let mut bent =
        patches(2, &[&|x, y| (Vec3::new(x, y, 0.2 * x), if x < 0.0 { Vec3::Y } else { -Vec3::Y })]);
    bent.normals[4] = Vec3::ZERO;
    let mut without_normals = ball();
    without_normals.normals.fill(Vec3::ZERO);
    let meshes = [ball(), creased_sheet(), rod_and_speck(), bent, without_normals];
    for (body, mesh) in meshes.iter().enumerate() {
        let surface = Surface::new(mesh, |_| true);
        let candidates = Candidates::new(&surface, 11);
        let one_by_one: Vec<Particle> = (0..1000).map(|number| candidates.particle(number)).collect();
        assert_eq!(bits(&scattered(&surface, 1000, 11)), bits(&one_by_one), "body {body}");
        let darts = candidates.darts(77..333);
        assert_eq!(darts.len(), 256);
        for (dart, number) in darts.iter().zip(77..) {
            let one = candidates.dart(number);
            assert_eq!((dart.number, dart.face, dart.position), (number, one.face, one.position));
        }
    }
}
