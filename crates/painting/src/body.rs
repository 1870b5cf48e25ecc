//! The surface of a body, with its materials.

use std::sync::Arc;

use impasto_core::TriangleMesh;
use impasto_core::shells::Side;
use impasto_scene::mesh_file::{Sampler, Texture};

use crate::body_bend::BodyBend;

/// A surface with its materials, in model space (static scale applied).
#[derive(Debug)]
pub struct BodySurface {
    /// The triangles.
    pub mesh: TriangleMesh,
    /// For each triangle, the side that can be seen.
    pub sides: Vec<Side>,
    /// The targets, joints and point cache that bend it.
    pub(crate) bending: BodyBend,
    /// Indexed by `mesh.material_of_triangle`.
    pub materials: Vec<BodyMaterial>,
}

/// A resolved material.
#[derive(Clone, Debug)]
pub struct BodyMaterial {
    /// Its name in the mesh file; may be empty.
    pub name: String,
    /// Linear Rec. 709 albedo.
    pub albedo: [f32; 3],
    /// Multiplies `albedo`; sRGB bytes.
    pub texture: Option<Arc<Texture>>,
    /// How the texture is read.
    pub sampler: Sampler,
    /// Where the texture's alpha, 0..=1, is less than this, there is no surface; without a texture, alpha is 1.
    pub cutoff: Option<f32>,
    /// Whether it is shown as it is, without light or shadow.
    pub unlit: bool,
    /// Strength of highlights, 0 matt .. 1 glazed.
    pub gloss: f32,
}
