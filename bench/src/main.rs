//! Times of Impasto's steps, medians over several runs, beside a copy of memory that sets the floor.

mod live;
mod noise_displace;
mod sequence;
mod stroke_pass;

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use impasto_core::sampling::{Surface, progressive};
use impasto_core::screen_map::PixelLens;
use impasto_core::solve::{SolvedParticles, solve};
use impasto_core::{ScreenMap, lift::Lift, solve::BakedParticles};
use impasto_tests::shapes;

/// The particles of the source paper's largest scene.
const PARTICLES: usize = 355_467;

fn main() {
    println!("threads: {}", rayon::current_num_threads());
    if std::env::args().any(|argument| argument == "live") {
        return live::run();
    }
    if std::env::args().any(|argument| argument == "noise_displace") {
        return noise_displace::run();
    }
    let named = |what: &str| std::env::args().any(|argument| argument == what);
    if named("sequence") {
        return sequence::run(named("--quick"));
    }
    if named("stroke_pass") {
        return stroke_pass::run(named("--quick"));
    }
    sampling();
    solving();
    preparing();
    stroke_pass::run(false);
    sequence::run(false);
    noise_displace::run();
    live::run();
}

/// Median seconds of `runs` calls.
fn median_secs(runs: usize, mut work: impl FnMut()) -> f64 {
    let mut seconds: Vec<f64> = (0..runs)
        .map(|_| {
            let start = Instant::now();
            work();
            start.elapsed().as_secs_f64()
        })
        .collect();
    seconds.sort_by(f64::total_cmp);
    seconds[runs / 2]
}

fn sampling() {
    let mesh = shapes::sphere(48, 24);
    let surface = Surface::new(&mesh, |_| true);
    for count in [45_658, PARTICLES] {
        let seconds = median_secs(3, || {
            black_box(progressive(&surface, count, 7));
        });
        println!("progressive order, one body of {count}: {:.0} ms", seconds * 1e3);
    }
}

fn solving() {
    let mesh = shapes::sphere(48, 24);
    let particles = progressive(&Surface::new(&mesh, |_| true), PARTICLES, 7);
    let mut baked = BakedParticles::default();
    for particle in &particles {
        let normal = particle.normal.as_dvec3();
        baked.push(
            particle.position.as_dvec3(),
            normal,
            Lift::facing_view(normal, glam::DVec3::Y, 0.0, 300.0),
        );
    }
    let view = glam::DMat4::from_translation(glam::DVec3::new(0.0, 0.0, -4.0));
    let map = ScreenMap::new(view, glam::DAffine3::IDENTITY, PixelLens::Perspective { focal_px: 1100.0 });
    let mut solved = SolvedParticles::default();
    let solve_secs = median_secs(101, || {
        solve(&baked, &map, &mut solved);
        black_box(&solved);
    });
    // The floor: as many bytes, read and written by as many threads.
    let floats = PARTICLES * 17 / 2;
    let (from, mut to) = (vec![1.0f32; floats], vec![0.0f32; floats]);
    let copy_secs = median_secs(101, || {
        use rayon::prelude::*;
        to.par_chunks_mut(1 << 16)
            .zip(from.par_chunks(1 << 16))
            .for_each(|(to, from)| to.copy_from_slice(from));
        black_box(&to);
    });
    println!(
        "project and solve {PARTICLES} particles: {:.2} ms, {:.2} times a copy of the same bytes",
        solve_secs * 1e3,
        solve_secs / copy_secs
    );
}

/// The source paper's largest scene, whole: what opening it costs before the first frame.
fn preparing() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/simple_objects.ron");
    let load = || {
        impasto_scene::load::load(&path, &impasto_scene::load::LoadOptions::default())
            .expect("the shipped scene is good")
    };
    println!("load simple_objects: {:.0} ms", median_secs(5, || drop(black_box(load()))) * 1e3);
    let loaded = Arc::new(load());
    let mut steps: Vec<(&'static str, Vec<f64>)> = Vec::new();
    let mut particles = 0;
    let seconds = median_secs(5, || {
        let painting = impasto_painting::prepare(Arc::clone(&loaded)).expect("the scene has its meshes");
        particles = painting.particle_counts().iter().sum();
        for step in painting.steps() {
            match steps.iter_mut().find(|(name, _)| *name == step.name) {
                Some((_, seconds)) => seconds.push(step.seconds),
                None => steps.push((step.name, vec![step.seconds])),
            }
        }
    });
    println!("prepare simple_objects ({particles} particles): {:.0} ms", seconds * 1e3);
    for (name, mut times) in steps {
        times.sort_by(f64::total_cmp);
        let median = times[times.len() / 2];
        println!("  {name:<10} {:>7.1} ms {:>5.1} %", median * 1e3, 100.0 * median / seconds);
    }
    let painting = impasto_painting::prepare(loaded).expect("the scene has its meshes");
    let options =
        impasto_painting::FrameOptions::new([1280, 720]);
    let frame_secs = median_secs(21, || {
        black_box(painting.at(0.0, &options));
    });
    println!("one frame of it as data: {:.1} ms", frame_secs * 1e3);
}
