//! A particle's place alone, for keeping millions of them.

use glam::Vec3;

use super::Particle;
use crate::TriangleMesh;

/// The bit of [`Place`] that says on which side of its triangle it is.
const FLIPPED: u32 = 1 << 31;

/// What of a [`Particle`] cannot be computed from its mesh, in 12 bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Index of the triangle, with [`FLIPPED`].
    triangle_and_side: u32,
    /// Weights of the triangle's second and third corner.
    barycentric: [f32; 2],
}

impl Place {
    /// Of a particle of a mesh with fewer than 2³¹ triangles.
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

    /// The particle again, to the bit, on the mesh that it was sampled on.
    #[inline]
    pub fn on(self, mesh: &TriangleMesh) -> Particle {
        let place = Particle {
            triangle: self.triangle_and_side & !FLIPPED,
            barycentric: self.barycentric,
            flipped: self.triangle_and_side & FLIPPED != 0,
            position: Vec3::ZERO,
            normal: Vec3::Y,
        };
        place.on(mesh, &mesh.positions, &mesh.normals)
    }
}
