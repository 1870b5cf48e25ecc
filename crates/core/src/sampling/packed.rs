//! Particles in 12 bytes each, since millions of them are held in memory.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::Particle;
use crate::TriangleMesh;
use crate::hash;

/// The bit of `triangle_and_side` that is set for particles on the back of their triangle.
const FLIPPED: u32 = 1 << 31;

/// The part of a [`Particle`] that cannot be computed from its mesh, in 12 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct PackedParticle {
    /// Index of the triangle; the top bit is [`FLIPPED`].
    triangle_and_side: u32,
    /// Weights of the triangle's second and third corner.
    barycentric: [f32; 2],
}

impl PackedParticle {
    /// Packs a particle of a mesh with fewer than 2³¹ triangles.
    #[inline]
    pub fn of(particle: &Particle) -> Self {
        let side = if particle.flipped { FLIPPED } else { 0 };
        Self { triangle_and_side: particle.triangle | side, barycentric: particle.barycentric }
    }

    /// Index of the triangle.
    #[inline]
    pub fn triangle(self) -> usize {
        (self.triangle_and_side & !FLIPPED) as usize
    }

    /// Weights of the triangle's three corners.
    #[inline]
    pub fn weights(self) -> [f32; 3] {
        let [v, w] = self.barycentric;
        [1.0 - v - w, v, w]
    }

    /// Random bits that depend on the place and the seed alone.
    #[inline]
    pub fn random_bits(self, seed: u32) -> u32 {
        let [v, w] = self.barycentric.map(f32::to_bits);
        [self.triangle_and_side, v, w].into_iter().fold(seed, hash::combine)
    }

    /// Unpacks the particle on the mesh that it was sampled on; equal to the bit to the one that was packed.
    #[inline]
    pub fn on(self, mesh: &TriangleMesh) -> Particle {
        let unplaced = Particle {
            triangle: self.triangle_and_side & !FLIPPED,
            barycentric: self.barycentric,
            flipped: self.triangle_and_side & FLIPPED != 0,
            position: Vec3::ZERO,
            normal: Vec3::Y,
        };
        unplaced.on(mesh, &mesh.positions, &mesh.normals)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_packed_particle_gives_the_same_bits() {
        let mesh = TriangleMesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            normals: vec![Vec3::Z, Vec3::new(0.6, 0.0, 0.8), Vec3::Z],
            triangles: vec![[0, 1, 2]],
            ..TriangleMesh::default()
        };
        for flipped in [false, true] {
            let unplaced = Particle {
                triangle: 0,
                barycentric: [0.31, 0.17],
                flipped,
                position: Vec3::ZERO,
                normal: Vec3::Y,
            };
            let particle = unplaced.on(&mesh, &mesh.positions, &mesh.normals);
            assert_eq!(PackedParticle::of(&particle).on(&mesh), particle);
        }
    }
}
