//! The list of the benchmark's parts, by name.
//!
//! A part is a function that adds rows to [`Bench::table`]. It fails if the answers of its peers differ from ours. Most
//! parts make [`crate::race::Contender`]s: ours first, then the peers, and last the floor (`floor.rs`), if any. They
//! pass these to [`crate::race::race`] and make a [`crate::table::Row`] of the figures. To add a part, write a module
//! with `pub fn run(&mut Bench) -> anyhow::Result<()>` and add a line here.

use crate::bench::Bench;
use crate::{
    bending, gltf_loading, growth, live, loading, memory, neighbours, noise_displace, paper_scenes, sampling,
    sequence, solving, stroke_pass,
};

/// A part of the benchmark.
pub struct Part {
    /// Its name on the command line.
    pub name: &'static str,
    /// What it measures.
    pub about: &'static str,
    /// Whether `--quick` runs it. Without `--quick`, all parts run. Parts named on the command line run in any case.
    pub quick: bool,
    /// Measures it.
    pub run: fn(&mut Bench) -> anyhow::Result<()>,
}

const fn part(name: &'static str, about: &'static str, run: fn(&mut Bench) -> anyhow::Result<()>) -> Part {
    Part { name, about, quick: true, run }
}

/// All parts, in the order in which they run.
pub const PARTS: &[Part] = &[
    part("neighbours", "lists of the nearest, beside kiddo, rstar, nanoflann and scipy", neighbours::run),
    part("sampling", "particles on a surface, beside trimesh and Open3D", sampling::run),
    part(
        "solve",
        "projection and turn of all particles, beside gathers, numpy, numba and Eigen",
        solving::run,
    ),
    part("bending", "vertices, strain and particles of a body that bends", bending::run),
    part("loading", "a mesh file of a million triangles, beside tobj", loading::run),
    part("loading_gltf", "a glTF file of a million triangles, beside gltf", gltf_loading::run),
    part("paper_scenes", "table 2 of the source paper, measured again", paper_scenes::run),
    part("memory", "bytes per particle, in playback and while preparing", memory::run),
    part("stroke_pass", "laying strokes, beside a bare draw of the same", stroke_pass::run),
    Part { quick: false, ..part("sequence", "120 frames, beside one thread", sequence::run) },
    part("growth", "cost against the number of particles", growth::run),
    Part { quick: false, ..part("edits", "preparing again after one edit", live::edits) },
    Part { quick: false, ..part("pictures", "pictures of a moving view", live::pictures) },
    Part {
        quick: false,
        ..part("noise_displace", "spheres with and without displacing noise", noise_displace::run)
    },
];
