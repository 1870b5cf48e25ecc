//! Mesh files after reading, the same for every format: the mesh, group names, materials and their textures.

use std::sync::Arc;

use impasto_core::TriangleMesh;
pub use impasto_gltf::Wrap;

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
    /// How the texture is read.
    pub sampling: Sampling,
    /// Where the texture's alpha, 0..=1, is less than this, there is no surface; without a texture, alpha is 1. `None`: alpha means
    /// nothing.
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
        let sampling = Sampling::default();
        Self { name, color, texture: None, sampling, cutoff: None, gloss: 0.0, unlit: false }
    }
}

/// How a texture is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Sampling {
    /// Beyond the left and right border, and beyond the upper and lower border.
    pub wrap: [Wrap; 2],
    /// Whether pixels show as squares when the picture is enlarged.
    pub is_nearest: bool,
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

    /// The pixel at texture coordinates whose V points up, (0, 0) the lower left corner.
    pub fn pixel(&self, sampling: Sampling, uv: [f32; 2]) -> [u8; 4] {
        let at = |axis: usize| {
            let unit = match sampling.wrap[axis] {
                Wrap::Repeat => uv[axis].rem_euclid(1.0),
                Wrap::Mirror => 1.0 - (uv[axis].rem_euclid(2.0) - 1.0).abs(),
                Wrap::Clamp => uv[axis],
            };
            // The cast brings numbers below 0 to 0.
            ((unit * self.size_px[axis] as f32) as u32).min(self.size_px[axis] - 1)
        };
        let row = self.size_px[1] - 1 - at(1);
        self.rgba8[(row * self.size_px[0] + at(0)) as usize]
    }
}
