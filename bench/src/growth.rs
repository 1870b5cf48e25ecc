//! Measures how the cost of each step grows with the number of particles, from a thousand to ten million. The scene of
//! the steps "prepare" and "frame as data" is the paper's largest one without its wall. Its number of particles counts
//! those of the body layer, the bulk of the paint. The other layers have some in addition.

use std::hint::black_box;
use std::time::Instant;

use impasto_core::solve::{SolvedParticles, solve};
use impasto_painting::{FrameOptions, prepare};

use crate::bench::Bench;
use crate::inputs::PAPER_SCENES;
use crate::memory::alone_with_particles;
use crate::plots::{Curve, Plot};
use crate::table::{Figure, Goal, Row, Spread, Unit, shown, shown_count};
use crate::{neighbours, sampling, solving};

const COUNTS: [usize; 9] = [1000, 3000, 10_000, 30_000, 100_000, 300_000, 1_000_000, 3_000_000, 10_000_000];

const STEPS: [(&str, Plot); 7] = [
    ("sampling, by chance", Plot::Sampling),
    ("sampling, blue noise", Plot::Sampling),
    ("neighbours", Plot::Neighbours),
    ("neighbours, kiddo", Plot::Neighbours),
    ("project and solve", Plot::Growth),
    ("prepare", Plot::Growth),
    ("frame as data", Plot::Growth),
];

/// The best time of some runs; quick work is run more often.
fn best_secs<T>(mut work: impl FnMut() -> T) -> f64 {
    let (mut best, mut spent) = (f64::INFINITY, 0.0);
    for run in 0..200 {
        let start = Instant::now();
        black_box(work());
        let secs = start.elapsed().as_secs_f64();
        best = best.min(secs);
        spent += secs;
        if spent > 0.15 && (run >= 2 || spent > 1.0) {
            break;
        }
    }
    best
}

/// Measures all counts for which there are time and memory.
pub fn run(bench: &mut Bench) -> anyhow::Result<()> {
    let most = if bench.quick() {
        100_000
    } else if bench.has_memory("growth", 12 << 30) {
        10_000_000
    } else {
        3_000_000
    };
    let mut curves = STEPS.map(|(name, plot)| Curve { name, plot, points: Vec::new() });
    for count in COUNTS.into_iter().filter(|&count| count <= most) {
        eprintln!("  {} particles", shown_count(count));
        for (curve, secs) in curves.iter_mut().zip(at(bench, count)?) {
            curve.points.extend(secs.map(|secs| (count as f64, secs)));
        }
    }
    for curve in curves.iter().filter(|curve| !curve.name.ends_with("kiddo")) {
        let at = |count: usize| curve.secs_per_particle(count as f64);
        let Some((small, large)) = at(most / 10).zip(at(most)) else { continue };
        // Cost per particle at `most` particles over the cost at a tenth of them: 1 is linear growth.
        let what = format!("growth, {}", curve.name);
        let input = format!("{} to {}", shown_count(most / 10), shown_count(most));
        let figure = Figure::new("Impasto", Unit::Ratio, Spread::exact(large / small)).noted(format!(
            "{} per particle at the end, {} at the beginning; {} at most with fewer particles",
            shown(large, Unit::Seconds),
            shown(small, Unit::Seconds),
            shown(curve.most_secs_below((most / 10) as f64), Unit::Seconds),
        ));
        let row = Row::of_ours(&what, &input, figure);
        bench.push(if most == 10_000_000 { row.meant(Goal::AtMost(1.2)) } else { row });
    }
    bench.curves.extend(curves);
    Ok(())
}

/// Seconds of each step at a count; `None` for steps that are left out at this count.
fn at(bench: &mut Bench, count: usize) -> anyhow::Result<[Option<f64>; 7]> {
    let mesh = bench.inputs.mesh()?;
    let (mut by_chance, mut blue) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..if count <= 300_000 { 3 } else { 1 } {
        let [chance_secs, blue_secs] = sampling::secs(&mesh, count);
        (by_chance, blue) = (by_chance.min(chance_secs), blue.min(blue_secs));
    }
    let cloud = bench.inputs.cloud(count)?;
    let lists = best_secs(|| neighbours::find_in(&cloud));
    let kiddo = (count <= 1_000_000).then(|| best_secs(|| neighbours::kiddo_in(&cloud)));
    let (baked, now) = solving::input(bench, &cloud)?;
    drop(cloud);
    let mut solved = SolvedParticles::default();
    let solved_secs = best_secs(|| solve(&baked, &now, &mut solved));
    drop((baked, solved));
    let largest = &PAPER_SCENES[2];
    let loaded = alone_with_particles(&*bench.inputs.scene(largest.file)?, largest.object, count as u64);
    let prepared = best_secs(|| prepare(loaded.clone()));
    let painting = prepare(loaded)?;
    let options = FrameOptions::new([1280, 720]);
    let frame = best_secs(|| painting.at(0.0, &options));
    Ok([Some(by_chance), Some(blue), Some(lists), kiddo, Some(solved_secs), Some(prepared), Some(frame)])
}
