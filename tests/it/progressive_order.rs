//! Tests of the order of particles. The first particles, however many of them, are blue noise. A longer list begins
//! with the particles of a shorter one.

use glam::Vec3;
use impasto_core::TriangleMesh;
use impasto_core::sampling::{Particle, Surface, hexagonal_spacing, progressive};
use impasto_tests::shapes::{cube, sheet, sphere};

/// Mean and 1st percentile of a particle's distance to its nearest neighbour on the same side of the surface, divided
/// by the spacing that equally many points would have in a hexagonal lattice. Neighbours are found by brute force,
/// without the sampler's code. To save time, only some hundreds of the particles are measured.
fn spacing(particles: &[Particle], area: f64) -> (f64, f64) {
    let stride = (particles.len() / 700).max(1);
    let mut nearest: Vec<f64> = (0..particles.len())
        .step_by(stride)
        .map(|index| {
            let here = &particles[index];
            let distance = |other: &Particle| f64::from((other.position - here.position).length());
            let others = particles
                .iter()
                .enumerate()
                .filter(|&(other, p)| other != index && p.normal.dot(here.normal) > 0.0);
            others.map(|(_, p)| distance(p)).fold(f64::INFINITY, f64::min)
        })
        .collect();
    nearest.sort_by(f64::total_cmp);
    let ideal = hexagonal_spacing(area, particles.len());
    let mean = nearest.iter().sum::<f64>() / nearest.len() as f64;
    (mean / ideal, nearest[nearest.len() / 100] / ideal)
}

fn bodies() -> [(&'static str, TriangleMesh); 3] {
    [("sphere", sphere(24, 12)), ("cube", cube()), ("sheet", sheet(3))]
}

#[test]
fn every_prefix_is_blue_noise() {
    let count = 40_000;
    for (name, mesh) in bodies() {
        let surface = Surface::new(&mesh, |_| true);
        let particles = progressive(&surface, count, 7);
        assert_eq!(particles.len(), count);
        for share in [1.0, 0.75, 0.5, 0.35, 0.11, 1.0 / 64.0] {
            let prefix = &particles[..(count as f64 * share) as usize];
            let (mean, least) = spacing(prefix, surface.area());
            println!("{name}: prefix {share:.3}: mean {mean:.3}, 1st percentile {least:.3}");
            assert!(mean >= 0.745, "{name}: mean spacing of the first {share} is {mean}");
            assert!(least >= 0.59, "{name}: 1st percentile of the first {share} is {least}");
        }
    }
}

#[test]
fn a_random_order_is_told_from_a_progressive_one() {
    let mesh = sphere(24, 12);
    let surface = Surface::new(&mesh, |_| true);
    let particles = progressive(&surface, 8000, 7);
    let random: Vec<Particle> = particles.iter().step_by(2).copied().collect();
    let (mean, _) = spacing(&random, surface.area());
    assert!(mean < 0.68, "every other particle is not blue noise, yet its mean spacing is {mean}");
}

#[test]
fn twice_the_particles_keep_the_first() {
    for (name, mesh) in bodies() {
        let surface = Surface::new(&mesh, |_| true);
        let few = progressive(&surface, 3000, 3);
        let many = progressive(&surface, 6000, 3);
        assert_eq!(few, many[..3000], "{name}");
    }
}

#[test]
fn particles_lie_on_the_surface_and_fill_it_evenly() {
    let mesh = sphere(24, 12);
    let surface = Surface::new(&mesh, |_| true);
    let particles = progressive(&surface, 20_000, 11);
    let mut octants = [0u32; 8];
    for particle in &particles {
        let [v, w] = particle.barycentric;
        assert!(v >= 0.0 && w >= 0.0 && v + w <= 1.0 + 1e-6);
        let [a, b, c] = mesh.corners(particle.triangle as usize);
        let expected = a * (1.0 - v - w) + b * v + c * w;
        assert!((expected - particle.position).length() < 1e-6);
        assert!((particle.normal - particle.position.normalize()).length() < 0.02, "a flat or inward normal");
        let sign = particle.position.cmpgt(Vec3::ZERO).bitmask();
        octants[sign as usize] += 1;
    }
    for count in octants {
        assert!((f64::from(count) / 2500.0 - 1.0).abs() < 0.03, "{octants:?}");
    }
}

#[test]
fn the_order_does_not_depend_on_threads() {
    let mesh = sphere(24, 12);
    let on_threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| progressive(&Surface::new(&mesh, |_| true), 30_000, 5))
    };
    let one = on_threads(1);
    assert_eq!(one, on_threads(2));
    assert_eq!(one, on_threads(7));
}
