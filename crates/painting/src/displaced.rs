//! Moves vertices by noise.

use glam::Vec3;
use impasto_core::bending::Vertices;
use impasto_core::noise_displace::{Lookup, VertexNoise};
use rayon::prelude::*;

/// Vertices after noise has moved them, with the normals with which they are drawn.
pub(crate) fn displaced(vertices: &Vertices, noise: &VertexNoise, lookup: &Lookup) -> Vertices {
    let moved = |(position, normal): (&Vec3, &Vec3)| {
        let (position, normal) = (position.as_dvec3(), normal.as_dvec3());
        let turned = match noise.moves_normals {
            true => noise.displaced_normal(position, normal, lookup),
            false => normal,
        };
        (noise.displaced(position, normal, lookup).as_vec3(), turned.as_vec3())
    };
    let all = vertices.positions.par_iter().zip(&vertices.normals).with_min_len(1024);
    let (positions, normals) = all.map(moved).unzip();
    Vertices { positions, normals }
}
