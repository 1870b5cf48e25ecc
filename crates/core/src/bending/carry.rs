//! Carries particles along with a bent surface.

use glam::{DMat3, DVec3, Mat3, Vec3};
use rayon::prelude::*;

use super::gradient::cofactors;
use crate::TriangleMesh;
use crate::sampling::PackedParticle;
use crate::solve::BakedParticles;

/// How many particles one task carries.
const CHUNK: usize = 4096;

/// A bent surface, ready to carry what lies on it.
#[derive(Clone, Debug)]
pub struct Carrier {
    /// For each vertex its position and the columns of F.
    vertices: Vec<[f32; 12]>,
}

/// A place on a surface at rest, carried to where it is now.
#[derive(Clone, Copy, Debug)]
pub struct CarriedPlace {
    /// Where it is now, model space.
    pub position: DVec3,
    /// F: takes steps on the surface at rest to steps now.
    pub gradient: DMat3,
}

impl CarriedPlace {
    /// The unit normal now of a side that had this normal at rest; that one where the surface has collapsed.
    pub fn normal(&self, at_rest: DVec3) -> DVec3 {
        let DMat3 { x_axis: x, y_axis: y, z_axis: z } = self.gradient;
        (y.cross(z) * at_rest.x + z.cross(x) * at_rest.y + x.cross(y) * at_rest.z).normalize_or(at_rest)
    }

    /// The rows of a Jacobian here, pulled back to the surface at rest: `J F`.
    pub fn pulled_back(&self, jacobian: [DVec3; 2]) -> [DVec3; 2] {
        jacobian.map(|row| self.gradient.transpose() * row)
    }
}

impl Carrier {
    /// From the positions of all vertices, and F at each.
    pub fn new(positions: &[Vec3], gradients: &[Mat3]) -> Self {
        let record = |(position, gradient): (&Vec3, &Mat3)| {
            let [x, y, z] = position.to_array();
            let [a, b, c, d, e, f, g, h, i] = gradient.to_cols_array();
            [x, y, z, a, b, c, d, e, f, g, h, i]
        };
        Self { vertices: positions.par_iter().zip(gradients).with_min_len(CHUNK).map(record).collect() }
    }

    /// Position and F at a place.
    #[inline(always)]
    fn blended(&self, mesh: &TriangleMesh, place: PackedParticle) -> [f32; 12] {
        let [a, b, c] = mesh.triangles[place.triangle()].map(|vertex| &self.vertices[vertex as usize]);
        let [u, v, w] = place.weights();
        std::array::from_fn(|index| a[index] * u + b[index] * v + c[index] * w)
    }

    /// Where a place is now.
    pub fn place(&self, mesh: &TriangleMesh, place: PackedParticle) -> CarriedPlace {
        let [x, y, z, gradient @ ..] = self.blended(mesh, place).map(f64::from);
        CarriedPlace { position: DVec3::new(x, y, z), gradient: DMat3::from_cols_array(&gradient) }
    }

    /// Particles that were baked at rest, carried to where they are now: N'' = F N'. **The length of a normal is then the area of the
    /// surface now over that at rest**: projected areas come out per unit of surface at rest. `height` is how far a
    /// particle is lifted off the surface.
    pub fn carry(
        &self,
        mesh: &TriangleMesh,
        places: &[PackedParticle],
        baked: &BakedParticles,
        height: impl Fn(usize) -> f32 + Sync,
    ) -> BakedParticles {
        let mut carried = BakedParticles::default();
        carried.resize(baked.len());
        carried.chunks_mut(0, CHUNK).into_par_iter().enumerate().for_each(|(chunk, mut chunk_out)| {
            let first = chunk * CHUNK;
            for (offset, &place) in places[first..baked.len().min(first + CHUNK)].iter().enumerate() {
                let index = first + offset;
                let [x, y, z, columns @ ..] = self.blended(mesh, place);
                let gradient = Mat3::from_cols_array(&columns);
                let of =
                    |arrays: &[Vec<f32>; 3]| Vec3::new(arrays[0][index], arrays[1][index], arrays[2][index]);
                let normal = cofactors(&gradient) * of(&baked.normal);
                let mut position = Vec3::new(x, y, z);
                let height = height(index);
                if height != 0.0 {
                    position += normal.normalize_or_zero() * height;
                }
                let (along, across) = (gradient * of(&baked.along), gradient * of(&baked.across));
                chunk_out.set_f32(offset, [position, normal, along, across]);
            }
        });
        carried.flatness.clone_from(&baked.flatness);
        carried
    }
}
