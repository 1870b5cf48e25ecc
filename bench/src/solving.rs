//! Measures how long it takes to project and turn all particles of a body: ours from six baked numbers, beside direct
//! sums over 48 neighbours as in the source paper.
//!
//! Which answers must agree (p and c are a neighbour's offsets in the reference picture and in this one, as complex
//! numbers):
//! - The gathers (Rust, numpy, numba) all compute `arg Σ p̄ c`.
//! - Ours equals this sum with each neighbour weighted by w = z_neighbour / z_stroke, and is checked against the
//!   weighted sum. The row states how much the weights change the angle.
//! - Umeyama's method measures p and c from their means over the neighbours, and is checked against the sum with these.

mod gather;
mod scene;

use std::rc::Rc;

use anyhow::{Context as _, ensure};
use impasto_core::angle::wrap_pi;
use impasto_core::solve::{SolvedParticles, solve};

use crate::bench::Bench;
use crate::floor::Streams;
use crate::inputs::{Cloud, LARGEST};
use crate::peers::{Peer, files};
use crate::race::{Contender, race};
use crate::table::{Goal, Row};
use gather::Gathered;
use scene::SolveScene;

/// Floats that the solve reads per particle: position, normal, and the two columns of its lift.
pub const READ: usize = 12;

/// Floats that the solve writes per particle: position (2), depth, angle, area.
pub const WRITTEN: usize = 5;

/// Measures bodies of several numbers of particles.
pub fn run(bench: &mut Bench) -> anyhow::Result<()> {
    let counts: &[usize] = if bench.quick() { &[LARGEST] } else { &[LARGEST, 1_000_000] };
    for &count in counts {
        let cloud = bench.inputs.cloud(count)?;
        beside_gathers(bench, &cloud)?;
    }
    if !bench.quick() && bench.has_memory("solve", 6 << 30) {
        let cloud = bench.inputs.cloud(10_000_000)?;
        alone(bench, &cloud)?;
    }
    Ok(())
}

/// Measures ours beside nothing but the floor, the least time that the memory's speed allows: there are no neighbour
/// lists for so many particles.
fn alone(bench: &mut Bench, cloud: &Rc<Cloud>) -> anyhow::Result<()> {
    let (reference, now) = scene::views(&mut bench.inputs)?;
    let baked = scene::facing(cloud, &reference);
    let mut solved = SolvedParticles::default();
    let contenders = vec![
        Contender::here("Impasto", "", || solve(&baked, &now, &mut solved)),
        Streams::new(baked.len(), READ, WRITTEN).contender(),
    ];
    let figures = race(&bench.pace(false), contenders)?;
    bench.push(Row::of_race("project and solve", &cloud.name, figures, true));
    Ok(())
}

fn beside_gathers(bench: &mut Bench, cloud: &Rc<Cloud>) -> anyhow::Result<()> {
    let (reference, now) = scene::views(&mut bench.inputs)?;
    let scene = SolveScene::new(cloud, reference, now)?;
    let count = scene.positions.len();
    let mut solved = SolvedParticles::default();
    solve(&scene.baked, &scene.now, &mut solved);
    let mut plain = Gathered::new(count);
    plain.solve(&scene);

    scene.check_by_matrices(&plain.angles_rad).context("the gather and the paper's formula differ")?;
    close("Impasto and the weighted sum", &solved.angle_rad, &scene.weighted(), [0.02, 0.2])?;
    let [p50, p99] = apart_deg(&solved.angle_rad, &plain.angles_rad);
    ensure!(p99 < 1.0, "the weights move the angle by {p99}° (1 in 100), where at most 1° is expected");

    let (numpy, numba) = (python(bench, &scene, "numpy"), python(bench, &scene, "numba"));
    for (who, peer) in [("numpy", &numpy), ("numba", &numba)] {
        if let Ok((_, angles_rad)) = peer {
            close(&format!("{who} and the gather"), angles_rad, &plain.angles_rad, [0.02, 0.2])?;
        }
    }
    let umeyama = bench.peers.cpp("umeyama", &scene.write(&bench.peers.folder()?)?);
    if umeyama.is_ok() {
        let angles_rad = files::read_floats(&scene::answer(&bench.peers.folder()?))?;
        close("Umeyama and the centred sum", &angles_rad, &scene.centred(), [0.05, 1.0])?;
    }

    let contenders = vec![
        Contender::here("Impasto", "", || solve(&scene.baked, &scene.now, &mut solved)),
        Contender::here("gather, Rust", "k = 48, Morton order, lists made before", || plain.solve(&scene)),
        Contender::started("gather, numba", "k = 48, Morton order", numba.map(|(peer, _)| peer.rounds())),
        Contender::started(
            "gather, numpy",
            "k = 48, Morton order, 1 thread",
            numpy.map(|(peer, _)| peer.rounds()),
        ),
        Contender::started(
            "Eigen umeyama",
            "k = 48, Morton order; -march=native",
            umeyama.map(|peer| peer.rounds()),
        ),
        Streams::new(count, READ, WRITTEN).contender(),
    ];
    let figures = race(&bench.pace(false), contenders)?;
    let mut row = Row::of_race("project and solve", &cloud.name, figures, true)
        .meant(Goal::OverFloor(1.5))
        .meant(Goal::Faster { than: "gather, Rust", times: 15.0 })
        .meant(Goal::Faster { than: "Eigen", times: 80.0 });
    row.ours.note = format!("within {p50:.3}° (half), {p99:.2}° (99 of 100) of the unweighted sum");
    bench.push(row);
    Ok(())
}

fn python(bench: &mut Bench, scene: &SolveScene, way: &str) -> anyhow::Result<(Peer, Vec<f32>)> {
    let folder = bench.peers.folder()?;
    let peer = bench.peers.python("solving", way, &scene.write(&folder)?)?;
    Ok((peer, files::read_floats(&scene::answer(&folder))?))
}

/// Differences of angles, degrees: the median and the 99th percentile.
fn apart_deg(one: &[f32], other: &[f32]) -> [f64; 2] {
    let sorted = sorted_deg(one, other);
    [sorted[sorted.len() / 2], sorted[sorted.len() - 1 - sorted.len() / 100]]
}

fn sorted_deg(one: &[f32], other: &[f32]) -> Vec<f64> {
    let apart = |(&one, &other): (&f32, &f32)| {
        let apart = wrap_pi(f64::from(one) - f64::from(other)).to_degrees().abs();
        if apart.is_finite() { apart } else { 180.0 }
    };
    let mut sorted: Vec<f64> = one.iter().zip(other).map(apart).collect();
    sorted.sort_by(f64::total_cmp);
    sorted
}

/// Checks that two answers agree up to rounding: 99 of 100 within `most_deg[0]`, 999 of 1000 within `most_deg[1]`.
fn close(what: &str, one: &[f32], other: &[f32], most_deg: [f64; 2]) -> anyhow::Result<()> {
    ensure!(one.len() == other.len(), "{what}: {} and {} angles", one.len(), other.len());
    let sorted = sorted_deg(one, other);
    for (share, most_deg) in [100, 1000].into_iter().zip(most_deg) {
        let reached = sorted[sorted.len() - 1 - sorted.len() / share];
        ensure!(
            reached <= most_deg,
            "{what}: one in {share} differs by {reached}°, where {most_deg}° are allowed"
        );
    }
    Ok(())
}

/// The solve's input for a cloud.
pub fn input(bench: &mut Bench, cloud: &Cloud) -> anyhow::Result<scene::Facing> {
    let (reference, now) = scene::views(&mut bench.inputs)?;
    Ok((scene::facing(cloud, &reference), now))
}
