//! Measures neighbour searches: ours beside the search trees (k-d and R*) of crates, of C++ and of Python. Each
//! particle gets a list of its nearest neighbours, at most 50 of them within a radius that holds about 64.

mod answer;
mod trees;

use std::path::Path;
use std::rc::Rc;

use anyhow::Context as _;
use glam::Vec3;
use impasto_core::neighbours::{MAX_NEIGHBOURS, Neighbours};

use crate::bench::Bench;
use crate::floor::Streams;
use crate::inputs::{Cloud, LARGEST, PAPER_SCENES};
use crate::peers::files;
use crate::race::{Contender, race};
use crate::table::{Goal, Row};
use answer::Answer;

/// How many others the radius holds on a flat piece of the surface: more than a list has room for, so that the farthest
/// must be left out.
const WITHIN: f64 = 64.0;

/// From this number of points on, only the fastest peers take part, for few rounds.
const HUGE: usize = 4_000_000;

/// Our search, with all normals equal. With real normals it would leave out points on the other side of the surface
/// (n·n' ≤ 0), which a tree does not.
pub fn find(positions: &[Vec3], radius: f32) -> Neighbours {
    let normals = vec![Vec3::Y; positions.len()];
    Neighbours::find(positions, &normals, radius)
}

/// Our search with the radius that these benchmarks use.
pub fn find_in(cloud: &Cloud) -> Neighbours {
    find(&cloud.positions, cloud.radius_for(WITHIN))
}

/// Measures all inputs.
pub fn run(bench: &mut Bench) -> anyhow::Result<()> {
    let mut clouds = Vec::new();
    for scene in &PAPER_SCENES {
        if !bench.quick() || scene.particles != PAPER_SCENES[1].particles {
            clouds.push(bench.inputs.paper_cloud(scene)?);
        }
    }
    if !bench.quick() {
        clouds.push(bench.inputs.cloud(1_000_000)?);
    }
    for cloud in clouds {
        one(bench, &cloud)?;
    }
    if !bench.quick() && bench.has_memory("neighbours", 12 << 30) {
        let cloud = bench.inputs.cloud(10_000_000)?;
        one(bench, &cloud)?;
    }
    Ok(())
}

fn one(bench: &mut Bench, cloud: &Rc<Cloud>) -> anyhow::Result<()> {
    let positions = &cloud.positions;
    let radius = cloud.radius_for(WITHIN);
    let normals = vec![Vec3::Y; positions.len()];
    let huge = positions.len() >= HUGE;

    let found = find(positions, radius);
    let ours = Answer::of(positions, |particle| found.of(particle));
    drop(found);
    ours.check_by_brute_force(positions, radius)?;
    let agrees = |who: &str, answer: &Answer| {
        ours.check(answer).with_context(|| format!("{who} and Impasto differ on {}", cloud.name))
    };
    let kiddo = trees::kiddo(positions, radius);
    agrees("kiddo", &Answer::of_lists(positions, &kiddo))?;
    drop(kiddo);
    let mut contenders = vec![
        Contender::here("Impasto", "", || Neighbours::find(positions, &normals, radius)),
        Contender::here("kiddo 6.3", "radius, then selection; Morton order", || {
            trees::kiddo(positions, radius)
        }),
    ];
    if !huge {
        agrees("rstar", &Answer::of_lists(positions, &trees::rstar(positions, radius)))?;
        contenders.push(Contender::here("rstar 0.14", "radius, then selection; Morton order", || {
            trees::rstar(positions, radius)
        }));
    }
    let folder = bench.peers.folder()?;
    let points = folder.join("neighbours.points");
    files::write_floats(&points, positions.iter().flat_map(|point| point.to_array()))?;
    let found = folder.join("neighbours.found");
    let arguments = |most: usize| -> Vec<String> {
        let file = |path: &Path| path.to_string_lossy().into_owned();
        vec![file(&points), radius.to_string(), most.to_string(), file(&found)]
    };
    let nanoflann = bench.peers.cpp("nanoflann", &arguments(MAX_NEIGHBOURS));
    if nanoflann.is_ok() {
        agrees("nanoflann", &Answer::read(&found)?)?;
    }
    let note = "radius, then selection; Morton order; -march=native";
    contenders.push(Contender::started("nanoflann", note, nanoflann.map(|peer| peer.rounds())));
    if !huge {
        let scipy = bench.peers.python("neighbours", "scipy", &arguments(MAX_NEIGHBOURS));
        if scipy.is_ok() {
            agrees("scipy", &Answer::read(&found)?)?;
        }
        contenders.push(Contender::started(
            "scipy cKDTree",
            "k nearest, bounded",
            scipy.map(|peer| peer.rounds()),
        ));
    }
    let streams = Streams::of_bytes(12 * positions.len(), 4 * (positions.len() + ours.pairs()));
    contenders.push(streams.contender());
    let figures = race(&bench.pace(huge), contenders)?;
    let mut row = Row::of_race("neighbours", &cloud.name, figures, true);
    if positions.len() <= 1_000_000 {
        row = row
            .meant(Goal::Faster { than: "kiddo", times: 3.0 })
            .meant(Goal::Faster { than: "nanoflann", times: 3.0 });
    }
    row.ours.note = format!("{:.1} in a list", ours.pairs() as f64 / positions.len() as f64);
    if positions.len() == LARGEST {
        row.ours.note += ", the same lists from all";
    }
    bench.push(row);
    Ok(())
}

/// kiddo's search with the radius that these benchmarks use.
pub fn kiddo_in(cloud: &Cloud) -> trees::Lists {
    trees::kiddo(&cloud.positions, cloud.radius_for(WITHIN))
}
