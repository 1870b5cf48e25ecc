//! Mesh files after reading, the same for every format: the mesh, group names, materials and their textures.

use std::sync::Arc;

use impasto_core::TriangleMesh;

/// A mesh with the names and materials of its file.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshFile {
    /// The surface.
    pub mesh: TriangleMesh,
    /// Group names, indexed by `mesh.group_of_triangle`. At least one.
    pub groups: Vec<String>,
    /// Materials, indexed by `mesh.material_of_triangle`. At least one; faces without `usemtl` use a grey one.
    pub materials: Vec<Material>,
}

/// A material of a mesh file.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The name in the mesh file; empty for the default.
    pub name: String,
    /// Base colour, sRGB encoded, each channel in 0..=1.
    pub color: [f32; 3],
    /// Multiplies `color` where the mesh has texture coordinates.
    pub texture: Option<Arc<Texture>>,
    /// Strength of highlights, 0 matt .. 1 glazed.
    pub gloss: f32,
    /// Shown as it is, without light or shadow.
    pub unlit: bool,
}

/// A decoded picture: 8 bits per channel, sRGB, straight alpha, first row on top.
#[derive(Debug, PartialEq)]
pub struct Texture {
    /// Width and height in pixels, each from 1 to [`Texture::MAX_SIDE_PX`].
    pub size_px: [u32; 2],
    /// `size_px[0] * size_px[1]` pixels.
    pub rgba8: Vec<[u8; 4]>,
}

impl Texture {
    /// The longest side that is kept; larger pictures are scaled down on reading, so that every GL driver takes them.
    pub const MAX_SIDE_PX: u32 = 4096;
}
