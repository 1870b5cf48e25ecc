//! The direction field of a body: a sparse linear solve on a few samples, with parallel transport between them (Knöppel
//! et al. 2013, the guided case, on points instead of a mesh).
//!
//! The unknown is one complex number `u` per sample (see [`super`]). The field minimises
//! `Σ w_ij |u_i − ρ_ij u_j|² + Σ μ_i |u_i − û_i|²`. Here `ρ_ij` is the transport of j's axes to i's, raised to the
//! field's power, `w_ij` is the weight of a pair of neighbours, and `û_i` is the direction that sample i is pulled to
//! with the weight `μ_i`. The numbers that are found are normalised. Then further steps, which keep every `u` on the
//! unit circle, make the sum smaller.

use std::sync::OnceLock;

use glam::{DVec2, Vec3};
use rayon::prelude::*;

use super::{Symmetry, transport_rad};
use crate::neighbours::Neighbours;

/// How many samples the field of a body has, at most.
pub const MAX_SAMPLES: usize = 4096;

/// Samples within this many spacings (of the hexagonal lattice) of each other are neighbours.
const REACH_SPACINGS: f64 = 1.9;

/// Conjugate gradients stop after this many steps at the latest.
const MOST_STEPS: usize = 400;
/// Conjugate gradients stop when the residual has fallen to this share of the first one.
const RESIDUAL: f64 = 1e-5;

/// How many steps are taken on the unit circle after the linear solve.
const UNIT_ROUNDS: usize = 24;

/// Samples with their neighbours and the transport between them.
#[derive(Clone, Debug)]
pub struct FieldGraph {
    /// Index of the first edge of each sample; last, the number of all edges.
    starts: Vec<u32>,
    edges: Vec<Edge>,
    /// Sum of the weights of each sample's edges.
    weights: Vec<f64>,
    /// ρ of every edge, for arrows and for lines; found when they are first asked for.
    turns: [OnceLock<Vec<DVec2>>; 2],
}

#[derive(Clone, Copy, Debug)]
struct Edge {
    to: u32,
    weight: f64,
    /// Angle that transport from `to` adds, radians.
    transport_rad: f64,
}

/// The direction that a sample is pulled to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constraint {
    /// The unit complex number that the sample should have.
    pub target: DVec2,
    /// How strong the pull is, in units of one neighbour's weight, > 0.
    pub weight: f64,
}

impl FieldGraph {
    /// The graph of samples that stand about `spacing` apart. Positions and unit normals are in model space. `joined`
    /// says whether two samples may be neighbours at all.
    pub fn new(
        positions: &[Vec3],
        normals: &[Vec3],
        spacing: f64,
        joined: impl Fn(usize, usize) -> bool + Sync,
    ) -> Self {
        let reach = REACH_SPACINGS * spacing;
        let near = Neighbours::find(positions, normals, reach as f32);
        let lists: Vec<Vec<Edge>> = (0..positions.len())
            .into_par_iter()
            .with_min_len(256)
            .map(|sample| {
                let normal = normals[sample].as_dvec3();
                near.of(sample)
                    .iter()
                    .filter(|&&other| joined(sample, other as usize))
                    .map(|&other| {
                        let other_normal = normals[other as usize].as_dvec3();
                        let distance =
                            f64::from(positions[sample].distance(positions[other as usize])) / reach;
                        Edge {
                            to: other,
                            weight: normal.dot(other_normal).max(0.0).powi(2)
                                * (-2.0 * distance * distance).exp(),
                            transport_rad: transport_rad(other_normal, normal),
                        }
                    })
                    .collect()
            })
            .collect();
        let weights = lists.iter().map(|list| list.iter().map(|edge| edge.weight).sum()).collect();
        let mut starts = Vec::with_capacity(lists.len() + 1);
        starts.push(0);
        let mut edges = Vec::with_capacity(lists.iter().map(Vec::len).sum());
        for list in lists {
            edges.extend(list);
            starts.push(edges.len() as u32);
        }
        Self { starts, edges, weights, turns: Default::default() }
    }

    fn turns(&self, symmetry: Symmetry) -> &[DVec2] {
        let turn = |edge: &Edge| symmetry.turn(edge.transport_rad);
        self.turns[symmetry as usize].get_or_init(|| self.edges.par_iter().map(turn).collect())
    }

    /// How many samples.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The neighbours of a sample.
    pub fn neighbours(&self, sample: usize) -> impl Iterator<Item = usize> + '_ {
        self.edges_of(sample).iter().map(|edge| edge.to as usize)
    }

    /// The neighbours of a sample with their weights and the angle that transport from them adds, radians.
    pub(super) fn ties(&self, sample: usize) -> impl Iterator<Item = (usize, f64, f64)> + '_ {
        self.edges_of(sample).iter().map(|edge| (edge.to as usize, edge.weight, edge.transport_rad))
    }

    fn edges_of(&self, sample: usize) -> &[Edge] {
        &self.edges[self.starts[sample] as usize..self.starts[sample + 1] as usize]
    }

    /// The unit complex numbers that fit the constraints best. A sample whose number comes out of the linear solve as 0
    /// begins the further steps at its target. The same inputs give the same bits, on any number of threads.
    pub fn solve(&self, symmetry: Symmetry, constraints: &[Constraint]) -> Vec<DVec2> {
        let system = System { graph: self, turns: self.turns(symmetry), constraints };
        let mut u = system.conjugate_gradients();
        for _ in 0..UNIT_ROUNDS {
            u = system.unit_round(&u);
        }
        u
    }
}

struct System<'a> {
    graph: &'a FieldGraph,
    /// ρ of every edge.
    turns: &'a [DVec2],
    constraints: &'a [Constraint],
}

impl System<'_> {
    /// Σ w ρ u over the neighbours, and Σ w.
    fn gathered(&self, u: &[DVec2], sample: usize) -> (DVec2, f64) {
        let edges = self.graph.edges_of(sample);
        let turns = &self.turns[self.graph.starts[sample] as usize..][..edges.len()];
        let mut sum = DVec2::ZERO;
        for (edge, turn) in edges.iter().zip(turns) {
            sum += turn.rotate(u[edge.to as usize]) * edge.weight;
        }
        (sum, self.graph.weights[sample])
    }

    fn map(&self, value: impl Fn(usize) -> DVec2 + Send + Sync) -> Vec<DVec2> {
        (0..self.graph.len()).into_par_iter().with_min_len(512).map(value).collect()
    }

    /// The matrix of the normal equations times `u`.
    fn apply(&self, u: &[DVec2]) -> Vec<DVec2> {
        self.map(|sample| {
            let (sum, weights) = self.gathered(u, sample);
            u[sample] * (weights + self.constraints[sample].weight) - sum
        })
    }

    /// Solves the linear problem (preconditioned by the diagonal) and normalises. Sums run in a fixed order, so the
    /// bits do not depend on the threads.
    fn conjugate_gradients(&self) -> Vec<DVec2> {
        let count = self.graph.len();
        let diagonal: Vec<f64> =
            (0..count).map(|sample| self.graph.weights[sample] + self.constraints[sample].weight).collect();
        let dot = |a: &[DVec2], b: &[DVec2]| a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum::<f64>();
        let mut u: Vec<DVec2> = self.constraints.iter().map(|constraint| constraint.target).collect();
        let applied = self.apply(&u);
        let mut residual: Vec<DVec2> = (0..count)
            .map(|i| self.constraints[i].target * self.constraints[i].weight - applied[i])
            .collect();
        let scaled = |residual: &[DVec2]| -> Vec<DVec2> {
            residual.iter().zip(&diagonal).map(|(r, d)| *r / d.max(f64::MIN_POSITIVE)).collect()
        };
        let mut z = scaled(&residual);
        let mut direction = z.clone();
        let mut rz = dot(&residual, &z);
        let enough = rz * RESIDUAL * RESIDUAL;
        for _ in 0..MOST_STEPS {
            if rz <= enough || !rz.is_finite() || rz <= 0.0 {
                break;
            }
            let applied = self.apply(&direction);
            let step = rz / dot(&direction, &applied);
            if !step.is_finite() {
                break;
            }
            for i in 0..count {
                u[i] += direction[i] * step;
                residual[i] -= applied[i] * step;
            }
            z = scaled(&residual);
            let next = dot(&residual, &z);
            let share = next / rz;
            for i in 0..count {
                direction[i] = z[i] + direction[i] * share;
            }
            rz = next;
        }
        u.iter()
            .zip(self.constraints)
            .map(|(u, constraint)| u.try_normalize().unwrap_or(constraint.target))
            .collect()
    }

    /// Moves every sample half-way to the weighted mean of its neighbours and its target, then normalises it. This
    /// never raises the sum that the field minimises; whole steps could oscillate.
    fn unit_round(&self, u: &[DVec2]) -> Vec<DVec2> {
        self.map(|sample| {
            let (sum, weights) = self.gathered(u, sample);
            let constraint = self.constraints[sample];
            let pull = sum + constraint.target * constraint.weight;
            (pull + u[sample] * (weights + constraint.weight)).try_normalize().unwrap_or(u[sample])
        })
    }
}

/// Points spread evenly over a unit sphere along a spiral, and their spacing. On this sphere a point's position is also
/// its normal. The tests of this folder share them.
#[cfg(test)]
pub(super) fn spiral_sphere(count: usize) -> (Vec<Vec3>, f64) {
    use glam::DVec3;
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let points = (0..count).map(|index| {
        let y = 1.0 - 2.0 * (index as f64 + 0.5) / count as f64;
        let around = golden * index as f64;
        let across = (1.0 - y * y).sqrt();
        DVec3::new(across * around.cos(), y, across * around.sin()).as_vec3()
    });
    (points.collect(), crate::sampling::hexagonal_spacing(4.0 * std::f64::consts::PI, count))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::direction::{angle_between, tangent_axes};

    #[test]
    fn a_plane_with_one_constraint_is_parallel_everywhere() {
        let positions: Vec<Vec3> =
            (0..400).map(|i| Vec3::new((i % 20) as f32, (i / 20) as f32, 0.0)).collect();
        let normals = vec![Vec3::Z; 400];
        let graph = FieldGraph::new(&positions, &normals, 1.0, |_, _| true);
        for symmetry in [Symmetry::Arrows, Symmetry::Lines] {
            let axes = tangent_axes(DVec3::Z);
            let wanted = DVec3::new(0.6, 0.8, 0.0);
            let prior = symmetry.encode(DVec3::X, axes);
            let mut constraints = vec![Constraint { target: prior, weight: 1e-6 }; 400];
            constraints[210] = Constraint { target: symmetry.encode(wanted, axes), weight: 10.0 };
            let field = graph.solve(symmetry, &constraints);
            let worst = field
                .iter()
                .map(|&u| angle_between(symmetry, symmetry.decode(u, axes), wanted))
                .fold(0.0, f64::max);
            assert!(worst.to_degrees() < 0.5, "{symmetry:?}: {}", worst.to_degrees());
        }
    }

    #[test]
    fn a_ring_of_constraints_spreads_smoothly_over_a_sphere() {
        let (positions, spacing) = spiral_sphere(4096);
        let graph = FieldGraph::new(&positions, &positions, spacing, |_, _| true);
        let symmetry = Symmetry::Lines;
        let constraints: Vec<Constraint> = positions
            .iter()
            .map(|position| {
                let normal = position.as_dvec3();
                let axes = tangent_axes(normal);
                // The front is combed 35 degrees off the vertical; the back is free.
                let front = crate::direction::towards(DVec3::new(0.57, 0.82, 0.0), normal);
                let weight = if normal.z > 0.3 { 100.0 } else { 1e-6 };
                Constraint { target: symmetry.encode(front, axes), weight }
            })
            .collect();
        let field = graph.solve(symmetry, &constraints);
        let mut apart: Vec<f64> = Vec::new();
        for sample in 0..graph.len() {
            for edge in graph.edges_of(sample) {
                let there = symmetry.turn(edge.transport_rad).rotate(field[edge.to as usize]);
                apart.push(there.angle_to(field[sample]).abs().to_degrees() / 2.0);
            }
        }
        apart.sort_by(f64::total_cmp);
        let (median, p95) = (apart[apart.len() / 2], apart[apart.len() * 95 / 100]);
        println!("neighbours differ by {median:.2}, p95 {p95:.2} degrees over {} pairs", apart.len());
        assert!(median < 3.0 && p95 < 12.0, "median {median}, p95 {p95}");
        // The number of threads changes no bit.
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        assert_eq!(one.install(|| graph.solve(symmetry, &constraints)), field);
    }
}
