//! Prints how evenly the first particles of the progressive order are spread, for several shares of all particles.
//! Also prints how long it takes to make the order on one thread. For 355,467 particles:
//! `cargo run --release -p impasto-core --example spacing -- 355467`.
#![expect(clippy::print_stdout, reason = "its output is what it is for")]

use std::time::Instant;

use glam::Vec3;
use impasto_core::TriangleMesh;
use impasto_core::neighbours::Neighbours;
use impasto_core::sampling::{Particle, Surface, hexagonal_spacing, progressive};

/// Which beginnings of the order are measured, as shares of all particles. The order is made level by level, and most
/// of these beginnings end inside a level.
const BEGINNINGS: [f64; 7] = [0.02, 0.11, 0.25, 0.37, 0.5, 0.71, 1.0];

/// The mean and the 0.1 % quantile of the distances to the nearest neighbour. Both are divided by the spacing of the
/// hexagonal lattice.
fn spacing(particles: &[Particle], area: f64) -> [f64; 2] {
    let hexagonal = hexagonal_spacing(area, particles.len());
    let (positions, normals): (Vec<Vec3>, Vec<Vec3>) =
        particles.iter().map(|particle| (particle.position, particle.normal)).unzip();
    // Far enough for nearly all: in the hexagonal lattice, the evenest spread, the nearest neighbour is at 1 spacing.
    let reach = 1.5 * hexagonal;
    let found = Neighbours::find(&positions, &normals, reach as f32);
    let nearest = |at: usize| match found.of(at).first() {
        Some(&other) => f64::from(positions[at].distance(positions[other as usize])) / hexagonal,
        None => reach / hexagonal,
    };
    let mut nearest: Vec<f64> = (0..particles.len()).map(nearest).collect();
    nearest.sort_by(f64::total_cmp);
    [nearest.iter().sum::<f64>() / nearest.len() as f64, nearest[nearest.len() / 1000]]
}

/// A square sheet; both of its sides carry particles.
fn plane() -> TriangleMesh {
    TriangleMesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y, Vec3::Y],
        normals: vec![Vec3::Z; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..TriangleMesh::default()
    }
}

fn ball() -> TriangleMesh {
    const ROUND: u32 = 48;
    const DOWN: u32 = 24;
    let mut mesh = TriangleMesh::default();
    for index in 0..(ROUND + 1) * (DOWN + 1) {
        let round = (index % (ROUND + 1)) as f32 / ROUND as f32 * std::f32::consts::TAU;
        let down = (index / (ROUND + 1)) as f32 / DOWN as f32 * std::f32::consts::PI;
        let position = Vec3::new(down.sin() * round.cos(), down.cos(), -down.sin() * round.sin());
        mesh.positions.push(position);
        mesh.normals.push(position);
    }
    for cell in 0..ROUND * DOWN {
        let a = cell / ROUND * (ROUND + 1) + cell % ROUND;
        let [b, c, d] = [a + 1, a + ROUND + 2, a + ROUND + 1];
        mesh.triangles.extend([[a, d, c], [a, c, b]]);
    }
    mesh
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let count: usize = std::env::args().nth(1).map_or(Ok(100_000), |count| count.parse())?;
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    for (name, mesh) in [("plane", plane()), ("ball", ball())] {
        let surface = Surface::new(&mesh, |_| true);
        let start = Instant::now();
        let particles = one_thread.install(|| progressive(&surface, count, 7));
        let secs = start.elapsed().as_secs_f64();
        println!("{name}, {count} particles: {secs:.3} s on one thread");
        println!("  beginning   mean   closest 0.1 %");
        for share in BEGINNINGS {
            let first = ((count as f64 * share) as usize).clamp(count.min(2), count);
            if first >= 2 {
                let [mean, closest] = spacing(&particles[..first], surface.area());
                println!("  {share:9.2}  {mean:.3}   {closest:.3}");
            }
        }
    }
    Ok(())
}
