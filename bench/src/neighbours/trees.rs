//! The neighbour searches of other crates, to compare ours with. Each is used in its fastest way: it finds all points
//! within the radius, and the nearest of them are selected.

use glam::Vec3;
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use rayon::prelude::*;
use rstar::RTree;
use rstar::primitives::GeomWithData;

use impasto_core::neighbours::MAX_NEIGHBOURS;

use crate::morton;

/// Queries that one thread handles at a time.
const CHUNK: usize = 2048;

/// Neighbour lists one after the other.
pub struct Lists {
    /// The particle of each list.
    pub order: Vec<u32>,
    /// Where each list begins in `indices`, and the end of the last.
    pub starts: Vec<u32>,
    /// The particles in the lists.
    pub indices: Vec<u32>,
}

/// Makes the lists of all particles. `within` gives all particles within the radius of a particle's place, the particle
/// itself included, with their squared distances.
fn ask(positions: &[Vec3], within: impl Fn([f32; 3], &mut Vec<(f32, u32)>) + Sync) -> Lists {
    let order = morton::order(positions);
    let parts: Vec<(Vec<u32>, Vec<u32>)> = order
        .par_chunks(CHUNK)
        .map_init(Vec::new, |found, queries| {
            let mut lengths = Vec::with_capacity(queries.len());
            let mut indices = Vec::with_capacity(queries.len() * MAX_NEIGHBOURS);
            for &query in queries {
                found.clear();
                within(positions[query as usize].to_array(), found);
                found.retain(|&(_, other)| other != query);
                if found.len() > MAX_NEIGHBOURS {
                    found.select_nth_unstable_by(MAX_NEIGHBOURS, |a, b| a.0.total_cmp(&b.0));
                    found.truncate(MAX_NEIGHBOURS);
                }
                lengths.push(found.len() as u32);
                indices.extend(found.iter().map(|&(_, other)| other));
            }
            (lengths, indices)
        })
        .collect();
    let mut starts = Vec::with_capacity(positions.len() + 1);
    let mut indices = Vec::with_capacity(parts.iter().map(|(_, indices)| indices.len()).sum());
    let mut start = 0;
    starts.push(start);
    for (lengths, part) in parts {
        indices.extend(part);
        starts.extend(lengths.into_iter().map(|length| {
            start += length;
            start
        }));
    }
    Lists { order, starts, indices }
}

/// kiddo's immutable tree.
pub fn kiddo(positions: &[Vec3], radius: f32) -> Lists {
    let points: Vec<[f32; 3]> = positions.iter().map(Vec3::to_array).collect();
    let tree: ImmutableKdTree<f32, 3> =
        ImmutableKdTree::new_from_slice_parallel(&points).expect("a tree of finite points");
    ask(positions, |query, found| {
        tree.query(&query)
            .within::<SquaredEuclidean<f32>>(radius * radius)
            .unsorted()
            .visit(|near| found.push((near.distance, near.item)));
    })
}

/// rstar's tree, loaded in bulk.
pub fn rstar(positions: &[Vec3], radius: f32) -> Lists {
    let points = positions.iter().enumerate();
    let tree = RTree::bulk_load(
        points.map(|(index, point)| GeomWithData::new(point.to_array(), index as u32)).collect(),
    );
    ask(positions, |query, found| {
        let distance = |point: &[f32; 3]| {
            let [x, y, z] = [0, 1, 2].map(|axis| point[axis] - query[axis]);
            x * x + y * y + z * z
        };
        let near = tree.locate_within_distance(query, radius * radius);
        found.extend(near.map(|near| (distance(near.geom()), near.data)));
    })
}
