//! Mesh files after reading, the same for every format: the mesh, group names, materials and their textures.

use std::sync::Arc;

use impasto_core::TriangleMesh;
use impasto_core::bending::Bend;
pub use impasto_gltf::{Sampler, Wrap};

/// A mesh with the names and materials of its file.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshFile {
    /// The surface.
    pub mesh: TriangleMesh,
    /// Group names, indexed by `mesh.group_of_triangle`. At least one.
    pub groups: Vec<String>,
    /// Materials, indexed by `mesh.material_of_triangle`. At least one; faces without a material use a grey one.
    pub materials: Vec<Material>,
    /// The morph targets and joints that bend it; `None` if there are none.
    pub bend: Option<Arc<Bend>>,
    /// The points of the file, for a point cache to move; `None` if they were not asked for, or the file does not have
    /// them.
    pub points: Option<Arc<Points>>,
}

impl MeshFile {
    /// A mesh that nothing bends.
    pub fn still(mesh: TriangleMesh, groups: Vec<String>, materials: Vec<Material>) -> Self {
        Self { mesh, groups, materials, bend: None, points: None }
    }
}

/// The points of a mesh file, in the order of the file: the `v` lines of an OBJ file, the `_POINT` numbers of a glTF
/// file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Points {
    /// How many there are.
    pub count: usize,
    /// For each vertex of the mesh, the index of its point.
    pub of_vertex: Vec<u32>,
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
    /// How the texture is read.
    pub sampler: Sampler,
    /// There is no surface where the texture's alpha (0..=1) is less than this. Without a texture, alpha is 1. `None`
    /// ignores alpha.
    pub cutoff: Option<f32>,
    /// Strength of highlights, 0 matt .. 1 glazed.
    pub gloss: f32,
    /// Shown as it is, without light or shadow.
    pub unlit: bool,
}

impl Material {
    /// A matt material of one colour (sRGB, each channel in 0..=1).
    pub fn plain(name: impl Into<String>, color: [f32; 3]) -> Self {
        let name = name.into();
        let sampler = Sampler::default();
        Self { name, color, texture: None, sampler, cutoff: None, gloss: 0.0, unlit: false }
    }
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

    /// The pixel at these texture coordinates: V points up, and (0, 0) is the lower left corner.
    pub fn pixel(&self, sampler: Sampler, [u, v]: [f32; 2]) -> [u8; 4] {
        let at = |wrap: Wrap, along: f32, size: u32| {
            let unit = match wrap {
                Wrap::Repeat => along.rem_euclid(1.0),
                Wrap::Mirror => 1.0 - (along.rem_euclid(2.0) - 1.0).abs(),
                Wrap::Clamp => along,
            };
            // The cast turns negative numbers into 0.
            ((unit * size as f32) as u32).min(size - 1)
        };
        let [width, height] = self.size_px;
        let row = height - 1 - at(sampler.wrap_v, v, height);
        self.rgba8[(row * width + at(sampler.wrap_u, u, width)) as usize]
    }
}
