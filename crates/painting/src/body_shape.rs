//! The shape of a body at one time, as numbers: what bends it, and its noise.

use std::sync::Arc;

use glam::Vec2;
use impasto_core::bending::BendPose;
use impasto_core::noise_displace::{Lookup, Tile, VertexNoise};
use impasto_scene::document::NoiseDisplace;

/// The noise of one body.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyNoise {
    /// What moves its vertices.
    pub vertex: Option<VertexNoise>,
    /// What colours it.
    pub layers: Option<NoiseLayers>,
    /// As the scene states it.
    pub(crate) stated: NoiseDisplace,
}

/// Layers of one texture that move against each other, multiplied.
#[derive(Clone, Debug, PartialEq)]
pub struct NoiseLayers {
    /// The texture.
    pub tile: Arc<Tile>,
    /// k, at least 1: the layers 1 to k − 1 are multiplied. With 1, the tint alone shows.
    pub count: u32,
    /// How fast layers move; also how far apart they begin.
    pub speed: f32,
    /// Factors on the texture coordinates.
    pub tiling: Vec2,
    /// What is added to the texture coordinates after `tiling`.
    pub offset: Vec2,
    /// Which way the first layer goes, 1 or −1; each later layer goes against the one before it.
    pub first_way: f32,
    /// The power that the product is raised to.
    pub exponent: f32,
    /// Linear Rec. 709, intensity multiplied in: may be brighter than 1.
    pub tint: [f32; 3],
    /// Multiplies alpha.
    pub opacity: f32,
    /// Whether the first channel is the alpha too.
    pub alpha_is_grey: bool,
    /// How much of what is brighter than `threshold` is spread as a glow.
    pub bloom: f32,
    /// The brightness above which the surface glows.
    pub threshold: f32,
}

/// The noise of a body at one time.
#[derive(Clone, Debug)]
pub struct FrameNoise {
    /// The noise, shared between frames.
    pub noise: Arc<BodyNoise>,
    /// Where its vertices look their noise up.
    pub lookup: Lookup,
    /// How far the layers have moved, in lengths of the texture: only the fractional part. Speed is multiplied in.
    pub travelled: Vec2,
}

/// Equal where the vertices are moved alike; colours are not compared.
impl PartialEq for FrameNoise {
    fn eq(&self, other: &Self) -> bool {
        match (&self.noise.vertex, &other.noise.vertex) {
            (Some(here), Some(there)) => self.lookup == other.lookup && here == there,
            (here, there) => here.is_none() && there.is_none(),
        }
    }
}

/// The shape of a surface at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BodyShape {
    /// The weights of targets and the joints, model space; `None` if they are as in the mesh file.
    pub pose: Option<Arc<BendPose>>,
    /// The frame at which its point cache is read.
    pub cache_frame: Option<f64>,
    /// The noise that displaces it.
    pub noise: Option<FrameNoise>,
}

impl BodyShape {
    /// The noise that moves vertices, and where they look it up.
    pub(crate) fn displacing(&self) -> Option<(&VertexNoise, &Lookup)> {
        let noise = self.noise.as_ref()?;
        Some((noise.noise.vertex.as_ref()?, &noise.lookup))
    }
}
