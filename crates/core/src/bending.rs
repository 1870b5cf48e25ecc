//! Bending: where the vertices of a mesh are when morph targets and joints move them, and how a bent surface carries
//! what lies on it.
//!
//! ```text
//! bound ─▶ + Σ weight · target ─▶ Σ weight · joint ─┬─▶ (noise) ─▶ vertices ─▶ Gradients: F at each ─▶ carry
//!                    or, instead, points of a cache ┘
//! ```
//!
//! F is the deformation gradient: it takes a step on the surface at rest to the same step on the bent one. Where there
//! is a point cache, its points replace targets and joints. The cache and the noise are applied by the `painting`
//! crate.

mod bonds;
mod carry;
mod gradient;

use std::ops::Range;

use glam::{DAffine3, Vec3};
use rayon::prelude::*;

pub use bonds::Bonds;
pub use carry::{CarriedPlace, Carrier, SortedParticles, most_growth, normals_around};
pub use gradient::Gradients;

/// The vertices of a mesh in some shape, model space.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Vertices {
    /// One for each vertex of the mesh.
    pub positions: Vec<Vec3>,
    /// Unit, one for every position.
    pub normals: Vec<Vec3>,
}

/// What bends a mesh: morph targets first, then joints.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bend {
    /// The vertices before anything bends them, in the space in which the joints are bound.
    pub bound: Vertices,
    /// Morph targets.
    pub targets: Vec<Target>,
    /// Which joints move the vertices.
    pub skin: Option<SkinWeights>,
    /// The pose in which the mesh is at rest.
    pub rest: BendPose,
    /// True if the file does not say how targets change normals. Then the normals that [`Bend::at`] gives are not
    /// used: [`Gradients::normals`] finds normals from how the bent surface turns.
    pub turns_normals: bool,
}

/// A morph target: what a weight of 1 adds. Only the vertices that it moves are listed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Target {
    /// Indices of vertices, increasing.
    pub vertices: Vec<u32>,
    /// Added to the position of each of them.
    pub positions: Vec<Vec3>,
    /// Added to the normal of each of them.
    pub normals: Vec<Vec3>,
}

/// Joints and weights of all vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SkinWeights {
    /// How many joints move a vertex.
    pub per_vertex: usize,
    /// `per_vertex` indices for each vertex.
    pub joints: Vec<u16>,
    /// `per_vertex` weights for each vertex, not negative, with a sum of one.
    pub weights: Vec<f32>,
}

/// How far targets and joints have moved at a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BendPose {
    /// The weight of each target; those left out are 0.
    pub weights: Vec<f32>,
    /// For each joint, the map into model space from the space in which the mesh was bound. With no joints, vertices
    /// stay where targets put them.
    pub joints: Vec<DAffine3>,
}

/// How many vertices one task moves.
const CHUNK: usize = 2048;

/// A joint in single precision: rows of a 3×4 matrix.
type Rows = [[f32; 4]; 3];

impl Target {
    /// The target that takes vertices from one place to another.
    pub fn between(from: &Vertices, to: &Vertices) -> Self {
        let mut target = Self::default();
        for vertex in 0..from.positions.len() {
            let position = to.positions[vertex] - from.positions[vertex];
            let normal = to.normals[vertex] - from.normals[vertex];
            target.push(vertex as u32, position, normal);
        }
        target
    }

    /// Adds a vertex if the target changes its position or its normal.
    pub fn push(&mut self, vertex: u32, position: Vec3, normal: Vec3) {
        if position != Vec3::ZERO || normal != Vec3::ZERO {
            self.vertices.push(vertex);
            self.positions.push(position);
            self.normals.push(normal);
        }
    }

    fn entries(&self, vertices: &Range<usize>) -> Range<usize> {
        let first = |limit: usize| self.vertices.partition_point(|&vertex| (vertex as usize) < limit);
        first(vertices.start)..first(vertices.end)
    }
}

impl Bend {
    /// The vertices in a pose, by linear blend skinning: `Σ w J (p + Σ m d)`. J and w are the matrices and weights of
    /// the joints, p is the bound position, d and m are the offsets and weights of the targets. Normals are transformed
    /// by the cofactors of the blended matrix `Σ w J`. A normal that vanishes stays as it was bound.
    pub fn at(&self, pose: &BendPose) -> Vertices {
        let joints: Vec<Rows> = pose.joints.iter().map(rows).collect();
        let count = self.bound.positions.len();
        let mut bent = Vertices { positions: vec![Vec3::ZERO; count], normals: vec![Vec3::ZERO; count] };
        let chunks = bent.positions.par_chunks_mut(CHUNK).zip(bent.normals.par_chunks_mut(CHUNK));
        chunks.enumerate().for_each(|(chunk, (positions, normals))| {
            let range = chunk * CHUNK..chunk * CHUNK + positions.len();
            positions.copy_from_slice(&self.bound.positions[range.clone()]);
            normals.copy_from_slice(&self.bound.normals[range.clone()]);
            self.morph(&pose.weights, &range, positions, normals);
            if let Some(skin) = self.skin.as_ref().filter(|_| !joints.is_empty()) {
                skin.move_all(&joints, range.start, positions, normals);
            }
            for (normal, bound) in normals.iter_mut().zip(&self.bound.normals[range]) {
                *normal = normal.try_normalize().unwrap_or(*bound);
            }
        });
        bent
    }

    fn morph(&self, weights: &[f32], range: &Range<usize>, positions: &mut [Vec3], normals: &mut [Vec3]) {
        for (target, &weight) in self.targets.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
            for entry in target.entries(range) {
                let vertex = target.vertices[entry] as usize - range.start;
                positions[vertex] += target.positions[entry] * weight;
                normals[vertex] += target.normals[entry] * weight;
            }
        }
    }
}

impl SkinWeights {
    /// Moves a run of vertices; `first` is the index of the first of them.
    fn move_all(&self, joints: &[Rows], first: usize, positions: &mut [Vec3], normals: &mut [Vec3]) {
        let of_vertex = |list: usize| list * self.per_vertex..(list + 1) * self.per_vertex;
        for (offset, (position, normal)) in positions.iter_mut().zip(normals).enumerate() {
            let range = of_vertex(first + offset);
            let mut blend = [[0.0f32; 4]; 3];
            for (&joint, &weight) in self.joints[range.clone()].iter().zip(&self.weights[range]) {
                let Some(rows) = joints.get(usize::from(joint)).filter(|_| weight > 0.0) else { continue };
                for (sum, row) in blend.iter_mut().zip(rows) {
                    for (sum, value) in sum.iter_mut().zip(row) {
                        *sum += value * weight;
                    }
                }
            }
            let [x, y, z] = blend.map(|[a, b, c, _]| Vec3::new(a, b, c));
            let moved = Vec3::new(x.dot(*position), y.dot(*position), z.dot(*position));
            *position = moved + Vec3::new(blend[0][3], blend[1][3], blend[2][3]);
            // The rows of the cofactor matrix are the cross products of the blended matrix's rows.
            *normal = Vec3::new(y.cross(z).dot(*normal), z.cross(x).dot(*normal), x.cross(y).dot(*normal));
        }
    }
}

fn rows(joint: &DAffine3) -> Rows {
    [0, 1, 2].map(|row| {
        let linear = joint.matrix3.row(row).as_vec3();
        [linear.x, linear.y, linear.z, joint.translation[row] as f32]
    })
}

#[cfg(test)]
mod tests;
