//! Finds singular points, where a direction field has no direction: lines run round them or out of them.
//!
//! The index of a loop is the number of turns that the field makes along it, corrected for the turn of parallel
//! transport round the loop. On a closed surface without handles the indices add up to 2, whatever the field (Poincaré
//! and Hopf).

use glam::{DVec2, DVec3, Vec3};

use super::field::FieldGraph;
use super::{Symmetry, tangent_axes, transport_rad};
use crate::angle::wrap_pi;

/// One singular point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Singularity {
    /// Model space.
    pub position: DVec3,
    /// 1 where strokes run round the point or out of it, ½ where lines bend round an end, −½ where they part at a fork.
    pub index: f64,
}

/// The singular points of a direction field that is given by a complex number of length 1 at each sample. Positions and
/// unit normals of the samples are in model space.
pub fn find(
    graph: &FieldGraph,
    positions: &[Vec3],
    normals: &[Vec3],
    field: &[DVec2],
    symmetry: Symmetry,
) -> Vec<Singularity> {
    let index_of = |ring: &[usize]| index_of_loop(ring, normals, field, symmetry);
    let indices: Vec<f64> =
        (0..graph.len()).map(|sample| index_of(&ring(graph, sample, positions, normals))).collect();
    // Loops round neighbouring samples overlap, so neighbours whose index is not 0 are joined into one cluster. Its
    // index is that of the loop round the whole cluster.
    let mut seen = vec![false; indices.len()];
    let mut found = Vec::new();
    for start in 0..indices.len() {
        if seen[start] || indices[start] == 0.0 {
            continue;
        }
        let (mut cluster, mut open) = (Vec::new(), vec![start]);
        seen[start] = true;
        while let Some(sample) = open.pop() {
            cluster.push(sample);
            for other in graph.neighbours(sample) {
                if !seen[other] && indices[other] != 0.0 {
                    seen[other] = true;
                    open.push(other);
                }
            }
        }
        let index = index_of(&ring_of_cluster(graph, &cluster, positions, normals));
        if index != 0.0 {
            let sum: DVec3 = cluster.iter().map(|&sample| positions[sample].as_dvec3()).sum();
            found.push(Singularity { position: sum / cluster.len() as f64, index });
        }
    }
    found
}

fn index_of_loop(ring: &[usize], normals: &[Vec3], field: &[DVec2], symmetry: Symmetry) -> f64 {
    if ring.len() < 3 {
        return 0.0;
    }
    let n = symmetry.power();
    let (mut turned, mut transport) = (0.0, 0.0);
    for (step, &from) in ring.iter().enumerate() {
        let to = ring[(step + 1) % ring.len()];
        let rho = transport_rad(normals[from].as_dvec3(), normals[to].as_dvec3());
        turned += symmetry.turn(rho).rotate(field[from]).angle_to(field[to]) / n;
        transport += rho;
    }
    // Parallel transport round the loop turns by the curvature inside it, which is small: wrapping loses no turn.
    ((turned + wrap_pi(transport)) / std::f64::consts::TAU * n).round() / n
}

/// The samples round a cluster, counter-clockwise as seen from outside: in each of 16 directions the nearest neighbour
/// that is not in the cluster itself.
fn ring_of_cluster(
    graph: &FieldGraph,
    cluster: &[usize],
    positions: &[Vec3],
    normals: &[Vec3],
) -> Vec<usize> {
    const SECTORS: usize = 16;
    let middle =
        cluster.iter().map(|&sample| positions[sample].as_dvec3()).sum::<DVec3>() / cluster.len() as f64;
    let normal = cluster.iter().map(|&sample| normals[sample].as_dvec3()).sum::<DVec3>();
    let axes = tangent_axes(normal.normalize_or(DVec3::Y));
    let mut nearest = [(f64::INFINITY, usize::MAX); SECTORS];
    for other in cluster.iter().flat_map(|&sample| graph.neighbours(sample)) {
        if !cluster.contains(&other) {
            let offset = positions[other].as_dvec3() - middle;
            let sector = sector_of(offset, axes, SECTORS);
            if offset.length() < nearest[sector].0 {
                nearest[sector] = (offset.length(), other);
            }
        }
    }
    nearest.iter().map(|&(_, other)| other).filter(|&other| other != usize::MAX).collect()
}

fn sector_of(offset: DVec3, [right, above]: [DVec3; 2], sectors: usize) -> usize {
    let angle = offset.dot(above).atan2(offset.dot(right)).rem_euclid(std::f64::consts::TAU);
    ((angle / std::f64::consts::TAU * sectors as f64) as usize).min(sectors - 1)
}

/// The neighbours of a sample in order round it, counter-clockwise: the nearest in each of eight directions.
fn ring(graph: &FieldGraph, sample: usize, positions: &[Vec3], normals: &[Vec3]) -> Vec<usize> {
    const SECTORS: usize = 8;
    let axes = tangent_axes(normals[sample].as_dvec3());
    let mut nearest = [(f64::INFINITY, usize::MAX); SECTORS];
    for other in graph.neighbours(sample) {
        let offset = (positions[other] - positions[sample]).as_dvec3();
        let sector = sector_of(offset, axes, SECTORS);
        if offset.length() < nearest[sector].0 {
            nearest[sector] = (offset.length(), other);
        }
    }
    let filled = nearest.iter().filter(|(_, other)| *other != usize::MAX).count();
    // At a border of the surface the neighbours form no closed ring.
    if filled + 2 < SECTORS {
        return Vec::new();
    }
    nearest.iter().map(|&(_, other)| other).filter(|&other| other != usize::MAX).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::direction::field::{Constraint, spiral_sphere};
    use crate::direction::towards;

    #[test]
    fn the_poles_of_up_are_found_and_indices_of_a_sphere_add_up_to_2() {
        let (positions, spacing) = spiral_sphere(3000);
        let graph = FieldGraph::new(&positions, &positions, spacing, |_, _| true);
        for symmetry in [Symmetry::Arrows, Symmetry::Lines] {
            let up: Vec<DVec2> = positions
                .iter()
                .map(|position| {
                    let normal = position.as_dvec3();
                    symmetry.encode(towards(DVec3::Y, normal), tangent_axes(normal))
                })
                .collect();
            let found = find(&graph, &positions, &positions, &up, symmetry);
            assert_eq!(found.len(), 2, "{found:?}");
            for pole in &found {
                assert_eq!(pole.index, 1.0);
                assert!(pole.position.normalize().y.abs() > 0.99, "{pole:?}");
            }
            // A solved field has other singular points, but the sum of their indices is the same.
            let constraints: Vec<Constraint> = up
                .iter()
                .zip(&positions)
                .map(|(&target, at)| Constraint { target, weight: if at.z > 0.2 { 50.0 } else { 1e-6 } })
                .collect();
            let solved = graph.solve(symmetry, &constraints);
            let sum: f64 =
                find(&graph, &positions, &positions, &solved, symmetry).iter().map(|s| s.index).sum();
            assert_eq!(sum, 2.0);
        }
    }
}
