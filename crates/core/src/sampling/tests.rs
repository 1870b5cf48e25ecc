//! Tests of sampling: the order never changes by a bit, and degenerate meshes do no harm.

use glam::Vec3;

use super::candidates::Candidates;
use super::{Particle, ProgressiveState, Surface, progressive, scattered};
use crate::TriangleMesh;

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
        ("ball", ball(), [0x25b1_b734_e6d1_d93c, 0x7c0a_9ebd_1cd9_693d, 0xb59b_5cef_e3e9_40d0]),
        ("sheet", sheet(), [0x77e8_bc0e_300e_df7d, 0x5c4a_991c_7a68_a4e8, 0x39dc_8b4c_c3da_c996]),
        (
            "creased sheet",
            creased_sheet(),
            [0xacba_20ab_46fe_f437, 0x393d_96d0_271c_d6a8, 0xbe6f_5097_0715_a8bd],
        ),
        (
            "squares on each other",
            squares_on_each_other(),
            [0x4574_2ba0_06ad_03d4, 0x0b72_bedc_2a39_d024, 0x582b_27ca_8fff_242c],
        ),
        (
            "rod and speck",
            rod_and_speck(),
            [0xd238_b786_0217_cfb3, 0x626a_ad69_4ad7_70a7, 0x6c0b_d25e_fdb2_5add],
        ),
    ];
    for (name, mesh, expected) in bodies {
        let surface = Surface::new(&mesh, |_| true);
        let found = [20, 1500, 60_000].map(|count| bits(&progressive(&surface, count, 3)));
        assert_eq!(found, expected, "{name}");
    }
}

#[test]
fn growing_in_steps_gives_the_same_order() {
    for mesh in [ball(), creased_sheet(), squares_on_each_other()] {
        let surface = Surface::new(&mesh, |_| true);
        let (mut state, mut particles) = (ProgressiveState::default(), Vec::new());
        for count in [1, 7, 400, 401, 9000] {
            state.grow(&surface, 5, &mut particles, count);
            assert_eq!(particles[..count], progressive(&surface, count, 5));
        }
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
