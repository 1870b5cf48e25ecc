//! Noise-displaced materials: makes the noise of a body from what the document states.

use std::sync::Arc;

use glam::{DAffine3, DVec2};
use impasto_core::noise_displace::{
    Along, Lookup, Tile, VertexNoise, gaussian, perlin, travelled, vertex_shift,
};
use impasto_scene::document::{
    NoiseAlong, NoiseAlpha, NoiseDisplace, NoiseForward, NoiseMix, NoiseNormals, NoiseSpace, Object,
    SurfaceNoise,
};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::mesh_file::Texture;

use crate::body_shape::{BodyNoise, FrameNoise, NoiseLayers};
use crate::lights::linear;

impl BodyNoise {
    /// The noise of a body in this pose at this time.
    pub(crate) fn at(self: &Arc<Self>, seconds: f64, world_from_model: DAffine3) -> FrameNoise {
        let travelled = travelled(seconds, self.stated.period_secs);
        let lookup = match &self.stated.vertex {
            Some(vertex) => {
                let space = (vertex.space == NoiseSpace::World).then_some(world_from_model);
                Lookup::new(vertex.value, space, vertex_shift(travelled))
            }
            None => Lookup::new([0.0; 2], None, DVec2::ZERO),
        };
        let speed = self.stated.surface.as_ref().map_or(0.0, |surface| surface.speed);
        let travelled = travelled * speed;
        // The texture repeats, so only the fraction matters. Without the whole part it stays exact at late frames.
        FrameNoise { noise: Arc::clone(self), lookup, travelled: (travelled - travelled.floor()).as_vec2() }
    }

    /// How far noise may move a vertex along each axis, model units.
    pub(crate) fn reach(&self) -> f32 {
        self.vertex.as_ref().map_or(0.0, |vertex| 0.5 * vertex.scale.abs() as f32)
    }
}

#[derive(Clone, Default)]
pub(crate) struct NoiseInputs {
    stated: Option<NoiseDisplace>,
    /// The pictures of the noise, first for the vertices, then for the surface; none where the built-in noise is used.
    pictures: [Option<Arc<Texture>>; 2],
}

impl PartialEq for NoiseInputs {
    fn eq(&self, other: &Self) -> bool {
        let same = |index: usize| match (&self.pictures[index], &other.pictures[index]) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (a, b) => a.is_none() && b.is_none(),
        };
        self.stated == other.stated && same(0) && same(1)
    }
}

impl NoiseInputs {
    pub(crate) fn new(loaded: &LoadedScene, object: &Object) -> Self {
        let Some(stated) = object.material.as_ref().and_then(|material| material.noise_displace.clone())
        else {
            return Self::default();
        };
        let of_vertex = stated.vertex.as_ref().and_then(|vertex| vertex.texture.as_ref());
        let of_surface = stated.surface.as_ref().and_then(|surface| surface.texture.as_ref());
        let pictures = [of_vertex, of_surface].map(|name| loaded.textures.get(name?).map(Arc::clone));
        Self { stated: Some(stated), pictures }
    }

    /// The noise. Textures are reused from the noise `before` where their pictures are the same.
    pub(crate) fn build(&self, before: Option<&(Self, Option<Arc<BodyNoise>>)>) -> Option<Arc<BodyNoise>> {
        let stated = self.stated.clone()?;
        let before = |index: usize| {
            let (inputs, noise) = before?;
            let (Some(was), Some(is)) = (&inputs.pictures[index], &self.pictures[index]) else { return None };
            let noise = noise.as_ref().filter(|_| Arc::ptr_eq(was, is))?;
            match index {
                0 => noise.vertex.as_ref().map(|vertex| Arc::clone(&vertex.tile)),
                _ => noise.layers.as_ref().map(|layers| Arc::clone(&layers.tile)),
            }
        };
        let tile = |index: usize, built_in: fn() -> Arc<Tile>| match &self.pictures[index] {
            Some(picture) => {
                before(index).unwrap_or_else(|| Arc::new(Tile::of_picture(picture.size_px, &picture.rgba8)))
            }
            None => built_in(),
        };
        let vertex = stated.vertex.as_ref().map(|vertex| VertexNoise {
            tile: tile(0, gaussian),
            scale: vertex.scale,
            along: match vertex.along {
                NoiseAlong::Channels => Along::Channels,
                NoiseAlong::Normal => Along::Normal,
            },
            moves_normals: vertex.normals == NoiseNormals::Displaced,
        });
        let layers = stated.surface.as_ref().map(|surface| layers(surface, tile(1, perlin)));
        Some(Arc::new(BodyNoise { vertex, layers, stated }))
    }
}

fn layers(surface: &SurfaceNoise, tile: Arc<Tile>) -> NoiseLayers {
    let count = surface.layer_count.max(1);
    // The colour is a root of a product. With a `layer_count` of k, the product has 2(k − 1) factors. `Mean` takes
    // their geometric mean, `Root` the k-th root of the product. With k = 1 there is no factor.
    let root_degree = match surface.mix {
        NoiseMix::Root => f64::from(count),
        NoiseMix::Mean => f64::from(2 * (count - 1).max(1)),
    };
    NoiseLayers {
        tile,
        count,
        speed: surface.speed as f32,
        tiling: DVec2::from(surface.tiling).as_vec2(),
        offset: DVec2::from(surface.tile_offset).as_vec2(),
        first_way: if surface.forward == NoiseForward::Odd { 1.0 } else { -1.0 },
        exponent: (1.0 / root_degree) as f32,
        tint: linear(surface.tint).map(|channel| channel * surface.intensity as f32),
        opacity: surface.opacity as f32,
        alpha_is_grey: surface.alpha == NoiseAlpha::Grey,
        bloom: surface.bloom as f32,
        threshold: surface.threshold as f32,
    }
}
